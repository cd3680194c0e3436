"""Names of links (crank, rocker, ...), names of basic mechanisms and six-bar chains, and the default output link.

Names follow from the pairs and from which links make full turns. Six-bar chains: R. L. Norton, Design of Machinery, ch.
2. Basic mechanisms: I. I. Artobolevsky, Theory of Mechanisms and Machines, ch. 2.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import combinations, product

import numpy as np

from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.numerics import SAME_POINTS
from tmm_cli.mechanics.structure.assur import Structure
from tmm_cli.mechanics.structure.graph import Contour, find_contours
from tmm_cli.mechanics.structure.group import Group, Pair


def link_roles(linkage: Linkage, turns: Callable[[str], bool]) -> dict[str, str]:
    """Return the role of each moving link, e.g. "crank", "coupler" or "slider".

    turns: function that returns True for a link that makes full turns. It is called only where the role depends on
    that.
    """
    return {name: _link_role(linkage, name, turns) for name in linkage.moving}


def _link_role(linkage: Linkage, name: str, turns: Callable[[str], bool]) -> str:
    special = _higher_pair_role(linkage, name) or _cylinder_role(linkage, name)
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


def _higher_pair_role(linkage: Linkage, name: str) -> str | None:
    """Return the role of a gear, rack, cam, follower or carrier; None for other links.

    A gear whose axis moves is a planet.
    """
    for mesh in linkage.meshes:
        if mesh.kind == "cam" and name in (mesh.i, mesh.j):
            return "cam" if name == mesh.i else "follower"
        if mesh.kind == "rack" and name == mesh.j:
            return "rack"
        if name == mesh.i or (mesh.kind == "gear" and name == mesh.j):
            return "wheel" if linkage.hinged_to_frame(name) else "planet"
    return "carrier" if any(mesh.carrier == name for mesh in linkage.meshes) else None


def _cylinder_role(linkage: Linkage, name: str) -> str | None:
    """Return "cylinder" or "piston" for the links of a driven swinging cylinder; None for other links."""
    driven = {d.joint for d in linkage.drivers if d.kind == "slide" and d.base != FRAME}
    for slide in linkage.slides:
        if slide.name in driven and name in (slide.carrier, slide.runner):
            return "cylinder" if name == slide.carrier else "piston"
    return None


def output_link(linkage: Linkage, groups: tuple[Group, ...]) -> str | None:
    """Return the output link: the one that the file names, otherwise the last undriven link connected to the frame.

    Args:
        linkage: the linkage.
        groups: groups in solving order. If empty (constraints are redundant), links are taken in the order of the file.
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


def link_motion(linkage: Linkage, name: str) -> str:
    """Return the type of motion of a link relative to the frame, as far as its pairs determine it.

    Returns:
        "rotation" if a revolute pair joins the link to the frame; "translation" if prismatic pairs alone connect it to
        the frame, directly or through other links, so that it does not rotate; otherwise "plane motion".
    """
    if linkage.hinged_to_frame(name):
        return "rotation"
    parallel = {FRAME}
    for _repeat in linkage.slides:
        parallel |= {end for s in linkage.slides for end in (s.carrier, s.runner) if parallel & {s.carrier, s.runner}}
    return "translation" if name in parallel else "plane motion"


def is_parallelogram_coupler(linkage: Linkage, name: str) -> bool:
    """Return True if a link is the coupler of a parallelogram or antiparallelogram, judged by lengths.

    Two of its points are hinged to links pivoted on the frame; the arms are equal, and the two points are as far apart
    as the two pivots.
    """
    arms = []
    for hinge in linkage.hinges:
        others = [link for link in hinge.links if link not in (FRAME, name) and linkage.hinged_to_frame(link)]
        if name in hinge.links and others:
            pivot = linkage.shared(FRAME, others[0])
            assert pivot is not None
            arm = linkage.local(others[0], hinge.point) - linkage.local(others[0], pivot)
            arms.append((linkage.local(name, hinge.point), linkage.local(FRAME, pivot), abs(arm)))
    size = max((float(np.max(arm)) for __, __, arm in arms), default=0.0)
    return any(
        bool(np.all(np.abs(arm - other_arm) <= SAME_POINTS * size))
        and bool(np.all(np.abs(np.abs(end - other_end) - np.abs(pivot - other_pivot)) <= SAME_POINTS * size))
        for (end, pivot, arm), (other_end, other_pivot, other_arm) in combinations(arms, 2)
    )


def four_link_scheme(kinds: str) -> str | None:
    """Return the name of a basic four-link mechanism (e.g. "crank-slider"), whichever link is the driver.

    Args:
        kinds: kinds of its pairs in order round the contour, e.g. RRRP; the first and the last are those on the frame.

    Returns:
        The name; None if such a contour has no name.
    """
    schemes = {
        "RRRR": "hinged four-bar",
        "RRRP": "crank-slider",
        "RRPR": "slotted-lever",
        "RRPP": "sine",
        "RPRP": "tangent",
        "RPPR": "double slotted-link",
        "PRRP": "double-slider",
    }
    return schemes.get(kinds) or schemes.get(kinds[::-1])


def contour_scheme(contour: Contour, structure: Structure) -> str | None:
    """Return the name of the basic mechanism that a four-link contour with the frame forms; None for other contours."""
    if len(contour.links) != 4 or contour.links[0] != FRAME:
        return None
    kind = {pair.name: pair.kind for pair in structure.pairs}
    return four_link_scheme("".join(kind[name] for name in contour.pairs))


def basic_schemes(structure: Structure) -> dict[str, str]:
    """Return the names of the basic mechanisms formed by four-link contours with the frame, by title of the contour.

    For example {"0-1-2-3-0": "crank-slider"}.
    """
    named = (
        (contour.title, contour_scheme(contour, structure))
        for contour in find_contours(structure.pairs, structure.links)
    )
    return {title: scheme for title, scheme in named if scheme}


def six_bar_schemes(structure: Structure) -> tuple[str, ...]:
    """Return the possible names of a six-link mechanism with seven lower pairs: Watt I, II or Stephenson I, II, III.

    A compound hinge of three links can be drawn as two hinges in three ways, which may give different names; all of
    them are returned. Empty for any other mechanism, and for one with redundant links or pairs.
    """
    if len(structure.links) != 5 or len(structure.pairs) != 7 or structure.higher or structure.reduction:
        return ()
    names = (_six_bar_name(pairs) for pairs in _attachments(structure.pairs))
    return tuple(sorted({name for name in names if name}))


def _attachments(pairs: Sequence[Pair]) -> Iterator[tuple[tuple[str, str], ...]]:
    """Yield, for every choice of the common link of each compound hinge, the names of the two links of all pairs."""
    by_place: dict[str, list[tuple[str, str]]] = {}
    for pair in pairs:
        by_place.setdefault(pair.point if pair.kind == "R" else f"slide {pair.name}", []).append((pair.i, pair.j))
    choices = []
    for ends in by_place.values():
        links = tuple(dict.fromkeys(link for pair in ends for link in pair))
        stars = [tuple((centre, link) for link in links if link != centre) for centre in links]
        choices.append(stars if len(ends) > 1 else [tuple(ends)])
    for chosen in product(*choices):
        yield tuple(pair for star in chosen for pair in star)


def _six_bar_name(pairs: tuple[tuple[str, str], ...]) -> str | None:
    """Return the name of a six-link chain with two ternary links, e.g. Watt I; None for any other chain.

    pairs: names of the two links of each pair.
    """
    degree = {link: sum(link in pair for pair in pairs) for pair in pairs for link in pair}
    ternary = {link for link in degree if degree[link] == 3}
    if sorted(degree.values()) != [2, 2, 2, 2, 3, 3]:
        return None
    if any(set(pair) == ternary for pair in pairs):
        return "Watt II" if FRAME in ternary else "Watt I"
    if FRAME in ternary:
        return "Stephenson III"
    between = {link for pair in pairs if FRAME in pair for link in pair if link != FRAME}
    return "Stephenson I" if between == ternary else "Stephenson II"
