"""Choosing the assembly of a sketch, following it, and finding all of them."""

from . import choose as choose, search as search
from .choose import assemble as assemble, pinned as pinned, slack as slack
from .enumerate import (
    Assemblies as Assemblies,
    Assembly as Assembly,
    GroupAssemblies as GroupAssemblies,
    find_assemblies as find_assemblies,
    listed as listed,
)
from .rank import mobile as mobile
from .search import (
    CLOSE as CLOSE,
    close_from_afar as close_from_afar,
    placed_by_angles as placed_by_angles,
    sketch_deviations as sketch_deviations,
    sketched_angles as sketched_angles,
)
