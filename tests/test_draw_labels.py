"""What is written on the sheets of all problems covers nothing that is drawn, and nothing else that is written."""

import numpy as np
import pytest
from bank import EVERY, drawn
from covering import covered

from tmm_cli.drawing.paper import (
    AreaMark,
    CircleMark,
    Drawing,
    Label,
    LineMark,
    OccupiedArea,
    TextMark,
    box_distances,
    labels,
    place_labels,
)

DARK = "#000000"
A = TextMark(50 + 50j, "A", 4.0, DARK, "center")  # its letter is 2.7 mm wide and 2.9 mm high


def found(*marks):
    return [(one.text, one.kind, round(one.depth, 1)) for one in covered(Drawing.of((100.0, 100.0), [*marks, A]))]


@pytest.mark.parametrize("name", EVERY)
def test_no_text_covers_another_one_a_head_of_an_arrow_or_a_line(name):
    assert not [f"{stem}: {pair}" for stem, drawing in drawn(name).items() for pair in covered(drawing)]


def test_a_text_covers_what_meets_its_letters_and_by_how_much_is_measured():
    through, below = LineMark((40 + 50j, 60 + 50j), DARK, 0.2), LineMark((40 + 48.5j, 60 + 48.5j), DARK, 0.2)
    assert found(through, below) == [("A", "line", 1.2)]
    assert found(AreaMark((51 + 50j, 55 + 51j, 55 + 49j), DARK, None, 0.0)) == [("A", "head", 0.4)]
    assert found(CircleMark(50 + 45j, 5.0, "white", DARK, 0.0)) == [("A", "line", 1.1)]
    assert not found(CircleMark(50 + 50j, 5.0, "white", DARK, 0.2))
    turned = TextMark(50 + 47j, "AAAA", 4.0, DARK, turn=90)
    assert found(turned)[0][1] == "text" and not found(TextMark(54 + 47j, "AAAA", 4.0, DARK, turn=90))


def test_what_a_white_field_about_a_text_hides_is_not_covered():
    line, field = LineMark((40 + 50j, 60 + 50j), DARK, 0.2, z=1), (45 + 45j, 55 + 45j, 55 + 55j, 45 + 55j)
    assert not found(line, AreaMark(field, "white", DARK, 0.2, z=8))
    assert found(line, AreaMark(field, "white", DARK, 0.2, z=0))


def test_labels_are_placed_alike_however_few_candidates_are_looked_at_together(monkeypatch):
    """All gaps of 400 labels would be arrays of 400 * 48 * 400 numbers; a bound of them changes no place."""

    def places():
        random = np.random.default_rng(5)
        anchors = 280 * random.random(400) + 200j * random.random(400)
        return [
            one.middle
            for one in place_labels(OccupiedArea(0j, 280 + 200j), [Label("A", complex(z), 8, DARK) for z in anchors])
        ]

    together, largest = places(), []
    monkeypatch.setattr(labels, "MOST_DISTANCES", 20_000)
    monkeypatch.setattr(
        labels, "box_distances", lambda boxes, z: largest.append(len(boxes) * len(z)) or box_distances(boxes, z)
    )
    assert places() == together
    assert max(largest) <= 20_000
