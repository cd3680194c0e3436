"""Blocks of a problem file: their keys, and the parts of a linkage that are built from them."""
