"""The JSON Schema of result.json: what every key means."""

from __future__ import annotations

from typing import Any

from tmm_cli.results.as_json import FORMAT


def _series(text: str) -> dict[str, Any]:
    return {"description": f"{text}, one value a position", "type": "array", "items": {"type": ["number", "null"]}}


def _vector(text: str) -> dict[str, Any]:
    parts = {axis: _series(f"{axis} component") for axis in ("x", "y")}
    return {"description": text, "type": "object", "properties": parts, "required": ["x", "y"]}


def _object(text: str, **properties: Any) -> dict[str, Any]:
    return {"description": text, "type": "object", "properties": properties}


def _map(text: str, value: dict[str, Any]) -> dict[str, Any]:
    return {"description": text, "type": "object", "additionalProperties": value}


def _list(text: str, items: dict[str, Any]) -> dict[str, Any]:
    return {"description": text, "type": "array", "items": items}


def _text(text: str) -> dict[str, Any]:
    return {"description": text, "type": "string"}


def _number(text: str) -> dict[str, Any]:
    return {"description": text, "type": ["number", "null"]}


def _flag(text: str) -> dict[str, Any]:
    return {"description": text, "type": "boolean"}


def result_schema() -> dict[str, Any]:
    """A JSON Schema (draft 2020-12). SI and radians throughout; forces of pairs act on link `on`."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "result.json of tmm",
        "description": "SI and radians. Arrays have one entry a position; null: not reached, or dead. "
        "Per unit of the driver's motion: rad for a crank, m for a driven slider.",
        "type": "object",
        "required": ["tmm", "problem", "warnings"],
        "properties": {
            "tmm": {"description": "version of this format", "const": FORMAT},
            "problem": _object("what was computed", name=_text("of the file"), title=_text("title"),
                               description=_text("description")),
            "structure": _structure(),
            "space": _space(),
            "chain": _chain(),
            **_computed(),
            "digits": _digits(),
            "assemblies": _assemblies(),
            "warnings": _list("sentences", {"type": "string"}),
            "files": _list("written beside this file", {"type": "string"}),
        },
    }  # fmt: skip


def _computed() -> dict[str, Any]:
    """What is computed, part by part."""
    return {
        "driver": _driver(),
        "dead_positions": _list("inside the driver's way", _object(
            "a dead position", at=_number("place of the driver"), group=_text("the group"),
            margin=_number("what is left of its margin there"))),
        "turns": _number("turns of the driver after which everything repeats"),
        "pressure": _pressure(),
        "output": _output(),
        "further_outputs": _list("of the others, as the first one", _output()),
        "travels": _list("outputs where the driver does not turn fully, over the positions asked", _object(
            "extremes", link=_text("output link"), kind=_text("slide or swing"), low=_number("least run, m or rad"),
            high=_number("greatest"), low_at=_number("place of the driver there"), high_at=_number("and there"))),
        "positions": _positions(),
        "kinematics": _kinematics(),
        "forces": _forces(),
        "lever": _lever(),
        "energy": _energy(),
    }  # fmt: skip


def _digits() -> dict[str, Any]:
    """Numbers in result.json are float64 in full; here is how many of their digits count."""
    return _object(
        "how far the numbers of this file, which are float64 in full, are to be trusted: in their places and units",
        number=_list("positions that were judged: arrays below have one entry for each", {"type": "integer"}),
        scale=_number("of a drawing on A4, m a mm: that of `paper`"),
        bound=_object(
            "how far each number may be from the truth by rounding; null: it is not known at all", **_computed()
        ),
        lengths=_object("its change when every length changes by 0.1 %, worst case to first order", **_computed()),
        paper=_object("its change when every coordinate is 0.5 mm off on paper, likewise", **_computed()),
    )


def _structure() -> dict[str, Any]:
    names = {"type": "string"}
    return _object(
        "links, pairs and Assur groups",
        mobility=_number("Chebyshev, W = 3n - 2 p1 - p2"), n=_number("moving links"), p1=_number("lower pairs"),
        p2=_number("higher pairs"),
        true_mobility=_number("by rank, where dimensions leave more than the count"),
        passive=_list("passive constraints", _object(
            "conditions that only repeat others", pair=_text("pair"), constraints=_number("how many"),
            links=_list("its links, the passive one last", names), among=_list("links that hold each other", names))),
        contours=_number("independent contours K = p - n"),
        classification=_list("closed or open; elementary, simple, complex; of one type or several", names),
        formula=_text("formula of structure"),
        **{"class": _text("class of the mechanism")},
        links=_list("moving links", _object(
            "a link", name=_text("its key in the file"), role=_text("crank, rocker, coupler, ..."),
            label=_text("the file's own name"), points=_list("its points", names))),
        pairs=_list("pairs", _object(
            "a pair", name=_text("point or guide; a compound hinge's further pairs have primes"),
            kind=_text("R turning, P sliding, G wheels, K rack, C cam"),
            links=_list("first and second link", names), point=_text("hinge or running point"))),
        groups=_list("in solving order", _object(
            "an Assur group", name=_text("II(2,3)"), links=_list("links", names), **{"class": _text("roman")},
            order=_number("number of leads"), type=_text("RRR, RRP, RPR, PRP, RPP"),
            inner=_list("inner pairs", names), outer=_list("outer pairs", names))),
    )  # fmt: skip


def _count() -> dict[str, Any]:
    return {
        "mobility": _number("Somov-Malyshev, W = 6n - 5 p1 - 4 p2 - 3 p3 - 2 p4 - p5"),
        "n": _number("moving links"),
        **{f"p{i}": _number(f"pairs with {i} freedoms") for i in range(1, 6)},
        "K": _number("independent contours"),
    }


def _contours() -> dict[str, Any]:
    names = {"type": "string"}
    return _list(
        "independent contours",
        _object(
            "a contour", links=_list("from the one nearest the frame round", names), pairs=_list("between them", names)
        ),
    )


def _space() -> dict[str, Any]:
    names = {"type": "string"}
    return _object(
        "the planar linkage counted in space", **_count(), contours=_contours(), wanted=_number("mobility Wo"),
        local=_number("local mobility Wm"), redundant=_number("redundant constraints q = Wo + Wm - W"),
        replacements=_list("pairs to give more freedoms, so that q = 0; null: none found", _object(
            "a pair", pair=_text("name"), links=_list("first and second link", names), was=_text("kind"),
            kind=_text("kind it is to have"), freedoms=_number("of that kind"))) | {"type": ["array", "null"]},
        proposed=_object("the same count with them", **_count(), local=_number("Wm"), redundant=_number("q"))
        | {"type": ["object", "null"]},
    )  # fmt: skip


def _chain() -> dict[str, Any]:
    names = {"type": "string"}
    return _object(
        "a chain given by pairs alone", **_count(), form=_text("open, closed, or mixed: with open branches"),
        contours=_contours(), branches=_list("links in no contour", names),
        pairs=_list("pairs", _object(
            "a pair", name=_text("name"), links=_list("first and second link", names), freedoms=_number("1 to 5"),
            kind={"description": "null when only freedoms are given", "type": ["string", "null"]},
            **{"class": _number("number of its constraints")})),
        local_freedoms=_list("found from the kinds of pairs", _object(
            "one of them", links=_list("that move alone", names), freedoms=_number("how many"),
            pairs=_list("that hold them", names))),
        local=_number("local mobility Wm, as given or as found"), wanted=_number("mobility Wo, as given"),
        redundant=_number("q = Wo + Wm - W"), output={"description": "link held", "type": ["string", "null"]},
        manoeuvrability=_number("mobility with the output held"),
    )  # fmt: skip


def _driver() -> dict[str, Any]:
    return _object(
        "the input", link=_text("driven link"), kind=_text("turn or slide"), sense=_number("+1 or -1"),
        rate=_number("rad/s or m/s, at position 0, in its sense"), acceleration=_number("rad/s2 or m/s2, in its sense"),
        full_turn=_flag("whether the crank can turn fully"), range=_list("from, to", _number("place")),
        limits=_list("where it is stopped", _object("a limit", at=_number("place"), group=_text("by which group"))),
    )  # fmt: skip


def _output() -> dict[str, Any]:
    return _object(
        "strokes of the output; null when no link of the last group is on the frame",
        link=_text("output link"), kind=_text("slide or swing"), travel=_number("stroke H, m, or swing psi, rad"),
        k=_number("coefficient of change of mean speed"), rule=_text("why that stroke is the working one"),
        strokes=_list("the working one first", _object(
            "a stroke", start=_number("driver's place at its start"), length=_number("driver's way"),
            run=_number("of the output, signed"), working=_flag("working stroke"),
            rest=_number("driver's way in the dwell after it, if there is one"),
            **{"from": _number("place of the output at its start")})),
    )  # fmt: skip


def _positions() -> dict[str, Any]:
    return _object(
        "which positions", number=_list("numbers in the cycle, from 0", {"type": "integer"}),
        driver=_series("angle of the crank, rad, or run of the driven slider, m"), time=_series("s since position 0"),
        rate=_series("speed of the driver, rad/s or m/s"), placed=_list("can be assembled", {"type": "boolean"}),
        moving=_list("has velocities and forces", {"type": "boolean"}),
        state=_list("what is wrong with a position, or nothing", {"type": "string"}),
    )  # fmt: skip


def _kinematics() -> dict[str, Any]:
    point = _object(
        "motion of a point", x=_vector("place, m"), v=_vector("velocity, m/s"), a=_vector("acceleration, m/s2"),
        first=_vector("derivative of its place by the driver's"), second=_vector("second derivative"),
    )  # fmt: skip
    return _object(
        "motion", output=_text("output link"), points=_map("every named point that moves", point),
        centres=_map("centres of mass, S and the link", point),
        links=_map("turning of every link", _object(
            "a link", angle=_series("of its x axis, rad"), omega=_series("rad/s"), epsilon=_series("rad/s2"),
            first=_series("d angle / d driver"), second=_series("second derivative"))),
        slides=_map("sliding pairs", _object(
            "motion of the runner along the carrier's guide", runner=_text("link"), carrier=_text("link"),
            run=_series("m"), v=_series("m/s"), a=_series("relative acceleration, m/s2"),
            coriolis=_vector("Coriolis acceleration, m/s2"), first=_series("first"), second=_series("second"))),
        margins=_map("distance of each group from its dead position: 1 at best, 0 there", _series("margin")),
    )  # fmt: skip


def _forces() -> dict[str, Any]:
    return _object(
        "force plan",
        loads=_list("everything applied", _object(
            "G weight, U inertia force with its couple, or a load of the file", name=_text("name"), link=_text("link"),
            kind=_text("weight, inertia, load"), force=_vector("N"), moment=_series("couple, N m"))),
        reactions=_map("by pair", _object(
            "what link `by` does to link `on`", on=_text("link"), by=_text("link"), force=_vector("N"),
            size=_series("N"), angle=_series("rad"), at=_vector("hinge or running point, m"),
            tangential=_vector("part across the link, outer hinges, N"), normal=_vector("part along it, N"),
            signed=_series("guides: force along the guide's left normal, N"),
            couple=_series("guides: couple, reduced to the running point, N m"),
            arm=_series("guides: where the force acts, along the guide from the running point, m"))),
        compound_hinges=_map("force of the pin on each link", _map("by link", _vector("N"))),
        balancing=_balancing("what balances the first driver"),
        drivers=_map("what balances each driver, by its link", _balancing("a driver")),
    )  # fmt: skip


def _balancing(text: str) -> dict[str, Any]:
    return _object(
        text, kind=_text("moment or force: which the frame's reaction belongs to"),
        moment=_series("N m; null for a driven slider"), force=_series("on the crank's end across it, or along, N"),
        vector=_vector("the force, N"), at=_vector("where it acts, m"),
    )  # fmt: skip


def _pressure() -> dict[str, Any]:
    return _list("driven links of the groups", _object(
        "where and how a link is driven", group=_text("the group"), link=_text("driven link"), pair=_text("driven in"),
        slides=_flag("slides on what holds it, else turns"), largest=_number("largest pressure angle, rad"),
        at=_number("place of the driver there"), allowed=_number("rad"), holds=_flag("within what is allowed"),
        transmission=_number("least transmission angle, rad"), gain=_number("force increase, 1/cos of the largest"),
        angles=_series("pressure angle, rad")))  # fmt: skip


def _energy() -> dict[str, Any]:
    return _object(
        "power balance, and the mechanism reduced to its first driver",
        inertia=_series("reduced moment of inertia, kg m2, or mass, kg"), slope=_series("its derivative by the driver"),
        moment=_series("reduced moment of all loads but inertia, N m, or force, N"),
        kinetic=_series("kinetic energy, J"),
        rate=_series("its rate, W"), drivers=_series("power of the drivers, W"), weights=_series("of weights, W"),
        loads=_series("of loads, W"), friction=_series("of friction, W"),
        balance=_series("what is left of all powers, against the largest"),
        efficiency=_number("with friction: over the cycle"),
        locked=_list("locked by friction", {"type": "boolean"}),
        friction_work=_map("work of friction over the cycle, J, by pair", _number("J")),
    )  # fmt: skip


def _assemblies() -> dict[str, Any]:
    names = {"type": "string"}
    coordinates = _object("m", x=_number("x"), y=_number("y"))
    one = _object(
        "an assembly", angles=_map("of the group's links, rad", _number("rad")),
        points=_map("of the group's links", coordinates), margin=_number("distance from a dead position: 0 there"),
        sketch=_flag("that of the sketch"))  # fmt: skip
    group = _object(
        "a group", group=_text("II(2,3)"), method=_text("closed form, polynomial, angles, many starts"),
        complete=_flag("whether it is proved that there are no others"), most=_number("so many are possible, if known"),
        moves=_flag("moves by itself here: assemblies without end"), assemblies=_list("real ones", one))  # fmt: skip
    return _list("with --assemblies: real assemblies of the groups, by places of the driver", _object(
        "a place", position=_number("its number; null: the place of the sketch"), driver=_number("rad or m"),
        undecided={"description": "group that the sketch does not decide", "type": ["string", "null"]},
        lost=_list("groups whose neighbours cannot be placed", names),
        groups=_list("in solving order, links before placed as in the sketch", group)))  # fmt: skip


def _lever() -> dict[str, Any]:
    return _object(
        "the Zhukovsky lever", balancing=_series("moment, N m, or force of a driven slider, N"),
        difference=_series("from the force plan, relative to the largest in the cycle"),
        limit=_number("allowed difference"), holds=_flag("below the limit at every position"),
        items=_list("forces and couples on the lever", _object(
            "one of them", name=_text("name"), link=_text("link"), kind=_text("force or couple"),
            size=_series("N or N m"), arm=_series("m per rad; for a couple omega / omega_1"),
            moment=_series("about the pole, N m"))),
    )  # fmt: skip
