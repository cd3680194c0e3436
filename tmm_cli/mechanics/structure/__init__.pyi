"""Structure of a linkage: its mobility, pairs and Assur groups, and the names of links and of the mechanism."""

from .assur import (
    Structure as Structure,
    analyse_structure as analyse_structure,
    list_pairs as list_pairs,
    list_ties as list_ties,
    reduce_structure as reduce_structure,
    structural_formula as structural_formula,
)
from .cycle import MOST_TURNS as MOST_TURNS, POSITIONS_PER_TURN as POSITIONS_PER_TURN, turns_of_cycle as turns_of_cycle
from .graph import (
    Contour as Contour,
    Tie as Tie,
    classify_linkage as classify_linkage,
    find_contours as find_contours,
    is_dependent as is_dependent,
    links_joined_to_frame as links_joined_to_frame,
    reachable_nodes as reachable_nodes,
)
from .group import (
    ROMAN as ROMAN,
    Group as Group,
    Pair as Pair,
    PairRedundancy as PairRedundancy,
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
    link_roles as link_roles,
    output_link as output_link,
    six_bar_schemes as six_bar_schemes,
)
from .self_aligning import (
    PAIR_CHOICES as PAIR_CHOICES,
    count_in_space as count_in_space,
    out_of_plane_rank as out_of_plane_rank,
    spatial_chain as spatial_chain,
)
from .spatial import (
    AXLE_FREEDOMS as AXLE_FREEDOMS,
    CONTACT_PAIRS as CONTACT_PAIRS,
    PAIR_FREEDOMS as PAIR_FREEDOMS,
    ChainCount as ChainCount,
    ChainResults as ChainResults,
    LocalFreedom as LocalFreedom,
    SpatialChain as SpatialChain,
    SpatialPair as SpatialPair,
    count_chain as count_chain,
)
