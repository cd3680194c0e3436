"""From the shape of a file with `structure.spatial` to a chain: names are looked up, pairs get their freedoms."""

from __future__ import annotations

from tmm_cli.language import _
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.structure import KINDS, SpatialChain, SpatialPair, reached
from tmm_cli.problem import schema as schema_chain
from tmm_cli.problem.build import validated
from tmm_cli.problem.errors import Path, ProblemError, Tree, placed_in
from tmm_cli.problem.record import ChainProblem
from tmm_cli.problem.schema_parts import MAX_LINKS
from tmm_cli.problem.units import UnitSystem
from tmm_cli.problem.values import Part, ValueReader, check_name

PART: Path = ("structure", "spatial")
BARE = ValueReader({}, UnitSystem())


def build_chain(tree: Tree) -> ChainProblem:
    """A chain from a file that has been read. Raises ProblemError, located in the file."""
    shape = validated(schema_chain.SpatialFile, tree)
    name = tree.name
    spatial = shape.structure.spatial
    with placed_in(tree):
        chain = _chain(spatial)
        if spatial.output is not None:
            BARE.known(spatial.output, chain.links, (*PART, "output"), "moving link")
        return ChainProblem(
            name,
            shape.title or name,
            chain,
            spatial.output,
            _local(spatial, chain),
            spatial.wanted,
            BARE.units,
            shape.description,
            shape.reference,
            shape.shows,
            tree,
        )


def _chain(spatial: schema_chain.Spatial) -> SpatialChain:
    links = _links(spatial)
    pairs = []
    for name, pair in spatial.pairs.items():
        part = Part(pair, (*PART, "pairs", name), BARE)
        check_name(name, part.path, "pair")
        i, j = part.two_links((FRAME, *links))
        part.one_of("kind", "freedoms")
        pairs.append(SpatialPair(name, i, j, KINDS[pair.kind] if pair.kind else pair.freedoms or 0, pair.kind or ""))
    chain = SpatialChain(links, tuple(pairs))
    there = reached(chain.pairs)
    if apart := [link for link in links if link not in there]:  # W would count a chain of its own
        message = _("no pairs join link {link} to the frame").format(link=apart[0])
        raise ProblemError(message, path=(*PART, "pairs"), key=True)
    return chain


def _links(spatial: schema_chain.Spatial) -> tuple[str, ...]:
    given = spatial.links
    if isinstance(given, int):
        return tuple(str(number) for number in range(1, given + 1))
    if given is None:
        named = dict.fromkeys(link for pair in spatial.pairs.values() for link in pair.between if link != FRAME)
        for name, pair in spatial.pairs.items():
            for number, link in enumerate(pair.between):
                check_name(link, (*PART, "pairs", name, "between", number), "link")
        if len(named) > MAX_LINKS:
            raise ProblemError(
                _("there are too many links"),
                path=(*PART, "pairs"),
                found=str(len(named)),
                allowed=_("at most {max_links}").format(max_links=MAX_LINKS),
            )
        return tuple(named)
    for number, link in enumerate(given):
        check_name(link, (*PART, "links", number), "link", (FRAME, *given[:number]))
    return tuple(given)


def _local(spatial: schema_chain.Spatial, chain: SpatialChain) -> int | None:
    if not isinstance(spatial.local, dict):
        return spatial.local
    for link in spatial.local:
        BARE.known(link, chain.links, (*PART, "local", link), "moving link", key=True)
    return sum(spatial.local.values())
