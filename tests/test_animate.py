"""The page on which a mechanism turns: numbers of the results, no network, names that are data."""

from __future__ import annotations

import json
import re
from functools import cache

import numpy as np
import pytest
from bank import solved
from models import PROBLEMS

from tmm_cli import solve
from tmm_cli.animation import FEWEST_FRAMES, FRAMES, MOST_BYTES, animation_page, draw_first_frame, results_in_frames
from tmm_cli.mechanics.analysis import motion_at_positions
from tmm_cli.problem import ProblemError, build_problem, read_text

COURSE = ["shaper", "course-1", "course-2", "course-3", "course-4", "excavator", "summing-lever"]
HOSTILE = '</script><script>alert(1)</script><img src=x onerror="alert(2)">'


@cache
def page_of(name):
    return animation_page(solved(name))


def data_of(html):
    (text,) = re.findall(r'<script id="data" type="application/json">(.*?)</script>', html, re.S)
    return json.loads(text)


@pytest.mark.parametrize("name", COURSE)
def test_a_page_is_small_and_asks_for_nothing(name):
    html = page_of(name)
    assert len(html.encode()) < MOST_BYTES
    assert "default-src 'none'" in html
    assert not re.findall(r"(?:src|href|url|@import|fetch|XMLHttpRequest|WebSocket)\s*[=(]", html)
    assert set(re.findall(r"https?://[^\s\"']+", html)) <= {"http://www.w3.org/2000/svg"}


def test_a_page_that_would_be_too_large_has_fewer_frames(monkeypatch):
    whole = page_of("shaper")
    monkeypatch.setattr("tmm_cli.animation.page.MOST_BYTES", len(whole.encode()) * 3 // 4)
    fewer = animation_page(solved("shaper"))
    assert len(fewer.encode()) <= len(whole.encode()) * 3 // 4
    assert FEWEST_FRAMES < len(data_of(fewer)["driver"]["values"]) < len(data_of(whole)["driver"]["values"])


def test_links_are_in_every_frame_where_the_results_have_them():
    results, data = solved("shaper"), data_of(page_of("shaper"))
    whole = results_in_frames(results, FRAMES)
    picture = draw_first_frame(whole, whole.motion)
    for name, body in zip(picture.bodies, data["bodies"], strict=True):
        if name in results.linkage.moving:
            pose = whole.motion.poses[name]
            place = picture.sheet.origin + pose.x / picture.sheet.mu
            assert np.asarray(body["x"]) - 1j * np.asarray(body["y"]) == pytest.approx(place, abs=0.01)
            assert np.exp(-1j * np.asarray(body["turn"])) == pytest.approx(pose.z, abs=1e-4)


def test_plans_end_in_the_velocities_and_accelerations_of_the_points():
    results, data = solved("shaper"), data_of(page_of("shaper"))
    motion = motion_at_positions(results, results.closely(FRAMES + 1))
    for plan, quantity in zip(data["plans"], ("v", "a"), strict=True):
        found = {letter: n["point"] for n in plan["letters"] for letter in n["text"].split(", ")}
        for point in "ADE":
            x, y = plan["points"][found[point.lower()]]
            values = getattr(motion.named(point), quantity)
            assert np.asarray(x) + 1j * np.asarray(y) == pytest.approx(values, rel=1e-3, abs=1e-3)
        every = [letter for n in plan["letters"] for letter in n["text"].split(", ")]
        assert {"p", "π"} & set(every) and len(every) == len(set(every))  # each once, the pole too


def test_a_diagram_is_zero_at_the_ends_of_a_stroke_and_not_nearly_zero():
    velocity = data_of(page_of("crank-slider"))["charts"][1]["courses"][0]["values"]
    assert velocity[0] == velocity[-1] == 0 and max(velocity) > 1


def test_a_single_position_of_a_mechanism_that_does_not_turn_is_no_motion():
    text = (PROBLEMS / "excavator.yaml").read_text(encoding="utf-8")
    text = re.sub(r"^positions: .*$", "positions: {at: [s1]}", text, flags=re.M)
    with pytest.raises(ProblemError, match="the mechanism does not move in the requested positions"):
        animation_page(solve(build_problem(read_text(text, "x.yaml"))))


def test_names_from_files_are_data():
    text = (PROBLEMS / "crank-slider.yaml").read_text(encoding="utf-8")
    text = re.sub(r"^title: .*$", lambda _: f"title: {json.dumps(HOSTILE)}", text, flags=re.M)
    html = animation_page(solve(build_problem(read_text(text, "x.yaml"))))
    assert "<img" not in html and "<script>alert" not in html
    assert html.count("</script>") == 2
    data_of(html)


@pytest.fixture
def opened(browser, tmp_path):
    """Opens the page of a problem; at the end nothing was asked of a network, and nothing went wrong."""
    wrong, contexts = [], []

    def opening(name, width=1200, **options):
        file = tmp_path / f"{name}.html"
        file.write_text(page_of(name), encoding="utf-8")
        context = browser.new_context(viewport={"width": width, "height": 800}, **options)
        contexts.append(context)
        tab = context.new_page()
        tab.on("request", lambda request: request.url == file.as_uri() or wrong.append(request.url))
        tab.on("pageerror", lambda error: wrong.append(str(error)))
        tab.on("console", lambda message: wrong.append(message.text))
        tab.goto(file.as_uri())
        return tab

    yield opening
    for context in contexts:
        context.close()
    assert not wrong


def place(tab):
    return float(tab.input_value("#at"))


def until(tab, holds):
    """Waits for the place of the page; its own policy forbids the browser's waiting for an expression."""
    for _ in range(200):
        if holds(place(tab)):
            return
        tab.wait_for_timeout(50)
    raise AssertionError(f"the page stays at {place(tab)}")


def test_keys_play_step_and_stop(opened):
    tab = opened("shaper")
    tab.keyboard.press("ArrowRight")
    tab.keyboard.press("ArrowRight")
    assert place(tab) == 2
    tab.keyboard.press("ArrowLeft")
    assert place(tab) == 1
    tab.keyboard.press("ArrowUp")
    assert tab.input_value("#speed") == "2"
    tab.keyboard.press(" ")
    until(tab, lambda at: at > 5)
    tab.keyboard.press(" ")
    stopped = place(tab)
    tab.wait_for_timeout(100)
    assert place(tab) == stopped


def test_a_mechanism_that_does_not_turn_fully_goes_to_and_fro(opened):
    tab = opened("excavator")
    tab.keyboard.press("End")
    end = place(tab)
    tab.keyboard.press(" ")
    until(tab, lambda at: at < end - 3)


@pytest.mark.parametrize("name", ["shaper", "planetary-dwell-press", "cam-lever"])
def test_links_are_drawn_where_the_frame_has_them(opened, name):
    tab, data = opened(name), data_of(page_of(name))
    frame = 50
    for _ in range(frame):
        tab.keyboard.press("ArrowRight")
    for number, body in enumerate(data["bodies"]):
        here = {key: values[frame] if isinstance(values, list) else values for key, values in body.items()}
        shown = tab.evaluate(
            f"(() => {{ const g = document.querySelector('[data-body=\"{number}\"]'); if (!g) return null;"
            " const m = g.transform.baseVal.consolidate().matrix; return [m.a, m.b, m.e, m.f]; })()"
        )
        if shown is not None:
            turn, stretch = here["turn"], here["stretch"]
            wanted = [stretch * np.cos(turn), stretch * np.sin(turn), here["x"], here["y"]]
            assert shown == pytest.approx(wanted, abs=1e-4)


def test_a_finger_moves_it_and_a_narrow_screen_holds_it(opened):
    tab = opened("shaper", width=360, has_touch=True, is_mobile=True)
    assert tab.evaluate("document.documentElement.scrollWidth") == 360
    tab.tap("#charts svg >> nth=3", position={"x": 190, "y": 40})  # the middle, figures are left of it
    last = len(data_of(page_of("shaper"))["driver"]["values"]) - 1
    assert place(tab) == pytest.approx(last / 2, abs=0.05 * last)
    tab.tap("#play")
    before = place(tab)
    until(tab, lambda at: at > before + 2)
    sizes = tab.evaluate("[...document.querySelectorAll('#labels text')].map((t) => t.getBoundingClientRect().height)")
    assert min(sizes) >= 9
