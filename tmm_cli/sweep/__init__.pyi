"""A mechanism over its parameters: what comes of many variants, and where they cease to be mechanisms."""

from .grid import grid_points as grid_points, read_axes as read_axes
from .mechanisms import Mechanisms as Mechanisms
from .quantities import read_shown as read_shown
from .record import APART as APART, LIMIT as LIMIT, REFUSED as REFUSED, STOPS as STOPS, WORKS as WORKS, Swept as Swept
from .report import borders_table as borders_table, points_table as points_table, sections as sections
from .run import refuse_points as refuse_points, swept as swept
from .sheet import sheets as sheets
