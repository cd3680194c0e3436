"""Bad input in gears, racks, cams, springs, friction and drivers: exact messages, not a traceback."""

from __future__ import annotations

import json

import blocks
import pytest
from test_bad_input import place, refusal
from test_commands import tmm

CASES = {
    "wheel that does not exist": (
        blocks.GEARED,
        "between: [1, 4]",
        "between: [1, 9]",
        "[1,",
        "gears.z.between: there is no link of that name\n  found:   '9'\n  allowed: 0, 1, 2, 3, 4",
    ),
    "one wheel": (
        blocks.GEARED,
        "between: [1, 4]",
        "between: [1]",
        "[1]",
        (
            "gears.z.between: there are too few items; at least 2 are required here\n"
            "  found:   [1]\n"
            "  allowed: the two gears; one may be the frame (a fixed gear)"
        ),
    ),
    "one wheel twice": (
        blocks.GEARED,
        "between: [1, 4]",
        "between: [1, 1]",
        "[1,",
        ("gears.z.between: the links must be different\n  found:   1, 1, 0"),
    ),
    "fixed wheel on the frame that carries it": (
        blocks.GEARED,
        "between: [1, 4]",
        "between: [0, 4]",
        "[0, 4",
        ("gears.z.between: the links must be different\n  found:   0, 4, 0"),
    ),
    "wheel not hinged to the frame": (
        blocks.GEARED,
        "between: [1, 4]",
        "between: [1, 2]",
        "2]",
        ("gears.z.between[1]: link 2 has no suitable pair with link 0\n  found:   '2'\n  allowed: 1, 4"),
    ),
    "wheel not hinged to its carrier": (
        blocks.GEARED,
        "between: [1, 4]",
        "between: [1, 4], carrier: 2",
        "4]",
        ("gears.z.between[1]: link 4 has no suitable pair with link 2\n  found:   '4'\n  allowed: 1, 3"),
    ),
    "wheels on one axis": (
        blocks.GEARED,
        "D: [150, 0]}",
        "D: [0, 0]}",
        "[1",
        ("gears.z.between: gears 1 and 4 rotate about the same axis\n  found:   1, 4"),
    ),
    "axes too far apart for the module": (
        blocks.GEARED,
        "module: 5 mm",
        "module: 4 mm",
        "z:",
        ("gears.z: gears 1 and 4 do not mesh: their centre distance is 150 mm\n  allowed: a centre distance of 120 mm"),
    ),
    "axes too near for the radii": (
        blocks.GEARED,
        "teeth: [30, 30], module: 5 mm",
        "radii: [75, 80]",
        "z:",
        ("gears.z: gears 1 and 4 do not mesh: their centre distance is 150 mm\n  allowed: a centre distance of 155 mm"),
    ),
    "inner mesh at the distance of an outer one": (
        blocks.GEARED,
        "teeth: [30, 30], module: 5 mm",
        "radii: [75, 70], inner: true",
        "z:",
        ("gears.z: gears 1 and 4 do not mesh: their centre distance is 150 mm\n  allowed: a centre distance of 5 mm"),
    ),
    "teeth and ratio disagree": (
        blocks.GEARED,
        "module: 5 mm",
        "ratio: 2",
        "z:",
        ("gears.z: the data of gears 1 and 4 give contradictory ratios\n  found:   by teeth 1, by ratio 2"),
    ),
    "teeth and radii disagree": (
        blocks.GEARED,
        "teeth: [30, 30], module: 5 mm",
        "teeth: [30, 20], radii: [75, 75]",
        "z:",
        ("gears.z: the data of gears 1 and 4 give contradictory ratios\n  found:   by teeth 1.5, by radii 1"),
    ),
    "no ratio at all": (
        blocks.GEARED,
        "teeth: [30, 30], module: 5 mm",
        "offset: 3 deg",
        "z:",
        (
            "gears.z: one of the keys `teeth`, `radii` or `ratio` is required; with `module`, `teeth` is "
            "required\n"
            "  allowed: teeth: [20, 40]"
        ),
    ),
    "module without teeth": (
        blocks.GEARED,
        "teeth: [30, 30], module: 5 mm",
        "module: 3 mm",
        "z:",
        (
            "gears.z: one of the keys `teeth`, `radii` or `ratio` is required; with `module`, `teeth` is "
            "required\n"
            "  allowed: teeth: [20, 40]"
        ),
    ),
    "ratio zero": (
        blocks.GEARED,
        "teeth: [30, 30], module: 5 mm",
        "ratio: 0",
        "0}\nd",
        "gears.z.ratio: a number cannot be zero\n  found:   0\n  allowed: more than zero",
    ),
    "negative ratio": (
        blocks.GEARED,
        "teeth: [30, 30], module: 5 mm",
        "ratio: -1",
        "-1",
        "gears.z.ratio: a number cannot be negative\n  found:   -1\n  allowed: more than zero",
    ),
    "ratio of no wheels": (
        blocks.GEARED,
        "teeth: [30, 30], module: 5 mm",
        "ratio: 1e-20",
        "z:",
        ("gears.z: a pair of gears cannot have this ratio\n  found:   1e-20"),
    ),
    "no teeth": (
        blocks.GEARED,
        "teeth: [30, 30], module: 5 mm",
        "teeth: [0, 30]",
        "0, 3",
        "gears.z.teeth[0]: a number cannot be zero\n  found:   0\n  allowed: more than zero",
    ),
    "hardly a tooth": (
        blocks.GEARED,
        "teeth: [30, 30]",
        "teeth: [1e-17, 30]",
        "1e-17",
        ("gears.z.teeth[0]: a number of teeth must be a whole number\n  found:   1e-17"),
    ),
    "half a tooth": (
        blocks.GEARED,
        "teeth: [30, 30], module: 5 mm",
        "teeth: [1.5, 30]",
        "1.5",
        ("gears.z.teeth[0]: a number of teeth must be a whole number\n  found:   1.5"),
    ),
    "arithmetic that gives half a tooth": (
        blocks.GEARED,
        "teeth: [30, 30], module: 5 mm",
        "teeth: [61/2, 30]",
        "61/2",
        ("gears.z.teeth[0]: a number of teeth must be a whole number\n  found:   '61/2'"),
    ),
    "teeth of one wheel": (
        blocks.GEARED,
        "teeth: [30, 30], module: 5 mm",
        "teeth: [30]",
        "[30",
        (
            "gears.z.teeth: there are too few items; at least 2 are required here\n"
            "  found:   [30]\n"
            "  allowed: numbers of teeth of both gears"
        ),
    ),
    "equal wheels inside one another": (
        blocks.GEARED,
        "teeth: [30, 30], module: 5 mm",
        "teeth: [30, 30], inner: true",
        "z:",
        ("gears.z: a pair of gears cannot have this ratio\n  found:   1"),
    ),
    "pressure angle of a right angle": (
        blocks.GEARED,
        "module: 5 mm",
        "module: 5 mm, pressure: 90 deg",
        "90",
        ("gears.z.pressure: the pressure angle of the teeth must be between 0 and 90 deg\n  found:   90 deg"),
    ),
    "gear called like a hinge": (
        blocks.GEARED,
        "  z: {",
        "  A: {",
        "A:",
        ("gears.A: this name is already in use\n  found:   'A'"),
    ),
    "misspelt key of a gear": (
        blocks.GEARED,
        "module: 5 mm",
        "modul: 5 mm",
        "modu",
        "gears.z.modul: unknown key\n"
        "  found:   'modul'\n"
        "  allowed: between, carrier, teeth, radii, ratio, module, inner, offset, pressure\n"
        "  did you mean 'module'?",
    ),
    "misspelt block": (
        blocks.GEARED,
        "gears:",
        "gear:",
        "gear",
        (
            "gear: unknown key\n"
            "  found:   'gear'\n"
            "  allowed: tmm, lang, title, description, reference, shows, units, parameters, "
            "synthesis, variants, grading, points, guides, links, hinges, driver, gears, racks, "
            "cams, springs, dampers, friction, sketch, change points, masses, loads, gravity, output, cycle, "
            "intermittent, positions, checks, dynamics, balancing, sheet, frame, note\n"
            "  did you mean 'gears'?"
        ),
    ),
    "rack and wheel are one link": (
        blocks.RACK,
        "rack: 2",
        "rack: 1",
        "{w",
        ("racks.k: the links must be different\n  found:   1, 1, 0"),
    ),
    "wheel that is the frame": (
        blocks.RACK,
        "wheel: 1",
        "wheel: 0",
        "{w",
        ("racks.k: the links must be different\n  found:   0, 2, 0"),
    ),
    "rack that does not slide on the carrier": (
        blocks.GEARED,
        "driver:",
        "racks: {k: {wheel: 1, rack: 4, radius: 50}}\ndriver:",
        "4,",
        ("racks.k.rack: link 4 has no suitable pair with link 0\n  found:   '4'"),
    ),
    "wheel on a rack that is not hinged to the carrier": (
        blocks.GEARED,
        "driver:",
        "racks: {k: {wheel: 2, rack: 4, radius: 50}}\ndriver:",
        "2,",
        ("racks.k.wheel: link 2 has no suitable pair with link 0\n  found:   '2'\n  allowed: 1, 4"),
    ),
    "axis on the line of the rack's guide": (
        blocks.RACK,
        "[0, -50]",
        "[0, 0]",
        "k:",
        (
            "racks.k.side: the axis of the gear lies on the line of the guide: specify on which side of the "
            "rack the gear lies\n"
            "  allowed: side: left or right, looking along the guide"
        ),
    ),
    "side that is neither left nor right": (
        blocks.RACK,
        "radius: 50",
        "radius: 50, side: above",
        "abov",
        ("racks.k.side: this value is not allowed here\n  found:   'above'\n  allowed: left, right"),
    ),
    "radius zero": (
        blocks.RACK,
        "radius: 50",
        "radius: 0",
        "0}",
        "racks.k.radius: a length cannot be zero\n  found:   0\n  allowed: more than zero",
    ),
    "law that is less than a turn": (
        blocks.CAM,
        "over: 60 deg}]",
        "over: 50 deg}]",
        "[{ov",
        (
            "cams.c.law: the segments of the law of motion do not add up to a full turn of the cam\n"
            "  found:   350 deg\n"
            "  allowed: 360 deg"
        ),
    ),
    "law that does not come back": (
        blocks.CAM,
        "rise: -20",
        "rise: -10",
        "[{ov",
        (
            "cams.c.law: after a full turn the follower does not return to its initial position\n"
            "  allowed: values of `rise` that add up to 0"
        ),
    ),
    "piece of no angle": (
        blocks.CAM,
        "over: 60 deg}]",
        "over: 0 deg}]",
        "0 deg}]",
        "cams.c.law[3].over: an angle cannot be zero\n  found:   '0 deg'\n  allowed: more than zero",
    ),
    "rise in degrees of a follower that slides": (
        blocks.CAM,
        "rise: 20",
        "rise: 20 deg",
        "20 deg}",
        "cams.c.law[0].rise: expected here: a length\n"
        "  found:   '20 deg', an angle (20 deg)\n"
        "  allowed: a length, e.g. 110 mm or 0.11 m",
    ),
    "law of motion that is not known": (
        blocks.CAM,
        "law: cosine",
        "law: cosin",
        "cosi",
        (
            "cams.c.law[2].law: this value is not allowed here\n"
            "  found:   'cosin'\n"
            "  allowed: linear, parabolic, cosine, sine, 3-4-5, 4-5-6-7\n"
            "  did you mean 'cosine'?"
        ),
    ),
    "no pieces": (
        blocks.CAM,
        "law: [{over: 120 deg, rise: 20}, {over: 60 deg}, {over: 120 deg, rise: -20, law: cosine}, {over: 60 deg}]",
        "law: []",
        "[]",
        (
            "cams.c.law: a value is required here, but nothing is given\n"
            "  found:   a list, number of items: 0\n"
            "  allowed: law of motion: segments that add up to a full turn"
        ),
    ),
    "cam is its own follower": (
        blocks.CAM,
        "follower: 2",
        "follower: 1",
        "cam:",
        ("cams.c: the links must be different\n  found:   1, 1, 0"),
    ),
    "cam that is the frame": (
        blocks.CAM,
        "cam: 1",
        "cam: 0",
        "cam:",
        ("cams.c: the links must be different\n  found:   0, 2, 0"),
    ),
    "follower off the frame": (
        blocks.GEARED,
        "driver:",
        "cams: {c: {cam: 1, follower: 2, law: [{over: 360 deg}]}}\ndriver:",
        "2,",
        ("cams.c.follower: link 2 has no suitable pair with link 0\n  found:   '2'\n  allowed: 1, 4"),
    ),
    "cam off the frame": (
        blocks.GEARED,
        "driver:",
        "cams: {c: {cam: 2, follower: 4, law: [{over: 360 deg}]}}\ndriver:",
        "2,",
        ("cams.c.cam: link 2 has no suitable pair with link 0\n  found:   '2'\n  allowed: 1, 4"),
    ),
    "spring without its free length": (
        blocks.CYLINDER,
        ", free: 100",
        "",
        "s: {b",
        "springs.s.free: the free length or angle of the spring is missing\n  allowed: a length",
    ),
    "spring from a link to itself": (
        blocks.CYLINDER,
        "[0, 3], at: [O, K]",
        "[3, 3], at: [D, K]",
        "[3,",
        ("springs.s.between: the links must be different\n  found:   3, 3"),
    ),
    "spring on a link that does not exist": (
        blocks.CYLINDER,
        "between: [0, 3]",
        "between: [0, 8]",
        "8]",
        "springs.s.between[1]: there is no link of that name\n  found:   '8'\n  allowed: 0, 1, 2, 3",
    ),
    "spring at a point that does not exist": (
        blocks.CYLINDER,
        "[O, K]",
        "[O, Q]",
        "Q]",
        ("springs.s.at[1]: link 3 has no point of that name\n  found:   'Q'\n  allowed: D, B, K"),
    ),
    "spring with one end": (
        blocks.CYLINDER,
        "at: [O, K], ",
        "at: [K], ",
        "[K",
        (
            "springs.s.at: there are too few items; at least 2 are required here\n"
            "  found:   [K]\n"
            "  allowed: ends of the element, one on each link; default: the first points of the links"
        ),
    ),
    "spring without ends": (
        blocks.CYLINDER,
        "at: [O, K], ",
        "",
        "s: {b",
        ("springs.s.at: the ends are not given\n  allowed: at: [point of the first link, point of the second link]"),
    ),
    "spring without stiffness": (
        blocks.CYLINDER,
        "rate: 2 N/mm, ",
        "",
        "s: {b",
        ("springs.s: expected exactly one of these keys\n  allowed: rate, torsion"),
    ),
    "spring that stretches and twists": (
        blocks.CYLINDER,
        "rate: 2 N/mm",
        "rate: 2 N/mm, torsion: 1 N*m/rad",
        "s: {b",
        ("springs.s: expected exactly one of these keys\n  found:   rate, torsion\n  allowed: rate, torsion"),
    ),
    "spring that is shorter than nothing": (
        blocks.CYLINDER,
        "free: 100",
        "free: -100",
        "-100",
        "springs.s.free: a length cannot be negative\n  found:   -100\n  allowed: zero or more",
    ),
    "spring in a hinge": (
        blocks.CYLINDER,
        "[O, K]",
        "[D, D]",
        "[D, D",
        "springs.s.at: both ends are at hinge D, so the length is zero",
    ),
    "negative stiffness": (
        blocks.CYLINDER,
        "2 N/mm",
        "-2 N/mm",
        "-2",
        "springs.s.rate: a stiffness cannot be negative\n  found:   '-2 N/mm'\n  allowed: zero or more",
    ),
    "torsion spring with ends": (
        blocks.CYLINDER,
        "rate: 2 N/mm, free: 100",
        "torsion: 2 N*m/rad, free: 10 deg",
        "at: [",
        "springs.s.at: a torsional element has no end points",
    ),
    "torsion spring wound up": (
        blocks.CYLINDER,
        "{between: [0, 3], at: [O, K], rate: 2 N/mm, free: 100}",
        "{between: [0, 3], torsion: 2 N*m/rad, free: -300 deg}",
        "-300",
        (
            "springs.s.free: the free angle must not exceed half a turn; enter any further winding as `preload`\n"
            "  found:   -300 deg"
        ),
    ),
    "spring called like a load": (
        blocks.CYLINDER,
        "springs: {s:",
        "springs: {F:",
        "F:",
        ("springs.F: this name is already in use\n  found:   'F'"),
    ),
    "friction in a pair that does not exist": (
        blocks.SLIDER,
        "radius: 5}",
        "radius: 5, pairs: {X: {coefficient: 1}}}",
        "X:",
        (
            "friction.pairs.X: there is no revolute or prismatic pair of that name\n"
            "  found:   'X'\n"
            "  allowed: O, A, B, x\n"
            "  did you mean 'x'?"
        ),
    ),
    "journal of a sliding pair": (
        blocks.SLIDER,
        "radius: 5}",
        "radius: 5, pairs: {x: {radius: 5}}}",
        "radius: 5}",
        "friction.pairs.x.radius: a prismatic pair has no journal, so it has no `radius`",
    ),
    "negative coefficient": (
        blocks.SLIDER,
        "coefficient: 0.1",
        "coefficient: -0.1",
        "-0.1",
        "friction.coefficient: a number cannot be negative\n  found:   -0.1\n  allowed: zero or more",
    ),
    "friction between teeth": (
        blocks.GEARED,
        "driver:",
        "friction: {pairs: {z: {coefficient: 0.1}}}\ndriver:",
        "z: {c",
        (
            "friction.pairs.z: there is no revolute or prismatic pair of that name\n"
            "  found:   'z'\n"
            "  allowed: O, D, A, B, C"
        ),
    ),
    "no driver at all": (
        blocks.TWO,
        "driver:\n  - {link: 1, speed: 1 rad/s}\n  - {link: 4, speed: 2 rad/s, at: 90 deg}\n",
        "driver: []\n",
        "[]",
        "driver: there is no driver\n  found:   []\n  allowed: {link: 1, speed: 60 rpm}",
    ),
    "one link driven twice": (
        blocks.TWO,
        "link: 4",
        "link: 1",
        "1, speed: 2",
        ("driver[1].link: this link already has a driver\n  found:   '1'"),
    ),
    "driver that is not joined to the frame": (
        blocks.TWO,
        "link: 4",
        "link: 2",
        "2,",
        ("driver[1].link: link 2 has no suitable pair with link 0\n  found:   '2'\n  allowed: 1, 4"),
    ),
    "driver between links that are not joined": (
        blocks.TWO,
        "link: 4",
        "link: 4, on: 2",
        "4,",
        ("driver[1].link: link 4 has no suitable pair with link 2\n  found:   '4'\n  allowed: 1, 3"),
    ),
    "driver on itself": (
        blocks.TWO,
        "link: 4",
        "link: 4, on: 4",
        "4, s",
        ("driver[1].on: the links must be different\n  found:   4, 4"),
    ),
    "second driver without its place": (
        blocks.TWO,
        ", at: 90 deg",
        "",
        "{link: 4",
        (
            "driver[1].at: the sketch coordinate of the first driver is given in the block `sketch`; the key "
            "`at` is only for the other drivers\n"
            "  allowed: for the first driver: sketch: {at: 30 deg}; for the others: at: 30 deg"
        ),
    ),
    "first driver with a place": (
        blocks.TWO,
        "1 rad/s}",
        "1 rad/s, at: 3 deg}",
        "at",
        (
            "driver[0].at: the sketch coordinate of the first driver is given in the block `sketch`; the key "
            "`at` is only for the other drivers\n"
            "  allowed: for the first driver: sketch: {at: 30 deg}; for the others: at: 30 deg"
        ),
    ),
    "first driver at rest": (
        blocks.TWO,
        "1 rad/s}",
        "0}",
        "0}\n  -",
        (
            "driver[0].speed: positions are numbered along the motion of the first driver, so its speed must "
            "not be zero\n"
            "  found:   0"
        ),
    ),
    "speed of a slider for a crank": (
        blocks.TWO,
        "2 rad/s",
        "2 m/s",
        "2 m/",
        "driver[1].speed: expected here: an angular speed\n"
        "  found:   '2 m/s', a speed (2 m/s)\n"
        "  allowed: an angular speed, e.g. 82 rpm or 8.6 rad/s",
    ),
    "driver too fast to be followed": (
        blocks.TWO,
        "2 rad/s",
        "1e11 rad/s",
        "1e11",
        (
            "driver[1].speed: this driver is more than 100 times faster than the first one\n"
            "  found:   1e11 rad/s\n"
            "  allowed: write the fastest driver first in the list"
        ),
    ),
    "two drivers: no real assembly": (
        blocks.TWO,
        "[A, B], length: 200",
        "[A, B], length: 20",
        "90 deg,",
        (
            "sketch.at: group II(2,3) cannot be assembled when the driver coordinate is 90 deg\n"
            "  found:   the loop does not close: the gap is 80 mm\n"
            "  allowed: lengths with which the links can be joined, or another driver coordinate"
        ),
    ),
    "one driver for two freedoms": (
        blocks.TWO,
        "driver:\n  - {link: 1, speed: 1 rad/s}\n  - {link: 4, speed: 2 rad/s, at: 90 deg}\n",
        "driver: {link: 1, speed: 1 rad/s}\n",
        "2:",
        (
            "links.2: the mobility is not 1: these links are not sufficiently constrained: 2, 3, 4\n"
            "  found:   W = 3*4 - 2*5 = 2\n"
            "  allowed: W = 1, the number of drivers"
        ),
    ),
    "three drivers for two freedoms": (
        blocks.TWO,
        "  - {link: 4, speed: 2 rad/s, at: 90 deg}\n",
        "  - {link: 4, speed: 2 rad/s, at: 90 deg}\n  - {link: 2, on: 1, speed: 1 rad/s, at: 0}\n",
        "2,",
        (
            "driver[2].link: link 2 cannot be a driver: pairs or other drivers already determine its "
            "motion\n"
            "  found:   W = 3*4 - 2*5 = 2; links with redundant constraints: 0, 1, 2, 3, 4\n"
            "  allowed: W = 3"
        ),
    ),
    "two drivers for one freedom": (
        blocks.SLIDER,
        "driver: {link: 1, speed: 60 rpm}",
        "driver: [{link: 1, speed: 60 rpm}, {link: 3, speed: 1 m/s, at: 160}]",
        "3,",
        (
            "driver[1].link: link 3 cannot be a driver: pairs or other drivers already determine its "
            "motion\n"
            "  found:   W = 3*3 - 2*4 = 1; links with redundant constraints: 0, 1, 2, 3\n"
            "  allowed: W = 2"
        ),
    ),
    "driver on a link of a truss": (
        blocks.LOCKED,
        "driver: {link: 1",
        "driver: {link: 4",
        "4,",
        (
            "driver.link: link 4 cannot be a driver: pairs or other drivers already determine its "
            "motion\n"
            "  found:   W = 3*5 - 2*7 = 1; links with redundant constraints: 0, 4, 5\n"
            "  allowed: W = 1"
        ),
    ),
    "one of two drivers on a link of a truss": (
        blocks.LOCKED,
        "driver: {link: 1, speed: 1 rad/s}",
        "driver: [{link: 1, speed: 1 rad/s}, {link: 5, speed: 1 rad/s, at: 0}]",
        "5,",
        (
            "driver[1].link: link 5 cannot be a driver: pairs or other drivers already determine its "
            "motion\n"
            "  found:   W = 3*5 - 2*7 = 1; links with redundant constraints: 0, 4, 5\n"
            "  allowed: W = 2"
        ),
    ),
    "ring of three wheels outside one another": (
        blocks.RING,
        "driver:",
        "driver:",
        "c:",
        (
            "gears.c: gear pair c contradicts the pairs before it: the gears lock each other\n"
            "  allowed: ratios and offsets that are compatible around the closed gear train, or one gear pair "
            "fewer"
        ),
    ),
    "two ratios between two wheels": (
        blocks.RING,
        "c: {between: [3, 1], ratio: 0.5}",
        "c: {between: [1, 2], ratio: 3}",
        "c:",
        (
            "gears.c: gear pair c contradicts the pairs before it: the gears lock each other\n"
            "  allowed: ratios and offsets that are compatible around the closed gear train, or one gear pair "
            "fewer"
        ),
    ),
    "cylinder that is not one": (
        blocks.CYLINDER,
        "link: 2, on: 1",
        "link: 3, on: 1",
        "3,",
        ("driver.link: link 3 has no suitable pair with link 1\n  found:   '3'\n  allowed: 0, 2"),
    ),
    "cylinder too long": (
        blocks.CYLINDER,
        "sketch: {at: 280, B: [250, 140]}",
        "sketch: {at: 700}",
        "700",
        (
            "sketch.at: group II(1,2,3) cannot be assembled when the driver coordinate is 700 mm\n"
            "  found:   the loop does not close: the gap is 250 mm\n"
            "  allowed: lengths with which the links can be joined, or another driver coordinate"
        ),
    ),
    "cylinder whose lever may lie on either side": (
        blocks.CYLINDER,
        "sketch: {at: 280, B: [250, 140]}",
        "sketch: {at: 280}",
        "sket",
        (
            "sketch: the sketch does not determine the assembly of group II(1,2,3); to see all assemblies, run "
            "tmm kinematics x.yaml --assemblies\n"
            "  allowed: add one of these to the sketch for the driver coordinate 280 mm: P: [86.8452, 49.5773] "
            "or [86.8452, -49.5773]; 1: 29.7207 deg or -29.7207 deg; B: [243.167, 138.816] or [243.167, "
            "-138.816]; 2: 29.7207 deg or -29.7207 deg"
        ),
    ),
    "cylinder in line with its lever": (
        blocks.CYLINDER,
        "sketch: {at: 280, B: [250, 140]}",
        "sketch: {at: 450, B: [450, 0]}",
        "450",
        (
            "sketch.at: in the sketch group II(1,2,3) is in a dead position\n"
            "  found:   450 mm\n"
            "  allowed: another driver coordinate"
        ),
    ),
    "working stroke of a cylinder": (
        blocks.CYLINDER,
        "{at: [200, 250, 300, 350, 400]}",
        "{count: 5, from: working stroke}",
        "from",
        (
            "positions.from: `from` is allowed only for a crank: the positions of a driving slider run from "
            "one end of its stroke to the other\n"
            "  found:   working stroke\n"
            "  allowed: driver: {stroke: [first, last]}, or positions: {at: [...]}"
        ),
    ),
    "class III group without real assembly": (
        blocks.TRIAD,
        "[C, E], length: 90",
        "[C, E], length: 900",
        "90 d",
        (
            "sketch.at: group III(2,3,4,5) cannot be assembled when the driver coordinate is 90 deg\n"
            "  found:   the loop does not close at any position\n"
            "  allowed: lengths with which the links can be joined, or another driver coordinate"
        ),
    ),
    "class III group with a flat middle link": (
        blocks.TRIAD,
        "D: [40, 60]}}",
        "D: [40, 0]}}",
        "90 d",
        (
            "sketch.at: group III(2,3,4,5) cannot be assembled when the driver coordinate is 90 deg\n"
            "  found:   the loop does not close at any position\n"
            "  allowed: lengths with which the links can be joined, or another driver coordinate"
        ),
    ),
    "class III group that the sketch leaves open": (
        blocks.TRIAD,
        "sketch: {at: 90 deg, B: [110, 60], C: [190, 50], D: [155, 115]}",
        "sketch: {at: 90 deg}",
        "sket",
        (
            "sketch: the sketch does not determine the assembly of group III(2,3,4,5); to see all assemblies, "
            "run tmm kinematics x.yaml --assemblies\n"
            "  allowed: add one of these to the sketch for the driver coordinate 90 deg: B: [119.322, 52.7353] "
            "or [104.675, 98.679]; 2: 6.09211 deg or 29.2743 deg; C: [199.275, 49.9971] or [139.56, 26.6859]; "
            "D: [161.352, 111.331] or [176.112, 88.8464]"
        ),
    ),
}


def changed(text, old, new):
    assert old in text
    return text.replace(old, new, 1)


@pytest.mark.parametrize("case", CASES)
def test_one_error_that_names_links_and_group(case):
    base, old, new, at, message = CASES[case]
    text = changed(base, old, new)
    assert refusal(text) == f"x.yaml:{place(text, at)}: {message}"


def test_the_command_ends_with_2_and_writes_nothing(tmp_path):
    names = (
        "axes too far apart for the module",
        "ring of three wheels outside one another",
        "driver on a link of a truss",
        "class III group without real assembly",
        "law that does not come back",
        "spring in a hinge",
    )
    files = []
    for number, name in enumerate(names):
        base, old, new, _, _ = CASES[name]
        files.append(tmp_path / f"{number}.yaml")
        files[-1].write_text(changed(base, old, new), encoding="utf-8")
    done = tmm("run", *files, "-o", tmp_path / "out")
    assert (done.returncode, done.stdout, done.stderr.count("error: ")) == (2, "", len(names))
    assert not (tmp_path / "out").exists()
    told = json.loads(tmm("forces", files[2], "--json").stdout)
    assert (told["error"]["path"], told["error"]["line"]) == (["driver", "link"], 10)
