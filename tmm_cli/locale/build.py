"""Build hook: compile the catalogues of translations (.po) to what gettext reads (.mo).

Runs when a wheel, an sdist or an editable install is built; the tests of a checkout call `compile_catalogues`.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import polib
from hatchling.builders.hooks.plugin.interface import BuildHookInterface

LOCALE = Path(__file__).parent


def compile_catalogues() -> None:
    """Compile every catalogue whose .mo file is missing or older than its .po file."""
    for source in LOCALE.glob("*/LC_MESSAGES/*.po"):
        compiled = source.with_suffix(".mo")
        if not compiled.exists() or compiled.stat().st_mtime < source.stat().st_mtime:
            unfinished = source.with_suffix(f".{os.getpid()}")
            polib.pofile(str(source)).save_as_mofile(str(unfinished))
            unfinished.replace(compiled)


class CatalogueHook(BuildHookInterface):  # type: ignore[type-arg]
    """Compile the catalogues before hatchling collects the files."""

    PLUGIN_NAME = "catalogues"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Called by hatchling before each target is built."""
        compile_catalogues()
