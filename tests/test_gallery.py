"""The page of many mechanisms: small, found by what they are and do, turning where the results say; texts are data."""

from __future__ import annotations

import json
import re
import shutil
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from bank import moved
from models import PROBLEMS
from test_commands import tmm

from tmm_cli.animation import (
    ROW,
    STEPS_PER_MM,
    STEPS_PER_RADIAN,
    chain_places,
    draw_first_frame,
    gallery_page,
    make_card,
)
from tmm_cli.language import spoken
from tmm_cli.mechanics.analysis import motion_at_positions
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.structure import SpatialChain, SpatialPair

NAMES = ("crank-slider", "slotted-lever", "cam-lever", "excavator", "double-crank", "manipulator-open")
MOST = 3_000_000 / 60  # bytes of a mechanism
HOSTILE = '</script><script>alert(1)</script><img src=x onerror="alert(2)">'


@cache
def card_of(name):
    return make_card(str(PROBLEMS / f"{name}.yaml"))


@cache
def page_of():
    return gallery_page([card_of(name) for name in NAMES])


def data_of(html):
    (text,) = re.findall(r'<script id="data" type="application/json">(.*?)</script>', html, re.S)
    return json.loads(text)


def test_sixty_mechanisms_are_below_three_megabytes_and_ask_for_nothing():
    html = page_of()
    assert len(html.encode()) < MOST * len(NAMES)
    assert "default-src 'none'" in html
    assert not re.findall(r"(?:src|href|url|@import|fetch|XMLHttpRequest|WebSocket)\s*[=(]", html)
    assert not re.findall(r"https?://", html)


def test_a_card_says_class_groups_purposes_and_properties():
    lever = card_of("slotted-lever")
    assert (lever.number, lever.groups, lever.formula) == ("II", ("II RPR",), "I(0,1) → II(2,3)")
    assert lever.purposes == ("swings", "quick")
    facts = {fact.name: fact.number for fact in lever.facts}
    assert facts["time ratio k"] == 1.552
    assert card_of("double-crank").purposes == ("turns",)
    assert {"slides", "dwell"} <= set(card_of("cam-lever").purposes)


def test_a_chain_in_space_has_a_card_with_a_scheme_that_stands():
    arm = card_of("manipulator-open")
    assert arm.turning.bodies == () and arm.purposes == ("space",) and arm.formula == "W = 6·3 − 5·1 − 3·2 = 7"
    assert re.findall(r">(\w+)</text>", arm.turning.svg) == ["3", "1", "3", "0", "1", "2", "3"]  # pairs, then links
    assert {fact.number for fact in arm.facts if "mobility" in fact.name} == {7}


def value(course, unit, at, loops):
    """Between frames, as the script of the page has it."""
    if isinstance(course, int):
        return course / unit
    values = np.cumsum(course) / unit
    turn = values[-1] - values[0]
    ends = (values[-2] - turn, values[1] + turn) if loops else (2 * values[0] - values[1], 2 * values[-1] - values[-2])
    k, share = int(at), at - int(at)
    a, b, c, d = np.r_[ends[0], values, ends[1]][k : k + 4]
    return b + share / 2 * (c - a + share * (2 * a - 5 * b + 4 * c - d + share * (3 * (b - c) + d - a)))


@pytest.mark.parametrize("name", ["slotted-lever", "excavator"])
def test_bodies_are_in_their_places_between_the_frames(name):
    """Half-way, where it is worst, by a tenth of a mm of a picture of 120 mm at most."""
    results, turning = moved(name), card_of(name).turning
    last = max(len(course) for body in turning.bodies for course in body if not isinstance(course, int)) - 1
    exact = draw_first_frame(results, motion_at_positions(results, results.closely(2 * last + 1), 0))
    for body, own in zip(turning.bodies, (exact.bodies[n] for n, __ in layers_of(exact) if n != FRAME), strict=True):
        for half in range(0, 2 * last, 5):
            x, y = (value(course, STEPS_PER_MM, half / 2, turning.loops) for course in body[:2])
            turn = value(body[2], STEPS_PER_RADIAN, half / 2, turning.loops)
            assert x - 1j * y == pytest.approx(own.place[half], abs=0.1)
            assert -turn == pytest.approx(own.angle[half], abs=2e-3)


def test_links_of_a_chain_stand_in_rows_above_what_they_hang_on():
    ends = ("ab", "ac", "bd", "cd", "0a")
    pairs = tuple(SpatialPair(f"p{k}", i, j, 1) for k, (i, j) in enumerate(ends))
    places = chain_places(SpatialChain(tuple("abcd"), pairs))
    assert [places[link].imag / ROW for link in "0abcd"] == [0, 1, 2, 2, 3]
    assert len(set(places.values())) == 5


def layers_of(picture):
    return dict(picture.layers()).items()


def test_what_is_asked_for_a_single_position_moves_as_far_as_its_driver_can_go(tmp_path):
    text = (PROBLEMS / "excavator.yaml").read_text(encoding="utf-8")
    (tmp_path / "x.yaml").write_text(re.sub(r"^positions: .*$", "positions: {at: [s1]}", text, flags=re.M), "utf-8")
    turning = make_card(str(tmp_path / "x.yaml")).turning
    assert turning.bodies and not turning.loops


def hostile_folder(folder):
    text = (PROBLEMS / "crank-slider.yaml").read_text(encoding="utf-8")
    text = re.sub(r"^title: .*$", lambda _: f"title: {json.dumps(HOSTILE)}", text, flags=re.M)
    (folder / "a.yaml").write_text(f"# {HOSTILE}\n{text}", encoding="utf-8")
    return folder


def test_texts_of_files_are_data(tmp_path):
    html = gallery_page([make_card(str(hostile_folder(tmp_path) / "a.yaml"))])
    assert "<img" not in html and "<script>alert" not in html
    assert html.count("</script>") == 2
    data_of(html)


def test_the_page_says_nothing_of_the_machine_that_it_was_written_on(tmp_path):
    (tmp_path / "bank" / "presses").mkdir(parents=True)
    files = [tmp_path / "bank" / "sine.yaml", tmp_path / "bank" / "presses" / "press.yaml"]
    for file in files:
        shutil.copy(PROBLEMS / "sine.yaml", file)
    html = gallery_page([make_card(str(file)) for file in files])
    assert str(tmp_path) not in html and "<code>sine.yaml</code>" in html
    assert f"<code>{Path('presses', 'press.yaml')}</code>" in html
    assert "<code>sine.yaml</code>" in gallery_page([make_card(str(files[0]))])


def test_a_broken_file_is_said_and_left_out(tmp_path):
    (tmp_path / "deep").mkdir()
    shutil.copy(PROBLEMS / "sine.yaml", tmp_path / "deep")
    (tmp_path / "broken.yaml").write_text("tmm: 1\nlinks: [", encoding="utf-8")
    done = tmm("gallery", str(tmp_path), "-o", str(tmp_path / "out"))
    assert done.returncode == 1
    index = tmp_path / "out/index.html"
    assert done.stderr.splitlines() == [
        f"error: {tmp_path / 'broken.yaml'}:3:1: a value is missing",
        "  allowed: a value",
        f"written: {index}",
        "files omitted: 1",
    ]
    assert len(data_of(index.read_text(encoding="utf-8"))["cards"]) == 1
    (tmp_path / "deep/sine.yaml").unlink()
    assert tmm("gallery", str(tmp_path / "deep"), "-o", str(tmp_path / "none")).returncode == 2


def test_the_page_speaks_other_languages():
    with spoken("ru"):
        html = gallery_page([make_card(str(PROBLEMS / "slotted-lever.yaml"))])
    assert '<html lang="ru">' in html and "ускоренный обратный ход" in html and "1,552" in html


@pytest.fixture
def tab(browser, tmp_path):
    """The page in a narrow window that is touched; at the end nothing was asked of a network, nothing went wrong."""
    file, wrong = tmp_path / "index.html", []
    file.write_text(page_of(), encoding="utf-8")
    context = browser.new_context(viewport={"width": 360, "height": 800}, has_touch=True, is_mobile=True)
    opened = context.new_page()
    opened.on("request", lambda request: request.url == file.as_uri() or wrong.append(request.url))
    opened.on("pageerror", lambda error: wrong.append(str(error)))
    opened.on("console", lambda message: wrong.append(message.text))
    opened.goto(file.as_uri())
    yield opened
    context.close()
    assert not wrong


def shown(tab):
    titles = tab.evaluate("[...document.querySelectorAll('.card:not([hidden]) h2')].map((h) => h.textContent)")
    return [name for name in NAMES if card_of(name).title in titles]


def transforms(tab, number):
    bodies = f"document.querySelectorAll('.card:nth-child({number}) [data-body]')"
    return tab.evaluate(f"[...{bodies}].map((g) => g.getAttribute('transform'))")


@pytest.mark.parametrize(
    ("field", "words", "found"),
    [
        ("#words", "SLOTTED rpr", ["slotted-lever"]),
        ("#words", "no such word", []),
        ("#words", "link 3 = thet", ["slotted-lever"]),
        ("#words", "I(0,1", ["crank-slider", "slotted-lever", "cam-lever", "double-crank"]),
        ("#fact", "swing", ["slotted-lever", "excavator"]),
        ("#fact", "k > 1,5", ["slotted-lever"]),
        ("#fact", "stroke H >= 100", ["crank-slider"]),
    ],
)
def test_words_find_mechanisms(tab, field, words, found):
    tab.fill(field, words)
    assert set(shown(tab)) == set(found)
    assert tab.inner_text("#told") == f"{len(found)} of {len(NAMES)} mechanisms"


def test_class_group_and_purpose_find_mechanisms(tab):
    tab.select_option("#purpose", "slides")
    assert {"crank-slider", "cam-lever"} <= set(shown(tab)) and "slotted-lever" not in shown(tab)
    tab.select_option("#group", "II RC")
    assert shown(tab) == ["cam-lever"]
    tab.tap("button[type=reset]")
    tab.wait_for_timeout(50)
    assert shown(tab) == list(NAMES)
    tab.select_option("#number", "II")
    assert shown(tab) == list(NAMES[:-1])


def test_what_is_seen_turns_until_it_is_pressed(tab):
    assert tab.evaluate("document.documentElement.scrollWidth") == 360
    first, last = transforms(tab, 1), transforms(tab, 5)
    tab.wait_for_timeout(400)
    assert transforms(tab, 1) != first and transforms(tab, 5) == last
    tab.focus(".card:nth-child(1) .picture")
    tab.keyboard.press("Enter")
    stopped = transforms(tab, 1)
    tab.wait_for_timeout(200)
    assert transforms(tab, 1) == stopped
    tab.keyboard.press("/")
    tab.keyboard.type("drag link")
    assert shown(tab) == ["double-crank"]
    tab.wait_for_timeout(400)
    assert transforms(tab, 5) != last
