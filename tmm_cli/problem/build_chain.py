"""From the shape of a file with `structure.spatial` to a chain: names are looked up, pairs get their freedoms."""

from __future__ import annotations

from pathlib import PurePath

from tmm_cli.errors import _
from tmm_cli.linkage import FRAME
from tmm_cli.problem import schema_chain
from tmm_cli.problem.build import validated
from tmm_cli.problem.errors import ProblemError, placed_in
from tmm_cli.problem.reader import read_file
from tmm_cli.problem.record import ChainProblem
from tmm_cli.problem.schema_parts import MAX_LINKS
from tmm_cli.problem.tree import Path, Tree
from tmm_cli.problem.units import UnitSystem
from tmm_cli.problem.values import ValueReader, check_name
from tmm_cli.structure.contours import reached
from tmm_cli.structure.spatial import KINDS, SpatialChain, SpatialPair

PART: Path = ("structure", "spatial")


def load_chain(path: str) -> ChainProblem:
    """Read, check and build a file that gives a chain by pairs alone. Raises ProblemError, located in the file."""
    return build_chain(read_file(path))


def build_chain(tree: Tree) -> ChainProblem:
    """A chain from a file that has been read."""
    shape = validated(schema_chain.SpatialFile, tree)
    name = PurePath(tree.file).stem
    spatial = shape.structure.spatial
    with placed_in(tree):
        chain = _chain(spatial)
        return ChainProblem(
            name, shape.title or name, chain, _output(spatial, chain), _local(spatial, chain), spatial.wanted,
            UnitSystem({}), shape.description,
        )  # fmt: skip


def _chain(spatial: schema_chain.Spatial) -> SpatialChain:
    links = _links(spatial)
    pairs = []
    for name, pair in spatial.pairs.items():
        path: Path = (*PART, "pairs", name)
        check_name(name, path, "pair")
        for number, link in enumerate(pair.between):
            ValueReader.known(link, dict.fromkeys((FRAME, *links)), (*path, "between", number), "link")
        ValueReader.different(pair.between, (*path, "between"))
        i, j = pair.between
        pairs.append(SpatialPair(name, i, j, _freedoms(pair, path), pair.kind or ""))
    chain = SpatialChain(links, tuple(pairs))
    _one_piece(chain)
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
                _("there are too many links"), path=(*PART, "pairs"), found=str(len(named)),
                allowed=_("at most {max_links}").format(max_links=MAX_LINKS),
            )  # fmt: skip
        return tuple(named)
    for number, link in enumerate(given):
        check_name(link, (*PART, "links", number), "link", (FRAME, *given[:number]))
    return tuple(given)


def _freedoms(pair: schema_chain.SpatialPair, path: Path) -> int:
    ValueReader.one_of(pair, ("kind", "freedoms"), path)
    return KINDS[pair.kind] if pair.kind is not None else pair.freedoms or 0


def _one_piece(chain: SpatialChain) -> None:
    """Every link hangs on the frame by some way of pairs: otherwise W would count a chain of its own."""
    there = reached(chain.pairs)
    for link in chain.links:
        if link not in there:
            raise ProblemError(
                _("no pairs join link {link} to the frame").format(link=link), path=(*PART, "pairs"), key=True
            )


def _output(spatial: schema_chain.Spatial, chain: SpatialChain) -> str | None:
    if spatial.output is None:
        return None
    return ValueReader.known(spatial.output, dict.fromkeys(chain.links), (*PART, "output"), "moving link")


def _local(spatial: schema_chain.Spatial, chain: SpatialChain) -> int | None:
    if not isinstance(spatial.local, dict):
        return spatial.local
    for link in spatial.local:
        ValueReader.known(link, dict.fromkeys(chain.links), (*PART, "local", link), "moving link", key=True)
    return sum(spatial.local.values())
