"""Records to rows, and rows to the terminal, CSV and JSON."""

from .compare import (
    ResultDifference as ResultDifference,
    brief_value as brief_value,
    difference_table as difference_table,
    find_differences as find_differences,
    golden_part as golden_part,
    golden_record as golden_record,
    new_quantities as new_quantities,
)
from .cycle_tables import (
    centre_name as centre_name,
    has_flywheel as has_flywheel,
    output_motion as output_motion,
    position_states as position_states,
    sign_convention as sign_convention,
)
from .digits import (
    AccuracyReport as AccuracyReport,
    assess_accuracy as assess_accuracy,
    computed_tables as computed_tables,
    numbers_at_positions as numbers_at_positions,
    row_keys as row_keys,
    with_bound_columns as with_bound_columns,
)
from .elements.view import ELEMENT_COLOUR as ELEMENT_COLOUR, element_view as element_view
from .explain import (
    describe_stages as describe_stages,
    explain_tables as explain_tables,
    narrate_structure as narrate_structure,
)
from .exports import EXPORTS as EXPORTS
from .file_summary import (
    describe_driver_motion as describe_driver_motion,
    describe_interpolation as describe_interpolation,
    describe_units as describe_units,
    find_bare_speeds as find_bare_speeds,
    find_slips as find_slips,
    find_unused_parameters as find_unused_parameters,
    summarise_file as summarise_file,
)
from .force_tables import describe_locked_ranges as describe_locked_ranges, energy_tables as energy_tables
from .force_warnings import warn_of_load_tables as warn_of_load_tables
from .input_load_tables import links_with_inertia as links_with_inertia
from .input_tables import input_data_tables as input_data_tables
from .properties import PROPERTY_TOLERANCE as PROPERTY_TOLERANCE, shown_properties as shown_properties
from .quality_tables import describe_position as describe_position
from .register import tables as tables, tables_of as tables_of, walk as walk
from .result_files import (
    RECORD as RECORD,
    StagedFolder as StagedFolder,
    WrittenFolder as WrittenFolder,
    choose_folder as choose_folder,
    folder_name as folder_name,
    listed_files as listed_files,
    recorded_part as recorded_part,
    refuse_unwritable as refuse_unwritable,
    write_atomically as write_atomically,
    write_results as write_results,
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
    CREATED as CREATED,
    SpreadsheetKind as SpreadsheetKind,
    local_csv as local_csv,
    open_workbook as open_workbook,
    spreadsheet_cells as spreadsheet_cells,
    write_workbook as write_workbook,
)
from .structure_tables import (
    PAIRS as PAIRS,
    ROLES as ROLES,
    describe_classification as describe_classification,
    describe_contours as describe_contours,
    describe_link_motion as describe_link_motion,
    describe_primary_mechanisms as describe_primary_mechanisms,
    describe_schemes as describe_schemes,
    generalised_mobility as generalised_mobility,
    indeterminate_reactions as indeterminate_reactions,
    mobility_by_classes as mobility_by_classes,
    mobility_equation as mobility_equation,
    mobility_with_replacements as mobility_with_replacements,
    mobility_with_rollers as mobility_with_rollers,
    reduction_sentences as reduction_sentences,
    translate_label as translate_label,
)
from .synthesis_quality import quality_sentences as quality_sentences
from .synthesis_tables import (
    synthesis_json as synthesis_json,
    tables_of_synthesis as tables_of_synthesis,
    unmet_demand_sentences as unmet_demand_sentences,
)
from .table import (
    Column as Column,
    Table as Table,
    csv_cell as csv_cell,
    csv_text as csv_text,
    json_bytes as json_bytes,
    json_text as json_text,
    json_value as json_value,
    link_name as link_name,
    text_table as text_table,
    true_digits as true_digits,
    with_unit as with_unit,
)
from .terminal import (
    MORE_ROWS as MORE_ROWS,
    MORE_ROWS_AS_JSON as MORE_ROWS_AS_JSON,
    MOST_ROWS as MOST_ROWS,
    print_on_terminal as print_on_terminal,
    printed_figures as printed_figures,
    terminal_cells as terminal_cells,
)
from .warnings import collect_warnings as collect_warnings
