"""problems/docs/QUANTITIES.md: every quantity that a user can name, and the columns of tables and result.json."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from typing import Any

from reference_of_format import schema, slug
from test_commands import ROOT

from tmm_cli import load, solve
from tmm_cli.language import word_of_files
from tmm_cli.mechanics import quantities as register
from tmm_cli.mechanics.analysis import NamedQuantity, list_quantities, relative_angles, wheel_quantities
from tmm_cli.mechanics.quantities import ANGULAR_JERK, DIMENSIONS, Dimension
from tmm_cli.synthesis import QUANTITIES

HEAD = """# Reference: quantities

The names under which a quantity can be requested. `python -m tests.documentation` writes this page from the program.
In the names below P is a point or a centre of mass (`E`, `S3`), n and m are links (`3`, `5`), w is a wheel of the block
`intermittent`, i its step.

## By name

| name | meaning | symbol | unit | value | `shows` | grading | `sweep --show` |
| --- | --- | --- | --- | --- | --- | --- | --- |
"""
FILES = (  # whose quantities make the list
    "shaper",
    "six-bar",
    "crank-rocker",
    "inclined-slider",
    "v-compressor",
    "excavator",
    "clamp",
    "cam-lever",
    "slotted/intermittent",
    "settings/safety-rod",
    "five-bar",
)
MEANINGS: dict[str, tuple[str, str]] = {  # by the pattern of the name: meaning, symbol
    "W": ("mobility by the count of pairs", "W"),
    "class": ("class of the mechanism: that of its highest Assur group", ""),
    "n": ("number of moving links", "n"),
    "p1": ("number of lower pairs", "p₁"),
    "p2": ("number of higher pairs", "p₂"),
    "passive": ("number of redundant constraints", "q"),
    "H": ("stroke of the output; of one that swings the arc ψ·l of its first point", "H"),
    "psi": ("swing angle of the output link", "ψ"),
    "strokes": ("number of strokes in a cycle", ""),
    "k": ("time ratio: duration of the working stroke over that of the return stroke", "k"),
    "pressure": ("largest pressure angle on the output", "ϑ"),
    "x of P": ("coordinate of a point", "x_P"),
    "y of P": ("coordinate of a point", "y_P"),
    "v of P": ("velocity of a point; a vector", "v_P"),
    "a of P": ("acceleration of a point; a vector", "a_P"),
    "jerk of P": ("jerk of a point, the derivative of its acceleration; a vector", "j_P"),
    "jerk of n": ("angular jerk of a link, the derivative of its angular acceleration", ""),
    "phi of n": ("angle of the x axis of a link", "φ_n"),
    "omega of n": ("angular velocity of a link", "ω_n"),
    "epsilon of n": ("angular acceleration of a link", "ε_n"),
    "s of n": ("displacement of a link that slides on the frame, or angle of one hinged to it", "s_n"),
    "v of n": ("velocity of a link that slides on the frame, along its guide", "v_n"),
    "a of n": ("acceleration of a link that slides on the frame, along its guide", "a_n"),
    "phi of n on m": ("rotation of a link relative to a moving link that it is hinged to", "φ_nm"),
    "v of n on m": ("relative velocity in a prismatic pair", "v_nm"),
    "a of n on m": ("relative acceleration in a prismatic pair", "a_nm, a^r"),
    "Coriolis of n on m": ("Coriolis acceleration in a prismatic pair; a vector", "a^k"),
    "U of n": ("inertia force of a link; a vector", "U_n or Φ_n"),
    "M of n": ("inertia couple of a link", "M_Un or M_Φn"),
    "R_nm": ("reaction of link n on link m; a vector", "R_nm"),
    "R_nm in P": ("the same where two links have several pairs: in the pair of that name", "R_nm"),
    "R_P": ("force of the whole pin of a compound hinge; a vector", "R_P"),
    "arm of R_nm": ("where the force of a guide acts, along the guide from the running point", "h"),
    "M_b": ("balancing moment (required input torque)", "M_b, M_у"),
    "F_b": ("balancing force: at the end of the crank, or along the driven slider", "F_b, P_у"),
    "M_b of n": ("the same, of one of several drivers", "M_b"),
    "F_b of n": ("the same, of one of several drivers", "F_b"),
    "turn of w": ("rotation of a wheel in a cycle", "φ_w"),
    "step i of w": ("rotation of a wheel in the step of one setting", "φ_w"),
    "standing of w": ("share of the travel of the driver in which a wheel is at rest", ""),
    "cycles of w": ("cycles until a wheel has made whole turns", ""),
    "largest omega of w": ("largest angular velocity of a wheel", "ω_w"),
    "largest epsilon of w": ("largest angular acceleration of a wheel", "ε_w"),
    "shock of w": ("jump of angular velocity where a wheel is engaged or released", "Δω_w"),
}
LISTS = (  # lists of the register: heading, where in result.json, table
    ("Points", "kinematics.points, kinematics.centres", "points", register.POINT),
    ("Links", "kinematics.links", "link-motion", register.LINK),
    ("Prismatic pairs", "kinematics.slides", "slides", register.SLIDE),
    ("Reactions", "forces.reactions", "reactions", register.REACTION),
    ("Loads", "forces.loads", "loads", register.LOAD),
    ("Drivers", "forces.drivers", "balance", (*register.BALANCE, register.BALANCING)),
    ("Energy", "energy", "energy", register.ENERGY),
)


def pattern(name: str, quantity: NamedQuantity) -> str:
    """The name with letters for its points, links and wheels."""
    head, of, thing = name.partition(" of ")
    if name.startswith(("R_", "arm of R_")):
        return re.sub(r"R_\S+ in .*", "R_nm in P", name) if " in " in name else _reaction(name, quantity)
    if not of:
        return name
    if quantity.whole:
        return f"{re.sub(r'step [0-9]+', 'step i', head)} of w"
    if " on " in thing:
        return f"{head} of n on m"
    if head in ("v", "a") and not quantity.vector:
        return f"{head} of n"
    if head == "jerk":
        return "jerk of n" if quantity.dimension == ANGULAR_JERK else "jerk of P"
    link = head in ("phi", "omega", "epsilon", "s", "U", "M", "M_b", "F_b")
    return f"{head} of {'n' if link else 'P'}"


def _reaction(name: str, quantity: NamedQuantity) -> str:
    pin = not name.startswith("arm") and not quantity.thing and not re.fullmatch(r"R_\d\d|R_.+,.+", name)
    return "R_P" if pin else re.sub(r"R_\S+", "R_nm", name)


@cache
def named() -> dict[str, tuple[NamedQuantity, set[str]]]:
    """One quantity of every pattern, and where it can be used."""
    found: dict[str, tuple[NamedQuantity, set[str]]] = {}
    for file in FILES:
        results = solve(load(str(ROOT / "problems" / f"{file}.yaml")), "kinematics")
        every = list_quantities(results.linkage, results.structure)
        for name, quantity in every.items():
            uses = {"shows", "grading"} | (set() if name.startswith("arm of ") else {"sweep"})
            found.setdefault(pattern(name, quantity), (quantity, uses))
        for name, quantity in {**wheel_quantities(results.inputs.wheels), **relative_angles(results.linkage)}.items():
            found.setdefault(pattern(name, quantity), (quantity, {"shows"}))
    return found


def unit(dimension: Dimension) -> str:
    """The unit of tables for bare numbers."""
    name = dimension.name
    return DIMENSIONS[name].default or "-" if name else str(dimension)


def name_rows() -> Iterator[str]:
    """The rows of the first table."""
    known = named()
    strange = [name for name in known if name not in MEANINGS]
    assert not strange, f"a meaning in MEANINGS of {__name__}: {strange}"
    for name, (text, symbol) in MEANINGS.items():
        if name == "pressure":
            yield f"| `{name}` | {text} | {symbol} | deg | one | - | - | yes |\n"
            continue
        quantity, uses = known[name]
        value = "one" if quantity.whole else "each position"
        marks = " | ".join("yes" if use in uses else "-" for use in ("shows", "grading", "sweep"))
        yield f"| `{name}` | {text} | {symbol} | {UNITS.get(name) or unit(quantity.dimension)} | {value} | {marks} |\n"


UNITS = {"s of n": "mm or deg"}  # of what slides or swings
GOAL_UNITS = {"moment": "N*m or N", "stroke": "mm or deg", "law": "deg or mm", "speed": "m/s or rad/s"}


def goal_rows() -> Iterator[str]:
    """The quantities of optimal synthesis."""
    for name, goal in QUANTITIES.items():
        dimension = goal.dimension if isinstance(goal.dimension, str) else ""
        keys = ", ".join(f"`{key}`" for key in goal.keys) or "-"
        shown = GOAL_UNITS.get(name) or (DIMENSIONS[dimension].default if dimension in DIMENSIONS else "")
        best = "largest" if goal.lowest else "least"
        yield f"| `{name}` | {goal.text} | {shown or '-'} | {keys} | {best} |\n"


def column_rows(listed: tuple[Any, ...]) -> Iterator[str]:
    """Keys and headings of one list."""
    for quantity in listed:
        heads = ", ".join(f"`{word_of_files(header)}`" for header in quantity.headers) or "-"
        vector = "; a vector [x, y]" if quantity.vector else ""
        yield f"| `{quantity.name}` | {quantity.text or quantity.name}{vector} | {quantity.unit or '-'} | {heads} |\n"


def lines() -> Iterator[str]:
    """The page."""
    yield HEAD
    yield from name_rows()
    format_keys = schema()["else"]["properties"]
    assert "shows" in format_keys and "grading" in format_keys
    yield f"""
- *Value* is "one" where the quantity describes the whole mechanism; such a quantity takes no `at`.
- `shows` also takes `at`, `between`, `over` and `per`: [FORMAT](FORMAT.md#{slug("shows.NAME")}). Of a vector it takes
  the magnitude.
- `sweep --show` writes a name without spaces, `v_E` for `v of E`, and shows the largest magnitude over the cycle, of
  coordinates and angles their range.
- Between links of several digits or letters there is a comma: `R_10,11`.
- Tables and problem files use the units of `units:`; the table above shows the units of bare numbers.

## In optimal synthesis

Objectives and constraints of `synthesis: {{task: optimal}}`. The columns *keys* and *objective* say what may stand
beside `of`, and whether an objective makes the quantity least or largest; with a `target` it comes near to that.
Besides, `of` takes the name of any quantity of a position, except angles: `{{of: a of E, most: 3 m/s^2}}` limits its
largest value in the range of the driver, `over: least` and `over: range` its smallest value and its range.

| `of` | meaning | unit | keys | objective |
| --- | --- | --- | --- | --- |
"""
    yield from goal_rows()
    yield "\n## In tables and result.json\n\nValues of `result.json` are in SI and radians, one for each position.\n"
    for title, place, table, listed in LISTS:
        yield f"\n### {title}\n\nIn `result.json`: `{place}`; table `{table}.csv`.\n\n"
        yield "| key | meaning | unit | columns of the table |\n| --- | --- | --- | --- |\n"
        yield from column_rows(listed)
