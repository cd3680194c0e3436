"""A mechanism that turns on a page: what the results say at places close together, and a script that moves it."""

from .content import FRAMES as FRAMES, charts as charts, frames as frames, picture_of as picture_of
from .gallery.card import Card as Card, card as card
from .gallery.page import gallery_page as gallery_page
from .gallery.turning import PLACE as PLACE, ROW as ROW, TURN as TURN, places_of as places_of
from .page import FEWEST as FEWEST, MOST as MOST, animation_page as animation_page
