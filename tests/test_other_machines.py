"""The suite on machines that this one is not: an older processor, the oldest dependencies that are allowed.

`pytest -m bank` runs it there, which takes many minutes; before each commit `.ci/run` runs a part of it.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from old_processor import KERNELS, OFF, environment, open_blas_core

ROOT = Path(__file__).parents[1]
SUITE = ["-m", "pytest", "-q", "-m", "not bank", "-p", "no:cacheprovider"]
IDLE = ("ruff", "mypy", "types-PyYAML")  # tools that no test runs


def confirmed(**changes):
    """Confirm in a new process that instructions and kernels are as its environment says."""
    code = "import old_processor; old_processor.confirm()"
    return subprocess.run(
        [sys.executable, "-c", code], env=environment() | changes, cwd=ROOT / "tests", capture_output=True, text=True
    )


def test_instructions_that_numpy_chooses_by_the_machine_are_off():
    done = confirmed()
    assert done.returncode == 0, done.stderr


def test_names_that_numpy_ignores_in_silence_are_refused():
    done = confirmed(**{OFF: "AVX1024"})
    assert done.returncode == 1 and "unknown to this NumPy: ['AVX1024']" in done.stderr


@pytest.mark.skipif(open_blas_core() is None, reason="NumPy has not brought its own OpenBLAS")
def test_kernels_that_are_not_used_are_refused():
    done = confirmed(**{KERNELS: "Z80"})
    assert done.returncode == 1 and "Z80 is wanted" in done.stderr


def lower_bounds():
    """Of everything that the suite imports: name==version."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    wanted = [
        *project["dependencies"],
        *(x for name in ("excel", "cluster", "cad", "note", "test") for x in extras[name]),
    ]
    split = [re.fullmatch(r"([\w-]+)>=([\d.]+)", x) for x in wanted if not x.startswith("tmm-cli[")]
    assert all(split)
    return [f"{one[1]}=={one[2]}" for one in split if one[1] not in IDLE]


def test_every_dependency_has_a_lower_bound():
    assert {"numpy", "scipy", "pydantic", "hypothesis"} <= {x.partition("==")[0] for x in lower_bounds()}


def passes(command, **more):
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, **more)
    assert done.returncode == 0, done.stdout[-20_000:] + done.stderr[-2_000:]


@pytest.mark.bank
def test_the_suite_on_an_older_processor():
    passes([sys.executable, *SUITE], env=environment())


@pytest.mark.bank
def test_the_suite_with_the_oldest_dependencies(tmp_path):
    """On the oldest Python, where it is found: packages of that age have no wheels for newer ones."""
    python = shutil.which("python3.11") or sys.executable
    passes([python, "-m", "venv", str(tmp_path)])
    own = str(tmp_path / ("Scripts" if os.name == "nt" else "bin") / "python")
    passes([own, "-m", "pip", "install", "--quiet", "--only-binary", ":all:", *lower_bounds()])
    passes([own, "-m", "pip", "install", "--quiet", "--no-deps", "--editable", "."])
    passes([own, *SUITE])
