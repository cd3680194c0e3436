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
    Expression as Expression,
    Found as Found,
    Function as Function,
    Leaf as Leaf,
    Sum as Sum,
    evaluate as evaluate,
    fixed as fixed,
    largest_term as largest_term,
    rounded as rounded,
)
from .forces.equations import by_moments as by_moments
from .forces.loads import losses as losses
from .formats import FORMATS as FORMATS, formats_of as formats_of
from .formats.html import html as html
from .formula_tree import Letter as Letter, Row as Row, row as row
from .kinematics.on_paper import Here as Here
from .register import note as note
from .subject import Subject as Subject
