"""The explanatory note of a course project."""

from .blocks import (
    Block as Block,
    Contents as Contents,
    Equation as Equation,
    Figure as Figure,
    Heading as Heading,
    Note as Note,
    Paragraph as Paragraph,
    Ref as Ref,
    Rows as Rows,
    Source as Source,
    Sources as Sources,
    Title as Title,
    paragraph as paragraph,
)
from .expression import (
    EXACT as EXACT,
    MOST_FIGURES as MOST_FIGURES,
    ComputedQuantity as ComputedQuantity,
    Expression as Expression,
    Function as Function,
    Leaf as Leaf,
    Sum as Sum,
    evaluate as evaluate,
    format_fixed as format_fixed,
    largest_term as largest_term,
    round_figures as round_figures,
)
from .forces.equations import solve_moment_equation as solve_moment_equation
from .forces.loads import write_losses as write_losses
from .formats import FORMATS as FORMATS, formats_of as formats_of
from .formats.html import html as html
from .formula_tree import Letter as Letter, Row as Row, row as row
from .kinematics.on_paper import PositionPlans as PositionPlans
from .register import note as note
from .subject import Subject as Subject
