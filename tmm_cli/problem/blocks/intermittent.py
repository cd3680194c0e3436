"""The block `intermittent` of a problem file."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from tmm_cli.language import _
from tmm_cli.mechanics.analysis import Setting, WheelTask
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.problem import schema
from tmm_cli.problem.blocks import keys_on_request as shapes
from tmm_cli.problem.errors import Path, ProblemError, nearest, quote
from tmm_cli.problem.values import Part, ValueReader, check_name

Other = Callable[[Mapping[str, object]], Linkage]  # the linkage with other values of parameters


def build_wheels(shape: schema.File, linkage: Linkage, values: ValueReader, other: Other) -> tuple[WheelTask, ...]:
    """What is asked of each wheel."""
    return tuple(_wheel(name, given, shape, linkage, values, other) for name, given in shape.intermittent.items())


def _wheel(
    name: str, given: shapes.Wheel, shape: schema.File, linkage: Linkage, values: ValueReader, other: Other
) -> WheelTask:
    part = Part(given, ("intermittent", name), values)
    check_name(name, part.path, "link", linkage.links)
    link = part.known("moves_with", linkage.moving, "moving link")
    turning = [own for own in linkage.moving if linkage.hinged_to_frame(own)]
    if link not in turning:
        raise part.refusal(
            "moves_with", _("a wheel moves with a link that turns on the frame"), quote(link), ", ".join(turning)
        )
    settings = [
        _setting(own, (*part.path, "settings", k), shape.parameters, other) for k, own in enumerate(given.settings)
    ]
    return WheelTask(name, link, given.when, tuple(settings))


def _setting(given: Mapping[str, object], path: Path, known: Mapping[str, object], other: Other) -> Setting:
    for name in given:
        if name not in known:
            raise ProblemError(
                _("there is no parameter of that name"),
                path=(*path, name),
                found=quote(name),
                key=True,
                allowed=", ".join(known) or _("none: the file has no parameters"),
                near=nearest(name, known),
            )
    if not given:
        return Setting()
    try:
        return Setting({name: str(value) for name, value in given.items()}, other(given))
    except ProblemError as error:  # somewhere in the file, but it is this setting that does not fit there
        own = [name for name in given if error.path == ("parameters", name)]
        path = (*path, *own)
        raise ProblemError(error.message, path=path, found=error.found, allowed=error.allowed) from None
