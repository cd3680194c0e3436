"""group.png and group.svg: the drawing of the group. Imported when it is drawn: matplotlib is slow to load."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tmm_cli.draw.formats import files as pictures
from tmm_cli.grading.exports.book import Gradebook
from tmm_cli.grading.group_chart import chart


def files(book: Gradebook) -> Iterator[tuple[str, Iterable[bytes]]]:
    """One drawing, in every format of drawings."""
    for name, picture in pictures([("group", chart(book.task, book.marks))]):
        yield name, (picture,)
