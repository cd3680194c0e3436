"""Synthesis of a four-bar from pairs of input and output angles, or from a function that it must generate."""
