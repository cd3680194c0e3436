"""Problem files of schemes: the first good pose of each, tried as `tmm run` would, and written whole."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from tmm_cli import solve
from tmm_cli.errors import _
from tmm_cli.problem.build import build
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.reader import read_text
from tmm_cli.results.files import write_whole
from tmm_cli.results.schemes import Written
from tmm_cli.results.warnings import warnings
from tmm_cli.schemes.layout import layouts
from tmm_cli.schemes.schemes import Scheme
from tmm_cli.schemes.skeleton import problem_text

CANDIDATES = 24  # poses that are solved before the best of them is taken
FEW = 6  # the same, of schemes with groups that are not solved in closed form
MOST_FILES = 300  # each takes some tenths of a second


@dataclass(frozen=True)
class Skeleton:
    """A problem file of a scheme. solved: whether it was computed with its forces; else its structure was."""

    text: str
    solved: bool
    warnings: int

    @property
    def badness(self) -> tuple[bool, int]:
        return not self.solved, self.warnings


def skeleton(scheme: Scheme, title: str) -> Skeleton | None:
    """The first good pose, or that with the fewest warnings; None when no pose can be assembled."""
    closed = all(group.type.grade == 2 for group in scheme.groups)
    best: Skeleton | None = None
    for layout in layouts(scheme)[: CANDIDATES if closed else FEW]:
        found = _tried(problem_text(scheme, layout, title), scheme, closed)
        if found is not None and (best is None or found.badness < best.badness):
            best = found
        if best is not None and best.badness == (False, 0):
            break
    return best


def _tried(text: str, scheme: Scheme, closed: bool) -> Skeleton | None:
    """The problem with its forces; of groups that are not closed, whose assembly may not be found, its structure."""
    problem = build(read_text(text, scheme.name))
    try:
        results = solve(problem)
    except ProblemError:
        if closed:
            return None
        solve(problem, "structure")
        return Skeleton(text, False, 0)
    return Skeleton(text, True, sum(1 for __ in warnings(results))) if results.lever_holds else None


def write_skeletons(found: Sequence[Scheme], folder: Path, each: Iterable[Scheme]) -> Written:
    """A problem file a scheme in the folder.

    each: the schemes once more, as a progress bar counts them. Nothing is written before all files are made, and no
    file that is there already with other contents is touched. Raises ProblemError.
    """
    if len(found) > MOST_FILES:
        raise ProblemError(
            "these are too many files", path=("--out",), found=f"{len(found)} schemes",
            allowed=f"at most {MOST_FILES}: fewer links, or fewer types of groups (--groups)",
        )  # fmt: skip
    digits = max(2, len(str(len(found))))
    texts: dict[Path, str] = {}
    written: list[tuple[Path, bool] | None] = []
    for number, scheme in enumerate(each, 1):
        one = skeleton(scheme, _("Scheme {number}, {formula}").format(number=number, formula=scheme.formula))
        path = folder / f"scheme-{number:0{digits}d}-{scheme.name}.yaml"
        written.append(None if one is None else (path, one.solved))
        if one is not None:
            texts[path] = one.text
    for path, text in texts.items():
        if path.exists() and path.read_bytes() != text.encode():
            raise ProblemError(
                "there is another file of that name, perhaps your own work", path=("--out",), found=str(path),
                allowed="another folder",
            )  # fmt: skip
    for path, text in texts.items():
        write_whole(path, text.encode())
    return written
