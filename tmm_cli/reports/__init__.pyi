"""Records to rows, and rows to the terminal, CSV and JSON."""

from .compare import (
    Difference as Difference,
    brief as brief,
    difference_table as difference_table,
    differences as differences,
    recorded as recorded,
)
from .cycle_tables import (
    has_flywheel as has_flywheel,
    name as name,
    output_motion as output_motion,
    signs as signs,
    states as states,
)
from .digits import (
    AccuracyReport as AccuracyReport,
    accuracy as accuracy,
    beside as beside,
    cells_with_digits as cells_with_digits,
    computed_tables as computed_tables,
    keys_of as keys_of,
)
from .explain import describe_stages as describe_stages, explain_tables as explain_tables, in_words as in_words
from .exports import EXPORTS as EXPORTS
from .file_summary import (
    bare_speeds as bare_speeds,
    bare_units as bare_units,
    between_rows as between_rows,
    doubts as doubts,
    motion as motion,
    summarise_file as summarise_file,
    without_effect as without_effect,
)
from .force_tables import energy_tables as energy_tables, locked_ranges as locked_ranges
from .force_warnings import tables_of_many as tables_of_many
from .input_load_tables import heavy as heavy
from .input_tables import input_data_tables as input_data_tables
from .properties import MET as MET, properties_shown as properties_shown
from .quality_tables import place as place
from .register import tables as tables, tables_of as tables_of, walk as walk
from .result_files import (
    RECORD as RECORD,
    Staged as Staged,
    WrittenFolder as WrittenFolder,
    folder_name as folder_name,
    folder_of as folder_of,
    held as held,
    listed as listed,
    refuse_place as refuse_place,
    write_results as write_results,
    write_whole as write_whole,
)
from .result_json import schema as schema, sections as sections, to_json as to_json
from .space_tables import (
    WrittenSchemes as WrittenSchemes,
    chains_json as chains_json,
    chains_table as chains_table,
    schemes_json as schemes_json,
    schemes_table as schemes_table,
)
from .spreadsheets import (
    WRITTEN as WRITTEN,
    Kind as Kind,
    empty_workbook as empty_workbook,
    local_csv as local_csv,
    spreadsheet_cells as spreadsheet_cells,
    workbook as workbook,
)
from .structure_tables import (
    PAIRS as PAIRS,
    ROLES as ROLES,
    called as called,
    contours_in_words as contours_in_words,
    counted_by_classes as counted_by_classes,
    counted_generally as counted_generally,
    counted_mobility as counted_mobility,
    counted_with_replacements as counted_with_replacements,
    indeterminate as indeterminate,
    kind_in_words as kind_in_words,
    left_out as left_out,
    mobility_with_rollers as mobility_with_rollers,
    motion_in_words as motion_in_words,
    primary_mechanisms_in_words as primary_mechanisms_in_words,
    schemes_in_words as schemes_in_words,
)
from .synthesis_tables import (
    missed as missed,
    synthesis_json as synthesis_json,
    tables_of_synthesis as tables_of_synthesis,
)
from .table import (
    Column as Column,
    Table as Table,
    csv_cell as csv_cell,
    csv_text as csv_text,
    json_bytes as json_bytes,
    json_text as json_text,
    link_name as link_name,
    plain as plain,
    table_of_words as table_of_words,
    true_digits as true_digits,
    with_unit as with_unit,
)
from .terminal import (
    MORE_ROWS as MORE_ROWS,
    MORE_ROWS_AS_JSON as MORE_ROWS_AS_JSON,
    MOST_ROWS as MOST_ROWS,
    figures as figures,
    show as show,
    terminal_cells as terminal_cells,
)
from .warnings import collect_warnings as collect_warnings
