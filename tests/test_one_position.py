"""Every command on every problem of the bank when a single position is requested."""

from __future__ import annotations

import json
import re

import pytest
from bank import EVERY
from models import DATA, PROBLEMS
from test_commands import tmm

from tmm_cli.problem import read_text

SAMPLE = ("boom-lift", "crank-rocker")  # a cylinder, and a crank that rotates fully
REFUSED = {"lifting-boom": "the range of the driver is missing"}  # a single run has no single position
COMMANDS = (
    ("run", "--digits", "--tables", "csv-local"),
    ("note",),
    ("sheets",),
    ("sheets", "--positions", "all"),
    ("kinematics", "--extremes", "--centres"),
    ("kinematics", "--assemblies"),
    ("forces", "--extremes", "--hodographs"),
    ("structure", "--drawings"),
    ("dynamics",),
    ("explain",),
)


def with_one_position(name):
    """The problem with its first position only; what it shows may need others."""
    data = read_text((PROBLEMS / f"{name}.yaml").read_text(encoding="utf-8"), name).data
    data.pop("shows", None)
    positions = data.get("positions") if isinstance(data.get("positions"), dict) else {}
    kept = {key: value for key, value in positions.items() if key not in ("count", "at", "detail")}
    return json.dumps(data | {"positions": {**kept, "count": 1}}, ensure_ascii=False)  # JSON is YAML


@pytest.mark.parametrize(
    "name", [name if name in SAMPLE else pytest.param(name, marks=pytest.mark.bank) for name in EVERY]
)
def test_every_command_works_on_one_position(name, tmp_path):
    file = tmp_path / "one.yaml"
    file.write_text(with_one_position(name), encoding="utf-8")
    for command, *options in COMMANDS:
        out = () if command == "explain" else ("-o", tmp_path / "out")
        done = tmm(command, file, *options, *out, cwd=tmp_path)
        assert done.returncode in (0, 1, 2), done.stderr  # 3 is a fault of the program
        if name in REFUSED:
            assert done.returncode == 2 and REFUSED[name] in done.stderr
        elif done.returncode == 2:  # nothing to do for this command in this problem, said in its words
            assert re.search(NOTHING_TO_DO.get(command, "$^"), done.stderr), done.stderr


NOTHING_TO_DO = {"dynamics": "dynamics: the file has neither a block `dynamics` nor a block `balancing`"}


@pytest.mark.parametrize("command", ["run", "note", "sheets"])
def test_a_rocker_in_one_position_has_no_swing_on_its_sheet(command, tmp_path):
    """The output of a four-bar whose crank cannot rotate fully: its travel over one position is nothing."""
    done = tmm(command, DATA / "one-position.yaml", "-o", tmp_path)
    assert done.returncode == 0, done.stderr
    if command == "run":
        drawing = (tmp_path / "one-position" / "mechanism.svg").read_text(encoding="utf-8")
        assert "ψ =" not in drawing and "ends of the output" not in drawing


@pytest.mark.parametrize("command", ["run", "sheets", "note"])
def test_a_block_whose_points_are_one_but_for_rounding_is_drawn(command, tmp_path):
    """The scale of its free body was one of rounding, at which its guide was 1e16 mm long."""
    (tmp_path / "one.yaml").write_text(with_one_position("sine"), encoding="utf-8")
    done = tmm(command, tmp_path / "one.yaml", "-o", tmp_path)
    assert done.returncode == 0, done.stderr
