"""Synthesis: lengths from what a mechanism must do, a module or a package a task."""

from . import measures as measures, solving as solving
from .construction import (
    LETTERS as LETTERS,
    Arc as Arc,
    Centre as Centre,
    Chain as Chain,
    Construction as Construction,
    Diagram as Diagram,
    Line as Line,
    Size as Size,
    Spot as Spot,
)
from .coupler_positions.burmester import (
    CouplerPositionsTask as CouplerPositionsTask,
    Dyads as Dyads,
    Poses as Poses,
    Side as Side,
    beside as beside,
    by_turn as by_turn,
    centre as centre,
    marks as marks,
)
from .coupler_positions.curve import curve as curve, frame as frame
from .coupler_positions.dyads import guiding as guiding
from .crank_slider import (
    CrankSliderTask as CrankSliderTask,
    find as find,
    largest_theta as largest_theta,
    least_pressure as least_pressure,
    shortest as shortest,
)
from .four_bar import FOUR_BAR_TYPES as FOUR_BAR_TYPES, FourBar as FourBar, turning as turning
from .four_bar_by_angles.freudenstein import (
    Bars as Bars,
    of_zeros as of_zeros,
    outputs as outputs,
    signed_bars as signed_bars,
    solutions as solutions,
)
from .four_bar_by_angles.pairs import (
    AnglePairsTask as AnglePairsTask,
    chosen as chosen,
    quality as quality,
    real as real,
    through as through,
)
from .four_bar_by_k.arcs import (
    ARC as ARC,
    Found as Found,
    FourBarByKTask as FourBarByKTask,
    arcs as arcs,
    at as at,
    bound as bound,
    places as places,
    widest as widest,
)
from .four_bar_by_k.solver import choose as choose
from .grashof import (
    LEVERS as LEVERS,
    SLIDERS as SLIDERS,
    CrankSlider as CrankSlider,
    SlottedLever as SlottedLever,
    classify_crank_slider as classify_crank_slider,
    classify_slotted_lever as classify_slotted_lever,
)
from .measures import (
    MeasuredDemand as MeasuredDemand,
    k_of as k_of,
    measured as measured,
    measured_on as measured_on,
    ratio_of_curve as ratio_of_curve,
    ratio_open as ratio_open,
    theta_of as theta_of,
)
from .optimal.candidates import Candidates as Candidates
from .optimal.evolution import Evolved as Evolved, evolve as evolve
from .optimal.many_starts import (
    Ends as Ends,
    Rows as Rows,
    Settling as Settling,
    descend as descend,
    residuals as residuals,
    step_of as step_of,
)
from .optimal.outcome import history as history, outcome_of as outcome_of
from .optimal.polish import DONE as DONE, Local as Local, exactly as exactly, polish as polish
from .optimal.quantities import QUANTITIES as QUANTITIES
from .optimal.quantities.strokes import longest as longest
from .optimal.solver import best as best
from .reading import TaskFile as TaskFile, alone as alone, build as build, rounded as rounded, task_of as task_of
from .record import (
    Infeasible as Infeasible,
    Kind as Kind,
    Listing as Listing,
    Outcome as Outcome,
    Value as Value,
    sound as sound,
)
from .schemes.chains import (
    MOST_LINKS_OF_CHAIN as MOST_LINKS_OF_CHAIN,
    KinematicChain as KinematicChain,
    canonical as canonical,
    chains as chains,
)
from .schemes.layout import layouts as layouts
from .schemes.schemes import (
    CLASSES as CLASSES,
    GROUP_TYPES as GROUP_TYPES,
    MOST_CRANKS as MOST_CRANKS,
    MOST_LINKS_OF_SCHEME as MOST_LINKS_OF_SCHEME,
    MOST_SCHEMES as MOST_SCHEMES,
    Scheme as Scheme,
    TooManySchemes as TooManySchemes,
    enumerate_schemes as enumerate_schemes,
)
from .schemes.skeleton import problem_text as problem_text
from .shaper import ShaperTask as ShaperTask
from .slotted_lever import SlottedLeverTask as SlottedLeverTask
from .solving import (
    count as count,
    inputs_of as inputs_of,
    load as load,
    prepare as prepare,
    redrive as redrive,
    solve as solve,
    structure_of as structure_of,
)
from .tasks import TASKS as TASKS, block as block
