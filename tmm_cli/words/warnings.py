"""Words of warnings and of the state of a position."""

WORDS: dict[str, str] = {
    "warning.cycle": "no number of turns was found after which all repeats: of the cycle, one turn is shown",
    "warning.passive": "pair {pair} holds link {j} on link {i} where it would be without it: this works with exact "
    "dimensions only, and the reactions of links {among} are indeterminate (given: the least ones)",
    "warning.pressure": "the pressure angle on link {link} comes to {largest}, the file allows {allowed}",
    "warning.pressure_usual": "the pressure angle on link {link} comes to {largest}; usual is at most {allowed} "
    "(another limit: checks: {{{check}: ...}})",
    "warning.locked": "the mechanism locks itself by friction: {places}; no forces are given there",
    "warning.locked_in": "in position{s} {numbers}, most of all in pair {pair} of links {i} and {j}",
    "warning.twist": "torsion spring {spring} is turned by more than half a turn from its free angle at {place}: its "
    "moment jumps there, as angles are counted within half a turn",
    "warning.impact": "the law of cam {cam} lets the speed of follower {follower} jump ({places} of the cam): a hard "
    "impact, the acceleration there is not finite and is not in the tables",
    "warning.range": "driving link {link} cannot turn fully: it can go from {start} to {end}; there {groups} comes to "
    "its dead position",
    "warning.range_stopped": "driving link {link} goes from {start} to {end} only: it slows down and stops there",
    "warning.more": "... and {count} positions more that cannot be reached or are dead",
    "warning.from": "; positions.from ({start}) is for a driver that turns fully",
    "warning.given": "; results are given for that range",
    "warning.dead": "dead position of {group} inside the cycle at {place} (margin {margin}): velocities and forces "
    "grow without bound there, and the group may leave it either way; the results keep to the side of the sketch",
    "warning.passed": "dead position of {group} inside the cycle at {place} (margin {margin}): there the group may "
    "leave its way for that of another assembly; the results go on along the smooth one",
    "warning.missing": "position {number} ({place}): {group} cannot be assembled, {gap} short",
    "warning.dead_here": "position {number} ({place}): {group} is in its dead position; no velocities and forces",
    "warning.sketch": "in the sketch {point} is {share} % of the mechanism's size from its place with the driver at "
    "{place}: is sketch.at right?",
    "warning.drives": "load {load} acts along the motion in the whole working stroke: it drives and does not resist",
    "warning.always": "load {load} is one of the working stroke, but there are no whole strokes on this way of the "
    "driver: it acts always",
    "warning.table": "the table of load {load} does not reach as far as the {against} goes: its end value is held",
    "warning.stopped": "driver {link} slows down and stops before it comes to position {number}: no velocities and "
    "forces from there on",
    "warning.near": "position {number} is near a dead position of {group}: sine of the transmission angle {margin}",
    "warning.lever": "the lever differs from the force plan by {difference} % at position {number}, "
    "more than the limit of {limit} %",
    "state.missing": "{group} cannot be assembled",
    "state.locked": "locks by friction",
    "state.dead": "{group} is dead",
    "state.stopped": "the driver has stopped before",
}
