"""The house: which folder may know which. Imports run one way, and what computes knows nothing of files and screens.

Imports under TYPE_CHECKING are apart: a type may be named from below, as nothing runs through it.
"""

import ast
import os
import subprocess
import sys
from collections.abc import Iterator
from fnmatch import fnmatch
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

ROOT = Path(__file__).parents[1]
TOP = {
    "__init__",
    "__main__",
    "library",
    "linkage",
    "interpolation",
    "vectors",
    "roots",
    "errors",
    "language",
    "tolerances",
    "quantities",
}
NUMERIC = (  # from below; folders of one floor may know one another
    ("structure",), ("pairs", "groups"), ("assembly",), ("kinematics",), ("forces", "plans"), ("dynamics",),
    ("analysis",), ("tape", "variants"), ("schemes", "synthesis"), ("accuracy",),
)  # fmt: skip
FLOORS = (
    ("top", "double_double", "words"), *NUMERIC, ("results",), ("door",),
    ("draw", "animate", "note", "grading", "sweep", "bench"), ("cli",),
)  # fmt: skip
FLOOR = {folder: number for number, folders in enumerate(FLOORS) for folder in folders}
# what turns a problem with a task into one with lengths, and what shows a problem
KNOW_PROBLEMS = ("results", "door", "draw", "animate", "note", "grading", "sweep", "bench", "cli")
READS_A_TASK = (
    "synthesis.reading",
    "synthesis.blocks",
    "synthesis.bounded",
    "synthesis.refusals",
    "synthesis.*.block*",
)
PROBLEM_LEANS_ON = (  # names of pairs, and what stands among the numbers of a file: a cam's law, motors, flywheels
    "structure", "pairs.cam_law", "dynamics.task", "dynamics.balancing_task", "dynamics.motors", "dynamics.sizes",
    "kinematics.intermittent_task",
)  # fmt: skip
FILES_AND_SCREENS = {"yaml", "pydantic", "pydantic_core", "typer", "rich", "matplotlib"}
MAY_IMPORT_SCIPY = {"synthesis", "dynamics"}
IMPORT_WHEN_CALLED = {  # what most runs do without, so that they start sooner
    "door": "the whole library, when one of its names is asked for",
    "__main__": "the commands: stopping while they load ends without a traceback",
    "language": "gettext, for other languages than English",
    "library": "synthesis, for files with a task; centres, for files that ask for them",
    "analysis.on_request": "the law of motion, balancing and intermittent motion, for files that ask for it",
    "synthesis.optimal.*": "scipy.optimize and rich.progress, for searches",
    "cli.opening": "grading, for variants of a table",
    "note.formats": "an extra: python-docx",
    "draw.formats.dxf": "an extra: ezdxf",
    "grading.cells": "an extra: python-calamine",
    "results.workbook": "an extra: xlsxwriter",
}


def modules() -> dict[str, Path]:
    """Files of the package by their dotted names; a folder's own file has the name of the folder."""
    files = {path: ".".join(path.relative_to(ROOT / "tmm_cli").with_suffix("").parts)
             for path in (ROOT / "tmm_cli").rglob("*.py")}  # fmt: skip
    return {("door" if name == "__init__" else name.removesuffix(".__init__")): path for path, name in files.items()}


def folder(name: str) -> str:
    """The folder of a file, `top` for those beside the folders."""
    own = {"__main__": "cli", "library": "door"}
    if name in own:
        return own[name]
    return name.partition(".")[0] if name == "door" or MODULES[name].parent != ROOT / "tmm_cli" else "top"


def statements(tree: ast.AST) -> Iterator[ast.Import | ast.ImportFrom]:
    """Imports, inside functions too, without those that are for types alone."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            continue
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield node
        else:
            yield from statements(node)


@cache
def parsed(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


def imported(path: Path) -> set[str]:
    """Names of what a file imports: our own files as in `modules`, the packages of others with their dots."""
    found = set()
    for node in statements(parsed(path)):
        names = [alias.name for alias in node.names]
        if isinstance(node, ast.ImportFrom):
            inside = [f"{node.module}.{name}" for name in names]
            names = [name if name.removeprefix("tmm_cli.") in MODULES else str(node.module) for name in inside]
        found |= {"door" if name == "tmm_cli" else name.removeprefix("tmm_cli.") for name in names}
    return found


MODULES = modules()


@cache
def imports() -> dict[str, set[str]]:
    """What each file imports."""
    return {name: imported(path) for name, path in MODULES.items()}


def ours() -> dict[str, set[str]]:
    """What each file imports of the package."""
    return {name: {other for other in others if other in MODULES} for name, others in imports().items()}


def allowed(name: str, other: str) -> bool:
    """Whether a file may import another of the package."""
    own, its = folder(name), folder(other)
    if its == "problem":
        return own == "problem" or own in KNOW_PROBLEMS or any(fnmatch(name, reader) for reader in READS_A_TASK)
    if own == "problem":
        return its in FLOORS[0] or other.startswith(PROBLEM_LEANS_ON)
    return own == its or FLOOR[its] <= FLOOR[own]


def test_every_folder_has_a_floor():
    assert {folder(name) for name in MODULES} <= {*FLOOR, "problem"}


def test_only_what_everything_leans_on_stands_beside_the_folders():
    assert {path.stem for path in (ROOT / "tmm_cli").glob("*.py")} <= TOP


def test_imports_run_one_way():
    upward = [
        f"{name} imports {other}" for name, others in ours().items() for other in sorted(others)
        if not allowed(name, other)
    ]  # fmt: skip
    assert not upward


def test_no_files_import_one_another_in_a_circle():
    TopologicalSorter(ours()).prepare()  # raises CycleError, which names the circle


def test_what_computes_knows_nothing_of_files_and_screens():
    numeric = {one for floor in NUMERIC for one in floor} | {"top"}
    talking = [
        f"{name} imports {other}" for name in MODULES if folder(name) in numeric for other in imports()[name]
        if other.partition(".")[0] in FILES_AND_SCREENS and not any(fnmatch(name, r) for r in READS_A_TASK)
    ]  # fmt: skip
    assert not talking


def test_imports_stand_at_the_top_except_where_most_runs_do_without():
    late = {
        name for name, path in MODULES.items() for node in ast.walk(parsed(path))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and any(statements(node))
    }  # fmt: skip
    unnamed = {name for name in late if not any(fnmatch(name, known) for known in IMPORT_WHEN_CALLED)}
    idle = {known for known in IMPORT_WHEN_CALLED if not any(fnmatch(name, known) for name in late)}
    assert not unnamed and not idle


def test_scipy_is_for_optimisation_and_integration_alone():
    users = {folder(name) for name in MODULES if any(other.partition(".")[0] == "scipy" for other in imports()[name])}
    assert users <= MAY_IMPORT_SCIPY


def test_without_its_block_nothing_of_dynamics_is_loaded(tmp_path):
    told = (
        "import sys; from tmm_cli.cli.app import main\n"
        f"sys.argv = ['tmm', 'run', 'problems/sine.yaml', '--no-drawings', '-o', {str(tmp_path)!r}]\n"
        "try: main()\nfinally: import tmm_cli.draw, tmm_cli.note; print('loaded:', *sorted(\n"
        "    name for name in sys.modules if name.startswith('tmm_cli.dynamics') or name == 'scipy'))"
    )
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run([sys.executable, "-c", told], cwd=ROOT, env=environment, capture_output=True, text=True)
    assert done.stdout.splitlines()[-1] == "loaded:"


def test_paper_knows_no_mechanism_and_symbols_no_sheets():
    rooms = ("draw.paper", "draw.formats", "draw.symbols", "draw.sheets", "draw.layout")

    def floor(name):
        return next((number for number, room in enumerate(rooms) if name.startswith(room)), -1)

    drawn = {name: others for name, others in ours().items() if floor(name) >= 0}
    assert not {(name, other) for name, others in drawn.items() for other in others if floor(other) > floor(name)}
