"""Grading: variants of a task, reading of submissions, marks, and explanations of wrong answers."""

from .answer_key import (
    HEADER as HEADER,
    compute_answer_key as compute_answer_key,
    describe_idle_questions as describe_idle_questions,
)
from .copies import find_copies as find_copies
from .diagnose import diagnose_students as diagnose_students
from .draw_variants import (
    CHUNK as CHUNK,
    VariantGenerator as VariantGenerator,
    check_load_tables as check_load_tables,
    draw_numbered_variants as draw_numbered_variants,
    draw_student_variants as draw_student_variants,
)
from .exports import EXPORTS as EXPORTS, write_formats as write_formats
from .exports.book import (
    ANSWERS_HEADER as ANSWERS_HEADER,
    Gradebook as Gradebook,
    direction as direction,
    points_text as points_text,
    share_text as share_text,
)
from .group_chart import draw_group_chart as draw_group_chart
from .mistakes import MISTAKES as MISTAKES, list_cases as list_cases
from .mistakes.base import Mistake as Mistake, solve_with_mistakes as solve_with_mistakes
from .mistakes.data import OtherZero as OtherZero, Sense as Sense
from .own_answers import find_carried_errors as find_carried_errors, replace_by_own_answer as replace_by_own_answer
from .record import (
    Mark as Mark,
    ReadAnswer as ReadAnswer,
    StudentMarks as StudentMarks,
    Submission as Submission,
    VariantTable as VariantTable,
)
from .run import (
    append_marks as append_marks,
    grade as grade,
    grade_example as grade_example,
    grade_group as grade_group,
    read_parameter_values as read_parameter_values,
    read_saved_marks as read_saved_marks,
    write_gradebook as write_gradebook,
)
from .sheet import (
    RightAnswers as RightAnswers,
    WrittenAnswers as WrittenAnswers,
    compute_right_answers as compute_right_answers,
    predict_answers as predict_answers,
)
from .statistics import (
    count_by_points as count_by_points,
    rank_difficulties as rank_difficulties,
    rank_mistakes as rank_mistakes,
    statistics_tables as statistics_tables,
)
from .submissions.numbers import Heading as Heading, Headings as Headings, read_answer as read_answer
from .submissions.read import read_submissions as read_submissions
from .submissions.template import write_template as write_template
from .task_sheets import (
    TaskSheets as TaskSheets,
    explain_quantity as explain_quantity,
    variant_problem_text as variant_problem_text,
)
from .untrusted_tables import printable_text as printable_text, read_rows as read_rows
from .variant_tables import (
    csv_bytes as csv_bytes,
    find_variant as find_variant,
    read_students as read_students,
    read_table as read_table,
    variant_table_rows as variant_table_rows,
    xlsx_bytes as xlsx_bytes,
)
