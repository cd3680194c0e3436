"""One file a command: parse, call, print. Heavy packages are imported inside, when their command runs."""

from .app import COMMANDS as COMMANDS, application as application, main as main
from .bench import MEASUREMENTS as MEASUREMENTS
from .common import each as each
from .drawing import FEW as FEW, by_all_cores as by_all_cores
from .opening import opened as opened
from .reporting import bounds_of as bounds_of
from .schemes import named_types as named_types, skeleton as skeleton
from .talk import speaking as speaking, tell_fault as tell_fault
