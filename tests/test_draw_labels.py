"""What is written on the sheets of all problems covers nothing that is drawn, and nothing else that is written."""

import numpy as np
import pytest
from bank import EVERY, drawn
from covering import covered

from tmm_cli.drawing.paper import Area, Circle, Drawing, Ground, Label, Line, Text, gaps, labels, place

DARK = "#000000"
A = Text(50 + 50j, "A", 4.0, DARK, "center")  # its letter is 2.7 mm wide and 2.9 mm high


def found(*marks):
    return [(one.text, one.kind, round(one.depth, 1)) for one in covered(Drawing.of((100.0, 100.0), [*marks, A]))]


@pytest.mark.parametrize("name", EVERY)
def test_no_text_covers_another_one_a_head_of_an_arrow_or_a_line(name):
    assert not [f"{stem}: {pair}" for stem, drawing in drawn(name).items() for pair in covered(drawing)]


def test_a_text_covers_what_meets_its_letters_and_by_how_much_is_measured():
    through, below = Line((40 + 50j, 60 + 50j), DARK, 0.2), Line((40 + 48.5j, 60 + 48.5j), DARK, 0.2)
    assert found(through, below) == [("A", "line", 1.2)]
    assert found(Area((51 + 50j, 55 + 51j, 55 + 49j), DARK, None, 0.0)) == [("A", "head", 0.4)]
    assert found(Circle(50 + 45j, 5.0, "white", DARK, 0.0)) == [("A", "line", 1.1)]
    assert not found(Circle(50 + 50j, 5.0, "white", DARK, 0.2))
    turned = Text(50 + 47j, "AAAA", 4.0, DARK, turn=90)
    assert found(turned)[0][1] == "text" and not found(Text(54 + 47j, "AAAA", 4.0, DARK, turn=90))


def test_what_a_white_field_about_a_text_hides_is_not_covered():
    line, field = Line((40 + 50j, 60 + 50j), DARK, 0.2, z=1), (45 + 45j, 55 + 45j, 55 + 55j, 45 + 55j)
    assert not found(line, Area(field, "white", DARK, 0.2, z=8))
    assert found(line, Area(field, "white", DARK, 0.2, z=0))


def test_labels_are_placed_alike_however_few_candidates_are_looked_at_together(monkeypatch):
    """All gaps of 400 labels would be arrays of 400 * 48 * 400 numbers; a bound of them changes no place."""

    def places():
        random = np.random.default_rng(5)
        anchors = 280 * random.random(400) + 200j * random.random(400)
        return [one.middle for one in place(Ground(0j, 280 + 200j), [Label("A", complex(z), 8, DARK) for z in anchors])]

    together, largest = places(), []
    monkeypatch.setattr(labels, "MOST_GAPS", 20_000)
    monkeypatch.setattr(labels, "gaps", lambda boxes, z: largest.append(len(boxes) * len(z)) or gaps(boxes, z))
    assert places() == together
    assert max(largest) <= 20_000
