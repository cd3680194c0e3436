"""Large sheets of the bank, drawn once a process, and how much stands on them."""

from __future__ import annotations

import functools

from bank import solved

from tmm_cli.drawing.layout import TITLE_BLOCK_SIZES, choose_positions, frame_corners, large_sheets

COURSES = ["shaper", "course-1", "course-2", "course-3", "course-4"]


@functools.cache
def laid_out(name, paper):
    return dict(large_sheets(choose_positions(solved(name), all_positions=False), paper))


def drawn(name, paper="A1"):
    return laid_out(name, paper)


def about(name, subject):
    """The first sheet with this in its name."""
    return next(sheet for stem, sheet in drawn(name).items() if stem.endswith(subject))


def free(sheet):
    """What is within the frame beside the title block, mm²."""
    low, high = frame_corners(sheet.paper)
    return (high - low).real * (high - low).imag - TITLE_BLOCK_SIZES["gost"][0] * TITLE_BLOCK_SIZES["gost"][1]


def used(sheet):
    return sum((b - a).real * (b - a).imag for a, b in boxes(sheet))


def boxes(sheet):
    """Lower left and upper right corners of what stands on a sheet."""
    return [(at, at + complex(*one.paper)) for at, one in sheet.pictures]


def apart(one, other):
    (low, high), (other_low, other_high) = one, other
    return (
        low.real >= other_high.real
        or other_low.real >= high.real
        or low.imag >= other_high.imag
        or other_low.imag >= high.imag
    )
