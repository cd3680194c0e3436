"""Web pages with moving mechanisms: a page for one mechanism, and a gallery of many."""

from .gallery.card import Card as Card, make_card as make_card
from .gallery.moving_picture import (
    ROW as ROW,
    STEPS_PER_MM as STEPS_PER_MM,
    STEPS_PER_RADIAN as STEPS_PER_RADIAN,
    chain_places as chain_places,
)
from .gallery.page import gallery_page as gallery_page
from .page import (
    FEWEST_FRAMES as FEWEST_FRAMES,
    FRAMES as FRAMES,
    MOST_BYTES as MOST_BYTES,
    animation_page as animation_page,
    chart_quantities as chart_quantities,
    draw_first_frame as draw_first_frame,
    results_in_frames as results_in_frames,
)
