"""Choosing the assembly of a sketch, following it, and finding all of them."""
