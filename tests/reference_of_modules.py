"""The page tmm_cli/MODULES.md: every module with what its docstring says and the names that it defines."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from reference_of_format import ROOT

PACKAGE = ROOT / "tmm_cli"


def names_of(tree: ast.Module) -> Iterator[str]:
    """Public classes, functions and constants at the top of a module."""
    for node in tree.body:
        if isinstance(node, ast.ClassDef | ast.FunctionDef):
            yield node.name
        elif isinstance(node, ast.Assign):
            yield from (name.id for target in node.targets for name in ast.walk(target) if isinstance(name, ast.Name))
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            yield node.target.id


def row(path: Path) -> str:
    """A module: its name, its docstring's first paragraph, its names."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    first = " ".join((ast.get_docstring(tree) or "").split("\n\n")[0].split()).replace("|", "\\|")
    names = ", ".join(f"`{name}`" for name in names_of(tree) if not name.startswith("_"))
    return f"| [{path.stem}]({path.relative_to(PACKAGE).as_posix()}) | {first} | {names} |"


def lines() -> Iterator[str]:
    """The lines of the page."""
    yield from (f"{line}\n" for line in _lines())


def _lines() -> Iterator[str]:
    yield "# Modules"
    yield ""
    yield "Every module with what it holds and the public names that it defines; `python -m tests.documentation` writes"
    yield "this page. Where to begin: [README.md](README.md)."
    for folder in sorted({path.parent for path in PACKAGE.rglob("*.py")} - {PACKAGE / "locale"}):
        modules = [path for path in sorted(folder.glob("*.py")) if path.name != "__init__.py"]
        if not modules:
            continue
        about = ast.get_docstring(ast.parse((folder / "__init__.py").read_text(encoding="utf-8"))) or ""
        name = folder.relative_to(ROOT).as_posix()
        yield from ("", f"## {name}", "", about.split("\n\n")[0], "")
        yield from ("| module | what it holds | names |", "| --- | --- | --- |")
        yield from (row(path) for path in modules)
