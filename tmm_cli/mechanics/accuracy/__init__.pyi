"""How many digits are to be trusted."""

from .length_sensitivity import changed as changed, list_lengths as list_lengths, widened as widened
from .rounding_bounds import (
    FEWEST as FEWEST,
    PAPER as PAPER,
    Digits as Digits,
    at as at,
    bare as bare,
    bounds as bounds,
    exact as exact,
    is_angle as is_angle,
    judged as judged,
    quantities as quantities,
    relative as relative,
    sizes as sizes,
)
from .search_bounds import Wide as Wide, blur as blur, coarsely as coarsely, searched as searched
