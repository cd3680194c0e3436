"""What each kind of pair asks of its links, one file a kind. A new kind is a file and a line here."""

from collections.abc import Callable

from tmm_cli.linkage import Linkage
from tmm_cli.pairs.base import Constraint
from tmm_cli.pairs.cam import Cam
from tmm_cli.pairs.gear import Gear
from tmm_cli.pairs.rack import Rack
from tmm_cli.pairs.sliding import Sliding
from tmm_cli.pairs.turning import Turning
from tmm_cli.structure.assur import Pair

PAIRS: dict[str, Callable[[Pair, Linkage], Constraint]] = {
    "R": Turning.of, "P": Sliding.of, "G": Gear.of, "K": Rack.of, "C": Cam.of,
}  # fmt: skip
