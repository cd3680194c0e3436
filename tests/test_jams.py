"""What jams, stops, jumps, locks or is too large: results that say where and in which group, never a crash or a nan."""

from __future__ import annotations

import cmath
import math
import warnings
from dataclasses import replace

import blocks
import numpy as np
import pytest
from bank import NAMES, problem, solved
from models import solved_text
from test_bad_input import place, refusal
from test_bad_linkages import changed
from test_commands import tmm

from tmm_cli.mechanics.forces import FrictionSolution, LockedRange, find_locked_ranges
from tmm_cli.mechanics.groups import CamLaw, CamLawPiece
from tmm_cli.mechanics.numerics import solve as solve_linear, to_double_double
from tmm_cli.note import Paragraph, Subject, write_losses
from tmm_cli.reports import collect_warnings as words, find_slips, to_json

# ---------------------------------------------------------------- wheels


def test_an_idle_wheel_in_a_ring_that_agrees_is_a_result():
    """3 turns with 1 inside an annulus and meets it through 2 as well: all ratios agree, one gear is passive."""
    text = changed(blocks.RING, "c: {between: [3, 1], ratio: 0.5}", "c: {between: [3, 1], ratio: 0.5, inner: true}")
    results = solved_text(text)
    omega = [float(results.motion.link(n).omega[0]) for n in "123"]
    assert omega == pytest.approx([1, -1, 2])
    assert bool(results.motion.moving.all())


def test_an_idle_wheel_in_a_ring_gives_its_group_no_higher_class():
    """Without the gear that only repeats the others each wheel hangs by its axis and one gear: class II, order 2."""
    text = changed(blocks.RING, "c: {between: [3, 1], ratio: 0.5}", "c: {between: [3, 1], ratio: 0.5, inner: true}")
    structure = solved_text(text).structure
    assert structure.formula == "I(0,1) -> II(2) -> II(3)"
    assert [group.order for group in structure.groups] == [2, 2]
    assert (structure.mechanism_class, structure.redundant, structure.passive[0].pair) == (2, 1, "c")


@pytest.mark.parametrize("offsets, wanted", [((0, 0, 30), 0), ((10, 0, 0), 10), ((10, 20, 0), 0), ((10, 20, 5), 0)])
def test_contradictory_offsets_in_a_ring_are_refused(offsets, wanted):
    """phi2 = -phi1 + a, phi3 = -2 phi2 + b, phi1 = phi3/2 + c: the ring closes with c = a - b/2."""
    ring = blocks.RING.replace("ratio: 0.5", "ratio: 0.5, inner: true")

    def text(*angles):
        changed_ring = ring
        for name, ratio, angle in zip("abc", ("1", "2", "0.5"), angles, strict=True):
            number = f"ratio: {ratio}" + (", inner: true" if name == "c" else "")
            changed_ring = changed(changed_ring, number + "}", f"{number}, offset: {angle} deg}}")
        return changed_ring

    a, b, c = offsets
    assert wanted == a - b / 2
    if c == wanted:
        for rounding in (0, 2e-5):
            assert solved_text(text(a, b, c + rounding)).structure.redundant == 1
    else:
        assert refusal(text(*offsets)) == (
            f"x.yaml:{place(text(*offsets), 'c: {')}: gears.c: gear pair c contradicts "
            "the pairs before it: the gears lock each other\n"
            "  allowed: ratios and offsets that are compatible around the closed gear train, or one gear pair fewer"
        )


def planets(number, driver):
    """A sun of radius 40 and as many planets of radius 20 on one carrier, in a fixed ring of radius 80."""
    ends = [60 * np.exp(2j * math.pi * k / number) for k in range(number)]
    axes = "".join(f", P{k}: [{end.real:.17g}, {end.imag:.17g}]" for k, end in enumerate(ends))
    links = "".join(f"  p{k}: {{points: [P{k}]}}\n" for k in range(number))
    gears = "".join(
        f"  s{k}: {{between: [s, p{k}], carrier: h, radii: [40, 20]}}\n"
        f"  r{k}: {{between: [0, p{k}], carrier: h, radii: [80, 20], inner: true}}\n"
        for k in range(number)
    )
    return (
        f"tmm: 1\nunits: {{length: mm}}\npoints: {{O: [0, 0]}}\nlinks:\n  s: {{points: [O]}}\n"
        f"  h: {{points: {{O: [0, 0]{axes}}}}}\n{links}gears:\n{gears}driver: {{link: {driver}, speed: 1 rad/s}}\n"
    )


@pytest.mark.parametrize("driver, ratio", [("h", 3.0), ("s", 1 / 3)])
def test_further_planets_share_the_load_and_leave_the_class_as_it_is(driver, ratio):
    """Willis: (omega_s - omega_h)/(0 - omega_h) = -80/40. Each planet beyond the first brings one passive gear."""
    alone, three = solved_text(planets(1, driver)), solved_text(planets(3, driver))
    for results in (alone, three):
        assert float(results.motion.link("s" if driver == "h" else "h").omega[0]) == pytest.approx(ratio)
    assert three.structure.redundant == 2
    assert three.structure.mechanism_class == alone.structure.mechanism_class


def train(number, teeth):
    """So many wheels in a row, each with the next one in mesh."""
    points = ", ".join(f"O{k}: [{50 * k}, 0]" for k in range(number))
    links = "".join(f"  w{k}: {{points: [O{k}]}}\n" for k in range(number))
    gears = "".join(f"  g{k}: {{between: [w{k}, w{k + 1}], teeth: {teeth}}}\n" for k in range(number - 1))
    return f"tmm: 1\npoints: {{{points}}}\nlinks:\n{links}gears:\n{gears}driver: {{link: w0, speed: 1 rad/s}}\n"


def test_40_wheels_in_a_train_are_solved():
    results = solved_text(train(40, [20, 21]))
    assert float(results.motion.link("w39").omega[0]) == pytest.approx(-((20 / 21) ** 39))
    assert any(word.startswith("no number of turns was found") for word in words(results))


@pytest.mark.parametrize("number, teeth, turns", [(2, [20, 40], 2), (3, [20, 40], 4), (4, [20, 40], 8), (3, [3, 1], 1)])
def test_a_train_comes_back_when_its_last_wheel_does(number, teeth, turns):
    """Each halving of the speed doubles the turns of the driver after which all is as it was."""
    reach = solved_text(train(number, teeth)).driver_range
    assert (reach.turns, reach.repeats) == (turns, True)


def test_a_system_with_only_one_side_in_double_doubles_is_solved_in_double_doubles():
    """Rows of wheels alone are ratios: they stay float64 where the angles next to a dead position are longer."""
    right = to_double_double(np.array([[1.0, 2.0]])) / 3
    found = solve_linear(np.array([[[2.0, 0.0], [0.0, 4.0]]]), right)
    assert np.all(found * np.array([2.0, 4.0]) == right)


def test_wheels_next_to_a_dead_position_are_solved():
    text = changed(blocks.GEARED, "{at: 90 deg, B: [139, 120]}", "{at: 90 deg, B: [139, 120]}\npositions: {at: [DEAD]}")
    end = solved_text(text.replace("DEAD", "0")).driver_range.limits
    place = end[0].place if end else 0.0
    results = solved_text(text.replace("DEAD", f"{place!r} rad"))
    assert np.isfinite(results.motion.point("2", 0j).x).all()


# ---------------------------------------------------------------- cams


def test_a_law_of_many_pieces_is_looked_up():
    law = CamLaw(tuple(CamLawPiece(math.tau / 100, (-1) ** k * 0.001, "3-4-5") for k in range(100)), 0.3)
    angle = np.linspace(-7, 7, 1001)
    value, first, second = law(angle)
    step = 1e-5
    assert np.max(np.abs((law(angle + step)[0] - law(angle - step)[0]) / (2 * step) - first)) < 1e-6
    assert np.max(np.abs((law(angle + step)[1] - law(angle - step)[1]) / (2 * step) - second)) < 1e-3
    assert value.min() >= 0 and value.max() == pytest.approx(0.001)
    assert law.jumps() == ()


def test_a_jump_of_the_followers_speed_is_named():
    text = changed(blocks.CAM, "{over: 120 deg, rise: 20}", "{over: 120 deg, rise: 20, law: linear}")
    assert list(words(solved_text(text))) == [
        (
            "by the law of motion of cam 1, the speed of follower 2 jumps (cam angle 0, 120 deg). This is a "
            "hard impact: the acceleration there is infinite and is not in the tables"
        )
    ]


# ---------------------------------------------------------------- springs


def test_a_torsion_spring_past_half_a_turn_is_named():
    spring = "springs: {t: {between: [0, 1], torsion: 2 N*m/rad, free: 30 deg}}\ndriver:"
    results = solved_text(changed(blocks.SLIDER, "driver:", spring))
    assert (
        "torsion spring t is twisted by more than half a turn from its free angle when the driver is at "
        "209.5 deg: its moment jumps there, because its angle is measured from -180 to 180 deg"
    ) in list(words(results))


def spring_warnings(spring, positions="", turns="ccw"):
    text = changed(blocks.SLIDER, "driver: {", f"springs: {{s: {spring}}}\ndriver: {{turns: {turns}, ") + positions
    return [w for w in words(solved_text(text)) if w.startswith("the ends of spring")]


@pytest.mark.parametrize("turns", ["ccw", "cw"])
def test_a_spring_whose_ends_meet_between_the_positions_is_named(turns):
    """The fixed end lies on the circle of A at 40 deg; positions are at 0, 30, 60 deg and so on."""
    x, y = 50 * math.cos(math.radians(40)), 50 * math.sin(math.radians(40))
    at = f"at: [[{x:.9f}, {y:.9f}], A]"
    told = (
        "the ends of spring s meet when the driver is at 40 deg: the direction of its force reverses "
        "there. Give other points in `between`, or use a torsion spring"
    )
    assert spring_warnings(f"{{between: [0, 1], {at}, rate: 800 N/m, free: 90}}", turns=turns) == [told]
    assert spring_warnings(f"{{between: [0, 1], {at}, rate: 800 N/m, free: 0}}", turns=turns) == []  # F = c r
    near = f"at: [[{x:.9f}, {y + 1:.9f}], A]"
    assert spring_warnings(f"{{between: [0, 1], {near}, rate: 800 N/m, free: 90}}", turns=turns) == []
    few = "positions: {at: [60, 90, 200]}\n"
    assert spring_warnings(f"{{between: [0, 1], {at}, rate: 800 N/m, free: 90}}", few, turns) == [told]


# ---------------------------------------------------------------- friction


@pytest.mark.parametrize("coefficient, locks", [(0.1, False), (2.8, False), (2.85, True), (10, True)])
def test_a_guide_locks_where_its_friction_is_more_than_the_rod_can_overcome(coefficient, locks):
    """At 270 deg the rod leans by asin(1/3): it cannot push the slider where mu tan(lean) > 1, mu > 2.828."""
    friction = f"{{pairs: {{x: {{coefficient: {coefficient}}}}}}}"
    results = solved_text(changed(blocks.SLIDER, "{coefficient: 0.1, radius: 5}", friction))
    assert bool(results.locked[9]) is locks
    said = [word for word in words(results) if "friction locks the mechanism" in word]
    moment = results.reactions.balance.moment[9]
    if locks:
        half = 90 - math.degrees(math.asin(3 * math.sin(math.atan(1 / coefficient))))
        numbers = {2.85: "position 9", 10: "positions 7, 8, 9, 10, 11"}[coefficient]
        assert said == [
            f"friction locks the mechanism from {270 - half:.5g} to {270 + half:.5g} deg ({numbers}), "
            "mainly in pair x of links 0 and 3; no forces are computed there. Reduce the coefficients of friction, or "
            "choose another input link"
        ]
        assert math.isnan(moment)
        assert to_json(results)["positions"]["state"][9] == "self-locking by friction"
    else:
        lean = math.asin(1 / 3)
        push = 1000 / (math.cos(lean) - coefficient * math.sin(lean))
        assert (said, moment) == ([], pytest.approx(push * math.cos(lean) * 0.05))
    assert results.lever_holds


@pytest.mark.parametrize("turns", ["ccw", "cw"])
def test_self_locking_between_the_positions_is_told_with_its_range(tmp_path, turns):
    """The driver moves the other way round and the slider is pushed the other way: the range is at 90 deg."""
    text = changed(blocks.SLIDER, "{coefficient: 0.1, radius: 5}", "{pairs: {x: {coefficient: 2.85}}}")
    text = changed(text, "driver: {", f"driver: {{turns: {turns}, ") + "positions: {at: [0, 30, 200]}\n"
    middle, half = 270 if turns == "ccw" else 90, 90 - math.degrees(math.asin(3 * math.sin(math.atan(1 / 2.85))))
    told = f"from {middle - half:.5g} to {middle + half:.5g} deg, between the computed positions"
    results = solved_text(text)
    assert not np.any(results.locked)
    (found,) = results.losses.ranges
    degrees = np.mod(np.degrees([found.start, found.end]), 360)
    assert degrees == pytest.approx([middle - half, middle + half], abs=1e-4)
    assert [w for w in words(results) if f"friction locks the mechanism {told}" in w]
    file = tmp_path / "x.yaml"
    file.write_text(text, encoding="utf-8")
    for command in ("forces", "run"):
        done = tmm(command, file, *(["--no-drawings", "-o", tmp_path / "out"] if command == "run" else []))
        assert f"friction locks the mechanism {told}" in done.stderr
    assert f"self-locking: {told}" in tmm("forces", file).stdout
    note = [block for block in write_losses(Subject(results, drawn=False)) if isinstance(block, Paragraph)]
    assert told in str(note[0].line)


def test_a_range_over_the_beginning_of_the_cycle_is_one_range():
    locked = np.array([True, True, False, False, True, True])  # the last is the first of the next cycle
    rubbed = FrictionSolution(None, (), locked, ("x",) * 6, {}, None)
    q = np.linspace(0, 5, 6)
    at = lambda q: (np.mod(q, 5) < 1.25) | (np.mod(q, 5) > 3.5)  # noqa: E731
    (found,) = find_locked_ranges(q, rubbed, at, cyclic=True)
    assert (found.start, found.end - 5) == (pytest.approx(3.5, abs=1e-4), pytest.approx(1.25, abs=1e-4))
    whole = find_locked_ranges(q, replace(rubbed, locked=np.full(6, True)), at, cyclic=True)
    assert whole == (LockedRange(0.0, 5.0, "x"),)


def test_a_locked_position_in_detail_is_no_crash(tmp_path, monkeypatch):
    monkeypatch.setattr("tmm_cli.drawing.formats.register.FORMATS", dict.fromkeys(("png", "svg"), lambda drawing: b""))
    text = changed(blocks.SLIDER, "coefficient: 0.1", "coefficient: 10") + "positions: {count: 12, detail: [9]}\n"
    file = tmp_path / "locked.yaml"
    file.write_text(text, encoding="utf-8")
    done = tmm("run", file, "-o", tmp_path / "out")
    assert (done.returncode, "Traceback" in done.stderr, "RuntimeWarning" in done.stderr) == (0, False, False)
    assert "friction locks the mechanism from " in done.stderr
    assert "self-locking by friction" in (tmp_path / "out" / "locked" / "cycle.csv").read_text(encoding="utf-8")


# ---------------------------------------------------------------- drivers


def test_a_cylinder_driven_beyond_its_range_says_how_far():
    """Piston and lever reach 300 + 150 from the cylinder's hinge: at 460 mm they are 10 mm short."""
    text = changed(blocks.CYLINDER, "at: [200, 250, 300, 350, 400]", "at: [140, 300, 460, 1000]")
    results = solved_text(text)
    assert results.motion.moving.tolist() == [False, True, False, False]
    said = [word for word in words(results) if "cannot be assembled" in word]
    assert said == [
        f"position {number} ({place}): group II(1,2,3) cannot be assembled; its points remain {short} apart"
        for number, place, short in ((0, "140 mm", "10 mm"), (2, "460 mm", "10 mm"), (3, "1000 mm", "550 mm"))
    ]


def test_where_the_first_of_two_drivers_stops_its_way_ends():
    text = changed(blocks.TWO, "1 rad/s}", "1 rad/s, acceleration: -1 rad/s^2}")
    results = solved_text(text)
    assert results.driver_range.end == pytest.approx(math.pi / 2 + 0.5, abs=1e-7)
    assert "input link 1 moves only from -90 deg to 118.64789 deg, where it slows down and stops" in " ".join(
        words(results)
    )
    assert np.isfinite(results.motion.named("B").a[:-1]).all()


def test_the_limits_of_two_drivers_that_never_come_back_together_are_not_taken_from_a_turn_later():
    results = solved_text(changed(blocks.TWO, "2 rad/s", "3.14159265 rad/s"))
    assert [limit.group for limit in results.driver_range.limits] == ["II(2,3)"]
    assert bool(results.motion.moving.all())


def test_a_second_driver_at_rest_is_a_link_that_stands():
    results = solved_text(changed(blocks.TWO, "2 rad/s", "0"))
    assert np.max(np.abs(results.motion.link("4").omega)) == 0


def test_the_output_of_a_cylinder_is_what_it_lifts_and_two_points_of_a_link_are_its_guide():
    text = blocks.CYLINDER.replace("slides: {on: 1, along: OP}", "slides: {on: 1}")
    assert solved_text(text).travels[0].link == "3"


def test_positions_of_a_cylinder_do_not_start_somewhere():
    text = changed(blocks.CYLINDER, "{at: [200, 250, 300, 350, 400]}", "{count: 5, from: 250}")
    assert refusal(text) == (
        f"x.yaml:{place(text, 'from')}: positions.from: `from` is allowed only for a crank: the positions of "
        "a driving slider run from one end of its stroke to the other\n"
        "  found:   250\n  allowed: driver: {stroke: [first, last]}, or positions: {at: [...]}"
    )


def test_positions_out_of_reach_are_not_named_one_by_one_without_end():
    text = changed(blocks.CYLINDER, "at: [200, 250, 300, 350, 400]", f"at: {[300, *range(500, 900)]}")
    said = [word for word in words(solved_text(text)) if "cannot be" in word]
    assert (len(said), said[-1]) == (101, "... and further positions that cannot be reached or are dead positions: 300")


# ---------------------------------------------------------------- groups


def ladder(number):
    """One group of 2 n + 2 links: n triangles in a row, each on a leg, between a crank and a last leg."""
    links = ["  1: {points: [O, A], length: 0.3}", f"  a: {{points: [A, T0], length: {math.hypot(0.7, 0.1)!r}}}"]
    points = {"O": (-1, 1)}
    places = {"T0": (0, 1.1)}
    for k in range(number):
        y, after = 1 + 0.1 * (-1) ** k, 1 - 0.1 * (-1) ** k
        long, turned = math.hypot(1, after - y), complex(1, after - y) / math.hypot(1, after - y)
        at = complex(0.5, -0.4) / turned
        points[f"G{k}"] = (k + 0.4 + 0.2 * (k % 2), 0)
        places |= {f"T{k + 1}": (k + 1, after), f"C{k}": (k + 0.5, y - 0.4)}
        leg = math.dist(places[f"C{k}"], points[f"G{k}"])
        links.append(f"  t{k}: {{points: {{T{k}: [0, 0], T{k + 1}: [{long!r}, 0], C{k}: [{at.real!r}, {at.imag!r}]}}}}")
        links.append(f"  g{k}: {{points: [C{k}, G{k}], length: {leg!r}}}")
    points["E"] = (number + 0.6, 0.2)
    links.append(f"  e: {{points: [T{number}, E], length: {math.dist(places[f'T{number}'], points['E'])!r}}}")
    frame, sketch = (", ".join(f"{n}: [{x}, {y}]" for n, (x, y) in some.items()) for some in (points, places))
    return (
        f"tmm: 1\nunits: {{length: m}}\npoints: {{{frame}}}\nlinks:\n"
        + "\n".join(links)
        + f"\ndriver: {{link: 1, speed: 1 rad/s}}\nsketch: {{at: 0, {sketch}}}\n"
    )


def test_a_group_of_98_links_is_refused_by_name_and_one_of_6_is_solved():
    text = ladder(48)
    assert refusal(text).startswith(
        f"x.yaml:{place(text, 'links:')}: links: this group has too many links to be solved: III(a,t0,g0,t1,"
    )
    assert refusal(text).endswith("found:   98\n  allowed: at most 16 links in one group; any number of groups")
    results = solved_text(ladder(2))
    assert results.structure.groups[0].title == "III(a,t0,g0,t1,g1,e)"
    assert bool(results.motion.moving.all())


def kites(number):
    """A gear at 1/50 of the driver's speed, then so many kites, each a quarter of a turn on from the rocker before it.

    The hinge A of a kite runs over the pivot of its rocker, which rotates once in two turns of its crank.
    """
    crank, at, points, links = cmath.rect(100, math.pi / 3), 0, ["G: [-200, 0]", "O0: [0, 0]"], []
    places = [f"A0: [{crank.real}, {crank.imag}]"]
    for k in range(1, number + 1):
        diagonal = 100 - crank
        half = math.sqrt(250**2 - abs(diagonal) ** 2 / 4)
        rocker = diagonal / 2 + diagonal / abs(diagonal) * 1j * half - diagonal
        crank, at = 1j * 100 * rocker / 250, at + 100
        points.append(f"O{k}: [{at}, 0]")
        places += [f"B{k}: [{at + rocker.real}, {rocker.imag}]", f"A{k}: [{at + crank.real}, {crank.imag}]"]
        links.append(f"  c{k}: {{points: [A{k - 1}, B{k}], length: 250}}")
        links.append(f"  r{k}: {{points: {{O{k}: [0, 0], B{k}: [250, 0], A{k}: [0, 100]}}}}")
    return (
        f"tmm: 1\npoints: {{{', '.join(points)}}}\nlinks:\n  g: {{points: [G]}}\n"
        "  1: {points: [O0, A0], length: 100}\n"
        + "\n".join(links)
        + "\ngears: {a: {between: [g, 1], ratio: 0.02, offset: 60 deg}}\ndriver: {link: g, speed: 1 rad/s}\n"
        + f"sketch: {{at: 0, {', '.join(places)}}}\n"
    )


def test_change_points_behind_too_many_groups_and_turns_are_refused_by_name(monkeypatch):
    """50 turns of the driver are one of the first crank, and each kite doubles them."""
    text = kites(2)
    assert bool(solved_text(text).motion.moving.all())
    assert "the search for the change points of group II(" in refusal(kites(10))
    monkeypatch.setattr("tmm_cli.mechanics.assembly.assembling.LARGEST_SEARCH", 299)
    assert refusal(text) == (
        f"x.yaml:{place(text, 'links:')}: links: the search for the change points of group II(c2,r2) would take "
        "too long, as the group depends on too many others\n  found:   groups: 3, turns of the driver: 100\n"
        "  allowed: a product of the two numbers of at most 299"
    )


def test_a_group_that_is_too_large_is_named_before_a_search_that_is_too_long(monkeypatch):
    monkeypatch.setattr("tmm_cli.mechanics.assembly.assembling.LARGEST_SEARCH", 0)
    text = changed(ladder(47), "points: {", "points: {Q: [-1, 2], ")
    text = changed(text, "driver:", "  p: {points: [A, P], length: 0.8}\n  q: {points: [Q, P], length: 0.8}\ndriver:")
    text = changed(text, "sketch: {at: 0, ", "sketch: {at: 0, P: [-0.2, 1.9], ")
    assert "this group has too many links to be solved: III(a,t0,g0,t1," in refusal(text)


def test_a_group_that_moves_by_itself_is_in_a_dead_position():
    """Three parallel legs of one length: the platform translates with the crank at rest."""
    text = changed(blocks.TRIAD, "E: [200, -40], F: [260, 160]", "E: [160, 0], F: [260, 0]")
    text = changed(text, "length: 40", "length: 60")
    text = changed(text, "{B: [0, 0], C: [80, 0], D: [40, 60]}", "{B: [0, 0], C: [100, 0], D: [200, 0]}")
    text = changed(changed(text, "[C, E], length: 90", "[C, E], length: 120"), "length: 110", "length: 120")
    text = changed(
        text, "{at: 90 deg, B: [110, 60], C: [190, 50], D: [155, 115]}", "{at: 0, B: [60, 120], C: [160, 120]}"
    )
    assert "sketch.at: in the sketch group III(2,3,4,5) is in a dead position" in refusal(text)


@pytest.mark.parametrize("name", ["triad", "planet", "rack", "cam", "cylinder", "two", "slider"])
@pytest.mark.parametrize("unit, size", [("um", 1e-6), ("km", 1e3)])
def test_no_size_of_a_mechanism_is_special(name, unit, size):
    """Angles are those of the same mechanism in millimetres, lengths in proportion."""
    text = blocks.EVERYTHING[name]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        one, other = solved_text(text).motion, solved_text(text.replace("length: mm", f"length: {unit}")).motion
    assert one.moving.tolist() == other.moving.tolist()
    assert bool(one.moving.all())
    for link in one.linkage.moving:
        if name not in ("rack", "cylinder"):  # their drivers' speeds or radii are in millimetres still
            assert np.allclose(one.poses[link].z, other.poses[link].z, atol=1e-9)
            assert np.allclose(one.poses[link].x * size / 1e-3, other.poses[link].x, atol=1e-9 * size)


@pytest.mark.parametrize("name", blocks.EVERYTHING)
def test_without_masses_and_loads_all_forces_are_zero_and_finite(name):
    text = blocks.EVERYTHING[name]
    text = "\n".join(line for line in text.splitlines() if not line.startswith(("masses", "loads", "springs")))
    results = solved_text(text.replace("points: [A, B], length: 20}", "points: {A: [0, 0], B: [20, 0]}}") + "\n")
    assert all(np.all(r.force[results.motion.moving] == 0) for r in results.reactions.all)
    assert results.lever_holds


@pytest.mark.parametrize("name", NAMES)
def test_no_problem_of_the_bank_has_a_load_or_a_spring_or_a_friction_to_be_warned_of(name):
    told = ("in the direction of motion", "does no work in", "the ends of spring", "locks by friction")
    assert not [w for w in words(solved(name)) if any(phrase in w for phrase in told)]
    assert not [w for w in find_slips(problem(name).whole) if "move as one slider" in w]
