"""Large sheets to hand in: drawings and tables packed into a frame with its title block."""

from .contents import CONTENTS as CONTENTS, chosen as chosen
from .files import files_of_sheets as files_of_sheets, formats_of as formats_of, refuse_plans as refuse_plans
from .large import PAPERS as PAPERS, field_of as field_of, framed as framed, large_sheets as large_sheets
from .packing import SIZES as SIZES, Field as Field, Titles as Titles, inner as inner, pack as pack, spread as spread
