"""Words of the synthesis of a four-bar by positions of its coupler."""

_W = "synthesis_coupler_positions"

WORDS: dict[str, str] = {
    f"{_W}.l1": "driver l1 = AB",
    f"{_W}.l2": "coupler l2 = BC",
    f"{_W}.l3": "follower l3 = DC",
    f"{_W}.l4": "frame l4 = AD",
    f"{_W}.phi1": "angle of AB in position 1",
    f"{_W}.AB": "length AB",
    f"{_W}.DC": "length DC",
    f"{_W}.AB_turn": "turn of AB from position 1 to 2",
    f"{_W}.DC_turn": "turn of DC from position 1 to 2",
    f"{_W}.transmission": "least transmission angle on the way",
    f"{_W}.way": "turn of AB from the first to the last position",
    f"{_W}.defect": "defects",
    f"{_W}.sound": "none: all positions on one assembly, reached in order",
    f"{_W}.branch": "branch: some positions are on the other assembly",
    f"{_W}.turns_back": "order: the driver must turn back between positions",
    f"{_W}.locks": "circuit: the driver locks on the way",
    f"{_W}.source_2": "pivots on the bisector of the two places of a pin, at the link's length",
    f"{_W}.source_3": "pivots in the centre of the circle through the three places of a pin; pins for given pivots "
    "likewise, the coupler held (inversion)",
    f"{_W}.source_4": "pins on the circle-point curve and pivots on the centre-point curve of four positions "
    "(Burmester), by W (e^(i beta) - 1) + Z (e^(i alpha) - 1) = P - P1",
    f"{_W}.construction": "Pivots on the bisectors of the places of the pins",
    f"{_W}.construction_pivots": "Pins on the bisectors of the places of the pivots, seen from the coupler in "
    "position 1",
    f"{_W}.construction_both": "Pivot on the bisectors of the places of its pin; pin on those of its pivot, seen from "
    "the coupler",
    f"{_W}.curves_alone": "Centre-point curve and circle-point curve of the four positions (Burmester)",
    f"{_W}.construction_4": "Four positions: pivots on the centre-point curve, pins on the circle-point curve",
    f"{_W}.bisectors": "dashed: bisectors of the places of the pin",
    f"{_W}.inversion": "dashed: bisectors of the pivot and its places ′, turned back with the coupler to position 1",
    f"{_W}.curves": "red: centre points m (pivots); dashed: circle points k1 (pins), in position 1",
    f"{_W}.still": "{point} does not move between these positions, or not against the coupler: it is the pole",
    f"{_W}.elsewhere": "another {point}",
    f"{_W}.one_pole": "the coupler only turns about one point: every pivot would be there",
    f"{_W}.hinge": "a hinge at [{x}, {y}] in the place of a four-bar; or positions that are no turns about one point",
    f"{_W}.elsewhere_at": "another {point}, as [{x}, {y}]",
    f"{_W}.line": "the three places of {point} lie on a line: the other end of the link is infinitely far",
    f"{_W}.off_line": "another {point}, or a slider instead of the link",
    f"{_W}.off_line_at": "{point} [{x}, {y}], whose link reaches {sizes} times the size of the task, or a slider "
    "instead of the link",
    f"{_W}.one_point": "{names} are one point: that is no four-bar",
    f"{_W}.short": "{name} does not reach both places",
    f"{_W}.longer": "{name} {length} or more",
    f"{_W}.no_turn": "no link through the four positions turns by this angle from the first to the second",
    f"{_W}.far_turn": "{name} of this turn is {length} long, or its ends are as far from the positions: near the turn "
    "of the coupler itself links grow beyond all bounds",
    f"{_W}.nearest_turn": "{turn}",
    f"{_W}.nearest_turn_usable": "{turn} ({usable} for a least transmission angle of {transmission})",
    f"{_W}.still_line": "the coupler does not turn, and its places lie on a line: links would be infinitely long",
    f"{_W}.still_slider": "places on a circle, or a slider",
    f"{_W}.still_off": "the coupler does not turn: all its points go on equal circles, and the fourth place is not on "
    "that through the others",
    f"{_W}.still_on": "x = {x}, y = {y}; or a coupler that turns",
    f"{_W}.still_on_turn": "x = {x}, y = {y} with {names} {turn}; or a coupler that turns",
    f"{_W}.still_turns": "{names} {turn}",
    f"{_W}.still_turn": "the coupler does not turn: both links turn as its places do on their circle",
    f"{_W}.any_parallelogram": "the coupler does not turn: any parallelogram with these arms does it; AD is free in "
    "length and direction, taken across the arms in the middle of their way",
    f"{_W}.source_still": "all points of a coupler that does not turn go on equal circles: A and D are their centres",
    f"{_W}.other_positions": "other positions",
    f"{_W}.position": "position {which}: {part} {to}",
    f"{_W}.whole": "position {which}: [{x}, {y}, {angle}], where a four-bar through the others comes; no coordinate of "
    "one position alone was found to help",
    f"{_W}.left_out_whole": "without {left}, and position {which}: [{x}, {y}, {angle}]",
    f"{_W}.left_out": "without {left}",
    f"{_W}.both_points": "{first} [{x0}, {y0}] and {second} [{x1}, {y1}]; no other of them alone was found to help",
    f"{_W}.on_circle": "positions 2 and 3 at [{x0}, {y0}] and [{x1}, {y1}]: with the others on a circle of {radius}, "
    "{sizes} times the size of the task; or a slider",
    f"{_W}.left_out_position": "without {left}, and position {which}: {part} {to}",
    f"{_W}.no_curve": "Burmester's curves have no links of sensible length (0.15 to 2 times the size of the task)",
    f"{_W}.has_branch": "branch defect: some positions are on the other assembly of the four-bar",
    f"{_W}.has_turns_back": "order defect: AB does not reach the positions in order by turning one way",
    f"{_W}.has_locks": "circuit defect: AB locks on the way between the positions",
    f"{_W}.swap": "DC as the driver ({swap}); or defects: keep",
    f"{_W}.sides": "AB_side: {one}, DC_side: {other}; or defects: keep",
    f"{_W}.length": "{name} {length}; or defects: keep",
    f"{_W}.point": "{point} [{x}, {y}]; or defects: keep",
    f"{_W}.turn": "{name} {turn}; or defects: keep",
    f"{_W}.turns": "AB_turn {one} with AB_branch: {first} and DC_turn {other} with DC_branch: {second}; "
    "or defects: keep",
    f"{_W}.turns_no_box": "AB_turn {one} with AB_branch: {first} and DC_turn {other} with DC_branch: {second}, and no "
    "pivots_within; or defects: keep",
    f"{_W}.no_room": "two pivots of links, frame and coupler of sensible length have no room in this box",
    f"{_W}.roomy": "a wider box",
    f"{_W}.none_within": "no pivot of a link of sensible length lies in this box",
    f"{_W}.box_grown": "[[{one_x}, {one_y}], [{other_x}, {other_y}]]: the box with its sides moved outwards by {by}; "
    "the pivots of the best four-bar anywhere are [{Ax}, {Ay}] and [{Dx}, {Dy}]",
    f"{_W}.wider": "a wider box",
    f"{_W}.curve": "Burmester's curves: pivots on the frame and their pins",
    f"{_W}.column_branch": "branch",
    f"{_W}.column_turn": "turn from 1 to 2",
    f"{_W}.column_pivot_x": "pivot, x",
    f"{_W}.column_pivot_y": "pivot, y",
    f"{_W}.column_pin_x": "pin in the coupler, x",
    f"{_W}.column_pin_y": "pin in the coupler, y",
    f"{_W}.column_first_x": "pin in position 1, x",
    f"{_W}.column_first_y": "pin in position 1, y",
    f"{_W}.column_length": "length of the link",
    f"{_W}.AB_branch": "branch of AB",
    f"{_W}.DC_branch": "branch of DC",
    f"{_W}.A_away": "distance of A from the wanted place",
    f"{_W}.D_away": "distance of D from the wanted place",
    f"{_W}.A_near_x": "A near to x",
    f"{_W}.A_near_y": "A near to y",
    f"{_W}.D_near_x": "D near to x",
    f"{_W}.D_near_y": "D near to y",
    f"{_W}.one_x": "pivots within, x",
    f"{_W}.one_y": "pivots within, y",
    f"{_W}.other_x": "pivots within, to x",
    f"{_W}.other_y": "pivots within, to y",
    f"{_W}.other_points": "other points or turns, or defects: keep",
}
for _key in ("position", "whole", "left_out", "left_out_position", "left_out_whole", "both_points"):
    WORDS[f"{_W}.{_key}_or_keep"] = WORDS[f"{_W}.{_key}"] + "; or defects: keep"
_FAR = "; no change of one position by up to {turn}, or {share} of the size of the task, was found to help"
for _key, _text in {
    "other_positions": "other positions",
    "other_points": "other points",
    "elsewhere": "another {point}",
    "off_line": "another {point}, or a slider instead of the link",
    "still_slider": "places on a circle, or a slider",
    "no_box": "other positions: without this box there is no such four-bar either",
}.items():
    WORDS |= {f"{_W}.{_key}_far": _text + _FAR, f"{_W}.{_key}_far_or_keep": f"{_text}{_FAR}; or defects: keep"}
_USABLE = {
    "turn": " ({usable} for a least transmission angle of {transmission})",
    "turns": " ({usable} on {usable_first} and {usable_other} on {usable_second} for a least transmission angle of "
    "{transmission})",
}
for _key, _text in {"turn": "turn", "turns": "turns", "turns_no_box": "turns"}.items():
    WORDS[f"{_W}.{_key}_usable"] = WORDS[f"{_W}.{_key}"].replace("; or", _USABLE[_text] + "; or")
for _key in ("sides", "length", "point", *("turn", "turn_usable", "turns", "turns_usable"), "turns_no_box",
             "turns_no_box_usable"):  # fmt: skip
    WORDS[f"{_W}.{_key}_swap"] = WORDS[f"{_W}.{_key}"].replace("; or", "; or DC as the driver ({swap}); or")
for _point, _text in {
    "A": "pivot A",
    "D": "pivot D",
    "C": "pin C in position 1",
    "P": "P of the coupler, from B",
}.items():
    WORDS |= {f"{_W}.{_point}{_axis}": f"{_text}: {_axis}" for _axis in "xy"}
for _point, _text in {"A": "pivot A", "D": "pivot D", "B": "B in the coupler", "C": "C in the coupler"}.items():
    WORDS |= {f"{_W}.{_point}_{_axis}": f"{_text}: {_axis}" for _axis in "xy"}
for _number in range(1, 5):
    WORDS |= {f"{_W}.{_axis}{_number}": f"position {_number}: {_axis} of P" for _axis in "xy"}
    WORDS[f"{_W}.angle{_number}"] = f"position {_number}: angle of the coupler"
for _key in ("point", "turn", "turn_usable", "turns", "turns_usable"):
    WORDS[f"{_W}.{_key}_alone"] = WORDS[f"{_W}.{_key}"].replace("; or defects: keep", "")
