"""A group, or a driving link, taken apart: what acts on it, what is known and what is sought."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from tmm_cli.draw.paper.sheet import safe
from tmm_cli.draw.sheets.group_loads import sheetfuls
from tmm_cli.forces.plan import GroupForces, Reaction
from tmm_cli.note.context import Subject
from tmm_cli.plans.bodies import DRIVE, Acting, Loaded
from tmm_cli.plans.forces import ForcePlan, force_plans
from tmm_cli.plans.moments import LoadedPart, MomentEquation, loaded_parts
from tmm_cli.plans.projections import ForceSum
from tmm_cli.plans.record import NamedVector, Symbol, reaction_symbol
from tmm_cli.tolerances import NO_FORCE


@dataclass(frozen=True)
class Part:
    """Of a position: a group or a driving link with its outer reactions (a driving link's is the frame's)."""

    subject: Subject
    here: Loaded
    loaded: LoadedPart
    plan: ForcePlan
    outer: tuple[Reaction, ...]
    forces: GroupForces | None

    @property
    def links(self) -> tuple[str, ...]:
        return self.loaded.links

    @property
    def sought(self) -> frozenset[Symbol]:
        """Letters of all that the outer reactions may be told by."""
        names = [(r.by, r.on) for r in self.outer]
        return frozenset(
            reaction_symbol(*n, part, letter) for n in names for part in ("", "n", "τ") for letter in ("R", "M")
        )

    @property
    def given(self) -> list[Acting]:
        """What is known when the part is taken apart."""
        return [one for one in self.loaded.acting if one.symbol not in self.sought and one.pair != DRIVE]

    @property
    def by_moments(self) -> frozenset[Symbol]:
        """What equations of moments give."""
        return frozenset(e.sought.symbol for e in self.loaded.equations if e.sought and not e.sought.arm)

    @property
    def calculated(self) -> frozenset[Symbol]:
        """What is found before the force plan is drawn."""
        return self.by_moments | {s.found.acting.symbol for s in self.sums[0]}

    @property
    def borne(self) -> frozenset[Symbol]:
        """Vectors of the plan that are known before it; not what balances a driver."""
        drives = {one.symbol for one in self.loaded.acting if one.pair == DRIVE}
        return frozenset(v.symbol for v in self.plan.plan.vectors) - self.sought - drives

    @property
    def guided(self) -> frozenset[Symbol]:
        """What acts along a line that is known: reactions of guides and teeth, forces of drivers."""
        outer = {reaction_symbol(r.by, r.on) for r in self.outer if r.pair.slide is not None or not r.pair.lower}
        return frozenset(outer | {one.symbol for one in self.loaded.acting if one.pair == DRIVE})

    @property
    def sums(self) -> tuple[list[ForceSum], list[ForceSum]]:
        """Sums along guides of what is known before the force plan is drawn, and the others."""
        inner = () if self.forces is None else self.forces.inner
        both = {reaction_symbol(*names) for r in inner for names in ((r.by, r.on), (r.on, r.by))}
        unknown = (self.sought | both) - self.by_moments
        found: tuple[list[ForceSum], list[ForceSum]] = [], []
        for one in self.loaded.sums:
            others = {part.acting.symbol for part in one.parts if part is not one.found}
            found[bool(others & unknown)].append(one)
        return found

    @property
    def inner_first(self) -> bool:
        """Whether a guide between its two links and one that holds it leave a third unknown to a plan of both."""
        return self.forces is not None and self.forces.group.type == "RPP" and len(self.links) == 2

    @property
    def at_once(self) -> bool:
        """Whether no equation has one unknown only."""
        return any(e.sought is None for e in self.loaded.equations)

    @property
    def caption(self) -> str:
        """Of its position."""
        return self.subject.at_position(self.here.k)

    @property
    def vectors(self) -> list[NamedVector]:
        """Of the plan without the inner reaction, and without loads that are nothing here."""
        least = NO_FORCE * self.plan.plan.size
        return [
            v for v in self.plan.plan.vectors if v.kind != "inner" and (v.symbol in self.sought or abs(v.value) > least)
        ]

    def size(self, reaction: Reaction) -> float:
        """Of a reaction in this position, N."""
        return abs(complex(reaction.force[self.here.k]))

    def on_paper(self, equation: MomentEquation) -> float | None:
        """The scale of the drawing on which the arms of an equation are, m/mm; None where arms are told in metres."""
        if self.subject.results.problem.note_style.arms != "paper":
            return None
        number = next(n for n, few in enumerate(sheetfuls(self.loaded.equations)) if equation in few)
        stem = self.stem("group-loads") + (f"-sheet-{number + 1}" if number else "")
        return self.subject.scale("group-loads", self.here.k, stem)

    def stem(self, name: str) -> str:
        """Of its drawing."""
        kind = "links" if len(self.links) > 1 else "link"
        return safe("-".join([self.subject.position(self.here.k).stem(name), kind, *self.links]))


def parts_of(subject: Subject, k: int) -> Iterable[Part]:
    """Last group first, the driving links at the end."""
    motion, reactions = subject.motion, subject.reactions
    here = Loaded.at(motion, reactions, k)
    loaded, plans = loaded_parts(motion, reactions, k), force_plans(reactions, k, motion)
    owners: list[tuple[tuple[Reaction, ...], GroupForces | None]] = [(g.outer, g) for g in reversed(reactions.groups)]
    owners += [((frame,), None) for frame in reactions.frames]
    for part, plan, (outer, forces) in zip(loaded, plans, owners, strict=True):
        yield Part(subject, here, part, plan, outer, forces)
