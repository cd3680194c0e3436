"""Crank-slider from its stroke, or its mean speed, and two more."""
