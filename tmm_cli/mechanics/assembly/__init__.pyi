"""Assembly of the groups as the sketch shows them, continuation along the driver coordinate, list of all assemblies."""

from . import assembling as assembling, sketch_matching as sketch_matching
from .assembling import (
    assemble as assemble,
    assembly_reserve as assembly_reserve,
    refine_dead_positions as refine_dead_positions,
)
from .enumeration import (
    Assemblies as Assemblies,
    Assembly as Assembly,
    GroupAssemblies as GroupAssemblies,
    find_assemblies as find_assemblies,
    name_assembly_files as name_assembly_files,
)
from .redundant_constraints import analyse_mobile_structure as analyse_mobile_structure
from .sketch_matching import (
    SKETCH_CLOSE as SKETCH_CLOSE,
    close_from_afar as close_from_afar,
    placed_by_angles as placed_by_angles,
    sketch_deviations as sketch_deviations,
    sketched_angles as sketched_angles,
)
