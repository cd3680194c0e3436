"""Whole blocks at random that fit a problem file: friction, springs, laws of motion, tables of loads and the like."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from random import Random
from typing import Any

TABLES = ("linear", "step", "smooth")
SHOWN = ("H", "k", "M_b", "W", "q", "strokes", "pressure")


@dataclass
class Parts:
    """What a file names: moving links, points of each, guides of the frame, the first driver."""

    random: Random
    data: dict[str, Any]

    @property
    def links(self) -> dict[str, Any]:
        found = self.data.get("links")
        return found if isinstance(found, dict) and found else {"1": {}}

    @property
    def driver(self) -> dict[str, Any]:
        found = self.data.get("driver")
        first = found[0] if isinstance(found, list) and found else found
        return first if isinstance(first, dict) else {}

    @property
    def crank(self) -> Any:
        return self.driver.get("link", "1")

    def link(self) -> Any:
        return self.random.choice(list(self.links))

    def point(self, link: Any) -> Any:
        own = self.links.get(link)
        points = own.get("points") if isinstance(own, dict) else None
        return self.random.choice(list(points)) if points else "A"

    def any_point(self) -> Any:
        return self.point(self.link())

    def size(self, low: float, high: float) -> float:
        return round(self.random.uniform(low, high), 3)

    def table(self, end: float, high: float) -> list[list[float]]:
        """Rows from 0 to about an end; now and then steep ones, or two with one argument."""
        count = self.random.choice([2, 3, 6, 30])
        rows = sorted({0.0, end * self.random.choice([1, 1, 1, 0.5, 1.5]), *(self.size(0, end) for _ in range(count))})
        if self.random.random() < 0.3:
            rows.insert(1, rows[0] + self.random.choice([0.0, 1e-3, 1e-6]))
        return [[row, self.random.choice([0.0, high, self.size(0, high)])] for row in rows]

    def sized(self, high: float) -> Any:
        """A size, or a table of it."""
        against = self.random.choice(["stroke", "share of stroke", "crank angle", f"stroke of {self.link()}"])
        if self.random.random() < 0.5:
            return self.size(-high, high)
        end = {"share of stroke": 1.0, "crank angle": 360.0}.get(against, 100.0)
        found = {"against": against, "table": self.table(end, high)}
        return found | ({"between": self.random.choice(TABLES)} if self.random.random() < 0.4 else {})

    def when(self) -> dict[str, Any]:
        return self.random.choice(
            [
                {},
                {},
                {"when": "working stroke"},
                {"when": [self.size(0, 180), self.size(180, 360)]},
                {"when": f"working stroke of {self.link()}"},
            ]
        )


def _friction(parts: Parts) -> dict[str, Any]:
    found: dict[str, Any] = {"coefficient": parts.size(0, 0.3), "radius": parts.size(0, 20)}
    if parts.random.random() < 0.5:
        found["pairs"] = {str(parts.any_point()): {"coefficient": parts.size(0, 0.5)}}
    return {"friction": found}


def _spring(parts: Parts) -> dict[str, Any]:
    one, other = parts.link(), parts.random.choice(["0", parts.link()])
    kind = parts.random.choice(
        [
            {"rate": "5 N/mm", "free": parts.size(0, 400)},
            {"rate": 0, "preload": parts.size(-500, 500)},
            {"torsion": parts.size(0, 50), "free": parts.size(-180, 180)},
            {"damping": parts.size(0, 100)},
        ]
    )
    ends = {} if "torsion" in kind else {"at": [parts.point(one), [parts.size(-100, 100), parts.size(-100, 100)]]}
    return {"springs": {"s1": {"between": [one, other], **ends, **kind}}}


def _damper(parts: Parts) -> dict[str, Any]:
    one, other = parts.link(), parts.random.choice(["0", parts.link()])
    law = parts.random.choice(["linear", "quadratic", "torsion", "torsion quadratic"])
    ends = {} if "torsion" in law else {"at": [parts.point(one), [parts.size(-100, 100), parts.size(-100, 100)]]}
    return {"dampers": {"d1": {"between": [one, other], **ends, law: parts.size(-5, 100)}}}


def _dynamics(parts: Parts) -> dict[str, Any]:
    motor = parts.random.choice(
        [
            {"kind": "linear", "stall": parts.size(10, 200), "free": "1500 rpm", "ratio": parts.size(1, 30)},
            {
                "kind": "asynchronous",
                "synchronous": "1500 rpm",
                "speed": "1430 rpm",
                "moment": parts.size(1, 50),
                "ratio": parts.size(1, 30),
            },
        ]
    )
    wheel = {"inertia": parts.size(0, 50), "shape": parts.random.choice(["disk", "rim"])}
    run = {"from": parts.size(-90, 90), "to": parts.size(90, 400), "speed": "10 rpm", "drive": parts.size(0, 300)}
    return {
        "dynamics": parts.random.choice(
            [
                {"delta": parts.size(0.005, 0.3)},
                {"delta": "1/30", "mean speed": "60 rpm"},
                {"motor": motor},
                {"motor": motor, "delta": "1/25"},
                {"flywheel": wheel},
                {"run": run},
                {"run": run | {"brake": 5}},
            ]
        )
    }


def _balancing(parts: Parts) -> dict[str, Any]:
    weights = {str(parts.link()): parts.random.choice([{}, {"radius": parts.size(10, 100)}])}
    rotor = {
        "masses": [{"mass": parts.size(0, 9), "radius": 50, "angle": parts.size(0, 360), "at": parts.size(0, 99)}],
        "planes": parts.random.choice([[0], [0, {"at": 200, "radius": 60}]]),
    }
    return {
        "balancing": parts.random.choice(
            [
                {},
                {"counterweights": weights},
                {"counterweights": weights, "share": "2/3"},
                {"rotor": rotor},
            ]
        )
    }


def _load(parts: Parts) -> dict[str, Any]:
    link, load = parts.link(), parts.random.random()
    place = {"at": parts.point(link)}
    if load < 0.4:
        size = parts.sized(2000)
        force = size | {"angle": parts.size(0, 360)} if isinstance(size, dict) else [size, parts.size(-500, 500)]
        own = {**place, "force": force, "axes": parts.random.choice(["drawing", "link"])}
    elif load < 0.55:
        own = {**place, "force": {"resists": parts.size(0, 500)}}
    elif load < 0.75:
        own = {"moment": parts.random.choice([parts.sized(100), {"resists": parts.size(0, 50)}])}
    else:
        pressure = {"angle": parts.size(0, 360), "against": "crank angle", "table": parts.table(360, 5)}
        own = {**place, "pressure": pressure, **parts.random.choice([{"bore": 80}, {"area": "50 cm^2"}])}
    source = {"from": parts.link()} if parts.random.random() < 0.15 else {}
    loads = parts.data.get("loads") if isinstance(parts.data.get("loads"), dict) else {}
    return {"loads": {**loads, f"Q{len(loads)}": {"on": link, **source, **own, **parts.when()}}}


def _masses(parts: Parts) -> dict[str, Any]:
    link, masses = parts.link(), parts.data.get("masses") if isinstance(parts.data.get("masses"), dict) else {}
    own = parts.random.choice(
        [
            {
                "mass": parts.size(0, 20),
                "inertia": parts.size(0, 1),
                "centre": [parts.size(-99, 200), parts.size(-50, 50)],
            },
            {"points": [{"mass": parts.size(0, 5), "at": parts.point(link)}]},
            {"weight": "100 N", "centre": parts.point(link)},
        ]
    )
    return {"masses": {**masses, str(link): own}}


def _positions(parts: Parts) -> dict[str, Any]:
    number = parts.random.randint(1, 9)
    return {
        "positions": parts.random.choice(
            [
                {"count": 1},
                {"count": number, "detail": [0, number - 1][: parts.random.randint(0, 2)], "centres": True},
                {"at": [parts.size(-360, 360) for _ in range(parts.random.choice([1, 2, 5]))]},
                {"at": [30, 30]},
                {"count": number, "from": parts.random.choice(["working stroke", parts.size(-360, 360)])},
            ]
        )
    }


def _driver(parts: Parts) -> dict[str, Any]:
    table = [[angle, f"{parts.size(1, 99)} rpm"] for angle in (0, 90, parts.size(91, 300))]
    table.append([360, table[0][1]])
    speeds = {"against": "crank angle", "table": table, "between": parts.random.choice(["smooth", "linear"])}
    change = parts.random.choice(
        [
            {"speed": speeds},
            {"acceleration": parts.size(-5, 5)},
            {"turns": "cw"},
            {"balance": "force"},
            {"balance": "force", "end": parts.point(parts.crank)},
            {"speed": 0},
        ]
    )
    return {"driver": {**parts.driver, **change}}


def _output(parts: Parts) -> dict[str, Any]:
    one = parts.random.choice([parts.link(), parts.any_point()])
    return {
        "output": parts.random.choice(
            [
                one,
                [one, parts.link()],
                {"link": parts.link(), "working": parts.random.choice(["forward", "backward"])},
            ]
        )
    }


def _shows(parts: Parts) -> dict[str, Any]:
    of = [*SHOWN, f"v of {parts.any_point()}", f"phi of {parts.link()}", f"R_{parts.any_point()}"]
    more = parts.random.choice([{}, {"at": 0}, {"over": "largest"}, {"over": "range"}, {"between": [0, 1]}])
    return {"shows": {"property": {"of": parts.random.choice(of), **more}}}


def _rest(parts: Parts) -> dict[str, Any]:
    sheet = {
        "student": "И. Петров",
        "group": "21-101",
        "code": "TMM.07",
        "block": parts.random.choice(["plain", "gost"]),
    }
    wheel = {"moves_with": parts.link(), "when": parts.random.choice(["forward", "backward", "working stroke"])}
    return parts.random.choice(
        [
            {"gravity": 0},
            {"gravity": [parts.size(-10, 10), -9.81]},
            {"change points": "keep side"},
            {"cycle": "2 turns"},
            {"lang": parts.random.choice(["en", "ru", "sr"])},
            {"sheet": sheet},
            {"checks": {"lever": "1 %", "pressure_sliding": parts.size(1, 60), "pressure_turning": parts.size(1, 60)}},
            {"intermittent": {"w": wheel}},
            {"hinges": {str(parts.any_point()): {"attached to": parts.link()}}},
            {"racks": {"r": {"wheel": parts.crank, "rack": parts.link(), "radius": 30}}},
            {"gears": {"g": {"between": [parts.crank, parts.link()], "teeth": [20, 40], "module": 5}}},
            {
                "cams": {
                    "c": {
                        "cam": parts.crank,
                        "follower": parts.link(),
                        "law": [{"over": 120, "rise": 30}, {"over": 60}, {"over": 180, "rise": -30, "law": "3-4-5"}],
                    }
                }
            },
        ]
    )


BLOCKS: tuple[Callable[[Parts], dict[str, Any]], ...] = (
    _friction,
    _spring,
    _damper,
    _dynamics,
    _balancing,
    _load,
    _load,
    _masses,
    _positions,
    _driver,
    _output,
    _shows,
    _rest,
)


def with_blocks(data: dict[str, Any], random: Random) -> dict[str, Any]:
    """The file with one to three blocks more, or in place of its own."""
    for _ in range(random.choice([1, 1, 2, 3])):
        data = {**data, **random.choice(BLOCKS)(Parts(random, data))}
    return data
