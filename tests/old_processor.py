"""Python as it runs on an older processor: NumPy without the instructions that it chooses by the machine, and OpenBLAS
with the kernels of Nehalem.

    python -m tests.old_processor -m pytest tests/test_reference.py

NumPy ignores names of instructions that it does not know, so conftest.py confirms that those named are off.
"""

from __future__ import annotations

import ctypes
import os
import platform
import subprocess
import sys
from pathlib import Path

import numpy as np
from numpy._core._multiarray_umath import __cpu_dispatch__, __cpu_features__

CORE = "Nehalem"  # of 2008: SSE4.2, neither AVX nor fused multiplication and addition
OFF, KERNELS = "NPY_DISABLE_CPU_FEATURES", "OPENBLAS_CORETYPE"


def environment() -> dict[str, str]:
    """Variables with which Python runs so."""
    kernels = {KERNELS: CORE} if platform.machine() in ("x86_64", "AMD64") else {}
    return os.environ | {OFF: " ".join(__cpu_dispatch__)} | kernels


def confirm() -> None:
    """Raise RuntimeError if instructions or kernels that the environment names are not as it says."""
    named = os.environ.get(OFF, "").replace(",", " ").split()
    unknown = [name for name in named if name not in __cpu_features__]
    on = [name for name in named if __cpu_features__.get(name)]
    if unknown or on:
        raise RuntimeError(f"{OFF}: unknown to this NumPy: {unknown}; still used: {on}; it chooses {__cpu_dispatch__}")
    core, wanted = open_blas_core(), os.environ.get(KERNELS)
    if wanted and core and core.lower() != wanted.lower():
        raise RuntimeError(f"{KERNELS}: {wanted} is wanted, {core} is used")


def open_blas_core() -> str | None:
    """The processor whose kernels NumPy's own OpenBLAS uses; None where NumPy brings another library."""
    root = Path(np.__file__).parent
    for library in (*root.parent.glob("numpy.libs/*openblas*"), *root.glob(".dylibs/*openblas*")):
        name = getattr(ctypes.CDLL(str(library)), "scipy_openblas_get_corename64_", None)
        if name is not None:
            name.restype = ctypes.c_char_p
            return name().decode()
    return None


if __name__ == "__main__":
    sys.exit(subprocess.run([sys.executable, *sys.argv[1:]], env=environment()).returncode)
