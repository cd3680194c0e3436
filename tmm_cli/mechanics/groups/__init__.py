"""Assur groups that can be solved, a module a type, and the pairs of which they are made."""
