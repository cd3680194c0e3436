"""Synthesis of a four-bar whose coupler passes through 2, 3 or 4 given positions."""
