"""Problem files: reading a text and building a linkage from it; every error names its line and column."""

from . import schema as schema
from .arithmetic import (
    Parser as Parser,
    evaluate as evaluate,
    evaluate_quantity as evaluate_quantity,
)
from .blocks.loads import stroke_dimension as stroke_dimension
from .blocks.sheet_keys import SheetTexts as SheetTexts
from .build import (
    build_any_problem as build_any_problem,
    build_chain as build_chain,
    build_from_shape as build_from_shape,
    build_parameters as build_parameters,
    build_problem as build_problem,
    build_unit_system as build_unit_system,
    early_parameters as early_parameters,
    is_chain as is_chain,
    refuse_variable_speed as refuse_variable_speed,
    validate_planar as validate_planar,
    validate_shape as validate_shape,
)
from .error_messages import (
    located_problem_error as located_problem_error,
    translate_errors as translate_errors,
)
from .errors import (
    Path as Path,
    ProblemError as ProblemError,
    SourcePosition as SourcePosition,
    Tree as Tree,
    WrittenNumber as WrittenNumber,
    clean as clean,
    escape_controls as escape_controls,
    format_path as format_path,
    locate_errors_in as locate_errors_in,
    nearest_name as nearest_name,
    parse_names as parse_names,
    prefix_errors as prefix_errors,
    quote as quote,
    to_latin as to_latin,
    unknown_name_error as unknown_name_error,
    unknown_position_error as unknown_position_error,
)
from .formats import read_mechanism as read_mechanism
from .formats.imported_mechanism import problem_file_text as problem_file_text
from .formats.pmks_link import DIGITS as DIGITS
from .mobility_errors import mobility_error as mobility_error
from .parameters import check_parameter as check_parameter, resolve_parameters as resolve_parameters
from .problems import (
    ChainProblem as ChainProblem,
    Problem as Problem,
    Synthesised as Synthesised,
    TaskProblem as TaskProblem,
)
from .reader import (
    MAX_BYTES as MAX_BYTES,
    Composer as Composer,
    decimal_comma_hint as decimal_comma_hint,
    decode_text as decode_text,
    find_language as find_language,
    read_bytes as read_bytes,
    read_file as read_file,
    read_file_text as read_file_text,
    read_text as read_text,
)
from .scalars import finite_float as finite_float, plain_value as plain_value
from .schema import (
    File as File,
    ShownKeys as ShownKeys,
    SpatialFile as SpatialFile,
    file_schema as file_schema,
)
from .schema_errors import KEYS_IN_OTHER_LANGUAGES as KEYS_IN_OTHER_LANGUAGES, shape_error as shape_error
from .schema_types import (
    VALUE as VALUE,
    FileHead as FileHead,
    Name as Name,
    Strict as Strict,
    Value as Value,
    Vector as Vector,
    checked_value as checked_value,
)
from .settings import apply_settings as apply_settings, unused_parameters as unused_parameters
from .templates import (
    list_templates as list_templates,
    load_translations as load_translations,
    template_text as template_text,
)
from .units import (
    SYMBOLS as SYMBOLS,
    ExtendedUnits as ExtendedUnits,
    PhysicalValue as PhysicalValue,
    Unit as Unit,
    UnitError as UnitError,
    UnitSystem as UnitSystem,
    VariedUnits as VariedUnits,
    dotted_unit_error as dotted_unit_error,
    parse_unit as parse_unit,
    plain_text as plain_text,
    typeset_unit as typeset_unit,
)
from .values import ValueReader as ValueReader, make_complex as make_complex
from .work_limits import (
    WORK_BUDGET as WORK_BUDGET,
    refuse_options as refuse_options,
    refuse_work as refuse_work,
    work_size as work_size,
)
