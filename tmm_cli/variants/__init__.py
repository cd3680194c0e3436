"""Variants of a linkage that no tape can be written of: solved together on arrays, or one after another."""
