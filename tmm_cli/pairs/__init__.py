"""What each kind of pair asks of its links, one file a kind. A new kind is a file and a line here."""

from tmm_cli.pairs.base import Constraint
from tmm_cli.pairs.cam import Cam
from tmm_cli.pairs.gear import Gear
from tmm_cli.pairs.rack import Rack
from tmm_cli.pairs.sliding import Sliding
from tmm_cli.pairs.turning import Turning

PAIRS: dict[str, type[Constraint]] = {kind.kind: kind for kind in (Turning, Sliding, Gear, Rack, Cam)}
