"""Random linkages are the same in every run, and TMM_LONGDOUBLE=double makes longdouble a double.

That is what it is on Windows and on processors of Apple: results must be as good there.
"""

from __future__ import annotations

import os

import numpy as np
from hypothesis import settings

settings.register_profile("steady", derandomize=True, deadline=None)
settings.load_profile("steady")

if os.environ.get("TMM_LONGDOUBLE") == "double":  # before any module of tmm_cli is imported
    np.longdouble, np.clongdouble = np.double, np.cdouble
