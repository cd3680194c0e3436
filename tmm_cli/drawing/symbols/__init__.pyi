"""The symbols of a mechanism in one position: links, pairs, supports, wheels, cylinders, what acts on them."""

from .actuators import (
    BARREL as BARREL,
    SPRING_OF as SPRING_OF,
    Cylinder as Cylinder,
    cylinders as cylinders,
    springs as springs,
)
from .forms import Form as Form, Line as Line, by_pairs as by_pairs, by_points as by_points
from .parts import (
    FREE as FREE,
    MEASURED as MEASURED,
    MOVING as MOVING,
    PALETTE as PALETTE,
    PLATE as PLATE,
    STRUCTURAL as STRUCTURAL,
    WELD as WELD,
    Look as Look,
    box as box,
    free_runs as free_runs,
    guide as guide,
    mass_centre as mass_centre,
    numbers as numbers,
    quiet as quiet,
    rails as rails,
    support as support,
    support_side as support_side,
    symbol_size as symbol_size,
    tint as tint,
)
from .render import (
    BOX as BOX,
    Rendered as Rendered,
    arrows as arrows,
    names as names,
    render_scene as render_scene,
    slider as slider,
    spot as spot,
)
from .scene import (
    BEYOND as BEYOND,
    ON_LINE as ON_LINE,
    Scene as Scene,
    fit as fit,
    fitted as fitted,
    fixed_pivots as fixed_pivots,
    scale_to as scale_to,
    to_scale as to_scale,
)
from .wheel_symbols import draw as draw
from .wheels import (
    AROUND as AROUND,
    contact as contact,
    extent as extent,
    outline as outline,
    replacement as replacement,
)
