"""Command line of `tmm`: commands parse arguments, call other packages and print; heavy ones are imported late."""

from .app import COMMANDS as COMMANDS, application as application, main as main
from .bench import MEASUREMENTS as MEASUREMENTS
from .common import for_each_file as for_each_file
from .drawing import LEAST_JOBS as LEAST_JOBS, run_on_all_cores as run_on_all_cores
from .opening import open_problem as open_problem
from .reporting import accuracy_of as accuracy_of
from .schemes import make_scheme_file as make_scheme_file, read_group_types as read_group_types
from .talk import report_fault as report_fault, with_language_option as with_language_option
