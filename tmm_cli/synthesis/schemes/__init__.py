"""Structural synthesis: schemes built of Assur groups."""
