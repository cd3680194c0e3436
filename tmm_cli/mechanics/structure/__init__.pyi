"""Who is joined to whom: mobility, Assur groups, names of links."""

from .assur import (
    Structure as Structure,
    analyse as analyse,
    pairs_within as pairs_within,
    reduced as reduced,
    structural_formula as structural_formula,
    ties_of as ties_of,
)
from .cycle import DENSE as DENSE, MOST as MOST, turns_of_cycle as turns_of_cycle
from .graph import (
    Contour as Contour,
    Tie as Tie,
    classification as classification,
    contours as contours,
    is_dependent as is_dependent,
    reach as reach,
    reached as reached,
)
from .group import (
    ROMAN as ROMAN,
    Group as Group,
    Pair as Pair,
    Passive as Passive,
    Reduction as Reduction,
    RedundantLink as RedundantLink,
    RigidSet as RigidSet,
    group_class as group_class,
)
from .naming import (
    basic_schemes as basic_schemes,
    four_link_scheme as four_link_scheme,
    is_parallelogram_coupler as is_parallelogram_coupler,
    link_motion as link_motion,
    output_link as output_link,
    roles as roles,
    six_bar_schemes as six_bar_schemes,
)
from .redundancy import CHOICES as CHOICES, rank_of as rank_of, space as space, spatial_chain as spatial_chain
from .spatial import (
    AXLES as AXLES,
    CONTACTS as CONTACTS,
    KINDS as KINDS,
    ChainResults as ChainResults,
    Findings as Findings,
    LocalFreedom as LocalFreedom,
    SpatialChain as SpatialChain,
    SpatialPair as SpatialPair,
    examine as examine,
)
