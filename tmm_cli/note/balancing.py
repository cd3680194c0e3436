"""Chapter on balancing: shaking force and shaking moment, counterweights, balancing of a rotor.

The note explains counterweights by static replacement of masses where that gives the computed values, which is the
case if the centres of mass lie on the lines through the hinges of their links. The mass of a coupler is replaced by two
masses at its hinges (Artobolevsky, Theory of Mechanisms and Machines, 1988, ch. 13).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.dynamics import (
    BalancedCycle,
    BalancingResults,
    BalancingTask,
    CounterweightPlace,
    CounterweightSolution,
    UnbalancedShaft,
    constant_speed_motion,
)
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.numerics import NO_VECTOR, Vector, cross, dot
from tmm_cli.note.blocks import Block, Heading, Inline, write_sentence
from tmm_cli.note.expression import EXACT, ComputedQuantity, Expression, Function, Leaf, apply_sign, evaluate, sum_terms
from tmm_cli.note.subject import Subject, note_table
from tmm_cli.reports import walk

FORCE, MOMENT = Symbol("F"), Symbol("M")
X, Y = Symbol("F", "x"), Symbol("F", "y")


def write_balancing(subject: Subject) -> Iterable[Block]:
    """Write the chapter on balancing. It is empty if the file does not request balancing."""
    balancing = subject.results.balancing
    if balancing is not None and (balancing.task.rotor is not None or balancing.cycle.shakes):
        yield Heading(_("Balancing"))
        if balancing.cycle.shakes:
            yield from _write_shaking_and_counterweights(subject, balancing)
        if balancing.task.rotor is not None:
            yield Heading(_("Rotating masses"), 2)
            yield from write_rotor_balancing(subject, balancing.task.rotor, balancing.corrections)


def _write_shaking_and_counterweights(subject: Subject, balancing: BalancingResults) -> Iterable[Block]:
    yield Heading(_("Shaking force and moment"), 2)
    yield from _explain_symbols(balancing)
    for k in subject.detail:
        yield from _write_shaking_force(subject, balancing, k)
    if balancing.cycle.counterweights:
        yield Heading(_("Counterweights"), 2)
        yield from write_counterweights(subject, balancing.cycle, balancing.task)
    text = _("The hodograph of the shaking force is shown in figure {figure}.")
    if balancing.cycle.counterweights:
        text = _("The hodographs of the shaking force before and after balancing are shown in figure {figure}.")
    yield from subject.figures("shaking", text, _("Hodograph of the shaking force"))
    yield from (note_table(subject, table) for table in walk(subject.results, ("shaking",)))


def _explain_symbols(balancing: BalancingResults) -> Iterable[Block]:
    pivot: Inline = Symbol(balancing.pivot) if balancing.pivot else _("the origin")
    yield write_sentence(
        _(
            "At constant speed of the input link the inertia forces of the links act on the frame with the "
            "resultant force {F} and, about {pivot}, the resultant moment {M}. Here {m} is the mass of a link, "
            "{a} the acceleration of its centre of mass, {x} and {y} are the coordinates of the centre of mass "
            "relative to {pivot}, {J} is the moment of inertia about the centre of mass and {epsilon} the "
            "angular acceleration of the link."
        ),
        F=FORCE,
        M=MOMENT,
        pivot=pivot,
        m=Symbol("m"),
        a=Symbol("a", "S"),
        x=Symbol("x", "S"),
        y=Symbol("y", "S"),
        J=Symbol("J", "S"),
        epsilon=Symbol("ε"),
    )


def _write_shaking_force(subject: Subject, balancing: BalancingResults, k: int) -> Iterable[Block]:
    """Write the components and the magnitude of the shaking force (N) and the shaking moment (N m) in one position."""
    results = subject.results
    motion = constant_speed_motion(results.mechanism, subject.motion.q[k : k + 1])
    about, along, across, moments = balancing.before.about, list[Expression](), list[Expression](), list[Expression]()
    largest = max(abs(complex(motion.centre(name).a[0])) for name in motion.linkage.moving)
    for name in motion.linkage.moving:
        link = motion.linkage.links[name]
        centre, mass = motion.centre(name), float(np.ravel(link.mass)[0])
        a, r = complex(centre.a[0]), complex(centre.x[0]) - about
        if mass and abs(a) > NO_VECTOR * largest:
            m = Leaf(Symbol("m", name), mass)
            ax, ay = Leaf(Symbol("a", f"S{name}x"), a.real), Leaf(Symbol("a", f"S{name}y"), a.imag)
            x, y = Leaf(Symbol("x", f"S{name}"), r.real), Leaf(Symbol("y", f"S{name}"), r.imag)
            along.append(m * ax)
            across.append(m * ay)
            moments.append(m * (x * ay - y * ax))
        inertia, epsilon = float(np.ravel(link.inertia)[0]), float(np.broadcast_to(motion.link(name).epsilon, 1)[0])
        if inertia and epsilon:
            moments.append(Leaf(Symbol("J", f"S{name}"), inertia) * Leaf(Symbol("ε", name), epsilon))
    if not moments:
        return
    yield write_sentence(_("Position {number}:"), number=subject.position_number(k))
    force = complex(balancing.before.force[k])
    x, y = Leaf(X, force.real), Leaf(Y, force.imag)
    yield ComputedQuantity(X, -sum_terms(along), x.value, _("N"))
    yield ComputedQuantity(Y, -sum_terms(across), y.value, _("N"))
    yield ComputedQuantity(FORCE, Function("sqrt", x**2 + y**2), abs(force), _("N"))
    yield ComputedQuantity(MOMENT, -sum_terms(moments), float(balancing.before.moment[k]), _("N·m"))


ON_LINE = 1e-9  # relative distance within which a point counts as lying on a line
SAME = 1e-8  # relative difference within which static replacement gives the computed counterweight

MASS_RADIUS, SHARE = Symbol("D"), Symbol("k")


def write_counterweights(subject: Subject, cycle: BalancedCycle, task: BalancingTask) -> Iterable[Block]:
    """Write the counterweights and the shaking force that remains with them.

    Each counterweight is described by its mass-radius product m·r and, if its radius is given, by its mass.
    """
    replacement = _StaticReplacement(subject.results.linkage, cycle, task)
    if replacement.explain_counterweights():
        yield write_sentence(
            _(
                "The mass-radius product of a counterweight is {D} = m·r. A link without a counterweight is "
                "replaced by point masses at its hinges, chosen so that the common centre of mass does not change. "
                "A counterweight then balances the masses of its link about its pivot and is placed opposite to them."
            ),
            D=MASS_RADIUS,
        )
        yield from replacement.explanation
    else:
        yield write_sentence(
            _(
                "The mass-radius product {D} = m·r of each counterweight and its angle are chosen so that the mean "
                "square of the shaking force over the cycle is least. The shaking force is a linear function of "
                "the vectors {D}."
            ),
            D=MASS_RADIUS,
        )
    for weight in cycle.counterweights:
        link, mass_radius = weight.place.link, Leaf(Symbol("D", weight.place.link), weight.size)
        magnitude, angle = subject.text(weight.size), subject.text(float(np.degrees(weight.angle)))
        text = _("Link {link}: {D} = {size} kg·m, {angle}° from the x axis of the link.")
        yield write_sentence(text, link=link, D=mass_radius.symbol, size=magnitude, angle=angle)
        if weight.mass is not None and weight.size:
            mass = mass_radius / Leaf(Symbol("r", link), weight.place.radius)
            yield ComputedQuantity(Symbol("m", f"c{link}"), mass, weight.mass, _("kg"))
    before, after = (float(np.nanmax(np.abs(results.force))) for results in (cycle.before, cycle.after))
    if cycle.left < ON_LINE:
        yield write_sentence(
            _("With the counterweights no shaking force remains: the common centre of mass of the links does not move.")
        )
        return
    yield write_sentence(
        _("The largest shaking force is {F} without counterweights and {Fb} with them; the remaining fraction is"),
        F=Symbol("F", "max"),
        Fb=Symbol("F", "max").primed,
    )
    share = Leaf(Symbol("F", "max").primed, after) / Leaf(Symbol("F", "max"), before)
    yield ComputedQuantity(Symbol("λ"), share, cycle.left)


@dataclass
class _StaticReplacement:
    """Static replacement of links by point masses at their hinges, by which the note explains the counterweights.

    Attributes:
        linkage: linkage with the masses of its links.
        cycle: shaking force over the cycle, with and without the counterweights.
        task: requirements on the balancing.
        explanation: sentences and formulas that derive the counterweights.
        lumps: point masses (kg) by the hinge at which they are placed.
    """

    linkage: Linkage
    cycle: BalancedCycle
    task: BalancingTask
    explanation: list[Block] = field(default_factory=list)
    lumps: dict[str, list[Leaf]] = field(default_factory=dict)

    def explain_counterweights(self) -> bool:
        """Fill `explanation` with the derivation of the counterweights.

        Returns:
            False if static replacement of masses does not give all counterweights that were computed.
        """
        weights = {weight.place.link: weight for weight in self.cycle.counterweights}
        if len(weights) < len(self.cycle.counterweights):
            return False
        if not all(self._replace_link(link) for link in self.linkage.moving if link not in weights):
            return False
        moved = [link for link in weights if self._find_fixed_pivot(weights[link].place) is None]
        return all(self._balance_link(weights[link]) for link in [*moved, *(n for n in weights if n not in moved)])

    def _find_fixed_pivot(self, place: CounterweightPlace) -> str | None:
        """Return the hinge on the frame about which a counterweight rotates, or None if its pivot moves."""
        points = self.linkage.links[place.link].points
        return next((p for p in self._find_hinges(place.link, FRAME) if points[p] == place.about), None)

    def _find_hinges(self, link: str, *others: str) -> list[str]:
        """Return the hinges that connect a link to the links in `others`; if this is empty, to any moving link."""
        named = others or tuple(name for name in self.linkage.moving if name != link)
        return [h.point for h in self.linkage.hinges if link in h.links and set(named) & set(h.links)]

    def _replace_link(self, name: str) -> bool:
        """Replace a link that has no counterweight by point masses at its hinges.

        Return False if that is impossible.
        """
        link = self.linkage.links[name]
        mass = float(np.ravel(link.mass)[0])
        if not mass:
            return True
        mass_leaf, hinges = Leaf(Symbol("m", name), mass), list(dict.fromkeys(self._find_hinges(name)))
        if self.linkage.slides_on_frame(name) and len(hinges) == 1:
            self.lumps.setdefault(hinges[0], []).append(mass_leaf)
            return True
        if self._find_hinges(name, FRAME) or len(hinges) != 2:
            return False
        a, b = (complex(link.points[p]) for p in hinges)
        line, centre = b - a, complex(link.centre) - a
        if abs(cross(line, centre)) > ON_LINE * abs(line) ** 2:
            return False
        share = dot(line, centre) / abs(line) ** 2
        length = Leaf(Symbol("l", "".join(hinges)), abs(line))
        if not 0 <= share <= 1:
            return False
        self.explanation.append(
            write_sentence(
                _("Link {link} is replaced by masses at points {a} and {b}:"), link=name, a=hinges[0], b=hinges[1]
            )
        )
        for (point, fraction), other in (((hinges[0], 1 - share), hinges[1]), ((hinges[1], share), hinges[0])):
            symbol, value = Symbol("m", f"{name}{point}"), mass * fraction
            arm = Leaf(Symbol("l", f"S{name}{other}"), abs(line) * fraction)
            self.explanation.append(ComputedQuantity(symbol, mass_leaf * (arm / length), value, _("kg")))
            self.lumps.setdefault(point, []).append(Leaf(symbol, value))
        return True

    def _balance_link(self, weight: CounterweightSolution) -> bool:
        """Derive the counterweight of a link from its mass and the point masses at its hinges.

        Returns:
            False if this counterweight differs from the computed one.
        """
        place, link = weight.place, self.linkage.links[weight.place.link]
        name, pivot = place.link, next((p for p, at in link.points.items() if at == place.about), None)
        if pivot is None:
            return False
        mass_symbol, mass = Symbol("m", name), float(np.ravel(link.mass)[0])
        masses: list[tuple[Leaf, Leaf, complex]] = []
        if mass and link.centre != place.about:
            arm = complex(link.centre) - place.about
            masses.append((Leaf(mass_symbol, mass), Leaf(Symbol("l", f"{pivot}S{name}"), abs(arm)), arm))
        for point in self._find_hinges(name):
            if point == pivot or point not in self.lumps:
                continue
            arm = complex(link.points[point]) - place.about
            masses += [(lump, Leaf(Symbol("l", f"{pivot}{point}"), abs(arm)), arm) for lump in self.lumps.pop(point)]
        if not masses:
            return False
        along = masses[-1][2] / abs(masses[-1][2])
        if any(abs(cross(along, arm)) > ON_LINE * abs(arm) for *__, arm in masses):
            return False
        moments = [apply_sign(dot(along, arm), lump * length) for lump, length, arm in masses]
        expression = sum_terms((*moments, *self._reciprocating_moments(name, pivot, along)))
        if abs(abs(evaluate(expression, EXACT)) - weight.size) > SAME * weight.size:
            return False
        if evaluate(expression, EXACT) < 0:
            expression = -expression
        text = _("The counterweight of link {link} balances the masses of the link about {pivot}:")
        self.explanation.append(write_sentence(text, link=name, pivot=pivot))
        self.explanation.append(ComputedQuantity(Symbol("D", name), expression, weight.size, _("kg·m")))
        if self._find_fixed_pivot(place) is None:
            self._merge_into_pivot(
                weight, pivot, [Leaf(mass_symbol, mass), *(lump for lump, *__ in masses if lump.symbol != mass_symbol)]
            )
        return True

    def _merge_into_pivot(self, weight: CounterweightSolution, pivot: str, masses: list[Leaf]) -> None:
        """Replace a link and its counterweight by one point mass at the moving pivot of the link."""
        name = weight.place.link
        lumps = [*(lump for lump in masses if lump.value), Leaf(Symbol("m", f"c{name}"), weight.mass or 0.0)]
        total = Leaf(Symbol("m", f"{name}{pivot}"), sum(lump.value for lump in lumps))
        self.explanation.append(
            write_sentence(
                _("The link with its counterweight of mass {m} is replaced by one mass at {pivot}:"),
                m=lumps[-1].symbol,
                pivot=pivot,
            )
        )
        counterweight = Leaf(Symbol("D", name), weight.size) / Leaf(Symbol("r", name), weight.place.radius)
        self.explanation.append(
            ComputedQuantity(total.symbol, sum_terms((*lumps[:-1], counterweight)), total.value, _("kg"))
        )
        self.lumps.setdefault(pivot, []).append(total)

    def _reciprocating_moments(self, name: str, pivot: str, along: complex) -> Iterator[Expression]:
        """Yield the mass moments (kg m) of reciprocating masses that the counterweight of a crank balances.

        It balances only the fraction of these masses that the file requires.
        """
        points = self.linkage.links[name].points
        for point in list(self.lumps):
            sliding = any(
                self.linkage.slides_on_frame(link)
                for h in self.linkage.hinges
                if h.point == point
                for link in h.links
                if link != FRAME
            )
            pins = [p for p in self._find_hinges(name) if p in points and p != pivot]
            if sliding and len(pins) == 1:
                arm = complex(points[pins[0]]) - complex(points[pivot])
                length = Leaf(Symbol("l", f"{pivot}{pins[0]}"), abs(arm))
                share = Leaf(SHARE, self.task.share)
                for lump in self.lumps.pop(point):
                    yield apply_sign(dot(along, arm), share * lump * length)
                self.explanation.append(
                    write_sentence(
                        _("The fraction {k} of the reciprocating masses at {point} is balanced:"),
                        point=point,
                        k=SHARE,
                    )
                )


PLANES = ("I", "II")


def write_rotor_balancing(subject: Subject, rotor: UnbalancedShaft, corrections: Vector) -> Iterable[Block]:
    """Write the correction masses of a rotor.

    If there are two correction planes, the mass in the second plane is derived first.
    """
    two = len(rotor.planes) > 1
    static = _("A rotor is statically balanced if the vectors {D} = m·r of all its masses sum to zero.")
    dynamic = _(
        "A rotor is dynamically balanced if the vectors {D} = m·r of all its masses sum to zero, and so do "
        "their moments about one of the correction planes; {alpha} is the angle of a mass, {z} its "
        "coordinate along the axis."
    )
    yield write_sentence(dynamic if two else static, D=Symbol("D"), alpha=Symbol("α"), z=Symbol("z"))
    if two:
        yield from _write_correction_mass(subject, rotor, corrections, 1)
    yield from _write_correction_mass(subject, rotor, corrections, 0)


def _write_correction_mass(subject: Subject, rotor: UnbalancedShaft, corrections: Vector, k: int) -> Iterable[Block]:
    correction, name = complex(corrections[k]), PLANES[k]
    unbalance = Symbol("D", name)
    yield write_sentence(_("Correction mass in plane {plane}:"), plane=name)
    components = []
    for axis, function, take in (("x", "cos", np.real), ("y", "sin", np.imag)):
        whole: Expression = -sum_terms(
            _unbalance_term(rotor, number, function, moment=k > 0) for number in range(len(rotor.sizes))
        )
        if k:
            whole = whole / _distance_from_first_plane(Symbol("z", name), rotor.planes[k].at, rotor)
        elif len(rotor.planes) > 1:
            whole = whole - Leaf(Symbol("D", f"{PLANES[1]}{axis}"), float(take(corrections[1])))
        components.append(Leaf(Symbol("D", f"{name}{axis}"), float(take(correction))))
        yield ComputedQuantity(components[-1].symbol, whole, components[-1].value, _("kg·m"))
    yield ComputedQuantity(
        unbalance, Function("sqrt", sum_terms(component**2 for component in components)), abs(correction), _("kg·m")
    )
    if abs(correction):
        direction = subject.text(float(np.degrees(np.angle(correction) % (2 * np.pi))))
        yield write_sentence(_("The angle of this mass is {angle}°."), angle=direction)
    radius = rotor.planes[k].radius
    if radius:
        mass = Leaf(unbalance, abs(correction)) / Leaf(Symbol("r", name), radius)
        yield ComputedQuantity(Symbol("m", name), mass, abs(correction) / radius, _("kg"))


def _unbalance_term(rotor: UnbalancedShaft, number: int, function: str, *, moment: bool) -> Expression:
    """Return a component of the unbalance m·r of one mass, or its moment about the first correction plane.

    function: "cos" for the x component, "sin" for the y component.
    """
    unbalance, index = complex(rotor.sizes[number]), str(number + 1)
    angle = Leaf(Symbol("α", index), float(np.angle(unbalance) % (2 * np.pi)), angle=True)
    share = Leaf(Symbol("D", index), abs(unbalance)) * Function(function, angle)
    return share * _distance_from_first_plane(Symbol("z", index), float(rotor.at[number]), rotor) if moment else share


def _distance_from_first_plane(symbol: Symbol, at: float, rotor: UnbalancedShaft) -> Expression:
    """Return the axial distance (m) of a mass or a correction plane from the first correction plane."""
    return Leaf(symbol, at) - Leaf(Symbol("z", PLANES[0]), rotor.planes[0].at)
