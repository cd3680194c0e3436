"""A mechanism that turns on a page: what the results say at places close together, and a script that moves it."""

from .gallery.card import Card as Card, card as card
from .gallery.moving_picture import PLACE as PLACE, ROW as ROW, TURN as TURN, places_of as places_of
from .gallery.page import gallery_page as gallery_page
from .page import (
    FEWEST as FEWEST,
    FRAMES as FRAMES,
    MOST as MOST,
    animation_page as animation_page,
    charts as charts,
    frames as frames,
    picture_of as picture_of,
)
