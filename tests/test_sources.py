"""Every item of the sources is shown by a command: problems/SOURCES.md is what the commands print today."""

import re

import pytest
from sources import PAGE, items, written

NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")


def test_the_page_has_every_item_of_the_sources():
    every = list(items())
    assert [item.number for item in every] == list(range(1, 171))
    assert all(item.command and item.parts for item in every)
    assert len(re.findall(r"(?m)^\| \d+ \|", PAGE.read_text(encoding="utf-8"))) == 170


def test_the_page_is_what_its_command_writes():
    """Its words letter by letter, its numbers to six figures: their last digits are a processor's own."""
    kept, now = PAGE.read_text(encoding="utf-8"), written()
    assert NUMBER.sub("#", now) == NUMBER.sub("#", kept)
    assert list(map(float, NUMBER.findall(now))) == pytest.approx(list(map(float, NUMBER.findall(kept))), rel=1e-6)
