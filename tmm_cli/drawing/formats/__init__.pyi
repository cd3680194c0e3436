"""Formats of drawings."""

from .dxf import escape_codes as escape_codes
from .emf import write_emf as write_emf
from .pdf import subset_font as subset_font, write_pdf as write_pdf
from .png import write_png as write_png
from .register import (
    FORMATS as FORMATS,
    WITH_PAGES as WITH_PAGES,
    JobRunner as JobRunner,
    NamedDrawings as NamedDrawings,
    drawing_files as drawing_files,
    files_of_parts as files_of_parts,
    missing_character_notes as missing_character_notes,
    run_in_process as run_in_process,
)
from .svg import NOT_XML as NOT_XML, svg_element as svg_element, write_svg as write_svg
