"""What each kind of pair asks of its links, one file a kind. A new kind is a file and a line here."""

from collections.abc import Callable

from tmm_cli.mechanics.groups.pairs.higher import Cam, Gear, Rack
from tmm_cli.mechanics.groups.pairs.lower import Constraint, Sliding, Turning
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.structure import Pair

PAIRS: dict[str, Callable[[Pair, Linkage], Constraint]] = {
    "R": Turning.of,
    "P": Sliding.of,
    "G": Gear.of,
    "K": Rack.of,
    "C": Cam.of,
}
