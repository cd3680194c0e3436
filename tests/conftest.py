"""Random linkages are the same in every run, and TMM_LONGDOUBLE=double makes longdouble a double.

That is what it is on Windows and on processors of Apple: results must be as good there.
"""

from __future__ import annotations

import gc
import os
import shutil
import sys
from functools import cache
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from hypothesis import settings
from old_processor import confirm
from xdist.scheduler import LoadFileScheduling

from tmm_cli.locale.build import compile_catalogues

ROOMS = ("from bank import NAMES", "from big_sheets import")  # files that hold one of these go to one process


@cache
def room_of(file):
    text = Path(__file__).parents[1].joinpath(file).read_text(encoding="utf-8")
    return next((room for room in ROOMS if room in text), file)


class OfOneBank(LoadFileScheduling):
    """Files that go through the whole bank share what they solve and draw, and so do those about large sheets."""

    def _split_scope(self, nodeid):
        return room_of(nodeid.split("::", 1)[0])


def pytest_xdist_make_scheduler(config, log):
    return OfOneBank(config, log) if config.getoption("dist") == "loadfile" else None


confirm()  # where the environment turns instructions off

settings.register_profile("steady", derandomize=True, deadline=None, max_examples=40)
settings.load_profile("steady")


@pytest.fixture
def fifty_digits():
    """Arithmetic of mpmath in 50 digits."""
    with mp.workdps(50):
        yield


@pytest.fixture(scope="module")
def browser():
    """Chromium, where it is installed with what drives it."""
    api = pytest.importorskip("playwright.sync_api")
    found = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    with api.sync_playwright() as play:
        try:
            opened = play.chromium.launch(executable_path=found, args=["--no-sandbox"])
        except api.Error:
            pytest.skip("no Chromium is found")
        yield opened
        opened.close()


if "PYTEST_XDIST_WORKER" not in os.environ:
    compile_catalogues()  # a checkout has the sources of the translations alone

gc.set_threshold(100_000)  # as the command does; what pytest holds is looked through less often
sys.dont_write_bytecode = False  # or each process that a test starts would compile the whole product
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # of what is started from here: its threads would share the cores

if os.environ.get("TMM_LONGDOUBLE") == "double":  # before any module of tmm_cli is imported
    np.longdouble, np.clongdouble = np.double, np.cdouble
