"""Loads, the force plan group by group, and the Zhukovsky lever that checks it."""
