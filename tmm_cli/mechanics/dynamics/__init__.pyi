"""The law of motion: what drives the machine, the flywheel, balancing."""

from .balancing import (
    Balanced as Balanced,
    Balancing as Balancing,
    BalancingTask as BalancingTask,
    Counterweight as Counterweight,
    Place as Place,
    Plane as Plane,
    Rotor as Rotor,
    balance_machine as balance_machine,
    balanced as balanced,
    shaking as shaking,
    steadily as steadily,
)
from .flywheel import Tangent as Tangent
from .laws_of_motion import Cycle as Cycle, LawByTable as LawByTable
from .motors import Kloss as Kloss, Linear as Linear, Motor as Motor
from .reduced_model import Curve as Curve, fitted as fitted, reduce_machine as reduce_machine
from .single_run import (
    SingleRun as SingleRun,
    acceleration as acceleration,
    compute_single_run as compute_single_run,
    run as run,
)
from .steady_running import (
    Running as Running,
    Steady as Steady,
    find_steady_running as find_steady_running,
    fluctuation as fluctuation,
    reduced_machine as reduced_machine,
    running as running,
)
from .tasks import Disk as Disk, Profile as Profile, Rim as Rim, RunTask as RunTask, SteadyTask as SteadyTask
