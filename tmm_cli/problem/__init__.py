"""Problem files: text to a linkage, with every message at its line and column."""
