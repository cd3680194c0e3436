"""Optimal synthesis: numbers of a linkage within bounds that make an objective least and keep constraints.

    block.py        the block of a problem file as a Task (task.py); block_ranges.py, block_over.py: parts of it
    quantities/     what may be an objective or a constraint
    checks.py       what is said of a task before its search
    candidates.py   its linkages, a generation at once: objective and violation
    evolution.py    differential evolution finds where the best one lies; choices.py: where some values only may be
    exact.py        quantities of one candidate from windows about their peaks (peaks.py), and the polish on them
                    (polish.py: sequential quadratic programming)
    many_starts.py  beside it, for least squares: tournaments of random starts (settling.py: what is linear is found by
                    itself; least_squares.py: Levenberg-Marquardt)
    solver.py       all of it, in this order
    outcome.py      what is told of the best one; drawings.py: how it is drawn

Evolution and polish are scipy's. They replaced ones written by hand: on the four searches of the bank and of `tmm bench
synthesis`, three seeds each, both led to the same objectives to 1e-11, in 1.3 to 2 times the time of the search (most
on the six-bar) and about the same time of the polish.

A new quantity is a class in a file of quantities/ and its name in the registry there.
"""
