"""The page: one HTML file with the mechanism as inline SVG, the numbers as JSON, and the script that moves it.

It asks nothing of any network: its policy allows its own style and its own script alone. What comes from files is data.
"""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Iterable
from html import escape
from importlib.resources import files
from string import Template
from typing import Any

from tmm_cli.animation.content import FRAMES, content, frames, paths, picture_of, view
from tmm_cli.drawing.formats import element
from tmm_cli.language import _, language
from tmm_cli.mechanics.analysis import Results

MOST = 300_000  # bytes of a page
FEWEST = 36  # frames a turn
TEXT = str.maketrans({"<": "\\u003c", ">": "\\u003e", "&": "\\u0026"})  # nothing in JSON ends a script


def animation_page(results: Results) -> str:
    """The page of a mechanism, with fewer frames where it would be larger than it may be. Raises ProblemError."""
    count = FRAMES
    made = _page(results, count)
    while len(made.encode()) > MOST and count > FEWEST:
        count = count * 3 // 4
        made = _page(results, count)
    return made


def _page(results: Results, count: int) -> str:
    whole = frames(results, count)
    assert whole.motion is not None
    picture = picture_of(whole, whole.motion)
    names = list(picture.bodies)
    bodies = "\n".join(
        f'<g data-body="{names.index(name)}">{"".join(element(mark, 0.0) for mark in marks)}</g>'
        for name, marks in picture.layers()
    )
    return filled(
        "",
        title=escape(results.problem.title),
        view=" ".join(f"{side:.1f}" for side in view(picture)),
        paths="".join(_path(way) for way in paths(picture)),
        bodies=bodies,
        data=data_text(content(results, whole, picture)),
        hint=escape(_("Space: play or stop. Left and right: step. Up and down: speed. Drag in a diagram to go there.")),
        back="" if results.turns else escape(_("The way back is played backwards: all is shown as on the way there.")),
        play=escape(_("play or stop")),
        position=escape(_("position")),
        speed=escape(_("speed")),
        ways=escape(_("trajectories")),
    )


def filled(folder: str, **texts: str) -> str:
    """The page in a folder here, with its style and its script, which alone its policy allows, and with these texts."""
    own = files("tmm_cli.animation")
    whole, style, script = (own.joinpath(f"{folder}page.{kind}").read_text("utf-8") for kind in ("html", "css", "js"))
    policy = f"default-src 'none';style-src '{_digest(style)}';script-src '{_digest(script)}'"
    return Template(whole).substitute(texts, lang=language(), policy=policy, style=style, script=script)


def data_text(data: Any) -> str:
    """JSON that may stand in a script element."""
    return json.dumps(data, separators=(",", ":"), allow_nan=False).translate(TEXT)


def _path(way: Iterable[Iterable[float]]) -> str:
    return f'<polyline points="{" ".join(",".join(f"{x:g}" for x in place) for place in way)}"/>'


def _digest(text: str) -> str:
    """How a policy names a text that it allows."""
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
