"""Words of the synthesis of a four-bar by pairs of angles."""

_W = "synthesis_four_bar_by_angles"
_COLUMNS = {
    "l1": "l1", "l2": "l2", "l3": "l3", "l4": "l4", "phi0": "phi0", "psi0": "psi0",
    "transmission": "least transmission angle", "crank": "input turns fully",
}  # fmt: skip

WORDS: dict[str, str] = {
    f"{_W}.l1": "input l1 = AB",
    f"{_W}.l2": "coupler l2 = BC",
    f"{_W}.l3": "output l3 = DC",
    f"{_W}.l4": "frame l4 = AD",
    f"{_W}.phi0": "phi0, zero of the input angle, from AD",
    f"{_W}.psi0": "psi0, zero of the output angle, from AD",
    f"{_W}.phi1": "angle of AB from AD in the first pair",
    f"{_W}.psi1": "angle of DC from AD in the first pair",
    f"{_W}.transmission": "least transmission angle over the range",
    f"{_W}.crank_turns": "input turns fully (1: yes)",
    f"{_W}.defect": "defects",
    f"{_W}.sound": "none: all pairs on one assembly, reached in order",
    f"{_W}.branch": "branch: some pairs are on the other assembly",
    f"{_W}.locks": "order: the input locks on the way",
    f"{_W}.function": "y",
    f"{_W}.table": "table, straight between its rows",
    f"{_W}.x_from": "x, from",
    f"{_W}.x_to": "x, to",
    f"{_W}.phi_from": "input angle, from",
    f"{_W}.phi_to": "input angle, to",
    f"{_W}.psi_from": "output angle, from",
    f"{_W}.psi_to": "output angle, to",
    f"{_W}.solution": "solution, of those below",
    f"{_W}.solutions": "Solutions; another is taken by choose: its number",
    f"{_W}.number_of": "choose",
    f"{_W}.taken": "taken",
    f"{_W}.chosen": "yes",
    f"{_W}.free": "l4/l1, free with two pairs",
    f"{_W}.free_note": "two pairs leave l1/l4 free: that with the best transmission of 0.1 to 10 was taken; give two "
    "of l1, l3, l4 to take another",
    f"{_W}.free_end": "two pairs leave l1/l4 free: of 0.1 to 10 an end has the best transmission, and was taken; give "
    "two of l1, l3, l4 to take another",
    f"{_W}.no_crank": "no solution without defects has an input that turns fully: another was taken",
    f"{_W}.turns_fully": "yes",
    f"{_W}.swings": "no",
    f"{_W}.family": "Four-bars through both pairs",
    f"{_W}.error": "largest structural error",
    f"{_W}.error_curve": "structural error of the output angle",
    f"{_W}.error_title": "Structural error over the range",
    f"{_W}.points": "precision points",
    f"{_W}.phi": "input angle phi",
    f"{_W}.source": "Freudenstein's equation (l4/l1) cos(psi) - (l4/l3) cos(phi) "
    "+ (l1^2 + l3^2 + l4^2 - l2^2)/(2 l1 l3) = cos(phi - psi), angles from AD; Trans. ASME 76 (1954)",
    f"{_W}.construction": "Pairs turned back about {A} to the first input: {B}1 is the centre of the "
    "circle through {C}1, {C}2′ ...",
    f"{_W}.inversion": "dashed: bisectors, and arcs {C}{C}′ about {A} by the input's turn back",
    f"{_W}.order": "the input turns back: pair {this} cannot be reached after pair {last} in order",
    f"{_W}.in_order": "input angles that only grow, or only fall",
    f"{_W}.input_alone": "input angle {which}: {phi}",
    f"{_W}.turn": "the input has come round before the last pair",
    f"{_W}.one_turn": "less than a turn from the first to the last input angle",
    f"{_W}.positive": "there is no such link",
    f"{_W}.any_length": "any length, as {one}",
    f"{_W}.length_least_long": "{least} or more, with no link {links} times as long as another; {best} for the best "
    "transmission",
    f"{_W}.length_least": "{least} or more; {best} for the best transmission",
    f"{_W}.at_least": "{least} or more",
    f"{_W}.none": "no four-bar passes through these pairs",
    f"{_W}.all_branch": "branch defect: every four-bar through these pairs has some of them on its other assembly",
    f"{_W}.all_locks": "order defect: the input of every four-bar through these pairs locks on the way",
    f"{_W}.all_both": "every four-bar through these pairs has a branch defect, or its input locks on the way",
    f"{_W}.other": "other angles, or defects: keep; no angle alone within 60 deg of the given one helps",
    f"{_W}.endless": "the links of the four-bars through these pairs are infinitely long beside the frame",
    f"{_W}.short_sound": "none",
    f"{_W}.short_branch": "branch",
    f"{_W}.short_locks": "order",
    f"{_W}.other_alone": "other angles; no angle alone within 60 deg of the given one helps",
    f"{_W}.parallelogram": "these angles stay equal: every parallelogram l1 = l3, l2 = l4 passes the pairs, and its "
    "transmission angle is that of DC with AD; l1/l4 is free, 1/2 is taken",
    f"{_W}.reversed": "a zero angle is half a turn from the given one: in the given sense there is no such link",
    f"{_W}.its_branch": "branch defect: this solution has some pairs on its other assembly",
    f"{_W}.its_locks": "order defect: the input of this solution locks on the way",
    f"{_W}.another": "{numbers}; or choose: transmission; or defects: keep",
    f"{_W}.keep": "defects: keep; every other solution has a defect too",
    f"{_W}.number": "there is no solution of this number",
    f"{_W}.numbers": "1 to {count}",
    f"{_W}.choose_best": "choose: transmission",
    f"{_W}.numbers_fair": "{numbers}; or choose: transmission",
    f"{_W}.numbers_keep": "1 to {count} with defects: keep; every solution has a defect",
}
WORDS |= {f"{_W}.column_{key}": text for key, text in _COLUMNS.items()}
_NEAREST = {
    "nearest": "{what} {value}", "points_nearest": "points: {count} with {what} {value}",
    "nearest_more": "{what} {value} or more", "nearest_less": "{what} {value} or less",
}  # fmt: skip
_LONG = {"": "", "_long": ", with no link {links} times as long as another"}
_USABLE = {"": "", "_usable": " ({usable} for a least transmission angle of {transmission})"}
for _key, _text in _NEAREST.items():
    for _bound, _why in _LONG.items():
        for _plain, _number in _USABLE.items():
            for _left, _or in (("", "; or defects: keep"), ("_alone", "")):
                WORDS[f"{_W}.{_key}{_bound}{_plain}{_left}"] = f"{_text}{_number}{_why}{_or}"
for _count in range(2, 6):
    WORDS[f"{_W}.inputs_{_count}"] = "input angles " + ", ".join(f"{{phi{k}}}" for k in range(1, _count + 1))
for _left, _or in (("", "; or defects: keep"), ("_alone", "")):
    WORDS[f"{_W}.points_fewer{_left}"] = f"points: {{count}}{_or}"
    for _count in range(2, 6):
        _all = ", ".join(f"{{psi{k}}}" for k in range(1, _count + 1))
        WORDS[f"{_W}.all_{_count}{_left}"] = f"output angles {_all}, each changed by {{most}} or less{_or}"
WORDS |= {f"{_W}.what_{key}": key for key in ("l1", "l3", "l4", "phi0", "psi0")}
for _key in ("input", "output"):
    WORDS |= {f"{_W}.what_{_which}_{_key}": f"the {_which} {_key} angle" for _which in ("first", "last")}
    WORDS |= {f"{_W}.what_{_key}_{k}": f"{_key} angle {k}:" for k in range(1, 6)}
WORDS |= {f"{_W}.input{k}": f"input angle {k}" for k in range(1, 6)}
WORDS |= {f"{_W}.pair{k}": f"output angle {k}" for k in range(1, 6)}
