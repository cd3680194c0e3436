"""Optimal synthesis: parameters of a linkage, within bounds, that minimise an objective and satisfy constraints.

    block.py        keys of the task in a problem file, read into an OptimalTask
    ranges.py       ranges of the parameters and of the driver
    task.py         the task, and its checks before the search
    quantities/     quantities that may be an objective or a constraint
    candidates.py   evaluates linkages a generation at a time: objective and constraint violation
    evolution.py    differential evolution; parameters with discrete values
    many_starts.py  for least squares, beside the evolution: tournaments of random starts (Levenberg-Marquardt);
                    parameters on which the motion depends linearly are found directly
    refinement.py   quantities of one candidate from windows around their peaks, and sequential quadratic programming
    solver.py       the search: all of these in order outcome.py      results, tables and diagrams

Evolution and refinement use scipy. They replaced our own implementations: on the four searches of the bank and of `tmm
bench synthesis`, with three seeds each, both reached the same objectives to 1e-11; the search takes 1.3 to 2 times as
long (most on the six-bar), the refinement about as long.

A new quantity is a class in a module of quantities/ and its name in the register there.
"""
