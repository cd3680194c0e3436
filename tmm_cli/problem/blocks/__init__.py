"""Blocks of a problem file: the keys of each block, and how it becomes part of a linkage."""
