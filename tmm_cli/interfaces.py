"""Public interfaces of subpackages. A name is imported when it is first used.

The names are listed in `__init__.pyi` beside `__init__.py`, where editors and mypy read them too (Scientific Python
SPEC 1):

    from .strokes import Stroke as Stroke

A command therefore imports only the modules that it uses.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from importlib import import_module
from pathlib import Path

LINE = re.compile(r"^from \.(\w[\w.]*)? import (?:\(([^)]*)\)|(.*))$", re.MULTILINE)


def lazy(package: str, file: str) -> tuple[Callable[[str], object], list[str]]:
    """Make `__getattr__` (PEP 562) and `__all__` of a package from the stub file beside its `__init__.py`.

    Args:
        package: name of the package.
        file: path of its `__init__.py`.
    """
    stub = Path(file).with_suffix(".pyi").read_text(encoding="utf-8")
    modules = {
        name.split()[0]: module
        for module, lines, line in LINE.findall(stub)
        for name in (lines or line).replace("\n", " ").split(",")
        if name.strip()
    }

    def load(name: str) -> object:
        if name not in modules:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        if not modules[name]:
            return import_module(f"{package}.{name}")
        loaded = import_module(package)
        value = getattr(import_module(f"{package}.{modules[name]}"), name)
        setattr(loaded, name, value)  # found without this function from now on
        return value

    return load, sorted(modules)
