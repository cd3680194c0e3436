"""Python interface of the course-project calculator: `load` a problem file and `solve` it.

    from tmm_cli import load, solve

    results = solve(load("problems/shaper.yaml"))
    results.reactions.balance.moment      # balancing moment (N m), one value for each position
    results.motion.named("E").a           # acceleration of point E (m/s2), complex: x + iy

For many driver positions and many variants at once, `prepare` the problems:

    batch = prepare([load(path) for path in paths])
    batch(q)["T.1"]                       # balancing moment (N m), shape (variants, positions)

All values are in SI units and radians. Invalid input raises `tmm_cli.problem.errors.ProblemError`.
"""

from __future__ import annotations

# Nothing is imported here: the command reads this file before its own, where an interruption is caught.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from tmm_cli.synthesis import load, prepare, redrive, solve

__version__ = "0.1.0"
__all__ = ["__version__", "load", "prepare", "redrive", "solve"]


def __getattr__(name: str) -> object:
    """Import a name of `__all__` when it is first used."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from tmm_cli.synthesis import solving

    return getattr(solving, name)
