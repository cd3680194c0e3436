"""group.png and group.svg: the drawing of the group."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tmm_cli.grading.exports.book import Gradebook


def files(book: Gradebook) -> Iterator[tuple[str, Iterable[bytes]]]:
    """One drawing, in every format of drawings."""
    from tmm_cli.draw.formats import files as pictures  # matplotlib is slow to load
    from tmm_cli.grading.group_chart import chart

    for name, picture in pictures([("group", chart(book.task, book.marks))]):
        yield name, (picture,)
