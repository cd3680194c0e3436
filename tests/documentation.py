"""The pages in problems/docs: `python -m tests.documentation` writes the references and the output that pages show.

In a page a block `yaml` that begins with `# name.yaml` is a file of that name, a block `sh` has commands, and a block
`text` after it shows lines that they print, `...` standing for others. Commands of a page run one after the other in a
folder with its files and the bank. Before a block of commands `<!-- exit code 1 -->` says how its last one ends, and
`<!-- not run -->` that its commands are only parsed.
"""

from __future__ import annotations

import difflib
import os
import re
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import wraps
from importlib import import_module
from keyword import iskeyword
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).parent))  # as pytest does

import numpy as np
import reference_of_commands
import reference_of_format
import reference_of_modules
import reference_of_quantities
from PIL import Image
from reference_of_format import DOCS, PROBLEMS, ROOT
from test_commands import tmm

COMMAND = "python -m tests.documentation"
REFERENCES = {
    "FORMAT.md": reference_of_format.lines,
    "QUANTITIES.md": reference_of_quantities.lines,
    "COMMANDS.md": reference_of_commands.lines,
    "../../tmm_cli/MODULES.md": reference_of_modules.lines,
}
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.M | re.S)
WIDTH = "100"  # of a terminal
COLOURS = 48  # of a picture
TILE, SHADES = 16, 5.0  # pixels; of 255: largest mean difference of a tile of pictures that are the same


@dataclass
class Step:
    """A block of commands: what it shows of their output, how the last one ends, whether they run."""

    commands: list[str]
    runs: bool
    exit_code: int
    shown: tuple[int, int] | None = None  # the block of output after it: from, to in the page
    printed: list[str] = field(default_factory=list)


def pages() -> list[Path]:
    """All pages that are written by hand."""
    return sorted(path for path in DOCS.glob("*.md") if path.name not in REFERENCES)


def files_of(text: str) -> dict[str, str]:
    """The files that a page shows, by their names."""
    found = {}
    for kind, block in BLOCK.findall(text):
        name = re.match(r"# (\S+\.yaml)\n", block)
        if kind == "yaml" and name:
            found[name[1]] = block
    return found


def steps_of(text: str) -> list[Step]:
    """The blocks of commands of a page, in their order."""
    found: list[Step] = []
    end = 0
    for block in BLOCK.finditer(text):
        before = text[end : block.start()]
        if block[1] == "sh":
            code = re.search(r"<!-- exit code (\d) -->\s*\Z", before)
            commands = [line for line in block[2].replace("\\\n", " ").splitlines() if line.strip()]
            found.append(Step(commands, "<!-- not run -->" not in before, int(code[1]) if code else 0))
        elif block[1] == "text" and found and found[-1].shown is None:
            found[-1].shown = block.span(2)
        end = block.end()
    return found


def words_of(command: str) -> list[str]:
    """The words of a command line without its comment."""
    return shlex.split(command, comments=True)


@contextmanager
def folder_of(text: str) -> Iterator[Path]:
    """A folder with the files of a page and the bank."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, content in files_of(text).items():
            (folder / file).write_text(content, encoding="utf-8")
        (folder / "problems").symlink_to(PROBLEMS)
        yield folder


def run(step: Step, folder: Path) -> int:
    """Run the commands of a block, keep what they print; the exit code of the last one."""
    code = 0
    for command in step.commands:
        words = words_of(command)
        if words[0] == "tmm":
            with mock.patch.dict(os.environ, {"COLUMNS": WIDTH}):
                done = tmm(*words[1:], cwd=folder)
            printed, code = done.stdout + done.stderr, int(done.returncode)
        else:
            shell = subprocess.run(command, shell=True, cwd=folder, capture_output=True, encoding="utf-8", check=False)
            printed, code = shell.stdout + shell.stderr, shell.returncode
        step.printed += [line.rstrip() for line in printed.splitlines()]
    return code


def parsed(command: str) -> bool:
    """Whether the program takes the words of this command line; it does nothing."""
    __, name, *rest = words_of(command)
    module = import_module(f"tmm_cli.cli.{name}{'_' if iskeyword(name) else ''}")
    if not hasattr(module, name) and not hasattr(module, f"{name}_"):
        return tmm(name, *rest, "--help").returncode == 0  # a group of commands
    own = name if hasattr(module, name) else f"{name}_"

    @wraps(getattr(module, own))
    def nothing(*__: object, **___: object) -> None:
        pass

    with mock.patch.object(module, own, nothing):
        return tmm(name, *rest).returncode == 0


def parts(lines: list[str]) -> Iterator[list[str]]:
    """Lines between `...`."""
    part: list[str] = []
    for line in lines:
        if line.strip() == "...":
            yield part
            part = []
        else:
            part.append(line.rstrip())
    yield part


def shows(shown: str, printed: list[str]) -> bool:
    """Whether each part that is shown is in what was printed."""
    whole = "\n".join(["", *printed, ""])
    return all("\n".join(["", *part, ""]) in whole for part in parts(shown.splitlines()) if part)


def nearest(part: list[str], printed: list[str]) -> list[str]:
    """As many printed lines as the part has, those most like it."""
    size = min(len(part), len(printed))
    starts = range(len(printed) - size + 1)

    def likeness(start: int) -> float:
        pairs = zip(part, printed[start : start + size], strict=False)
        return sum(difflib.SequenceMatcher(None, one, other, autojunk=False).ratio() for one, other in pairs)

    best = max(starts, key=likeness, default=0)
    return printed[best : best + size]


def pictures_of(text: str) -> list[str]:
    """Pictures of a page that its commands draw: `name/picture.png` from outputs/name."""
    return re.findall(r"!\[[^]]*\]\(([\w-]+/[\w-]+\.png)\)", text)


def small(drawing: Path) -> Image.Image:
    """A drawing at half its size in few colours."""
    with Image.open(drawing) as picture:
        half = picture.convert("RGB").resize((picture.width // 2, picture.height // 2), Image.Resampling.LANCZOS)
        return half.quantize(COLOURS, Image.Quantize.MAXCOVERAGE)


def same_picture(committed: Path, drawing: Path) -> bool:
    """Whether a committed picture shows a drawing: each tile of it, as a word is a small part of a picture.

    Versions of Pillow may differ in shades.
    """
    if not committed.exists():
        return False
    with Image.open(committed) as picture:
        kept, now = (np.asarray(one.convert("L"), dtype=float) for one in (picture, small(drawing)))
    if kept.shape != now.shape:
        return False
    height, width = (side // TILE for side in kept.shape)
    tiles = np.abs(kept - now)[: height * TILE, : width * TILE].reshape(height, TILE, width, TILE)
    return float(np.max(np.mean(tiles, axis=(1, 3)))) < SHADES


def refreshed(text: str) -> str:
    """The page with the output that its commands print today; its pictures are written."""
    done: list[tuple[tuple[int, int], str]] = []
    with folder_of(text) as folder:
        for step in steps_of(text):
            if not step.runs:
                continue
            run(step, folder)
            if step.shown and not shows(text[slice(*step.shown)], step.printed):
                found = [nearest(part, step.printed) for part in parts(text[slice(*step.shown)].splitlines())]
                done.append((step.shown, "\n...\n".join("\n".join(lines) for lines in found).lstrip("\n") + "\n"))
        for picture in pictures_of(text):
            (DOCS / picture).parent.mkdir(exist_ok=True)
            if not same_picture(DOCS / picture, folder / "outputs" / picture):
                small(folder / "outputs" / picture).save(DOCS / picture, optimize=True)
                print(f"{DOCS.relative_to(ROOT)}/{picture}")
    for (start, end), lines in reversed(done):
        text = text[:start] + lines + text[end:]
    return text


def reference(name: str) -> str:
    """A reference page as the program describes itself today."""
    return "".join(REFERENCES[name]()).rstrip() + "\n"


def main(names: list[str]) -> None:
    """Write the pages of these names, or all."""
    for page in pages():
        if not names or page.name in names:
            text = page.read_text(encoding="utf-8")
            if (now := refreshed(text)) != text:
                page.write_text(now, encoding="utf-8")
                print(page.relative_to(ROOT))
    for name in REFERENCES:
        if not names or name in names:
            (DOCS / name).write_text(reference(name), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
