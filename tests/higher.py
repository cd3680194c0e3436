"""Small linkages with wheels, racks, cams, cylinders, springs, friction and several drivers, as problem files."""

from __future__ import annotations

PROBLEMS: dict[str, str] = {
    "gear": """tmm: 1
title: Press with a pair of wheels before its crank
units: {length: mm, angle: deg}
points: {O: [0, 0], C: [180, 0]}
guides: {x: {through: [180, 0], angle: 90}}
links:
  1: {name: pinion, points: {O: [0, 0], M: [30, 0]}}
  2: {name: wheel and crank, points: [C, A], length: 80}
  3: {name: rod, points: [A, B], length: 280}
  4: {name: ram, points: [B], slides: {on: x}}
gears: {g: {between: [1, 2], teeth: [20, 40], module: 6}}
driver: {link: 1, speed: 120 rpm}
sketch: {at: 0 deg, A: [260, 0], B: [180, 270]}
masses:
  2: {mass: 8 kg, inertia: 0.06, centre: C}
  3: {mass: 5 kg, inertia: 0.03, centre: {on: AB, at: 0.4}}
  4: {mass: 12 kg}
loads: {F: {on: 4, force: [0, -1500], when: working stroke}}
output: 4
positions: {count: 24, detail: [4]}
""",
    "inner": """tmm: 1
title: Inner gear pair drives a four-bar
units: {length: mm, angle: deg}
points: {O: [0, 0], C: [60, 0], D: [330, -20]}
links:
  1: {name: pinion, points: [O]}
  2: {name: ring, points: [C, A], length: 70}
  3: {points: [A, B], length: 260}
  4: {points: [D, B], length: 150}
gears: {g: {between: [1, 2], radii: [60, 120], inner: true}}
driver: {link: 1, speed: 120 rpm}
sketch: {at: 0 deg, A: [130, 0], B: [310, 130]}
masses:
  2: {mass: 8 kg, inertia: 0.06, centre: C}
  3: {mass: 5 kg, inertia: 0.03, centre: {on: AB, at: 0.4}}
  4: {mass: 3 kg, inertia: 0.02, centre: {on: DB}}
loads: {M: {on: 4, moment: -40}}
output: 4
positions: {count: 12, detail: [3]}
""",
    "planet": """tmm: 1
title: Dwell press, a planet that rolls on a fixed wheel drives the ram
units: {length: mm, angle: deg}
points: {O: [0, 0]}
guides: {y: {through: [0, 0], angle: 0}}
links:
  1: {name: carrier, points: [O, A], length: 120}
  2: {name: planet, points: [A, B], length: 40}
  3: {name: rod, points: [B, C], length: 400}
  4: {name: ram, points: [C], slides: {on: y}}
gears: {g: {between: [0, 2], carrier: 1, radii: [180, 60], inner: true}}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 0 deg, B: [160, 0], C: [560, 0]}
masses:
  1: {mass: 2 kg, inertia: 0.01, centre: {on: OA}}
  2: {mass: 3 kg, inertia: 0.004, centre: A}
  3: {mass: 4 kg, inertia: 0.05, centre: {on: BC}}
  4: {mass: 10 kg}
loads: {F: {on: 4, force: [-900, 0]}}
output: 4
positions: {count: 12, detail: [2]}
""",
    "rack": """tmm: 1
title: Rack and pinion after a crank-slider
units: {length: mm, angle: deg}
points: {O: [0, 0], D: [330, 50]}
guides: {x: {through: [0, 0], angle: 0}}
links:
  1: {points: [O, A], length: 60}
  2: {points: [A, B], length: 220}
  3: {name: rack, points: {B: [0, 0], E: [120, 0]}, slides: {on: x}}
  4: {name: pinion, points: [D, P], length: 90}
racks: {k: {wheel: 4, rack: 3, radius: 50}}
driver: {link: 1, speed: 90 rpm}
sketch: {at: 40 deg, B: [255, 0], P: [400, 80]}
masses:
  2: {mass: 2 kg, inertia: 0.01, centre: {on: AB}}
  3: {mass: 4 kg, centre: B}
  4: {mass: 3 kg, inertia: 0.01, centre: D}
loads: {M: {on: 4, moment: 12}}
output: 4
positions: {count: 12, detail: [2]}
""",
    "flat follower": """tmm: 1
title: Cam with a sliding follower drives a lever
units: {length: mm, angle: deg}
points: {O: [0, 0], D: [120, 230]}
guides: {y: {through: [0, 0], angle: 90}}
links:
  1: {name: cam, points: [O]}
  2: {name: follower, points: {A: [0, 0], B: [0, 80]}, slides: {on: y}}
  3: {points: [B, C], length: 90}
  4: {points: [D, C], length: 90}
cams:
  c:
    cam: 1
    follower: 2
    offset: 60
    law: [{over: 120, rise: 40, law: sine}, {over: 60}, {over: 100, rise: -40, law: 3-4-5}, {over: 80}]
driver: {link: 1, speed: 60 rpm}
sketch: {at: 0 deg, B: [0, 140], C: [40, 230]}
masses:
  2: {mass: 2 kg, centre: A}
  3: {mass: 1 kg, inertia: 0.002, centre: {on: BC}}
  4: {mass: 2 kg, inertia: 0.004, centre: {on: DC}}
loads: {M: {on: 4, moment: 9}}
springs: {s: {between: [0, 2], at: [[0, 260], B], rate: 3 N/mm, free: 160}}
output: 4
positions: {count: 12, detail: [2]}
""",
    "swinging follower": """tmm: 1
title: Cam with a swinging follower and a slider
units: {length: mm, angle: deg}
points: {O: [0, 0], D: [150, 40]}
guides: {x: {through: [0, 190], angle: 0}}
links:
  1: {name: cam, points: [O]}
  2: {name: lever, points: [D, A], length: 130}
  3: {points: [A, B], length: 160}
  4: {points: [B], slides: {on: x}}
cams:
  c:
    cam: 1
    follower: 2
    offset: 110
    law: [{over: 120, rise: 25, law: cosine}, {over: 60}, {over: 100, rise: -25, law: 4-5-6-7}, {over: 80}]
driver: {link: 1, speed: 60 rpm}
sketch: {at: 0 deg, A: [105, 162], B: [260, 190]}
masses:
  2: {mass: 2 kg, inertia: 0.01, centre: {on: DA}}
  3: {mass: 1 kg, inertia: 0.002, centre: {on: AB}}
  4: {mass: 3 kg}
loads: {F: {on: 4, force: [-60, 0]}}
springs: {s: {between: [0, 2], torsion: 6 N*m/rad, free: 170}}
output: 4
positions: {count: 12, detail: [2]}
""",
    "cylinder": """tmm: 1
title: Lever lifted by a swinging cylinder, balanced by a spring
units: {length: mm, angle: deg}
points: {O: [0, 0], D: [350, 40]}
links:
  1: {name: cylinder, points: {O: [0, 0], E: [180, 0]}}
  2: {name: piston, points: [A], slides: {on: 1, through: O, angle: 0}}
  3: {name: lever, points: {D: [0, 0], A: [-120, 0], B: [280, 0]}}
springs: {s: {between: [0, 3], at: [[520, -120], [200, 0]], rate: 2 N/mm, free: 120, preload: 20 N}}
driver: {link: 2, on: 1, speed: 0.1 m/s}
sketch: {at: 260, A: [240, 90], 1: 20 deg}
masses:
  1: {mass: 3 kg, inertia: 0.02, centre: {on: OE}}
  2: {mass: 1 kg, inertia: 0.001}
  3: {mass: 6 kg, inertia: 0.1, centre: [80, 0]}
loads: {F: {on: 3, at: B, force: [0, -400]}}
output: 3
positions: {count: 9, detail: [4]}
""",
    "two cylinders": """tmm: 1
title: Arm with two swinging cylinders
units: {length: mm, angle: deg}
points: {O: [0, 0], P: [150, -100]}
links:
  1: {name: boom, points: {O: [0, 0], A: [200, -30], B: [500, 0], C: [180, 60]}}
  2: {name: stick, points: {B: [0, 0], D: [-80, 0], T: [300, 0]}}
  3: {name: cylinder, points: {P: [0, 0], Q: [120, 0]}}
  4: {name: piston, points: [A], slides: {on: 3, through: P, angle: 0}}
  5: {name: cylinder, points: {C: [0, 0], R: [150, 0]}}
  6: {name: piston, points: [D], slides: {on: 5, through: C, angle: 0}}
driver:
  - {link: 4, on: 3, speed: 0.05 m/s}
  - {link: 6, on: 5, speed: 0.02 m/s, at: 290}
sketch: {at: 180, A: [190, 60], B: [450, 200], T: [650, -20], C: [150, 130], 1: 25 deg, 3: 75 deg, 5: 20 deg}
masses: {1: {mass: 20 kg, inertia: 0.5, centre: [240, 0]}, 2: {mass: 10 kg, inertia: 0.3, centre: [100, 0]}}
loads: {F: {on: 2, at: T, force: [0, -500]}}
output: [1, 2]
positions: {count: 7, detail: [3]}
""",
    "two cranks": """tmm: 1
title: Five-bar with two cranks
units: {length: mm, angle: deg}
points: {O: [0, 0], E: [200, 0]}
links:
  1: {points: [O, A], length: 60}
  2: {points: [A, B], length: 180}
  3: {points: [B, C], length: 180}
  4: {points: [E, C], length: 60}
driver:
  - {link: 1, speed: 60 rpm}
  - {link: 4, speed: 120 rpm, turns: cw, at: 90 deg}
sketch: {at: 30 deg, B: [130, 180], C: [200, 60]}
masses: {2: {mass: 2 kg, inertia: 0.005, centre: {on: AB}}, 3: {mass: 2 kg, inertia: 0.005, centre: {on: BC}}}
loads: {F: {on: 3, at: B, force: [0, -100]}}
output: [2, 3]
positions: {count: 12, detail: [2]}
""",
    "class III": """tmm: 1
title: Press with a group of class III
units: {length: mm, angle: deg}
points: {O: [0, 0], F: [420, 20]}
guides: {y: {through: [280, 0], angle: 90}}
links:
  1: {points: [O, A], length: 70}
  2: {points: [A, B], length: 200}
  3: {name: beam, points: {B: [0, 0], C: [150, 0], D: [90, -60]}}
  4: {points: [C, F], length: 160}
  5: {name: ram, points: [D], slides: {on: y}}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 90 deg, B: [185, 140], C: [335, 150], D: [280, 80]}
masses:
  2: {mass: 3 kg, inertia: 0.02, centre: {on: AB}}
  3: {mass: 5 kg, inertia: 0.03, centre: [80, -20]}
  5: {mass: 20 kg}
loads: {F1: {on: 5, force: [0, 2000]}}
output: 5
positions: {count: 12, detail: [2]}
""",
    "class IV": """tmm: 1
title: Group of class IV
units: {length: mm, angle: deg}
points: {O: [0, 0], F: [360, 40]}
links:
  1: {points: [O, A], length: 40}
  2: {points: {A: [0, 0], B: [160, 20], C: [150, 130]}}
  3: {points: [B, D], length: 140}
  4: {points: [C, E], length: 130}
  5: {points: {F: [0, 0], D: [-70, 20], E: [-60, 120]}}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 0 deg, A: [40, 0], B: [195, 40], C: [180, 140], D: [290, 60], E: [300, 160]}
masses: {2: {mass: 3 kg, inertia: 0.02, centre: [100, 50]}, 5: {mass: 3 kg, inertia: 0.02, centre: [-40, 50]}}
loads: {M: {on: 5, moment: -20}}
output: 5
positions: {count: 12, detail: [2]}
""",
    "friction": """tmm: 1
title: Crank-slider with friction
units: {length: mm, angle: deg}
points: {O: [0, 0]}
guides: {x: {through: [0, 0], angle: 0}}
links:
  1: {points: [O, A], length: 80}
  2: {points: [A, B], length: 260}
  3: {points: [B], slides: {on: x}}
friction: {coefficient: 0.1, radius: 15}
driver: {link: 1, speed: 120 rpm}
sketch: {at: 0 deg, B: [340, 0]}
masses: {2: {mass: 3 kg, inertia: 0.02, centre: {on: AB}}, 3: {mass: 5 kg}}
loads: {F: {on: 3, force: [500, 0], when: working stroke}}
output: {link: 3, working: backward}
positions: {count: 12, detail: [2]}
""",
}
