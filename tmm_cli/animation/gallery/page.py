"""Gallery page: one HTML file with the cards, their frames as JSON, and a script for search and animation.

The page loads nothing from the network: its content security policy allows only its own style and script. Texts
from problem files are escaped.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from tmm_cli.animation.gallery.card import PURPOSES, Card
from tmm_cli.animation.gallery.moving_picture import STEPS_PER_MM, STEPS_PER_RADIAN
from tmm_cli.animation.page import data_text, fill_page
from tmm_cli.drawing.formats import NOT_XML
from tmm_cli.language import LANGUAGES, _, translated
from tmm_cli.mechanics.structure import ROMAN


def gallery_page(cards: Sequence[Card]) -> str:
    """Return the HTML of the gallery with the cards in the given order."""
    groups = Counter(group for card in cards for group in card.groups)
    numbers = Counter(card.number for card in cards if card.number)
    purposes = Counter(purpose for card in cards for purpose in card.purposes)
    names = dict.fromkeys(fact.name for card in cards for fact in card.facts)
    words = {
        "title": _("Gallery of mechanisms"),
        "words_label": _("search text"),
        "words_hint": _("e.g. press, Whitworth, M15"),
        "number_label": _("class"),
        "group_label": _("group"),
        "purpose_label": _("purpose"),
        "fact_label": _("property"),
        "fact_hint": _("e.g. stroke, or k > 1.4"),
        "any": _("any"),
        "clear": _("clear the search"),
        "stop": _("stop all"),
        "go": _("start all"),
        "speed": _("playback speed"),
        "told": _("mechanisms: {shown} of {all}").format(shown="#", all="#"),
        "none": _("No mechanism matches."),
        "hint": _(
            "Click a picture to stop or start the mechanism, or a tag to find similar mechanisms. Press / to "
            "go to the search field. Properties are compared in the units shown on each card."
        ),
    }
    return fill_page(
        "gallery/",
        **{name: _escape(word) for name, word in words.items()},
        numbers=_options_html({number: number for number in sorted(numbers, key=ROMAN.index)}, numbers),
        groups=_options_html({group: group for group in sorted(groups)}, groups),
        purposes=_options_html({key: translated(words) for key, words in PURPOSES.items() if purposes[key]}, purposes),
        facts="".join(f'<option value="{_escape(name)}">' for name in sorted(names)),
        cards="\n".join(map(_card_html, cards, _display_names([card.file for card in cards]))),
        data=data_text(
            {"place": STEPS_PER_MM, "turn": STEPS_PER_RADIAN, "cards": [_card_data(card) for card in cards]}
        ),
    )


def _card_data(card: Card) -> dict[str, Any]:
    turning = card.turning
    return {
        "number": card.number,
        "groups": card.groups,
        "purposes": card.purposes,
        "facts": [[fact.name, fact.number] for fact in card.facts],
        "bodies": turning.bodies,
        "loops": turning.loops,
        "seconds": turning.seconds,
    }


def _display_names(files: Sequence[str]) -> list[str]:
    """Shorten absolute file paths to the part below their common folder."""
    full = [os.path.dirname(file) for file in files if os.path.isabs(file)]
    try:
        above = os.path.commonpath(full) if full else ""
    except ValueError:  # on several drives of Windows
        return [os.path.basename(file) for file in files]
    return [os.path.relpath(file, above) if os.path.isabs(file) else file for file in files]


def _card_html(card: Card, file: str) -> str:
    tongue = f' lang="{card.language}"' if card.language in LANGUAGES else ""
    tags = [
        *(("number", card.number, _("class {number}").format(number=card.number)) for __ in card.number[:1]),
        *(("group", group, group) for group in card.groups),
        *(("purpose", key, translated(PURPOSES[key])) for key in card.purposes),
    ]
    source = f'<p class="source">{_escape(card.reference)}</p>' if card.reference else ""
    formula = f'<p class="formula">{_escape(card.formula)}</p>' if card.formula else ""
    facts = "".join(f"<tr><td>{_escape(fact.name)}</td><td>{_escape(fact.formatted)}</td></tr>" for fact in card.facts)
    about = f"<p{tongue}>{_escape(card.about)}</p>" if card.about else ""
    return (
        f'<li class="card">{_picture_html(card)}<h2{tongue}>{_escape(card.title)}</h2>{source}'
        f'<div class="tags">{"".join(_tag_html(*tag) for tag in tags)}</div>{formula}<table>{facts}</table>'
        f"<details><summary>{_escape(_('meaning'))}</summary>{about}<p><code>{_escape(file)}</code></p></details>"
        "</li>"
    )


def _picture_html(card: Card) -> str:
    turning = card.turning
    sides = " ".join(f"{round(side, 1):g}" for side in turning.view)
    svg = f'<svg viewBox="{sides}" aria-hidden="true">{turning.svg}</svg>'
    if not turning.bodies:
        name = _("{title}: links and pairs with their degrees of freedom") if "space" in card.purposes else "{title}"
        return f'<div class="picture" role="img" aria-label="{_escape(name.format(title=card.title))}">{svg}</div>'
    name = _("{title}: start or stop the motion")
    label = _escape(name.format(title=card.title))
    return f'<button class="picture" type="button" aria-pressed="true" aria-label="{label}">{svg}</button>'


def _tag_html(field: str, value: str, words: str) -> str:
    return f'<button type="button" data-field="{field}" data-value="{_escape(value)}">{_escape(words)}</button>'


def _options_html(words: Mapping[str, str], counts: Mapping[str, int]) -> str:
    return "".join(
        f'<option value="{_escape(value)}">{_escape(label)} ({counts[value]})</option>'
        for value, label in words.items()
    )


def _escape(text: str) -> str:
    """Escape text for HTML and remove characters that are not allowed there."""
    return escape(text.translate(NOT_XML).encode(errors="replace").decode())
