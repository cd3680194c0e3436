"""The table of mechanisms in problems/docs/bank.md: `python -m tests.mechanisms` writes it and its schemes.

A row is a file of the bank with a `reference` (M7, Fig. 7); its formula, class and properties are those of its golden
run, which `tmm check problems` holds. What a row of the list still lacks is said in LACKING.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

from tmm_cli import load, solve
from tmm_cli.drawing.formats import write_svg
from tmm_cli.drawing.run import all_sheets

PROBLEMS = Path(__file__).parents[1] / "problems"
ROWS = 33
LACKING: dict[int, str] = {
    14: "structure only: its links move in space",
    18: "what holds the flange while it stands, the other slide in its slot, is in no contact in the calculation",
    19: "the shafts of Fig. 22 cross at 45 degrees, so its links move in space; crossed-slots has parallel "
    "shafts; crossed-slots-45 counts pairs only, and does not show that the mechanism moves or what its ratio is",
    20: "Fig. 26 sets by wedges what Fig. 25 sets by a sleeve",
    21: "Fig. 30 also tilts the guide out of the plane of the mechanism, which a planar calculation does not see; the "
    "text of Fig. 31b names no stop, its file takes one; of Fig. 34 the control cylinder is left out",
    22: "the bevel gears that carry the rotation on to the part, and the springs that let it begin later, are motions "
    "in space and of clearances",
    26: "ratchet-feed takes both places of its pin as given; ratchet-return is what moves it while the shaft stands",
    31: "structure only: its links move in space",
}
PAGE = PROBLEMS / "docs" / "bank.md"
BEGIN, END = "<!-- mechanisms: python -m tests.mechanisms -->\n", "<!-- end of mechanisms -->\n"
SCHEMES = PROBLEMS / "schemes"
SHOWN = {"m": (1e3, "mm"), "rad": (180 / math.pi, "deg")}  # by SI unit: factor and unit of the table
COUNTED = {"W", "Wm", "q", "m", "p1", "passive"}  # found by `tmm structure`


def files() -> list[Path]:
    """All problems of the bank."""
    return sorted([*PROBLEMS.glob("*.yaml"), *PROBLEMS.glob("*/*.yaml")])


def read(file: Path) -> dict[str, Any]:
    """The file as plain YAML: enough for texts."""
    found: dict[str, Any] = yaml.safe_load(file.read_text(encoding="utf-8"))
    return found


def referred() -> dict[Path, dict[str, Any]]:
    """Files with a reference, in the order of the list."""
    found = {file: read(file) for file in files()}
    chosen = {file: data for file, data in found.items() if "reference" in data}
    return dict(sorted(chosen.items(), key=lambda item: (number(item[1]), item[1]["reference"], item[0].stem)))


def number(data: dict[str, Any]) -> int:
    """Of its row in the list."""
    found = re.match(r"M(\d+)", data["reference"])
    assert found, data["reference"]
    return int(found[1])


def golden(file: Path) -> dict[str, Any]:
    """Its golden run."""
    text = (file.parent / "expected" / f"{file.stem}.json").read_text(encoding="utf-8")
    found: dict[str, Any] = json.loads(text)["result"]
    return found


def scheme(file: Path) -> Path:
    """Where its scheme is drawn."""
    return SCHEMES / f"{file.stem}.svg"


def lines() -> Iterator[str]:
    """The table, line by line."""
    yield "| | mechanism | scheme | structure | class | property | value | command |\n"
    yield "| --- | --- | --- | --- | --- | --- | --- | --- |\n"
    for file, data in referred().items():
        run, path = golden(file), file.relative_to(PROBLEMS).as_posix()
        planar = "structure" in run
        formula = run["structure"]["formula"] if planar else f"W = {run['chain']['mobility']} in space"
        link = f"[drawn](../schemes/{file.stem}.svg)" if planar else ""
        found = run["properties"]
        counted = all(one["of"] in COUNTED for one in data["shows"].values())
        cells = (
            data["reference"],
            f"[{data['title']}](../{path})",
            link,
            formula,
            run["structure"]["class"] if planar else "",
            "<br>".join(one["property"] for one in found),
            "<br>".join(map(value, found)),
            f"`tmm {'structure' if counted else 'kinematics' if moved(run) else 'forces'} problems/{path}`",
        )
        yield f"| {' | '.join(cells)} |\n"
    yield "\n"
    for row, why in LACKING.items():
        yield f"M{row}: {why}.\n\n"


def moved(run: dict[str, Any]) -> bool:
    """Whether kinematics is enough for all that is shown."""
    return not any(one["unit"] in ("N", "N*m", "kg*m*s^-2") for one in run["properties"])


def value(found: dict[str, Any]) -> str:
    """A property in the units of the table."""
    factor, unit = SHOWN.get(found["unit"], (1.0, found["unit"]))
    size = found["value"] * factor
    return f"{0.0 if abs(size) < 1e-9 else size:.6g} {unit}".strip()


def written() -> str:
    """The page with the table anew."""
    page = PAGE.read_text(encoding="utf-8")
    before, after = page.split(BEGIN)[0], page.split(END)[1]
    return f"{before}{BEGIN}\n{''.join(lines())}{END}{after}"


def drawn(file: Path) -> bytes | None:
    """The scheme of a file with dimensions."""
    if "structure" in read(file):
        return None
    return write_svg(dict(all_sheets(solve(load(str(file)), "structure")))["structure"])


def main() -> None:
    """Write the schemes and the table."""
    SCHEMES.mkdir(exist_ok=True)
    for file in referred():
        picture = drawn(file)
        if picture is not None:
            scheme(file).write_bytes(picture)
    PAGE.write_text(written(), encoding="utf-8")


if __name__ == "__main__":
    main()
