"""Measurements: what the program costs, and what it would cost otherwise."""
