"""Optimal synthesis: parameter values of a linkage, within bounds, that minimise an objective and satisfy
constraints.

    block.py        keys of the task in a problem file, read into an OptimalTask
    ranges.py       ranges of the parameters and of the driver
    task.py         the task, and its checks before the search
    quantities/     quantities that may be an objective or a constraint
    candidates.py   evaluates linkages a generation at a time: objective and constraint violation
    evolution.py    differential evolution; parameters with discrete values
    many_starts.py  additional search for least-squares objectives: tournaments of random starting points
                    (Levenberg-Marquardt); parameters on which the motion depends linearly are solved for directly
    refinement.py   accurate values of one candidate from windows around their peaks, and sequential quadratic
                    programming
    solver.py       the search, which uses all of these
    outcome.py      results, tables and diagrams

Evolution and refinement use scipy. Its results were compared with those of the former implementations of this package,
on the four searches of the test bank and of `tmm bench synthesis` with three seeds each: both reached the same
objectives to 1e-11. With scipy the search takes 1.3 to 2 times as long (most on the six-bar), the refinement about as
long.

To add a quantity, write a class in a module of quantities/ and add it to the register there.
"""
