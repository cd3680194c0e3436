"""What students hand in, read from files that nobody has checked, and the empty sheets that they fill in."""
