"""Drawings: every sheet is made, at its true scale, with labels apart, whatever the linkage."""

from __future__ import annotations

import pytest
from bank import drawn, moved, solved
from models import PARALLELOGRAM
from test_commands import SHAPER

from tmm_cli import solve
from tmm_cli.drawing.formats import FORMATS
from tmm_cli.drawing.paper import DrawingSheet, Label, OccupiedArea, place_labels, text_extent
from tmm_cli.drawing.run import all_sheets, position_remarks, sheet_files
from tmm_cli.drawing.sheets import detailed_drawings, draw_all_positions, draw_motion_plans, draw_position
from tmm_cli.problem import build_problem, read_text


def shaper(*changes):
    text = SHAPER.read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return build_problem(read_text(text, "shaper.yaml"))


def plain(drawing):
    """Texts on a sheet."""
    return set(drawing.texts())


def test_a_plotted_length_measures_what_the_scale_says():
    sheet = DrawingSheet("title", "caption", [0j, 0.65 + 0.27j])
    assert abs(sheet.on(0.5 + 0j) - sheet.on(0j)) * sheet.mu == pytest.approx(0.5)
    assert all(10 < c < 290 for p in (0j, 0.65 + 0.27j) for c in (sheet.on(p).real, sheet.on(p).imag))


def test_labels_do_not_cover_each_other_or_lines():
    ground = OccupiedArea(0j, 200 + 200j)
    ground.line(50 + 100j, 150 + 100j)
    labels = [Label(f"A{k}", 100 + 100j, 10, "k") for k in range(8)]
    places = [placed.middle for placed in place_labels(ground, labels)]
    for k, (at, label) in enumerate(zip(places, labels, strict=True)):
        width, height = text_extent(label.text, label.size)
        assert abs(at.imag - 100) > height / 2  # off the line
        for other in places[:k]:
            assert abs(at.real - other.real) > width or abs(at.imag - other.imag) > height


@pytest.mark.parametrize(
    ("name", "centre", "labels"),
    [
        ("T", "{on: CD, at: 0.5}", ["S3", "T"]),
        ("T", "{on: CD, at: 0.4}", ["T, S3"]),
        ("T", "T", ["T, S3"]),
        ("S3", "{on: CD, at: 0.4}", ["S3"]),
        ("S3", "S3", ["S3"]),
    ],
)
def test_a_centre_of_mass_that_is_a_point_or_has_the_name_of_one_is_labelled_once(name, centre, labels):
    problem = shaper(
        ("points: [C, D], length: CD", f"points: [C, D], length: CD, also: {{{name}: [260, 0]}}"),
        ("inertia: 1.1, centre: {on: CD, at: 0.5}", f"inertia: 1.1, centre: {centre}"),
    )
    ((__, sheet),) = draw_position(detailed_drawings(solve(problem))[0])
    found = [text for text in sheet.texts() if {"S3", "T"} & set(text.split(", "))]
    assert sorted(found) == labels


@pytest.mark.parametrize("unit", ["um", "mm", "km"])
def test_any_size_is_drawn(unit):
    results = solve(shaper(("length: mm", f"length: {unit}")))
    ram = plain(dict(draw_all_positions(results))["mechanism"])
    assert {"O", "A, S2", "C", "D", "E"} <= ram  # every named point, a centre of mass in one of them with it
    assert {"μ", "l"} <= ram and any(text.startswith(" = ") and text.endswith(" m/mm") for text in ram)
    (here,) = detailed_drawings(results)
    assert {"p", "p′"} & plain(dict(draw_motion_plans(here))["velocity-03"])


def test_kinematics_alone_has_no_sheets_of_forces():
    results = solve(shaper(), "kinematics")
    stems = [stem for stem, _ in all_sheets(results)]
    cycle = ["mechanism", "diagrams", "pressure"]
    assert stems == ["structure", "groups", *cycle, "position-03", "velocity-03", "acceleration-03"]


def test_a_title_is_never_read_as_mathematics_and_is_cut():
    results = solve(shaper(("Crank shaper, variant 7", "'$\\frac{1}{0}$ " + "x" * 150 + "'")), "kinematics")
    ((_, drawing),) = draw_all_positions(results)
    assert all(FORMATS[kind](drawing) for kind in FORMATS)


def test_nothing_moves_and_nothing_weighs_is_drawn_too():
    text = SHAPER.read_text(encoding="utf-8")
    text = text[: text.index("masses:")] + text[text.index("output:") :]
    still = build_problem(read_text(text.replace("speed: n1", "speed: 0"), "still.yaml"))
    drawn = dict(all_sheets(solve(still)))
    assert "energy" not in drawn
    assert "all points and links are at rest" in plain(drawn["velocity-03"])


@pytest.mark.parametrize("name", ["six-bar", "course-2", "cylinder", "inclined-slider", "tangent"])
def test_every_point_of_a_moving_link_is_named(name):
    results = moved(name)
    moving = {point for link in results.linkage.moving for point in results.linkage.links[link].points}
    labels = plain(dict(draw_all_positions(results))["mechanism"])
    assert moving <= {name for label in labels for name in label.split(", ")}  # with a centre of mass that lies there


BEGINS = {"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF-", "dxf": b"  0\nSECTION", "emf": b"\x01\x00\x00\x00"}


def test_a_run_writes_pictures_of_every_sheet():
    found = dict(sheet_files(solved("tangent")))
    assert {"structure", "mechanism", "diagrams", "reactions", "energy"} <= set(drawn("tangent"))
    assert list(found) == [f"{stem}.{kind}" for stem in drawn("tangent") for kind in ("png", "svg")]
    assert all(data.startswith(BEGINS[name[-3:]]) for name, data in found.items())


@pytest.mark.parametrize("kind", sorted(BEGINS.keys() - {"png", "svg"}))
def test_every_sheet_is_written_in_every_other_format(kind):
    assert set(FORMATS) == set(BEGINS)
    assert all(FORMATS[kind](drawing).startswith(BEGINS[kind]) for drawing in drawn("tangent").values())


def test_detailed_positions_that_cannot_be_computed_have_no_sheets():
    stems = [stem for stem, _ in all_sheets(solve(build_problem(read_text(PARALLELOGRAM, "x.yaml"))))]
    assert "velocity-01" in stems and "velocity-00" not in stems


def test_without_positions_in_detail_the_one_of_the_largest_balancing_moment_is_drawn_in_full_and_named():
    results = solve(shaper((", detail: [3]", "")))
    moments = abs(results.reactions.balance.moment)
    assert [here.k for here in detailed_drawings(results)] == [moments.argmax()]
    assert list(position_remarks(results)) == [
        f"note: the file has no positions.detail; position {moments.argmax()} is drawn in detail, "
        f"as its balancing moment is the largest: {moments.max():.4g} N*m"
    ]


def test_positions_that_the_file_names_are_drawn_in_full_and_nothing_is_said():
    results = solve(shaper(("detail: [3]", "detail: [3, 5]")))
    assert [here.k for here in detailed_drawings(results)] == [3, 5]
    assert not list(position_remarks(results))


def test_where_nothing_acts_the_position_after_the_first_is_drawn_in_full():
    text = SHAPER.read_text(encoding="utf-8")
    text = (text[: text.index("masses:")] + text[text.index("output:") :]).replace(", detail: [3]", "")
    (here,) = detailed_drawings(solve(build_problem(read_text(text, "light.yaml"))))
    assert here.k == 1
