"""Four-bar whose coupler takes 2, 3 or 4 given positions."""
