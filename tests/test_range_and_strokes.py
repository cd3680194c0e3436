"""How far the driver goes, what stops it, and where strokes end."""

from __future__ import annotations

from models import results_of

UNITS = {"length": "mm", "angle": "deg"}


def test_the_group_that_stops_the_driver_is_named():
    """A parallelogram that could go on to 90 deg carries a lever whose rod ends its way before."""
    results = results_of({
        "tmm": 1, "units": UNITS, "points": {"O": [0, 0], "P": [0, 120]},
        "links": {
            "1": {"points": ["O", "A"], "length": 400},
            "2": {"points": {"P": [0, 0], "B": [400, 0], "D": [300, 0]}},
            "3": {"points": {"A": [0, 0], "B": [0, 120], "C": [-20, 190]}},
            "4": {"points": ["D", "E"], "length": 100},
            "5": {"points": ["C", "E"], "length": 60},
        },
        "driver": {"link": "1", "speed": 1},
        "sketch": {"at": 0, "B": [400, 120], "C": [380, 190], "D": [300, 120], "E": [320, 200]},
        "positions": {"at": [0]},
    }, "kinematics")  # fmt: skip
    assert {limit.group for limit in results.way.limits} == {"II(4,5)"}
