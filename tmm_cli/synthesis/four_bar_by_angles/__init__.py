"""Four-bar by 2 to 5 pairs of angles of its input and output, given or taken from a function."""
