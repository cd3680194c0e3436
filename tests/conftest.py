"""Random linkages are the same in every run, and TMM_LONGDOUBLE=double makes longdouble a double.

That is what it is on Windows and on processors of Apple: results must be as good there.
"""

from __future__ import annotations

import gc
import os
import shutil
import sys

import mpmath as mp
import numpy as np
import pytest
from hypothesis import settings

settings.register_profile("steady", derandomize=True, deadline=None)
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


gc.set_threshold(100_000)  # as the command does; what pytest holds is looked through less often
sys.dont_write_bytecode = False  # or each process that a test starts would compile the whole product
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

if os.environ.get("TMM_LONGDOUBLE") == "double":  # before any module of tmm_cli is imported
    np.longdouble, np.clongdouble = np.double, np.cdouble
