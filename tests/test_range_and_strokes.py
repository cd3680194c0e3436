"""How far the driver goes, what stops it, and where strokes end."""

from __future__ import annotations

import math

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


def test_a_dwell_at_the_end_of_a_stroke_makes_no_strokes_of_rounding():
    """Where the rod is the radius of curvature of the pin's path, the speed of the ram has a threefold zero."""
    results = results_of({
        "tmm": 1, "units": UNITS, "points": {"O": [0, 0]}, "guides": {"y": {"through": "O", "angle": 90}},
        "links": {
            "1": {"points": ["O", "A"], "length": 100},
            "2": {"points": {"A": [0, 0], "P": [0, -40]}},
            "3": {"points": ["P", "D"], "length": 180**2 / 60},
            "4": {"points": ["D"], "slides": {"on": "y"}},
        },
        "gears": {"ring": {"between": ["0", "2"], "carrier": "1", "radii": [150, 50], "inner": True}},
        "driver": {"link": "1", "speed": 1},
        "sketch": {"at": 90, "P": [0, 140], "D": [0, -400]},
    }, "kinematics")  # fmt: skip
    assert len(results.strokes.strokes) == 2
    top, bottom = sorted(stroke.start for stroke in results.strokes.strokes)
    assert math.degrees(top) - 90 < 1e-9
    assert abs(math.degrees(bottom) - 270) < 0.2
    assert abs(results.strokes.travel - 0.2) < 1e-15
