"""The page of a gallery: one HTML file, cards as they stand and frames as JSON, and a script that finds and moves them.

It asks nothing of any network: its policy allows its own style and its own script alone. What comes from files is data.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from tmm_cli.animation.gallery.card import PURPOSES, Card
from tmm_cli.animation.gallery.moving_picture import PLACE, TURN
from tmm_cli.animation.page import data_text, filled
from tmm_cli.drawing.formats import NOT_XML
from tmm_cli.language import LANGUAGES, _, translated
from tmm_cli.mechanics.structure import ROMAN


def gallery_page(cards: Sequence[Card]) -> str:
    """The page of so many mechanisms, in their order."""
    groups = Counter(group for card in cards for group in card.groups)
    numbers = Counter(card.number for card in cards if card.number)
    purposes = Counter(purpose for card in cards for purpose in card.purposes)
    names = dict.fromkeys(fact.name for card in cards for fact in card.facts)
    words = {
        "title": _("Gallery of mechanisms"),
        "words_label": _("text"),
        "words_hint": _("press, Whitworth, M15"),
        "number_label": _("class"),
        "group_label": _("group"),
        "purpose_label": _("purpose"),
        "fact_label": _("property"),
        "fact_hint": _("stroke, or k > 1.4"),
        "any": _("any"),
        "clear": _("clear"),
        "stop": _("stop all"),
        "go": _("turn all"),
        "speed": _("speed"),
        "told": _("{shown} of {all} mechanisms").format(shown="#", all="#"),
        "none": _("No mechanism is like that."),
        "hint": _(
            "Press a picture to stop it or let it turn, a tag to find others like it; / goes to the search. "
            "Numbers of properties are compared in the units of each card."
        ),
    }
    return filled(
        "gallery/",
        **{name: _text(word) for name, word in words.items()},
        numbers=_options({number: number for number in sorted(numbers, key=ROMAN.index)}, numbers),
        groups=_options({group: group for group in sorted(groups)}, groups),
        purposes=_options({key: translated(words) for key, words in PURPOSES.items() if purposes[key]}, purposes),
        facts="".join(f'<option value="{_text(name)}">' for name in sorted(names)),
        cards="\n".join(map(_card, cards, _names_of_files([card.file for card in cards]))),
        data=data_text({"place": PLACE, "turn": TURN, "cards": [_data(card) for card in cards]}),
    )


def _data(card: Card) -> dict[str, Any]:
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


def _names_of_files(files: Sequence[str]) -> list[str]:
    """Names for readers: of what was named by a full path, the part below the folder that all of these have."""
    full = [os.path.dirname(file) for file in files if os.path.isabs(file)]
    try:
        above = os.path.commonpath(full) if full else ""
    except ValueError:  # on several drives of Windows
        return [os.path.basename(file) for file in files]
    return [os.path.relpath(file, above) if os.path.isabs(file) else file for file in files]


def _card(card: Card, file: str) -> str:
    tongue = f' lang="{card.language}"' if card.language in LANGUAGES else ""
    tags = [
        *(("number", card.number, _("class {number}").format(number=card.number)) for __ in card.number[:1]),
        *(("group", group, group) for group in card.groups),
        *(("purpose", key, translated(PURPOSES[key])) for key in card.purposes),
    ]
    source = f'<p class="source">{_text(card.reference)}</p>' if card.reference else ""
    formula = f'<p class="formula">{_text(card.formula)}</p>' if card.formula else ""
    facts = "".join(f"<tr><td>{_text(fact.name)}</td><td>{_text(fact.told)}</td></tr>" for fact in card.facts)
    about = f"<p{tongue}>{_text(card.about)}</p>" if card.about else ""
    return (
        f'<li class="card">{_picture(card)}<h2{tongue}>{_text(card.title)}</h2>{source}'
        f'<div class="tags">{"".join(_tag(*tag) for tag in tags)}</div>{formula}<table>{facts}</table>'
        f"<details><summary>{_text(_('what it is'))}</summary>{about}<p><code>{_text(file)}</code></p></details>"
        "</li>"
    )


def _picture(card: Card) -> str:
    turning = card.turning
    sides = " ".join(f"{round(side, 1):g}" for side in turning.view)
    svg = f'<svg viewBox="{sides}" aria-hidden="true">{turning.svg}</svg>'
    if not turning.bodies:
        name = _("{title}: links, and pairs with their freedoms") if "space" in card.purposes else "{title}"
        return f'<div class="picture" role="img" aria-label="{_text(name.format(title=card.title))}">{svg}</div>'
    name = _("{title}: turn or stop")
    label = _text(name.format(title=card.title))
    return f'<button class="picture" type="button" aria-pressed="true" aria-label="{label}">{svg}</button>'


def _tag(field: str, value: str, words: str) -> str:
    return f'<button type="button" data-field="{field}" data-value="{_text(value)}">{_text(words)}</button>'


def _options(words: Mapping[str, str], counts: Mapping[str, int]) -> str:
    return "".join(
        f'<option value="{_text(value)}">{_text(told)} ({counts[value]})</option>' for value, told in words.items()
    )


def _text(text: str) -> str:
    """As data of the page: no markup, and no signs that a page may not have."""
    return escape(text.translate(NOT_XML).encode(errors="replace").decode())
