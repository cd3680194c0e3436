"""Optimal synthesis: numbers of a linkage within bounds that make an objective least and keep constraints.

A global search finds where the best candidate lies (evolution), then sequential quadratic programming on exact peaks
finds it (polish). Both are scipy's. They replaced differential evolution and quadratic programming written by hand: on
the four searches of the bank and of `tmm bench synthesis`, three seeds each, both led to the same objectives to 1e-11,
in 1.3 to 2 times the time of the search (the most on the six-bar) and about the same time of the polish.

A new quantity is a file in quantities/ and a line in its registry.
"""
