"""Synthesis of a four-bar from the time ratio k and both extreme positions of its rocker."""
