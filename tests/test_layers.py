"""The layers of the package: imports point downwards, and what computes knows nothing of files and screens.

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
from importlib import import_module
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "tmm_cli"
LAYERS = (  # from below; parts of one layer do not know one another
    ("interfaces",),
    ("language",),
    ("mechanics",),
    ("problem",),
    ("batch",),
    ("synthesis",),
    ("reports",),
    ("drawing",),
    ("note", "animation", "grading", "sweep"),
    ("bench",),
    ("cli", "__main__", "__init__"),
)
MECHANICS = (  # the same within mechanics
    ("numerics",),
    ("linkage", "quantities", "errors"),
    ("structure",),
    ("groups",),
    ("assembly",),
    ("kinematics",),
    ("elements",),
    ("forces",),
    ("plans", "dynamics"),
    ("analysis",),
    ("accuracy",),
)
DRAWING = (("paper",), ("formats",), ("symbols",), ("sheets",), ("layout",), ("run",))
MOST_PAIRS = 90  # of entries at the top of the package, one of which imports the other
FILES_AND_SCREENS = {"yaml", "pydantic", "pydantic_core", "typer", "rich", "matplotlib"}
MAY_IMPORT_SCIPY = {"synthesis", "mechanics.dynamics"}
IMPORT_WHEN_CALLED = {  # what most runs do without, so that they start sooner
    "__init__": "the whole library, when one of its names is asked for",
    "__main__": "the commands: stopping while they load ends without a traceback",
    "language": "gettext, for other languages than English",
    "synthesis.solving": "centres and batches, for those who ask for them",
    "mechanics.analysis.optional_stages": "law of motion, balancing, intermittent motion: for files that ask for it",
    "synthesis.optimal.*": "scipy.optimize and rich.progress, for searches",
    "synthesis.four_bar_by_angles.least_squares": "scipy, for pairs that no four-bar reaches exactly",
    "cli.opening": "grading, for variants of a table",
    "note.formats": "an extra: python-docx",
    "drawing.formats.dxf": "an extra: ezdxf",
    "grading.untrusted_tables": "an extra: python-calamine",
    "reports.spreadsheets": "an extra: xlsxwriter",
}


def modules() -> dict[str, Path]:
    """Modules by their names below the package; a package has the name of its folder."""
    paths = (path for path in PACKAGE.rglob("*.py") if path.parent.name != "locale")  # there is a build hook
    names = {path: ".".join(path.relative_to(PACKAGE).with_suffix("").parts) for path in paths}
    return {name if name == "__init__" else name.removesuffix(".__init__"): path for path, name in names.items()}


MODULES = modules()


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


@cache
def imported(name: str) -> frozenset[str]:
    """What a module imports: modules of the package by their names here, the packages of others with their dots."""
    names: set[str] = set()
    for node in statements(parsed(MODULES[name])):
        for alias in node.names:
            whole = alias.name if isinstance(node, ast.Import) else f"{node.module}.{alias.name}"
            own = whole.removeprefix("tmm_cli.")
            if whole == "tmm_cli":
                names.add("__init__")
            elif own in MODULES or isinstance(node, ast.Import):
                names.add(own)
            else:
                names.add("__init__" if node.module == "tmm_cli" else str(node.module).removeprefix("tmm_cli."))
    return frozenset(names)


def ours() -> dict[str, set[str]]:
    """What each module imports of the package."""
    return {name: {other for other in imported(name) if other in MODULES and other != name} for name in MODULES}


def entry(name: str) -> str:
    """The entry at the top of the package to which a module belongs."""
    return name.partition(".")[0]


def subpackage(name: str) -> str:
    """The subpackage whose interface a module stands behind: an entry at the top, or one of mechanics or drawing."""
    return ".".join(name.split(".")[: 2 if entry(name) in ("mechanics", "drawing") else 1])


@cache
def subpackages() -> set[str]:
    """Those with an interface."""
    return {subpackage(name) for name, path in MODULES.items() if path.with_suffix(".pyi").exists()}


def reached(path: Path, own: str | None) -> Iterator[tuple[str, str]]:
    """Names that a file takes of other subpackages, with the module from which it takes them."""
    for node in ast.walk(parsed(path)):
        if isinstance(node, ast.ImportFrom) and str(node.module).startswith("tmm_cli."):
            module = str(node.module).removeprefix("tmm_cli.")
            if subpackage(module) in subpackages() and subpackage(module) != own:
                yield from ((module, alias.name) for alias in node.names)


def upward(layers: tuple[tuple[str, ...], ...], part: dict[str, str]) -> list[str]:
    """Imports that do not point downwards in these layers; part: of a module, in which of them it is."""
    floor = {name: number for number, names in enumerate(layers) for name in names}
    return [
        f"{name} imports {other}"
        for name, others in ours().items()
        if name in part
        for other in sorted(others)
        if other in part and part[other] != part[name] and floor[part[other]] >= floor[part[name]]
    ]


def test_every_module_stands_in_a_layer():
    assert {entry(name) for name in MODULES} <= {name for layer in LAYERS for name in layer}


def test_imports_point_downwards():
    assert not upward(LAYERS[:-1], {name: entry(name) for name in MODULES if entry(name) not in LAYERS[-1]})
    allowed = {"cli", "__main__", "__init__"}
    assert not [
        name
        for name, others in ours().items()
        if entry(name) not in allowed
        for other in others
        if entry(other) in {"cli", "__main__"}
    ]


def test_within_mechanics_imports_point_downwards_too():
    inside = {name: name.split(".")[1] for name in MODULES if name.startswith("mechanics.")}
    assert {*inside.values()} == {name for layer in MECHANICS for name in layer}
    assert not upward(MECHANICS, inside)


def test_paper_knows_no_mechanism_and_symbols_no_sheets():
    assert not upward(DRAWING, {name: name.split(".")[1] for name in MODULES if name.startswith("drawing.")})


def test_few_entries_know_one_another():
    pairs = {(entry(name), entry(other)) for name, others in ours().items() for other in others}
    assert len({(one, other) for one, other in pairs if one != other}) <= MOST_PAIRS


def test_nobody_reaches_past_an_interface():
    offered = {name: set(import_module(f"tmm_cli.{name}").__all__) for name in subpackages()}
    past = [
        f"{name}: {module}.{thing}"
        for name, path in MODULES.items()
        for module, thing in reached(path, subpackage(name))
        if thing not in offered.get(module, ())
    ]
    assert not past


def test_tests_use_interfaces_too():
    past = [
        f"{path.name}: {module}.{thing}"
        for path in (ROOT / "tests").glob("*.py")
        for module, thing in reached(path, None)
        if module not in subpackages() and f"{module}.{thing}" not in MODULES  # a module, whose parts a test replaces
    ]
    assert not past


def test_what_an_interface_offers_is_there_and_used():
    homes = {path: subpackage(name) for name, path in MODULES.items()}
    used = {pair for path in (*homes, *(ROOT / "tests").glob("*.py")) for pair in reached(path, homes.get(path))}
    for name in subpackages():
        interface = import_module(f"tmm_cli.{name}")
        for thing in interface.__all__:
            assert getattr(interface, thing) is not None
            assert (name, thing) in used, f"{name}.{thing} is used by nobody else"


def test_only_its_keys_and_its_view_know_a_kind_of_load_element():
    """All others iterate over the elements of a linkage: a new kind is three modules and a field of the file."""
    kinds = {name for name in MODULES if name.startswith("mechanics.elements.")} - {"mechanics.elements.element"}
    for kind in kinds:
        block = kind.rpartition(".")[2]
        users = {name for name, others in ours().items() if kind in others}
        assert users == {f"problem.blocks.{block}", f"reports.elements.{block}"}


def test_no_modules_import_one_another_in_a_circle():
    TopologicalSorter(ours()).prepare()  # raises CycleError, which names the circle


def test_what_computes_knows_nothing_of_files_and_screens():
    assert not [
        f"{name} imports {other}"
        for name in MODULES
        if entry(name) == "mechanics" or name.startswith(("batch.trace_", "batch.traced_arrays"))
        for other in imported(name)
        if other.partition(".")[0] in FILES_AND_SCREENS
    ]


def test_imports_stand_at_the_top_except_where_most_runs_do_without():
    late = {
        name
        for name, path in MODULES.items()
        for node in ast.walk(parsed(path))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and any(statements(node))
    }
    unnamed = {name for name in late if not any(fnmatch(name, known) for known in IMPORT_WHEN_CALLED)}
    idle = {known for known in IMPORT_WHEN_CALLED if not any(fnmatch(name, known) for name in late)}
    assert not unnamed and not idle


def test_scipy_is_for_optimisation_and_integration_alone():
    users = {name for name in MODULES if any(other.partition(".")[0] == "scipy" for other in imported(name))}
    assert all(name.startswith(tuple(MAY_IMPORT_SCIPY)) for name in users)


def test_no_module_is_longer_than_five_hundred_lines():
    assert not {name for name, path in MODULES.items() if len(path.read_text(encoding="utf-8").splitlines()) > 500}


def test_without_its_block_nothing_of_dynamics_is_loaded(tmp_path):
    told = (
        "import sys; from tmm_cli.cli.app import main\n"
        f"sys.argv = ['tmm', 'run', 'problems/sine.yaml', '--no-drawings', '-o', {str(tmp_path)!r}]\n"
        "try: main()\nfinally: import tmm_cli.drawing.run, tmm_cli.note.register; print('loaded:', *sorted(\n"
        "    name for name in sys.modules if name.startswith('tmm_cli.mechanics.dynamics.') or name == 'scipy'))"
    )
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run([sys.executable, "-c", told], cwd=ROOT, env=environment, capture_output=True, text=True)
    assert done.stdout.splitlines()[-1] == "loaded:"
