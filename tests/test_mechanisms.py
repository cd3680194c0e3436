"""Mechanisms of the sources: every row has a file, the table is what its command writes, and each number by hand."""

from __future__ import annotations

import math
import re

import mechanisms
import numpy as np
import pytest
from bank import drawn, solved
from models import PROBLEMS
from test_commands import tmm

from tmm_cli import load, solve
from tmm_cli.problem import build_problem, read_text
from tmm_cli.reports import shown_properties


def shown(name):
    """What a file shows, in its order."""
    return [one.value for one in shown_properties(solved(name))]


def meet(a, b, r1, r2, near):
    """Where circles about a and b meet, the point near another one."""
    d = b - a
    along = (r1 * r1 - r2 * r2 + abs(d) ** 2) / (2 * abs(d))
    root = np.sqrt(complex(r1 * r1 - along * along)).real
    both = [a + d / abs(d) * (along + 1j * s * root) for s in (1, -1)]
    return min(both, key=lambda p: abs(p - near))


def unit(degrees):
    return np.exp(1j * np.radians(degrees))


def slope(place, q, step=1e-5):
    """The derivative of a place by q, by differences of the fourth order."""
    f = [place(q + k * step) for k in (-2, -1, 1, 2)]
    return (f[0] - 8 * f[1] + 8 * f[2] - f[3]) / (12 * step)


# the table


def test_every_row_of_the_list_has_a_file():
    rows = {mechanisms.number(data) for data in mechanisms.referred().values()}
    assert rows == set(range(1, mechanisms.ROWS + 1))
    assert all(data.get("shows") for data in mechanisms.referred().values())


def test_the_table_is_what_its_command_writes():
    assert mechanisms.PAGE.read_text(encoding="utf-8") == mechanisms.written()


def test_schemes_are_there_and_show_every_link():
    files = [file for file in mechanisms.referred() if "structure" not in mechanisms.read(file)]
    assert {mechanisms.scheme(file) for file in files} == set(mechanisms.SCHEMES.glob("*"))
    for file in files:
        texts = set(re.findall(r"<text[^>]*>([^<]+)", mechanisms.scheme(file).read_text(encoding="utf-8")))
        assert set(load(str(file)).linkage.moving) <= texts, file.stem  # every link has its number


def test_what_files_expect_is_what_is_found():
    for file in mechanisms.referred():
        for one in mechanisms.golden(file)["properties"]:
            if one["expected"] is not None:
                assert one["value"] == pytest.approx(one["expected"], rel=1e-9, abs=1e-9), (file.stem, one["property"])


# four-bars


def test_double_rocker_goes_its_own_range_and_swings_as_circles_say():
    l1, l2, l3, l4 = 160, 90, 140, 180
    text = (PROBLEMS / "four-bars/double-rocker.yaml").read_text(encoding="utf-8")
    free = solve(build_problem(read_text(text.replace(", stroke: [34, 76]", ""), "free.yaml")), "kinematics")
    ends = [math.acos((l1**2 + l4**2 - (l3 + s * l2) ** 2) / (2 * l1 * l4)) for s in (-1, 1)]
    assert (free.driver_range.start, free.driver_range.end) == pytest.approx(tuple(ends), abs=1e-12)
    assert {free.roles[link] for link in "13"} == {"rocker"}
    b, angles = 160 + 138j, []
    for phi in np.linspace(60, 34, 200).tolist() + np.linspace(34, 76, 400).tolist():
        b = meet(l1 * unit(phi), l4, l2, l3, b)
        angles.append(np.angle(b - l4))
    assert shown("four-bars/double-rocker")[0] == pytest.approx(np.ptp(angles), abs=1e-9)


@pytest.mark.parametrize("name, driver", [("four-bars/swing-doubler", "1"), ("four-bars/swing-halver", "3")])
def test_double_rocker_changes_the_swing_between_circles(name, driver):
    results = solved(name)
    lengths = {
        pair: abs(results.motion.named(pair[0]).x - results.motion.named(pair[1]).x)[0] for pair in ("OA", "AB", "DB")
    }
    b = 0.2662 + 0.0352j
    angles = []
    for phi in np.linspace(61, 101, 60):
        b = meet(lengths["OA"] * unit(phi), 0.2, lengths["AB"], lengths["DB"], b)
        angles.append(np.degrees(np.angle(b - 0.2)))
    ratio = (angles[-1] - angles[0]) / 40
    assert shown(name)[0] == pytest.approx(ratio if driver == "1" else 1 / ratio, abs=1e-9)
    assert max(np.max(p.angles) for p in results.pressure) < math.radians(45)


def test_tilting_table_turns_over():
    motion = solved("four-bars/tilting-table").motion
    a, b, d = (motion.named(point).x for point in "ABD")
    assert np.ptp(np.abs(a - b)) < 1e-14 and np.ptp(np.abs(b - d)) < 1e-14
    table = np.degrees(np.unwrap(np.angle(b - a)))
    assert table[-1] - table[0] == pytest.approx(180, abs=1e-10)


def test_cradles_of_a_transfer_device_stay_level():
    results = solved("four-bars/transfer")
    assert results.structure.mobility == 3 * 6 - 2 * 10 and results.structure.redundant == 3
    assert np.max(np.abs(results.motion.link("5").angle)) < 1e-14
    assert results.motion.link("2").first == pytest.approx(1.0, abs=1e-14)


def test_gain_of_the_bench_press_by_differences():
    def lever_end(s):
        c, g = 150 - 320j, -150 - 230j
        k = meet(g, c, s, 110, 114 - 216j)
        a = c + (k - c) * 160 / 110
        b = meet(a, 0, 160, 150, 146 - 19j)
        return -60 * b / 150

    start, end = shown("four-bars/bench-press")
    assert start == pytest.approx(1 / abs(slope(lever_end, 246, 1e-2)), rel=1e-8)
    assert end == pytest.approx(1 / abs(slope(lever_end, 293, 1e-2)), rel=1e-8)


def test_prisms_of_the_clamp_meet_in_the_middle():
    results = solved("four-bars/clamp-levers")
    one, two = (results.motion.slide(results.linkage.slide(name)).run for name in ("x", "u"))
    way = np.array([one - one[4], two - two[4]])
    assert np.max(np.abs(way[0] + way[1])) < 1e-3


# cranks


def test_gain_of_the_toggle_with_a_swinging_output_by_differences():
    results = solved("cranks/toggle-rocker")

    def end(phi):
        o, c, d = -280 + 143j, 320j, 160 - 47j
        b = meet(o + 36 * np.exp(1j * phi), c, 240, 180, -42 + 145j)
        return meet(b, d, 190, 160, -39j)

    gains = [36 / abs(slope(end, q, 1e-4)) for q in results.motion.q[[6, 11]]]
    assert shown("cranks/toggle-rocker")[1:] == pytest.approx(gains, rel=1e-8)


def test_stroke_of_the_double_stroke_press_by_circles():
    def ram(phi, e=50, a=200, rod=420):
        pin = e * unit(phi)
        b = meet(pin, -a + rod * 1j, a, rod, -150 + 3j)
        c = 2 * pin - b
        return c.imag - math.sqrt(rod**2 - (c.real - a) ** 2)

    heights = [ram(phi) for phi in np.linspace(0, 360, 7201)]
    assert shown("cranks/double-stroke-press")[0] == pytest.approx(np.ptp(heights) / 100, abs=1e-6)


def test_reversing_lever_turns_the_slider_round_over_the_whole_turn():
    text = (PROBLEMS / "cranks/reversing.yaml").read_text(encoding="utf-8")
    other = solve(build_problem(read_text(text.replace("side: 1", "side: -1"), "other.yaml")), "kinematics")
    one, two = (r.motion.named("E").v.imag for r in (solved("cranks/reversing"), other))
    assert one[3] == pytest.approx(-0.03 * 2 * math.pi * math.tan(math.pi / 6), abs=1e-14)
    assert np.sum(one * two < 0) >= 10  # of 12: not near the ends of its strokes


# slotted links


def test_an_angle_on_the_circumference_is_doubled_and_fails_over_its_vertex():
    results = solved("lever-driven-slot")
    c, a = results.motion.named("C").x, results.motion.named("A").x
    assert np.angle(a - 0.08) == pytest.approx(2 * np.angle(a - c), abs=1e-13)
    assert sorted(math.degrees(dead.place) for dead in results.dead) == pytest.approx([-90, 90], abs=1e-6)


def test_slots_are_entered_and_left_along_them_and_the_flange_is_held_between():
    results = solved("slotted/intermittent")
    drive, idle = results.strokes.strokes
    assert [math.degrees(way.length) for way in (drive, idle)] == pytest.approx([180 - 36, 180 + 36], abs=1e-9)
    assert math.degrees(drive.start) == pytest.approx(18, abs=1e-9)
    assert abs(drive.run) == pytest.approx(2 * math.pi / 5, abs=1e-12)
    motion = results.motion
    radii = [abs(motion.named(end).x[0]) for end in "DL"]
    assert radii[0] == pytest.approx(radii[1], abs=1e-12)
    assert abs(motion.link("4").omega[0]) < 1e-12


# settings


@pytest.mark.parametrize("number, setting", list(enumerate((0, 20, 40))))
def test_strokes_of_the_adjustable_lever_by_circles(number, setting):
    c, r = 240 + 230j, 300
    b0 = r * unit(setting - 20)
    b, places = b0, []
    for phi in np.linspace(0, 360, 3601) + setting - 20:
        b = meet(40 * unit(phi), c, 260, abs(b0 - c), b)
        d = c + 150j * (b - c) / (b0 - c)
        places.append(d.real - math.sqrt(250**2 - (d.imag - 400) ** 2))
    found = shown("settings/adjustable-lever")
    assert 1000 * found[number] == pytest.approx(np.ptp(places), abs=1e-3)
    assert 1000 * found[3] == pytest.approx(places[0], abs=1e-9)


def test_a_rod_without_its_bolt_lets_the_crank_turn_beside_a_slider_that_stands():
    whole, broken = solved("settings/safety-rod"), solved("settings/safety-rod-broken")
    assert whole.structure.mobility + whole.structure.redundant == 1
    assert broken.structure.mobility == 3 * 6 - 2 * 8 == 2
    assert broken.driver_range.full and np.all(broken.motion.moving)
    assert np.ptp(broken.motion.named("E").x) == 0
    between = np.degrees(broken.motion.link("5").angle - broken.motion.link("4").angle)
    assert np.ptp(between) > 20
    assert any(name.startswith("lever") for name in drawn("settings/safety-rod-broken"))


def test_an_open_rod_rocks_beside_a_slider_that_stands_and_closes_at_the_top():
    closed, idle = solved("settings/breaking-rod"), solved("settings/breaking-rod-open")
    assert closed.structure.mobility + closed.structure.redundant == 1
    assert idle.structure.mobility == 3 * 4 - 2 * 5 == 2
    assert idle.driver_range.full and np.all(idle.motion.moving) and np.ptp(idle.motion.named("E").x) == 0

    def elbows(motion):
        return motion.link("3").angle - motion.link("2").angle

    assert elbows(closed.motion) == pytest.approx(np.zeros(12), abs=1e-12)
    assert elbows(idle.motion)[0] == pytest.approx(0, abs=1e-12)
    assert np.all(np.abs(elbows(idle.motion)[1:]) > math.radians(5))
    e, x, angles = -340j, 25 - 130j, []
    for phi in np.linspace(90, 450, 721):
        a = 60 * unit(phi)
        x = meet(a, e, math.hypot(190, 25), math.hypot(210, 25), x)
        angles.append((np.angle((x - a) / (190 + 25j)), np.angle((e - x) / (210 - 25j))))
    swings = np.ptp(np.unwrap(np.array(angles), axis=0), axis=0)
    assert shown("settings/breaking-rod-open")[3:] == pytest.approx(swings, abs=1e-5)


def test_the_initial_position_of_a_pusher_by_circles():
    found = shown("settings/initial-position")
    for number, rod in enumerate((206, 210, 214)):
        b, heights = 30 + 215j, []
        for phi in np.linspace(0, 360, 3601):
            b = meet(20 * unit(phi), 160 + 215j, rod, 130, b)
            d = 160 + 215j - 100 / 130 * (b - 160 - 215j)
            heights.append(d.imag + 15)
        assert 1000 * found[number] == pytest.approx(min(heights), abs=1e-4)
        if rod != 210:
            assert 1000 * found[3 if rod == 206 else 4] == pytest.approx(np.ptp(heights), abs=1e-4)


def test_the_stroke_of_an_eccentric_sleeve_is_twice_the_sum_of_two_vectors():
    for number, angle in enumerate((0, 90, 180)):
        assert 1000 * shown("settings/eccentric-sleeve")[number] == pytest.approx(
            2 * abs(10 + 8 * unit(angle)), abs=1e-9
        )


# gear-lever


def test_steps_of_the_ratchet_are_half_a_turn_together():
    rod, h = 320, 80j
    steps = []
    for radius in (100, 125):
        ends = [meet(0, x + h, radius, rod, radius * 1j) for x in (-397.6138276043, -241.4402949608)]
        steps.append(abs(np.angle(ends[0] / ends[1])))
    assert shown("gear-lever/ratchet-feed")[:2] == pytest.approx(steps, abs=1e-12)
    assert math.degrees(sum(steps)) == pytest.approx(180, abs=1e-9)


def test_on_the_way_back_the_pin_goes_outwards_and_the_crosshead_where_it_began():
    motion = solved("gear-lever/ratchet-return").motion
    assert np.abs(motion.named("E").x)[[0, -1]] == pytest.approx([0.1, 0.125], abs=1e-12)
    assert motion.named("F").x.real[[0, -1]] == pytest.approx([-0.2414402949608, -0.3976138276043], abs=1e-11)
    assert motion.link("5").first == pytest.approx(3.0, abs=1e-14)  # Willis: (w5 - w4)/(0 - w4) = -2


def test_files_in_folders_are_checked_too(tmp_path):
    (tmp_path / "slotted").mkdir()
    (tmp_path / "slotted/sine.yaml").write_bytes((PROBLEMS / "sine.yaml").read_bytes())
    done = tmm("check", tmp_path)
    assert done.returncode == 1
    assert (
        "sine.json: there are no expected values" in done.stderr
        and "problems: 1, of which with differences: 0" not in done.stderr
    )
