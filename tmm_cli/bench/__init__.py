"""Measurements of the product against other ways to compute the same; nothing else needs them."""
