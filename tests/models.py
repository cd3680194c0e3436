"""Problem files made from the data of published cases and 50-digit references, so that tests go the user's way."""

from __future__ import annotations

import cmath
import json
from functools import cache
from pathlib import Path
from typing import Any, Literal

from tmm_cli import load, solve
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.problem import build_problem, read_text

DATA = Path(__file__).parent / "data"
PROBLEMS = Path(__file__).parent.parent / "problems"
PARALLELOGRAM = """tmm: 1
points: {O: [0, 0], D: [300, 0]}
links:
  1: {points: [O, A], length: 100}
  2: {points: [A, B], length: 300}
  3: {points: [D, B], length: 100}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 60 deg, B: [350, 86]}
masses: {2: {mass: 3 kg, inertia: 0.1, centre: {on: AB}}}
positions: {count: 12, detail: [0, 1]}
"""
CLASS_III = """tmm: 1
points: {O: [0, 0], D: [300, 0], G: [200, 300]}
links:
  1: {points: [O, A], length: 60}
  2: {points: {A: [0, 0], B: [200, 0], E: [100, 120]}}
  3: {points: [D, B], length: 150}
  4: {points: [E, F], length: 120}
  5: {points: [G, F], length: 90}
driver: {link: 5, speed: 1 rad/s}
"""
SI = {"length": "m", "angle": "rad", "mass": "kg", "force": "N", "moment": "N*m", "inertia": "kg*m^2"}


def results_of(content: dict[str, Any], stage: str = "forces", positions: list[int] | None = None) -> Results:
    """Write a problem file and solve it."""
    text = json.dumps(content, ensure_ascii=False)  # JSON is YAML
    return solve(build_problem(read_text(text, "case.yaml")), stage, positions)  # type: ignore[arg-type]


@cache
def solved_text(text: str, stage: Literal["kinematics", "forces"] = "forces") -> Results:
    """The results of a problem file as a student writes it, solved once."""
    return solve(build_problem(read_text(text, "x.yaml")), stage)


def file_of(name: str) -> Path:
    """A problem of the bank by its name, or a linkage that only tests use (tests/data/linkages)."""
    return next(path for folder in (PROBLEMS, DATA / "linkages") if (path := folder / f"{name}.yaml").exists())


def linkage_of(name: str) -> Linkage:
    """The linkage of a problem of the bank."""
    return load(file_of(name)).linkage


def reference(name: str) -> dict[str, Any]:
    """A reference linkage: model and 50-digit answers (tests/data/reference, from an independent method)."""
    found: dict[str, Any] = json.loads((DATA / "reference" / f"{name}.json").read_text(encoding="utf-8"))
    return found


def reference_problem(data: dict[str, Any]) -> dict[str, Any]:
    """A reference model as a problem file in SI."""
    model = data["model"]
    driver = model["driver"]
    if driver["type"] == "P":
        joint = next(j for j in model["joints"] if j["name"] == driver["joint"])
        drive, at = {"link": joint["j"], "on": joint["i"], "speed": driver["v"]}, driver["s0"]
    else:
        sense = "ccw" if driver["omega"] > 0 else "cw"
        drive, at = {"link": driver["body"], "speed": abs(driver["omega"]), "turns": sense}, driver["theta0"]
    problem: dict[str, Any] = {
        "tmm": 1,
        "units": SI,
        "points": model["ground"],
        "guides": {},
        "links": {},
        "masses": {},
        "loads": {},
        "gravity": model["gravity"],
        "driver": drive,
        "sketch": {"at": at, **sketched_points(model), **{n: guess[2] for n, guess in model["guess"].items()}},
        "positions": {"at": [float(row["input"]) for row in data["reference"]]},
    }
    for name, body in model["bodies"].items():
        problem["links"][name] = {"points": body["points"]}
        problem["masses"][name] = {"mass": body["m"], "inertia": body["J"], "centre": body["S"]}
    for joint in (j for j in model["joints"] if j["type"] == "P"):
        slide = {"point": joint["pj"], "turned": joint["rel"]}
        if joint["i"] == "0":
            problem["guides"][joint["name"]] = {"through": joint["pi"], "angle": joint["dir"]}
            slide["on"] = joint["name"]
        else:
            slide |= {"on": joint["i"], "through": joint["pi"], "angle": joint["dir"]}
        problem["links"][joint["j"]].setdefault("slides", []).append(slide)
    for number, force in enumerate(model["forces"]):
        load = {"on": force["body"]}
        if "F" in force:
            load |= {"force": force["F"], "at": force.get("point", [0, 0])}
        if "M" in force:
            load["moment"] = force["M"]
        problem["loads"][f"F{number}"] = load
    return problem


def sketched_points(model: dict[str, Any]) -> dict[str, list[float]]:
    """Where the model's first guess puts every named point."""
    points = {}
    for name, body in model["bodies"].items():
        x, y, angle = model["guess"][name]
        for point, (px, py) in body["points"].items():
            place = complex(x, y) + complex(px, py) * cmath.exp(1j * angle)
            if point not in model["ground"]:
                points[point] = [place.real, place.imag]
    return points


def published(name: str) -> dict[str, Any]:
    """A published case (tests/data/published.json)."""
    found: dict[str, Any] = json.loads((DATA / "published.json").read_text(encoding="utf-8"))[name]
    return found


def published_problem(case: dict[str, Any], samples: list[dict[str, Any]], gravity: float = 0.0) -> dict[str, Any]:
    """A published case as a problem file: axes of every link are those of the drawing in the initial pose.

    Link axes therefore have the angle 0 there, and the crank's angle is the turn from the initial pose.
    """
    joints, tracers = case["joints"], case["tracers"]
    sense = samples[0]["sense"]
    links: dict[str, Any] = {}
    for joint, data in joints.items():
        for link in data["links"]:
            if link != "ground":
                links.setdefault(link, {"points": {}})["points"][joint] = data["at"]
    for point, data in tracers.items():
        links[data["link"]]["points"][point] = data["at"]
    problem: dict[str, Any] = {
        "tmm": 1,
        "units": SI,
        "links": links,
        "gravity": [0, -gravity],
        "guides": {},
        "points": {j: d["at"] for j, d in joints.items() if "ground" in d["links"] and d["kind"] == "R"},
        "driver": {k: case["input"][k] for k in ("link", "speed")} | {"turns": "ccw" if sense > 0 else "cw"},
        "sketch": {"at": 0, **{j: d["at"] for j, d in joints.items() if "ground" not in d["links"]}},
        "positions": {"at": [s["turn"] for s in samples]},
    }
    for joint, data in joints.items():
        if data["kind"] == "P":
            problem["guides"]["x"] = {"through": data["at"], "angle": 0}
            slider = f"slider{joint}"
            links[slider] = {"points": {joint: data["at"]}, "slides": {"on": "x"}}
            problem["sketch"][joint] = data["at"]
    if "masses" in case:
        problem["masses"] = {
            name: {"mass": m["m"], "inertia": m["J"], "centre": m["S"]} for name, m in case["masses"].items()
        }
        f, g = joints["F"]["at"], joints["G"]["at"]
        middle = [(f[0] + g[0]) / 2, (f[1] + g[1]) / 2]
        problem["loads"] = {"F0": {"on": case["load"]["link"], "at": middle, "force": case["load"]["force"]}}
    return problem
