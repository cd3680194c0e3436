"""Words of the synthesis of a four-bar by pairs of angles."""

_W = "synthesis_four_bar_by_angles"
_OF_EACH = {
    "l1": "l1", "l2": "l2", "l3": "l3", "phi0": "phi0", "psi0": "psi0", "transmission": "least transmission angle",
    "defect": "defect",
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
    f"{_W}.in_order": "input angles that only grow, or only fall; pair {last} has {phi}",
    f"{_W}.turn": "the input has come round before the last pair",
    f"{_W}.one_turn": "less than a turn from the first to the last input angle",
    f"{_W}.positive": "there is no such link",
    f"{_W}.more_than_zero": "more than zero",
    f"{_W}.none": "no four-bar passes through these pairs",
    f"{_W}.all_branch": "branch defect: every four-bar through these pairs has some of them on its other assembly",
    f"{_W}.all_locks": "order defect: the input of every four-bar through these pairs locks on the way",
    f"{_W}.all_both": "every four-bar through these pairs has a branch defect, or its input locks on the way",
    f"{_W}.nearest": "the last output angle {psi}; or defects: keep",
    f"{_W}.other": "other angles, or defects: keep; nothing within 60 deg of the last output angle helps",
    f"{_W}.nearest_alone": "the last output angle {psi}",
    f"{_W}.other_alone": "other angles; nothing within 60 deg of the last output angle helps",
    f"{_W}.parallelogram": "these angles stay equal: every parallelogram l1 = l3, l2 = l4 passes the pairs, and its "
    "transmission angle is that of DC with AD; l1/l4 is free, 1/2 is taken",
    f"{_W}.reversed": "a zero angle is half a turn from the given one: in the given sense there is no such link",
    f"{_W}.its_branch": "branch defect: this solution has some pairs on its other assembly",
    f"{_W}.its_locks": "order defect: the input of this solution locks on the way",
    f"{_W}.another": "another number; or choose: transmission; or defects: keep",
    f"{_W}.number": "there is no solution of this number",
    f"{_W}.numbers": "1 to {count}",
}
WORDS |= {f"{_W}.s{k}_{key}": f"solution {k}: {text}" for k in range(1, 4) for key, text in _OF_EACH.items()}
WORDS |= {f"{_W}.input{k}": f"input angle {k}" for k in range(1, 6)}
WORDS |= {f"{_W}.pair{k}": f"output angle {k}" for k in range(1, 6)}
