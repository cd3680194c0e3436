"""From the shape of a file with `structure.spatial` to a chain: names are looked up, pairs get their freedoms."""

from __future__ import annotations

from pathlib import PurePath

from pydantic import ValidationError

from tmm_cli.linkage import FRAME
from tmm_cli.problem import schema_chain
from tmm_cli.problem.chain import ChainProblem
from tmm_cli.problem.errors import Path, ProblemError, quote
from tmm_cli.problem.reader import Tree, read_file
from tmm_cli.problem.schema import MAX_LINKS
from tmm_cli.problem.sense import Sense, check_name
from tmm_cli.problem.units import UnitSystem
from tmm_cli.structure.contours import reached
from tmm_cli.structure.spatial import KINDS, Chain, SpatialPair

PART: Path = ("structure", "spatial")


def load_chain(path: str) -> ChainProblem:
    """Read, check and build a file that gives a chain by pairs alone. Raises ProblemError, located in the file."""
    return build_chain(read_file(path))


def build_chain(tree: Tree) -> ChainProblem:
    """A chain from a file that has been read."""
    try:
        shape = schema_chain.SpatialFile.model_validate(tree.data)
    except ValidationError as error:
        from tmm_cli.problem.refusals import shape_error  # only a bad file needs its words

        raise shape_error(error, tree) from None
    name = PurePath(tree.file).stem
    spatial = shape.structure.spatial
    try:
        chain = _chain(spatial)
        return ChainProblem(
            name, shape.title or name, chain, _output(spatial, chain), _local(spatial, chain), spatial.wanted,
            UnitSystem({}), shape.description, tree.file, tree,
        )  # fmt: skip
    except ProblemError as error:
        raise error.located(tree.file, tree) from None


def _chain(spatial: schema_chain.Spatial) -> Chain:
    links = _links(spatial)
    pairs = []
    for name, pair in spatial.pairs.items():
        path: Path = (*PART, "pairs", name)
        check_name(name, path, "pair")
        for number, link in enumerate(pair.between):
            Sense.known(link, dict.fromkeys((FRAME, *links)), (*path, "between", number), "link")
        i, j = pair.between
        if i == j:
            raise ProblemError(
                "a pair joins two different links", path=(*path, "between"), found=f"{quote(i)} twice",
                allowed="[1, 2]",
            )  # fmt: skip
        pairs.append(SpatialPair(name, i, j, _freedoms(pair, path), pair.kind or ""))
    chain = Chain(links, tuple(pairs))
    _one_piece(chain, spatial)
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
                "there are too many links", path=(*PART, "pairs"), found=str(len(named)),
                allowed=f"at most {MAX_LINKS}",
            )  # fmt: skip
        return tuple(named)
    for number, link in enumerate(given):
        path: Path = (*PART, "links", number)
        check_name(link, path, "link")
        if link == FRAME:
            raise ProblemError("0 is the frame", path=path, found="a moving link 0", allowed="another number")
        if link in given[:number]:
            raise ProblemError("this link is named already", path=path, found=quote(link), allowed="another name")
    return tuple(given)


def _freedoms(pair: schema_chain.SpatialPair, path: Path) -> int:
    if pair.kind is not None and pair.freedoms is not None:
        raise ProblemError(
            "the kind says the freedoms already", path=(*path, "freedoms"), found=f"{pair.kind}, {pair.freedoms}",
            allowed="kind or freedoms", key=True,
        )  # fmt: skip
    if pair.kind is not None:
        return KINDS[pair.kind]
    if pair.freedoms is None:
        raise ProblemError("the kind of this pair is missing", path=path, allowed=", ".join(KINDS), key=True)
    return pair.freedoms


def _one_piece(chain: Chain, spatial: schema_chain.Spatial) -> None:
    """Every link hangs on the frame by some way of pairs: otherwise W would count a chain of its own."""
    joined = {link for pair in chain.pairs for link in (pair.i, pair.j)}
    there = reached(chain.pairs)
    for number, link in enumerate(chain.links):
        path: Path = (*PART, "links")
        if isinstance(spatial.links, list):
            path = (*path, number)
        if link not in joined:
            raise ProblemError(
                "this link is joined to nothing", path=path, found=quote(link), allowed="a link that a pair names"
            )
        if link not in there:
            first = next(p for p in chain.pairs if link in (p.i, p.j))
            raise ProblemError(
                "this pair joins links that no way of pairs joins to the frame", path=(*PART, "pairs", first.name),
                found=f"links {', '.join(x for x in chain.links if x not in there)}",
                allowed="a pair of one of them with link 0, or with a link that hangs on it", key=True,
            )  # fmt: skip


def _output(spatial: schema_chain.Spatial, chain: Chain) -> str | None:
    if spatial.output is None:
        return None
    return Sense.known(spatial.output, dict.fromkeys(chain.links), (*PART, "output"), "moving link")


def _local(spatial: schema_chain.Spatial, chain: Chain) -> int | None:
    if not isinstance(spatial.local, dict):
        return spatial.local  # type: ignore[no-any-return]
    for link in spatial.local:
        Sense.known(link, dict.fromkeys(chain.links), (*PART, "local", link), "moving link", key=True)
    return sum(spatial.local.values())
