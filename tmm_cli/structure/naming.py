"""What each link is called, from its pairs and from whether it can turn all the way round or not; the output."""

from __future__ import annotations

from collections.abc import Callable

from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.structure.assur import Group


def roles(linkage: Linkage, turns: Callable[[str], bool]) -> dict[str, str]:
    """The role of each moving link; `turns` tells whether a link turns through 360 degrees, and is asked only then."""
    return {name: _role(linkage, name, turns) for name in linkage.moving}


def _role(linkage: Linkage, name: str, turns: Callable[[str], bool]) -> str:
    special = _higher(linkage, name) or _cylinder(linkage, name)
    if special is not None:
        return special
    slides = [s for s in linkage.slides if name in (s.carrier, s.runner)]
    carries = any(s.carrier == name and s.runner != FRAME for s in slides)
    runs = any(s.runner == name and s.carrier != FRAME for s in slides)
    if linkage.slides_on_frame(name):
        return "slider"
    if linkage.hinged_to_frame(name):
        if carries:
            return "slotted link"
        if runs:
            return "rocking slider"
        return "crank" if turns(name) else "rocker"
    if runs:
        return "stone"
    if carries:
        runner = next(s.runner for s in slides if s.carrier == name)
        return "rod" if linkage.hinged_to_frame(runner) else "slotted link"
    return "coupler"


def _higher(linkage: Linkage, name: str) -> str | None:
    """What a link is called for its teeth or its cam; a wheel is a planet where its axis moves."""
    for mesh in linkage.meshes:
        if mesh.kind == "cam" and name in (mesh.i, mesh.j):
            return "cam" if name == mesh.i else "follower"
        if mesh.kind == "rack" and name == mesh.j:
            return "rack"
        if name == mesh.i or (mesh.kind == "gear" and name == mesh.j):
            return "wheel" if linkage.hinged_to_frame(name) else "planet"
    return "carrier" if any(mesh.carrier == name for mesh in linkage.meshes) else None


def _cylinder(linkage: Linkage, name: str) -> str | None:
    """A cylinder that swings, and the piston that is driven out of it."""
    driven = {d.joint for d in linkage.drivers if d.kind == "slide" and d.base != FRAME}
    for slide in linkage.slides:
        if slide.name in driven and name in (slide.carrier, slide.runner):
            return "cylinder" if name == slide.carrier else "piston"
    return None


def output_link(linkage: Linkage, groups: tuple[Group, ...]) -> str | None:
    """The output: named in the file, or the last link that is joined to the frame and not a driver or its cylinder.

    Where constraints are redundant the groups are not known yet; then the links stand in the order of the file.
    """
    if linkage.output is not None:
        return linkage.output.link
    driving = {link for driver in linkage.drivers for link in (driver.link, driver.base)}
    for links in [group.links for group in reversed(groups)] or [linkage.moving[::-1]]:
        held = [link for link in links if linkage.slides_on_frame(link) or linkage.hinged_to_frame(link)]
        held = [link for link in held if link not in driving] or held
        if held:
            return next((link for link in held if linkage.slides_on_frame(link)), held[0])
    return None
