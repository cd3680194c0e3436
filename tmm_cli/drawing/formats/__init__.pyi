"""Formats of drawings."""

from .dxf import plain as plain
from .emf import write_emf as write_emf
from .pdf import cut as cut, write_pdf as write_pdf
from .png import write_png as write_png
from .register import (
    FORMATS as FORMATS,
    WITH_PAGES as WITH_PAGES,
    Drawn as Drawn,
    Way as Way,
    files as files,
    here as here,
    in_parts as in_parts,
    lacking_in as lacking_in,
)
from .svg import NOT_XML as NOT_XML, element as element, write_svg as write_svg
