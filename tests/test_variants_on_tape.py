"""Candidates of optimal synthesis on one tape are the candidates one by one: class III, wheels, several drivers."""

from __future__ import annotations

import numpy as np
import pytest
from test_synthesis_any_linkage import block, text_of

from tmm_cli.batch import SequentialVariants
from tmm_cli.problem import read_text
from tmm_cli.synthesis import Candidates, read_task

ALWAYS = (", when: working stroke", ""), ("from: working stroke", "from: 90")
TASKS = {
    "class III": (
        "press-class-iii",
        (("CE: 310, ", ""), (", FE: 270", ""), *ALWAYS),
        "{CE: [200, 400], FE: [200, 350]}",
        "moment",
    ),
    "class III, margin": ("press-class-iii", (("CE: 310, ", ""),), "{CE: [250, 400]}", "margin"),
    "class IV": ("class-iv", (("BD: 260, ", ""), *ALWAYS), "{BD: [255, 265]}", "{of: reaction, pair: D}"),
    "wheels with a lever group": ("sector-and-wheel", (("AB: 280, ", ""), *ALWAYS), "{AB: [270, 295]}", "moment"),
    "wheels that come round after turns": ("three-lobes", (("OA: 100, ", ""), ALWAYS[0]), "{OA: [90, 110]}", "moment"),
    "two cranks": ("five-bar", (("l: 180, ", ""),), "{l: [175, 195]}", "moment"),
}


@pytest.mark.parametrize("kind", TASKS)
def test_candidates_on_the_tape_are_those_one_by_one(kind):
    name, edits, vary, objective = TASKS[kind]
    text = text_of(name, *edits, (r"points: \{", block(vary, objective, "")))
    candidates = Candidates(read_task(read_text(text, "x.yaml")))
    assert candidates.traced
    forces = any(quantity.forces for quantity in candidates.quantities)
    one = SequentialVariants(candidates.task.make, candidates.first, candidates.outputs, forces=forces)
    numbers = candidates.numbers(np.random.default_rng(5).random((5, len(candidates.low))))
    found, expected = (of(numbers, candidates.places) for of in (candidates.program, one))
    assert candidates.cycle == one.driver_range(numbers[:1]).span[0, 0]
    for output in found:
        whole = np.all(np.isfinite(expected[output]), axis=1)  # goes through all its cycle
        assert np.any(whole) and np.array_equal(np.all(np.isfinite(found[output]), axis=1), whole), output
        off = np.abs(found[output] - expected[output])[whole]
        assert np.all(off <= 1e-11 * np.max(np.abs(expected[output][whole]))), output
