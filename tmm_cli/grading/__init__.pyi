"""Grading: variants of a task, what students hand in, how right it is, and what went wrong where it is not."""

from .answer_key import HEADER as HEADER, compute_answer_key as compute_answer_key, idle_questions as idle_questions
from .diagnose import diagnose_students as diagnose_students, with_copies as with_copies
from .draw_variants import (
    CHUNK as CHUNK,
    Variety as Variety,
    draw as draw,
    draw_for as draw_for,
    tables_apart as tables_apart,
)
from .exports import EXPORTS as EXPORTS, write as write
from .exports.book import (
    ANSWERS_HEADER as ANSWERS_HEADER,
    Gradebook as Gradebook,
    direction as direction,
    points_text as points_text,
    share_text as share_text,
)
from .group_chart import chart as chart
from .mistakes import MISTAKES as MISTAKES, cases as cases
from .mistakes.base import Mistake as Mistake, solve as solve
from .mistakes.data import OtherZero as OtherZero, Sense as Sense
from .own_answers import following as following, own_answer as own_answer
from .record import (
    Given as Given,
    Mark as Mark,
    StudentMarks as StudentMarks,
    Submission as Submission,
    VariantTable as VariantTable,
)
from .run import (
    grade as grade,
    graded as graded,
    grades as grades,
    keep as keep,
    numbers_of as numbers_of,
    read_kept as read_kept,
    written as written,
)
from .sheet import Right as Right, Written as Written, predicted as predicted, right as right
from .statistics import (
    commonest as commonest,
    hardest as hardest,
    histogram as histogram,
    statistics_tables as statistics_tables,
)
from .submissions.numbers import Heading as Heading, Headings as Headings, read_answer as read_answer
from .submissions.read import read_submissions as read_submissions
from .submissions.template import write_template as write_template
from .task_sheets import TaskSheets as TaskSheets, meaning as meaning, problem_text as problem_text
from .untrusted_tables import rows_of as rows_of, shown as shown
from .variant_tables import (
    csv_of as csv_of,
    read_students as read_students,
    read_table as read_table,
    rows_of_table as rows_of_table,
    variant_in as variant_in,
    xlsx_of as xlsx_of,
)
