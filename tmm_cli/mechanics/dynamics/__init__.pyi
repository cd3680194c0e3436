"""Dynamics of machines: motors, law of motion, flywheel, single runs, balancing."""

from .balancing import (
    BalancedCycle as BalancedCycle,
    BalancingResults as BalancingResults,
    BalancingTask as BalancingTask,
    CorrectionPlane as CorrectionPlane,
    CounterweightPlace as CounterweightPlace,
    CounterweightSolution as CounterweightSolution,
    UnbalancedShaft as UnbalancedShaft,
    balance_cycle as balance_cycle,
    balance_machine as balance_machine,
    compute_shaking as compute_shaking,
    constant_speed_motion as constant_speed_motion,
)
from .flywheel import Tangent as Tangent
from .laws_of_motion import MotorCycle as MotorCycle, SpeedTableLaw as SpeedTableLaw
from .motors import KlossMotor as KlossMotor, LinearMotor as LinearMotor, MotorCharacteristic as MotorCharacteristic
from .reduced_model import PanelCurve as PanelCurve, fit_curves as fit_curves, reduce_machine as reduce_machine
from .single_run import (
    SingleRun as SingleRun,
    compute_single_run as compute_single_run,
    driver_acceleration as driver_acceleration,
    integrate_run as integrate_run,
)
from .steady_running import (
    SteadyRunning as SteadyRunning,
    SteadySolution as SteadySolution,
    find_running_law as find_running_law,
    find_steady_running as find_steady_running,
    reduce_mechanism as reduce_mechanism,
    speed_fluctuation as speed_fluctuation,
)
from .tasks import (
    DiskFlywheel as DiskFlywheel,
    DriveProfile as DriveProfile,
    RimFlywheel as RimFlywheel,
    RunTask as RunTask,
    SteadyTask as SteadyTask,
)
