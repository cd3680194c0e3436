"""The page on which a mechanism turns: numbers of the results, no network, names that are data."""

from __future__ import annotations

import json
import re
from functools import cache

import numpy as np
import pytest
from models import PROBLEMS

from tmm_cli import load, solve
from tmm_cli.analysis.pipeline import at_positions
from tmm_cli.animate.content import FRAMES, frames, picture_of
from tmm_cli.animate.page import MOST, page
from tmm_cli.problem.build import build
from tmm_cli.problem.reader import read_text

COURSE = ["shaper", "course-1", "course-2", "course-3", "course-4"]
HOSTILE = '</script><script>alert(1)</script><img src=x onerror="alert(2)">'


@cache
def results_of(name):
    return solve(load(str(PROBLEMS / f"{name}.yaml")))


@cache
def page_of(name):
    return page(results_of(name))


def data_of(html):
    (text,) = re.findall(r'<script id="data" type="application/json">(.*?)</script>', html, re.S)
    return json.loads(text)


@pytest.mark.parametrize("name", COURSE)
def test_a_page_is_small_and_asks_for_nothing(name):
    html = page_of(name)
    assert len(html.encode()) < MOST
    assert "default-src 'none'" in html
    assert not re.findall(r"(?:src|href|url|@import|fetch|XMLHttpRequest|WebSocket)\s*[=(]", html)
    assert set(re.findall(r"https?://[^\s\"']+", html)) <= {"http://www.w3.org/2000/svg"}


def test_links_are_in_every_frame_where_the_results_have_them():
    results, data = results_of("shaper"), data_of(page_of("shaper"))
    whole = frames(results, FRAMES)
    picture = picture_of(whole, whole.motion)
    for name, body in zip(picture.bodies, data["bodies"], strict=True):
        if name in results.linkage.moving:
            pose = whole.motion.poses[name]
            place = picture.sheet.origin + pose.x / picture.sheet.mu
            assert np.asarray(body["x"]) - 1j * np.asarray(body["y"]) == pytest.approx(place, abs=0.01)
            assert np.exp(-1j * np.asarray(body["turn"])) == pytest.approx(pose.z, abs=1e-4)


def test_plans_end_in_the_velocities_and_accelerations_of_the_points():
    results, data = results_of("shaper"), data_of(page_of("shaper"))
    motion = at_positions(results, results.closely(FRAMES + 1))
    for plan, quantity in zip(data["plans"], ("v", "a"), strict=True):
        found = {letter: n["point"] for n in plan["letters"] for letter in n["text"].split(", ")}
        for point in "ADE":
            x, y = plan["points"][found[point.lower()]]
            values = getattr(motion.named(point), quantity)
            assert np.asarray(x) + 1j * np.asarray(y) == pytest.approx(values, rel=1e-3, abs=1e-3)


def test_names_from_files_are_data():
    text = (PROBLEMS / "crank-slider.yaml").read_text(encoding="utf-8")
    text = re.sub(r"^title: .*$", lambda _: f"title: {json.dumps(HOSTILE)}", text, flags=re.M)
    html = page(solve(build(read_text(text, "x.yaml"))))
    assert "<img" not in html and "<script>alert" not in html
    assert html.count("</script>") == 2
    data_of(html)
