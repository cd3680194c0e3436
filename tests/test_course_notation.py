"""How a course writes (force guidelines of MATI): the frame's number, the letter of inertia forces, arms on paper, the
steps 2.3.1 to 2.3.4, and the lever as it is drawn."""

import html
import math
import re
from pathlib import Path

import numpy as np
import pytest
from bank import solved
from test_commands import tmm

import tmm_cli.mechanics.plans.lever_drawing as drawn_plans
from tmm_cli.mechanics.forces import list_free_bodies
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.plans import balance_drawings, drawn_check
from tmm_cli.note import solve_moment_equation

COURSE = Path("problems/course-1.yaml").read_text(encoding="utf-8")
DRIVEN = ("course-1", "course-2", "course-3", "course-4", "shaper", "crank-slider", "six-bar", "cylinder", "whitworth")


def written(tmp_path: Path, more: str) -> str:
    file = tmp_path / "course.yaml"
    file.write_text(f"{COURSE}\n{more}\n", encoding="utf-8")
    return str(file)


def note_text(tmp_path: Path, more: str, *options: str) -> str:
    done = tmm("note", written(tmp_path, more), "-o", str(tmp_path / "out"), *options)
    assert done.returncode == 0, done.stderr
    page = next((tmp_path / "out").rglob("note.html")).read_text(encoding="utf-8")
    body = re.sub(r"<style.*?</style>|<svg.*?</svg>", "", page, flags=re.S)
    return re.sub(r"\s+", " ", html.unescape(re.sub(r"<[^>]+>", "", body)))


def test_the_frame_is_printed_by_its_number_in_the_course(tmp_path):
    file = written(tmp_path, "frame: 6")
    forces = tmm("forces", file, "--position", "3").stdout
    assert {"R_65", "R_61", "R_63", "R_12"} <= set(re.findall(r"R_\d\d", forces))
    assert not re.findall(r"R_\d*0\d*", forces)
    structure = tmm("structure", file).stdout
    assert "I(6,1) → II(2,3) → II(4,5)" in structure
    assert "slotted-link mechanism 6-1-2-3-6, crank-slider mechanism 6-3-4-5-6" in structure
    assert re.search(r"x +6 – 5 ", structure)
    drawn = tmm("structure", file, "-o", str(tmp_path / "out"))
    assert drawn.returncode == 0


def test_the_number_of_the_frame_is_no_other_links(tmp_path):
    done = tmm("structure", written(tmp_path, "frame: 5"))
    assert done.returncode == 2
    told = [line.strip() for line in done.stderr.splitlines()]
    assert told[0].endswith("course.yaml:35:8: frame: a link already has this number")
    assert told[1:] == ["found:   5", "allowed: a number that no link has, e.g. 6"]


def test_the_number_of_the_frame_is_no_rollers(tmp_path):
    file = tmp_path / "cam.yaml"
    cam = Path("problems/cam-lever.yaml").read_text(encoding="utf-8")  # its roller is link 5
    file.write_text(f"{cam}\nframe: 5\n", encoding="utf-8")
    done = tmm("structure", str(file))
    assert done.returncode == 2
    assert "frame: a link already has this number" in done.stderr
    assert "allowed: a number that no link has, e.g. 6" in done.stderr


def test_the_number_that_a_message_offers_for_the_frame_is_free(tmp_path):
    """Links 1, 2, 4 and the frame are four links, but 4 is taken: 3 is free."""
    file = tmp_path / "gap.yaml"
    file.write_text(
        "tmm: 1\ntitle: Gap\nunits: {length: mm, angle: deg}\npoints: {O: [0, 0], D: [300, 0]}\n"
        "links:\n  1: {points: [O, A], length: 80}\n  4: {points: [A, B], length: 250}\n"
        "  2: {points: [D, B], length: 200}\ndriver: {link: 1, speed: 10}\n"
        "sketch: {at: 60, A: [40, 69], B: [260, 190]}\nframe: 4\n",
        encoding="utf-8",
    )
    done = tmm("structure", str(file))
    assert done.returncode == 2
    assert "allowed: a number that no link has, e.g. 3" in done.stderr
    file.write_text(file.read_text(encoding="utf-8").replace("frame: 4", "frame: 3"), encoding="utf-8")
    assert "I(3,1) → II(4,2)" in tmm("structure", str(file)).stdout


def test_explain_prints_the_frame_by_its_number_in_every_formula(tmp_path):
    told = tmm("explain", written(tmp_path, "frame: 6")).stdout
    assert re.findall(r"I\(\w,1\)", told) == ["I(6,1)", "I(6,1)"], "in the formula and in the order of work"


@pytest.mark.parametrize(
    ("tongue", "more", "letter"),
    [
        ("ru", "", "Φ5"),
        ("ru", "note: {inertia: U}", "U5"),
        ("en", "", "U5"),
        ("en", "note: {inertia: Φ}", "Φ5"),
    ],
)
def test_forces_of_inertia_have_the_letter_of_the_course(tmp_path, tongue, more, letter):
    forces = tmm("forces", written(tmp_path, more), "--position", "3", "--lang", tongue).stdout
    names = set(re.findall(r" ([UΦ]\d) ", forces))
    assert names == {f"{letter[0]}{link}" for link in range(1, 6)}
    assert f"{letter[0]}5=" in note_text(tmp_path, more, "--lang", tongue).replace(" ", "")


def test_arms_on_paper_are_metres_over_the_scale_and_couples_are_divided_by_it():
    """Equation 7: R34τ = (U4 h1 + G4 h2 - M4/μ)/DE, here with the signs of position 3 of mechanism 1."""
    results, k, mu = solved("course-1"), 3, 0.0025
    motion = results.motion
    equation = list_free_bodies(motion, results.reactions, k)[0].equations[0]
    found = solve_moment_equation(equation, mu=mu)
    e, s, d = (complex(z[k]) for z in (motion.named("E").x, motion.centre("4").x, motion.named("D").x))
    inertia = -3.0 * complex(motion.centre("4").a[k])
    couple = -0.02 * float(motion.link("4").epsilon[k])
    h_weight = abs((s - e).real) / mu
    h_inertia = abs((np.conj(s - e) * inertia).imag) / abs(inertia) / mu
    moments = {  # about E, N mm
        "weight": (np.conj(s - e) * -1j * 3.0 * 9.81).imag / mu,
        "inertia": (np.conj(s - e) * inertia).imag / mu,
        "couple": couple / mu,
    }
    size = abs(sum(moments.values())) / (abs(d - e) / mu)
    assert found.unit == "N"
    assert found.result == pytest.approx(size, rel=1e-12)
    assert found.value(15) == pytest.approx(size, rel=1e-9)
    leaves = {leaf for __, term in found.expression.over.terms for leaf in _leaves(term)}
    arms = sorted(leaf.value for leaf in leaves if leaf.symbol.letter == "h")
    assert arms == pytest.approx(sorted([h_weight, h_inertia]), rel=1e-9)
    assert any(leaf.symbol.plain == "μl" and leaf.value == mu for leaf in leaves)


def _leaves(expression):
    parts = getattr(expression, "factors", None) or [
        getattr(expression, name) for name in ("over", "under") if hasattr(expression, name)
    ]
    return [leaf for part in parts for leaf in _leaves(part)] or [expression]


@pytest.mark.parametrize("name", DRIVEN)
def test_every_equation_gives_the_same_with_arms_on_paper_as_in_metres(name):
    results = solved(name)
    equations = [e for part in list_free_bodies(results.motion, results.reactions, 2) for e in part.equations]
    for equation in equations:
        metres, paper = solve_moment_equation(equation), solve_moment_equation(equation, mu=0.002)
        assert (metres is None) == (paper is None)
        if metres is not None:
            length = paper.unit == "mm"
            scale = abs(metres.result) + 1e-9
            assert abs(paper.value(15) * (0.002 if length else 1) - metres.value(15)) <= 1e-9 * scale + 1e-9
            assert paper.result * (0.002 if length else 1) == pytest.approx(metres.result, abs=1e-9 * scale)


def test_the_note_tells_arms_in_millimetres_of_its_drawings(tmp_path):
    text = note_text(tmp_path, "frame: 6\nnote: {arms: paper}")
    assert "The moment arms are given in millimetres of the drawing, whose scale factor is μl = 0.01 m/mm" in text
    assert re.search(r"=\s*22\.15\s*mm", text), "R65 acts 221.5 mm from E: 22.15 mm at 10 mm a millimetre"


def test_the_note_follows_the_steps_of_the_guidelines_where_the_file_asks(tmp_path):
    text = note_text(tmp_path, "frame: 6\nnote: {sections: MATI}")
    steps = (
        "4.1 Plan of the mechanism",
        "4.2 Weights and useful resistance",
        "4.3 Acceleration plan and inertia forces",
        "4.4 Reactions in the kinematic pairs",
        "4.4.1 Group of links 4, 5",
        "4.4.2 Group of links 2, 3",
        "4.4.3 Input link 1",
        "4.5 Check by the Zhukovsky lever",
    )
    body = text[text.rindex("4 Force analysis") :]
    places = [body.index(step) for step in steps]
    assert places == sorted(places)
    assert "Plan of the mechanism" not in note_text(tmp_path, "note: {sections: usual}")


def half_millimetres(length: float, mu: float) -> float:
    return round(2 * length / mu) / 2 * mu


def test_the_drawn_lever_sums_forces_times_arms_that_are_read_to_half_a_millimetre():
    results, k = solved("course-1"), 3
    drawing = balance_drawings(results.motion, results.reactions, results.lever, k)
    scales = drawing.scales()
    check = drawn_check(results.motion, results.reactions, drawing, scales)
    motion, total = results.motion, 0.0
    for load in results.reactions.applied:  # the lever: velocities per unit turn, turned clockwise
        arm = float((np.conj(complex(motion.point(load.link, load.at).first[k]) * -1j) * complex(load.force[k])).imag)
        size = abs(complex(load.force[k]))
        total += math.copysign(size * half_millimetres(abs(arm) / size, scales.lever), arm) if size else 0.0
        ends = list(motion.linkage.links[load.link].points)
        moment = float(load.moment[k])
        if not moment or len(ends) < 2:
            total += moment * float(motion.link(load.link).first[k])
            continue
        pair = [motion.named_on(load.link, point) for point in ends[:2]]
        line = complex((pair[1].x - pair[0].x)[k])
        for end, sense in zip(pair, (-1, 1), strict=True):
            force = sense * 1j * line * moment / abs(line) ** 2
            arm = float((np.conj(complex(end.first[k]) * -1j) * force).imag) / abs(force)
            total += math.copysign(abs(force) * half_millimetres(abs(arm), scales.lever), arm)
    assert abs(check.lever) == pytest.approx(abs(total), rel=1e-9)
    assert abs(check.lever) == pytest.approx(186.437, rel=0.02)


@pytest.mark.parametrize("name", DRIVEN)
def test_on_finer_and_finer_paper_both_ways_come_to_the_exact_value(name, monkeypatch):
    results = solved(name)
    k = int(np.nanargmax(np.abs(results.reactions.balance.generalized)))
    drawing = balance_drawings(results.motion, results.reactions, results.lever, k)
    balance = results.reactions.balance
    exact = abs(float(balance.generalized[k])) / (1.0 if balance.kind == "moment" or not balance.arm else balance.arm)
    assert drawn_check(results.motion, results.reactions, drawing, drawing.scales()).difference < 0.03
    monkeypatch.setattr(drawn_plans, "READING_STEP", 1e-9)
    check = drawn_check(results.motion, results.reactions, drawing, drawing.scales())
    assert check.difference < 1e-8
    assert [abs(check.plan), abs(check.lever)] == pytest.approx([exact, exact], rel=1e-7)


def test_forces_show_the_drawn_difference_beside_the_exact_one():
    text = tmm("forces", "problems/course-1.yaml", "--position", "3").stdout
    assert "Balancing load measured on the drawings of the force plan and the Zhukovsky lever" in text
    row = next(line for line in text.partition("Balancing load measured on")[2].splitlines() if line.startswith(" 3 "))
    *__, plan, lever, drawn, exact = (float(number) for number in row.split())
    assert [plan, lever] == pytest.approx([186.437, 186.437], rel=0.01)
    assert drawn == pytest.approx(100 * abs(plan - lever) / 192.3, abs=0.03)
    assert exact == 0
    assert "Arms and segments are measured to 0.5 mm on drawings on A4" in re.sub(r"\s+", " ", text)


def test_the_frame_inside_is_still_link_0():
    assert FRAME == "0"
    assert {r.by for r in solved("course-1").reactions.frames} == {"0"}
