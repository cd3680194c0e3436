"""Starting files for `tmm new`: every *.yaml beside this file is one; its title says what it is."""

from __future__ import annotations

from importlib.resources import files


def templates() -> dict[str, str]:
    """Names of the templates and their titles."""
    found = {}
    for entry in sorted(files(__name__).iterdir(), key=lambda e: e.name):
        if entry.name.endswith(".yaml"):
            titles = [x for x in entry.read_text(encoding="utf-8").splitlines() if x.startswith("title:")]
            found[entry.name.removesuffix(".yaml")] = titles[0].removeprefix("title:").strip()
    return found


def template_text(name: str) -> str:
    """The file, with its comments."""
    return files(__name__).joinpath(f"{name}.yaml").read_text(encoding="utf-8")
