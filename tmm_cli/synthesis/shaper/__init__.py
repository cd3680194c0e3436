"""Crank shaper by its stroke and k."""
