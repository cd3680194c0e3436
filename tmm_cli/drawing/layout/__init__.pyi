"""Large sheets to hand in: drawings and tables arranged in a frame with a title block."""

from .arrangement import (
    PAPERS as PAPERS,
    drawing_field as drawing_field,
    frame_pictures as frame_pictures,
    large_sheet_files as large_sheet_files,
    large_sheets as large_sheets,
    parse_formats as parse_formats,
    refuse_plans as refuse_plans,
)
from .contents import CONTENTS as CONTENTS, choose_positions as choose_positions
from .packing import (
    TITLE_BLOCK_SIZES as TITLE_BLOCK_SIZES,
    PackingField as PackingField,
    TitleBlockTexts as TitleBlockTexts,
    frame_corners as frame_corners,
    pack_boxes as pack_boxes,
    spread_boxes as spread_boxes,
)
