"""Conversion of a scheme to a problem file with dimensions in whole millimetres, masses and one load."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.language import _
from tmm_cli.synthesis.schemes.layout import SchemeLayout
from tmm_cli.synthesis.schemes.schemes import Scheme


def problem_text(scheme: Scheme, layout: SchemeLayout, title: str) -> str:
    """Return the text of the problem file for a scheme, in the form in which a student would write it."""
    return "\n".join([*_write_head(scheme, title), *_write_links(layout), *_write_driver_and_loads(scheme, layout), ""])


def _write_head(scheme: Scheme, title: str) -> Iterable[str]:
    yield f"# {scheme.formula}; groups: {', '.join(scheme.types)}."
    yield "# " + _("Initial scheme. The mechanism can be assembled with these dimensions; replace them by your own.")
    yield "tmm: 1"
    yield f"title: {title}"
    yield "units: {length: mm, angle: deg}"


def _write_links(layout: SchemeLayout) -> Iterable[str]:
    frame = ", ".join(f"{name}: {_format_vector(place)}" for name, place in layout.points[0].items())
    yield f"points: {{{frame}}}"
    guides = [slide for slide in layout.slides if slide.carrier == 0]
    if guides:
        yield "guides:"
    for slide in guides:
        yield f"  g{slide.runner}: {{through: {_format_vector(slide.through)}, angle: {slide.angle}}}"
    yield "links:"
    for link, points in layout.points.items():
        if link:
            yield f"  {link}: {{{', '.join([*_write_points(link, points, layout), *_write_slides(link, layout)])}}}"


def _write_points(link: int, points: dict[str, complex], layout: SchemeLayout) -> Iterable[str]:
    """Yield the lines of the problem file that define the points of a link.

    These are the names of the points and the length of the link, or, if that does not suffice, the coordinates of the
    points in the axes of the link.
    """
    coordinates = list(points.values())
    if len(points) == 1:
        yield f"points: [{next(iter(points))}]"
    elif len(points) == 2 and coordinates[1].imag == 0 and coordinates[1].real > 0:
        yield f"points: [{', '.join(points)}]"
        yield f"length: {_format_number(coordinates[1].real)}"
    else:
        yield f"points: {{{', '.join(f'{name}: {_format_vector(place)}' for name, place in points.items())}}}"


def _write_slides(link: int, layout: SchemeLayout) -> Iterable[str]:
    for slide in layout.slides:
        if slide.runner == link and slide.carrier == 0:
            yield f"slides: {{on: g{link}, point: {slide.point}}}"
        elif slide.runner == link:
            names = [name for name, place in layout.points[slide.carrier].items() if place == slide.through]
            through = names[0] if names else _format_vector(slide.through)
            yield f"slides: {{on: {slide.carrier}, through: {through}, angle: {slide.angle}, point: {slide.point}}}"


def _write_driver_and_loads(scheme: Scheme, layout: SchemeLayout) -> Iterable[str]:
    first, *others = layout.cranks
    driven = ["{link: 1, speed: 60 rpm, turns: ccw}"]
    driven += [f"{{link: {k}, speed: 60 rpm, turns: ccw, at: {at}}}" for k, at in enumerate(others, 2)]
    yield f"driver: {driven[0]}" if not others else f"driver: [{', '.join(driven)}]"
    sketch = [f"at: {first}", *(f"{name}: {_format_vector(place)}" for name, place in layout.places.items())]
    sketch += [f"{link}: {angle}" for link, angle in layout.angles.items()]
    yield f"sketch: {{{', '.join(sketch)}}}"
    yield "masses:"
    for link, points in layout.points.items():
        if link:
            yield f"  {link}: {{{', '.join(_write_mass(list(points.values())))}}}"
    yield "loads:"
    output, load = _choose_load(scheme, layout)
    yield f"  {load}"
    if output:
        yield f"output: {output}"
    yield "positions: {count: 12, detail: [1]}"


def _write_mass(points: list[complex]) -> Iterable[str]:
    """Yield the lines of the problem file with the mass properties of a slender bar of 1 kg per 100 mm of length."""
    span = max(abs(p - q) for p in points for q in points) / 1000
    mass = max(1.0, round(10 * span, 1))
    yield f"mass: {_format_number(mass)} kg"
    yield f"inertia: {_format_number(max(0.001, round(mass * span * span / 12, 4)))}"
    if len(points) > 1:
        middle = sum(points) / len(points)
        yield f"centre: {_format_vector(complex(round(middle.real), round(middle.imag)))}"


def _choose_load(scheme: Scheme, layout: SchemeLayout) -> tuple[int, str]:
    """Return the output link (0 if there is none) and the line with the load on it.

    The output is a link of the last group that is connected to the frame, preferably a slider.
    """
    guided = {slide.runner: slide.angle for slide in layout.slides if slide.carrier == 0}
    for group in reversed(scheme.groups):
        held = [moving for support, moving, __ in group.outer if support == 0]
        for link in held:
            if link in guided:
                return link, f"F: {{on: {link}, force: {{size: 100 N, angle: {guided[link]}}}}}"
        if held:
            return held[-1], f"M: {{on: {held[-1]}, moment: -10 N*m}}"
    last = scheme.links
    return 0, f"M: {{on: {last}, moment: -10 N*m}}"


def _format_vector(place: complex) -> str:
    return f"[{_format_number(place.real)}, {_format_number(place.imag)}]"


def _format_number(value: float) -> str:
    return f"{value + 0.0:.10g}"
