"""`tmm import` and `tmm export`: files of other programs, solved and compared with what those programs print.

pylinkage.json: nine mechanisms and their steps by pylinkage 1.3.0. pmks-verification.json: places that the reference
solver of PMKS+ prints to six decimals (PMKS-Web/PMKS_Verification); its points E, F, H of two mechanisms are left out,
as it goes over to their mirror images after the first row.
"""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from test_commands import ROOT, tmm

from tmm_cli.mechanics.analysis import results_at
from tmm_cli.problem import DIGITS, ProblemError, build_any_problem, problem_file_text, read_mechanism, read_text
from tmm_cli.synthesis import load, solve

FILES = ROOT / "tests" / "data" / "foreign"
PYLINKAGE = json.loads((FILES / "pylinkage.json").read_text(encoding="utf-8"))
PMKS = json.loads((FILES / "pmks-verification.json").read_text(encoding="utf-8"))
MIRRORED = {"otis-four-bar": "EFH", "stephenson-iii": "EFH"}


def imported(text, file="file"):
    """The foreign record, and its kinematics by the problem file that is written of it."""
    foreign = read_mechanism(text, file)
    return foreign, solve(build_any_problem(read_text(problem_file_text(foreign, file), file)), "kinematics")


def places(results, angle, names):
    """Of points in m, with the crank at an angle (rad)."""
    motion = results_at(results, np.array([angle])).motion
    return [complex(motion.named(name).x[0]) for name in names]


@pytest.mark.parametrize("case", PYLINKAGE, ids=[case["file"]["name"] for case in PYLINKAGE])
def test_a_mechanism_of_pylinkage_goes_through_the_places_that_pylinkage_computes(case):
    foreign, results = imported(json.dumps(case["file"]))
    driver = next(link for link in case["file"]["links"] if link["type"] == "driver")
    (tip,) = set(driver["joints"]) - {driver["motor_joint"]}
    long = [joint for joint in foreign.places if joint != "P"]  # names such as coupler.0_crank.tip become letters
    letters = dict(zip(long, "ABCDEFGH", strict=False))
    moving = [joint for joint in case["joints"] if joint not in foreign.frame]
    for step in case["steps"]:
        there = {joint: complex(*place) for joint, place in zip(case["joints"], step, strict=True)}
        angle = np.angle(there[tip] - there[driver["motor_joint"]])
        found = places(results, angle, [letters.get(joint, joint) for joint in moving])
        assert np.array(found) * 1000 == pytest.approx(np.array([there[joint] for joint in moving]), abs=1e-11)


@pytest.mark.parametrize("name", PMKS)
def test_a_mechanism_of_pmks_goes_through_the_places_that_its_reference_solver_prints(name):
    results = solve(load(FILES / f"{name}.yaml"), "kinematics")
    for row in PMKS[name]:
        there = {joint: complex(*place) for joint, place in row.items() if joint not in MIRRORED.get(name, "")}
        found = places(results, np.angle(complex(*row["B"]) - complex(*row["A"])), there)
        assert np.array(found) * 100 == pytest.approx(np.array(list(there.values())), abs=1e-6)


def encoded(number, *, signed=True):
    """A whole number to the base 64 as PMKS+ writes it."""
    digits, left = "", abs(number)
    while left or not digits:
        left, digit = divmod(left, 64)
        digits = DIGITS[digit] + digits
    return ("0" if signed and number < 0 else "") + digits


def link(joints, links, forces=(), *, clockwise=False, gravity=True, rpm=30, length=1, tail=""):
    """The text of a saved link. joints: (flags, name, x, y, angle, further fields); links: (kind, name, joints)."""

    def decimal(value):
        return encoded(round(1000 * value))

    text = f"{encoded(clockwise + 256 * (not gravity), signed=False)}.{decimal(1)}.{encoded(rpm)},0.{length}01."
    for flags, name, x, y, angle, *more in joints:
        fields = [name, name, decimal(x), decimal(y), decimal(angle), *more]
        text += f"{encoded(flags, signed=False)}{','.join(fields)}."
    text += "."
    for kind, name, own, mass, x, y in links:
        kind = kind if len(kind) > 1 else f"Y{kind}"
        text += f"{kind}{name},{name},{decimal(mass)},{decimal(0.5)},{decimal(x)},{decimal(y)},abcdef,"
        text += "".join(f"{joint}," for joint in own) + ",."
    text += "."
    for name, on, x0, y0, x1, y1, size in forces:
        text += f"2{name},{on},{name},{decimal(x0)},{decimal(y0)},{decimal(x1)},{decimal(y1)},{decimal(size)}."
    text += ".N" + tail
    return text + DIGITS[len(text) % 62]


TURNING, INPUT, GROUND, SLIDING = 0, 2, 4, 1
SLIDER = link(
    [
        (INPUT | GROUND, "A", 0, 0, 0),
        (TURNING, "B", 3, 4, 0),
        (TURNING, "C", 15, -1, 0),
        (SLIDING | GROUND, "D", 15, -1, math.pi / 4),
    ],
    [("R", "AB", "AB", 2, 1.5, 2), ("R", "BC", "BC", 3, 9, 1.5), ("P", "CD", "CD", 1, 0, 0)],
    [("F1", "BC", 9, 1.5, 9, 3.5, 40)],
    clockwise=True,
)


@pytest.mark.parametrize("text", [SLIDER, f"https://app.pmksplus.com/?{SLIDER}\n"])
def test_a_saved_link_of_pmks_keeps_lengths_guide_speed_masses_and_forces(text):
    foreign, results = imported(text)
    linkage = results.linkage
    assert (foreign.drive.speed, foreign.drive.unit) == (-30, "rpm")
    assert places(results, math.atan2(4, 3), "BC") == pytest.approx([0.03 + 0.04j, 0.15 - 0.01j], abs=1e-15)
    (slide,) = linkage.slides
    assert float(slide.direction) == pytest.approx(math.pi / 4, abs=5e-4)
    assert (linkage.driver.sense, linkage.links["BC"].mass) == (-1, 0.003)  # 3 g
    assert linkage.links["BC"].inertia == pytest.approx(0.5e-4, rel=1e-15)  # 0.5 kg*cm^2
    (load,) = linkage.loads
    assert load.force == pytest.approx(40j) and linkage.gravity == -9.81j


GALLERY = FILES / "pmks"


def gallery(name):
    """The kinematics of a file that was saved from the gallery of PMKS+."""
    __, results = imported((GALLERY / f"{name}.pmks").read_text(encoding="utf-8"), f"{name}.pmks")
    return results


@pytest.mark.parametrize(
    ("angle", "place"), [(0, 2.418 + 2.456j), (-30, 2.130 + 2.496j), (-60, 1.931 + 2.499j)]
)  # as PMKS+ shows them
def test_a_block_in_a_slot_of_the_coupler_moves_as_pmks_shows_it(angle, place):
    (found,) = places(gallery("SlottedCoupler"), math.radians(angle), "F")
    assert found * 100 == pytest.approx(place, abs=6e-4)


ANGLES = np.radians([0, 40, 75, 160, 200, 290, 345])


@pytest.mark.parametrize("angle", ANGLES)
def test_slotted_levers_of_pmks_follow_the_crank_pin(angle):
    crank, pivot, lever = np.exp(1j * angle), 3, math.hypot(4.743, 1.581)
    d = pivot + lever * (crank - pivot) / abs(crank - pivot)
    assert places(gallery("ISC"), angle, "D") == pytest.approx([d / 100], abs=1e-14)
    pivot, lever = -3j, math.hypot(1.581, 1.743 + 3)
    d = pivot + lever * (crank - pivot) / abs(crank - pivot)
    rise, rod = 3.5, math.hypot(3.36 - 1.581, 3.5 - 1.743)
    r = d.real + math.sqrt(rod**2 - (rise - d.imag) ** 2) + rise * 1j
    assert places(gallery("Shaper"), angle, "DR") == pytest.approx([d / 100, r / 100], abs=1e-14)


@pytest.mark.parametrize("angle", ANGLES)
def test_a_slide_of_pmks_does_not_rotate_on_its_guide(angle):
    results = gallery("Saw")  # a Scotch yoke: the yoke moves by the cosine of the crank angle
    c, e = (place + math.cos(angle) - 1 for place in (1 - 2j, 5 - 2j))
    assert places(results, angle, "CE") == pytest.approx([c / 100, e / 100], abs=1e-15)
    assert set(results.linkage.links) == {"0", "AB", "CDE", "block_B"}  # the parts CD and CE are one link
    assert [load.link for load in results.linkage.loads] == ["CDE", "CDE"]


@pytest.mark.parametrize("angle", np.radians([-90, -60, -130]))
def test_a_free_cylinder_of_pmks_lies_between_its_mounts(angle):
    mount, d = -4, 1.988 + 3j + 3 * np.exp(1j * angle)
    along = (d - mount) / abs(d - mount)
    b, c = mount + 3.538 * along, d - 3.538 * along
    assert places(gallery("Cylinder"), angle + math.pi, "BCD") == pytest.approx([b / 100, c / 100, d / 100], abs=1e-14)


@pytest.mark.parametrize("way", [-0.4, 0, 0.3])  # cm
def test_a_driven_cylinder_of_pmks_rotates_the_bell_crank_by_the_law_of_cosines(way):
    results = gallery("Backhoe")
    driver = results.linkage.driver
    assert (driver.kind, driver.link, driver.base) == ("slide", "CD", "AB")
    assert driver.rate == pytest.approx(0.012)  # 1.2 cm/s, of the settings
    a, b, c, d = -7, -3.493 + 1.66j, -4.631 + 1.121j, -1.124 + 2.781j
    slot = (b - a) / abs(b - a)
    at = ((c - a) / slot).real + way
    reach, lever = abs(at + (d - c) / slot), abs(d)  # from A to D; from the pivot G to D
    bend = math.acos((lever**2 + 49 - reach**2) / (2 * lever * 7))
    there = lever * np.exp(1j * (math.pi - bend))
    assert places(results, at / 100, "D") == pytest.approx([there / 100], abs=1e-14)


@pytest.mark.parametrize("angle", ANGLES)
def test_both_arms_of_the_windshield_wiper_of_pmks_rotate_together(angle):
    o, b0, c0, t0 = -3.5 - 2.828j, 0.879 - 1.796j, 0.659 - 1.347j, -2.198 + 4.491j
    a = o + abs(-3.496 - 1.328j - o) * np.exp(1j * angle)
    rod, arm = abs(b0 - (-3.496 - 1.328j)), abs(b0)
    share = (arm**2 - rod**2 + abs(a) ** 2) / (2 * abs(a))  # of the circles about P = 0 and A
    b = a / abs(a) * (share - 1j * math.sqrt(arm**2 - share**2))
    if ((b0 / (-3.496 - 1.328j)).imag > 0) != ((b / a).imag > 0):
        b = a / abs(a) * (share + 1j * math.sqrt(arm**2 - share**2))
    turned = b / b0
    expected = [b, c0 * turned, t0 * turned, c0 * turned + 6, 6 + (3.802 + 4.491j - 6) * turned]
    assert places(gallery("Wiper"), angle, "BCTDU") == pytest.approx(np.array(expected) / 100, abs=1e-14)


@pytest.mark.parametrize("angle", ANGLES)
def test_the_block_of_a_punch_press_of_pmks_has_its_mass_and_its_guide(angle):
    results = gallery("PunchPress")
    pin = 1.2j * np.exp(1j * (angle - math.pi / 2))
    ram = 1j * (pin.imag - math.sqrt(4.6**2 - pin.real**2))
    assert places(results, angle, "C") == pytest.approx([ram / 100], abs=2e-5)  # the guide is at 1.571 rad there
    links = results.linkage.links
    assert (links["block_C"].mass, links["AB"].mass, links["BC"].mass) == pytest.approx((6e-3, 2e-3, 3e-3))
    (load,) = results.linkage.loads
    assert load.force == pytest.approx(400j)


@pytest.mark.parametrize("way", [-1.5, 0.0, 0.8])  # cm along the guide
def test_a_driven_slider_of_pmks_pushes_its_links(way):
    results = gallery("ScrewJack")
    a, b, c = -1.165, 1.028 + 0.974j, 2.2j
    assert results.linkage.driver.kind == "slide" and results.linkage.driver.rate == pytest.approx(0.022)
    moved = a + way
    r, s, apart = abs(b - a), abs(c - b), abs(c - moved)
    along = (r**2 - s**2 + apart**2) / (2 * apart)
    side = math.copysign(math.sqrt(r**2 - along**2), ((b - a) / (c - a)).imag)
    there = moved + (c - moved) / apart * (along + 1j * side)
    assert places(results, way / 100, "AB") == pytest.approx([moved / 100, there / 100], abs=1e-14)


def test_links_that_are_welded_in_pmks_are_one_link_and_a_welded_frame_is_none():
    bucket = gallery("LoaderBucket").linkage
    assert set(bucket.links) == {"0", "OA", "AMBCD", "BP"} and set(bucket.links["AMBCD"].points) == set("AMBCD")
    foreign, results = imported((GALLERY / "Crosshead.pmks").read_text(encoding="utf-8"))
    assert set(results.linkage.links) == {"0", "SBCD"} and not foreign.left
    assert results.linkage.driver.rate == pytest.approx(0.01)


FOUR_BAR = [(INPUT | GROUND, "A", 0, 0, 0), (TURNING, "B", 3, 4, 0), (TURNING, "C", 9, 5, 0), (GROUND, "D", 11, 0, 0)]
BARS = [("R", "AB", "AB", 2, 1.5, 2), ("R", "BC", "BC", 3, 6, 4.5), ("R", "CD", "CD", 1, 10, 2.5)]


@pytest.mark.parametrize(
    ("length", "metre", "mass", "inertia"),
    [(1, 0.01, 3e-3, 0.5e-4), (0, 0.0254, 3 * 0.45359237, 0.5 * 0.45359237 * 0.0254**2), (2, 1, 3, 0.5)],
)
def test_masses_of_pmks_go_with_the_unit_of_length(length, metre, mass, inertia):
    force = [("F1", "BC", 6, 4.5, 6, 5.5, 10)]
    __, results = imported(link(FOUR_BAR, BARS, force, length=length))
    coupler = results.linkage.links["BC"]
    assert (coupler.mass, coupler.inertia) == (pytest.approx(mass), pytest.approx(inertia))
    assert abs(coupler.points["C"] - coupler.points["B"]) == pytest.approx(math.hypot(6, 1) * metre)
    (load,) = results.linkage.loads
    assert load.force == pytest.approx(10j * (4.4482216152605 if length == 0 else 1))


@pytest.mark.parametrize("flag", "YAMG0123")
def test_a_link_whose_mass_or_centre_pmks_computes_itself_is_there(flag):
    kinds = [("R", *BARS[0][1:]), (f"{flag}R", *BARS[1][1:]), ("R", *BARS[2][1:])]
    foreign, results = imported(link(FOUR_BAR, kinds))
    assert results.linkage.links["BC"].mass == pytest.approx(3e-3)
    noted = [note for note in foreign.notes if "link BC" in note]
    assert len(noted) == (flag not in "Y0")


def test_a_speed_in_the_record_of_the_driving_joint_goes_before_that_of_the_file():
    joints = [(*FOUR_BAR[0], "", "", "", encoded(-12_000)), *FOUR_BAR[1:]]
    foreign, __ = imported(link(joints, BARS, rpm=30))
    assert (foreign.drive.speed, foreign.drive.unit) == (-12, "rpm")


def test_numbers_of_pmks_that_thousandths_do_not_hold_are_exact():
    foreign, __ = imported(link(FOUR_BAR, BARS, tail=".PJB~0~3.00012345678,PLBC~0~0.0000015,PI~0~2.5,JA,KJB~o"))
    assert foreign.places["B"] == 3.00012345678 + 4j and foreign.drive.speed == 2.5
    assert foreign.bodies[1].mass == pytest.approx(1.5e-9)


def test_a_link_with_two_pins_on_the_frame_is_the_frame():
    rail = [*FOUR_BAR, (TURNING, "E", 14, 2, 0), (TURNING, "G", 13, 5, 0)]
    bars = [*BARS, ("R", "ADE", "ADE", 1, 5, 1), ("R", "EG", "EG", 1, 13, 3), ("R", "CG", "CG", 1, 11, 5)]
    foreign, results = imported(link(rail, bars))
    assert set(foreign.frame) == {"A", "D", "E"} and "ADE" not in results.linkage.links
    assert "Link ADE is pinned to the frame at two points, so it is part of the frame." in foreign.notes


def test_friction_and_synthesis_of_pmks_are_listed_as_not_carried_over():
    joints = [FOUR_BAR[0], (*FOUR_BAR[1], "", "", "", "", "0~3", "0~2", "1"), *FOUR_BAR[2:]]
    foreign, __ = imported(link(joints, BARS, tail=".SD~1~2~3"))
    assert foreign.left == ("The data for synthesis in PMKS+.", "The friction of joint B.")


def test_a_file_of_linkage_v2_has_its_points_constructed_and_its_masses_and_loads_carried_over():
    name = "slotted-lever.yaml"
    foreign, results = imported((FILES / name).read_text(encoding="utf-8"), name)
    linkage = results.linkage
    a = 0.11 * np.exp(1j * math.pi / 6)
    along = (a + 0.35j) / abs(a + 0.35j)
    d = -0.35j + 0.65 * along
    e = d.real + math.sqrt(0.21**2 - (d.imag - 0.27) ** 2) + 0.27j
    assert places(results, math.pi / 6, "ADE") == pytest.approx([a, d, e], abs=1e-14)
    assert (linkage.driver.sense, linkage.driver.rate, linkage.driver.acceleration) == (-1, 8, 4)
    lever = linkage.links["3"]  # 20 kg in its middle, 2 kg at its end
    assert lever.mass == pytest.approx(22) and lever.centre == pytest.approx((20 * 0.325 + 2 * 0.65) / 22)
    assert lever.inertia == pytest.approx(1.1 + 20 * 2 / 22 * 0.325**2)
    (load,) = linkage.loads
    assert load.force == pytest.approx(1500 * (d - e) / abs(d - e)) and load.at == pytest.approx(0.03j)
    assert foreign.left == ("Block `dynamics`: motor and flywheel have other keys here; write them by hand.",)


def file_of_pylinkage(**changed):
    """A four-bar of pylinkage; changed: joints that are added, or other keys."""
    places = {"A": [0, 0], "B": [10, 0], "C": [30, 20], "D": [40, 0]}
    joints = [
        {"id": name, "type": "ground" if name in "AD" else "revolute", "position": place}
        for name, place in places.items()
    ]
    links = [
        {"id": "ground", "type": "ground", "joints": ["A", "D"]},
        {"id": "crank", "type": "driver", "joints": ["A", "B"], "motor_joint": "A", "angular_velocity": 1},
        {"id": "rod", "type": "link", "joints": ["B", "C"]},
        {"id": "bar", "type": "link", "joints": ["C", "D"]},
    ]
    return {"name": "four-bar", "joints": [*joints, *changed.pop("more", ())], "links": links} | changed


NAMES = [
    "null",
    "true",
    "nan",
    "5",
    "0",
    "at",
    "g1",
    "_",
    "",
    " ",
    "]}, x: {y: [1",
    "B # c",
    "a\"b'c\\",
    "Шарнир",
    "&a *b !!python/object",
    "a: b",
    "x" * 90,
    "~",
    "2020-01-01",
    "<<",
    "²",
]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("old", ["A", "B", "crank", "rod"])
def test_whatever_a_name_is_what_is_written_is_the_same_mechanism(name, old):
    text = json.dumps(file_of_pylinkage()).replace(json.dumps(old), json.dumps(name))
    file = json.loads(text) | {"name": name}
    __, results = imported(json.dumps(file, ensure_ascii=False))
    linkage = results.linkage
    assert results.problem.title == (name or "file")
    assert len(linkage.links) == 4 and len(linkage.links["0"].points) == 2
    assert {len(link.points) for link in linkage.links.values()} == {2}


def test_joints_on_no_moving_link_are_left_out_and_said():
    more = [
        {"id": "X", "position": [5, 5]},
        {"id": "Y", "type": "ground", "position": [7, 5]},
        {"id": "T", "type": "tracker", "position": [2, 2], "ref_joint1_id": "T", "ref_joint2_id": "T"},
    ]
    foreign, results = imported(json.dumps(file_of_pylinkage(more=more)))
    assert set(results.linkage.links["0"].points) == {"A", "D"} and set(foreign.places) == set("ABCD")
    assert set(foreign.left) == {
        "Joint X belongs to no moving link.",
        "Joint Y belongs to no moving link.",
        "Point T follows two joints that are not on one link.",
    }


REFUSED = {
    "nothing of it\n": (
        "file: the format of this file is not supported\n  allowed: pylinkage; PMKS+, a saved link; linkage/v2"
    ),
    SLIDER[:-1]
    + (
        "0" if SLIDER[-1] != "0" else "1"
    ): "file: this web link is incomplete: its check character does not match its length",
    '{"joints": [{"id": "A", "position": [0, 0]}], "links": [{"id": "1", "type": "lnk", "joints": []}]}': (
        "file:1:77: links[0].type: this value is not allowed here\n"
        "  found:   'lnk'\n"
        "  allowed: ground, driver, arc_driver, link\n"
        "  did you mean 'link'?"
    ),
    json.dumps(file_of_pylinkage(more=[{"id": "B", "position": [1, 2]}])): (
        "file:1:252: joints[4].id: this name occurs twice in the file\n  found:   'B'"
    ),
    json.dumps(file_of_pylinkage(more=[{"id": "X", "position": [1e308, -1.7e308]}])): (
        "file:1:270: joints[4].position[0]: this value is too large for a mechanism\n  found:   1e+308"
    ),
    json.dumps(
        file_of_pylinkage(joints=[{}] * 501)
    ): "file:1:32: joints: there are too many items or characters; at most 500 are allowed",
    link([(INPUT | GROUND, "A", 0, 0, 0), (TURNING, "B", 1e40, 4, 0)], []): (
        "file: joints.B: this is not a base-64 number\n  found:   'SijRs6CXv000000000000000'"
    ),
    link([*FOUR_BAR[:3], (*FOUR_BAR[3], *"XAB")], BARS): (
        "file: joints.D: a slot needs a sliding joint, a link and two joints of that link\n  found:   'X,A,B'"
    ),
    link(
        [*FOUR_BAR[:3], (SLIDING, *FOUR_BAR[3][1:], "XY", "A", "B")], BARS
    ): "file: joints.D: there is no link of that name\n  found:   'XY'",
    link([*FOUR_BAR[:3], (*FOUR_BAR[3], "", "", "", "", "", "", "", "new")], BARS): (
        "file: joints.D: unknown field in the record of a joint\n  found:   ',,new'"
    ),
    link(FOUR_BAR, [*BARS[:2], ("QR", *BARS[2][1:])]): ("file: links.CD: unknown kind of link\n  found:   'Q'"),
    link(FOUR_BAR, BARS, tail=".G1~eyJnZWFycyI6W119"): (
        "file: gears of PMKS+ are not supported\n  found:   'G1~eyJnZWFycyI6W119'"
    ),
    link(FOUR_BAR, BARS, tail=".XJB"): ("file: this entry of the web link is unknown\n  found:   'XJB'"),
    link([(GROUND, *FOUR_BAR[0][1:]), (INPUT, *FOUR_BAR[1][1:]), *FOUR_BAR[2:]], BARS): (
        "file: joints.B: a motor between two moving links cannot be imported\n  found:   AB, BC"
    ),
    (GALLERY / "Saw.pmks").read_text(encoding="utf-8").replace("E,1E8", "E,1E9"): (
        "file: this web link is damaged: its checksum does not match its text\n  found:   '3FX8op'"
    ),
    "https://app.pmksplus.com/?pmks2:0123abcd.eyJib2RpZXMiOltdfQ": (
        "file: documents of the new PMKS+ editor are not supported\n  found:   pmks2:..."
    ),
    link(
        [(INPUT | GROUND, "A", 0, 0, 0)], [("R", "AB", "A", 2, 1, 2)], [("F", "BA", 0, 0, 1, 0, 9)]
    ): "file: forces.F: there is no link of that name\n  found:   'BA'",
    "\n" * 900_000: "file: the format of this file is not supported",
    "schema: linkage/v2\ngeometry: {points: {A: [0, 0]}}\nbodies: {}\njoints: [{type: revolute, endpoints: []}]\n": (
        "file:4:38: joints[0].endpoints: a hinge must join at least two links"
    ),
    "schema: linkage/v2\ngeometry: {points: {A: [0, 0]}, construct: [{type: point_on_ray, point: B, from: C}]}\n": (
        "file:2:82: geometry.construct[0].from: this value is not allowed here\n  found:   'C'\n  allowed: A"
    ),
}


@pytest.mark.parametrize("text", REFUSED)
def test_a_mistake_in_a_foreign_file_is_said_with_its_place(text):
    with pytest.raises(ProblemError) as refused:
        read_mechanism(text, "file")
    assert str(refused.value).startswith(REFUSED[text])


def test_what_is_exported_to_pylinkage_comes_back_as_the_same_linkage(tmp_path):
    ours = ROOT / "problems" / "crank-slider.yaml"
    done = tmm("export", str(ours), "--to", "pylinkage", "-o", "it.json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    done = tmm("import", "it.json", cwd=tmp_path)
    assert done.returncode == 0 and done.stderr.endswith("written: it.yaml; next step: tmm run it.yaml\n")
    one, other = (solve(load(str(file)), "kinematics") for file in (ours, tmp_path / "it.yaml"))
    for angle in (0.3, 2.0, 5.0):
        assert places(other, angle, "AB") == pytest.approx(places(one, angle, "AB"), abs=1e-14)


def test_lengths_in_other_units_come_back_too(tmp_path):
    text = (ROOT / "problems" / "crank-rocker.yaml").read_text(encoding="utf-8").replace("length: mm", "length: m")
    (tmp_path / "ours.yaml").write_text(text, encoding="utf-8")
    for command in (("export", "ours.yaml", "--to", "pylinkage", "-o", "it.json"), ("import", "it.json")):
        done = tmm(*command, cwd=tmp_path)
        assert done.returncode == 0, done.stderr
    one, other = (solve(load(str(tmp_path / file)), "kinematics") for file in ("ours.yaml", "it.yaml"))
    assert places(other, 1.0, "AB") == pytest.approx(places(one, 1.0, "AB"), rel=1e-13)


def test_no_file_is_overwritten_and_what_pylinkage_does_not_know_is_refused(tmp_path):
    (tmp_path / "it.pmks").write_text(SLIDER, encoding="utf-8")
    (tmp_path / "it.yaml").write_text("mine\n", encoding="utf-8")
    done = tmm("import", "it.pmks", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (
        2,
        ("error: it.yaml already exists\n  allowed: another file name, given with -o FILE\n"),
    )
    assert (tmp_path / "it.yaml").read_text(encoding="utf-8") == "mine\n"
    done = tmm("export", str(ROOT / "problems" / "shaper.yaml"), "--to", "pylinkage", "-o", "-", cwd=tmp_path)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.endswith(
        "error: pylinkage supports only sliders with one hinge on a straight guide of the frame\n"
    )


def test_what_cannot_be_a_problem_file_is_said_of_the_file_that_was_read(tmp_path):
    links = file_of_pylinkage()["links"]
    links[2]["joints"] = []
    (tmp_path / "it.json").write_text(json.dumps(file_of_pylinkage(links=links)), encoding="utf-8")
    done = tmm("import", "it.json", cwd=tmp_path)
    assert done.returncode == 2 and not (tmp_path / "it.yaml").exists()
    assert done.stderr.startswith(
        "error: it.json: the resulting problem file would be invalid: links.rod.points: a link must "
        "have at least one point\n"
    )


def test_a_key_with_control_characters_does_not_reach_the_terminal(tmp_path):
    text = (FILES / "slotted-lever.yaml").read_text(encoding="utf-8") + '"\\x1b[31mred": 1\n'
    (tmp_path / "it.yml").write_text(text, encoding="utf-8")
    done = tmm("import", "it.yml", cwd=tmp_path)
    assert "not converted: Key `\\x1b[31mred` was ignored.\n" in done.stderr
