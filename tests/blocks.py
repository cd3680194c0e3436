"""Small problem files with every block beside links: gears, racks, cams, springs, friction, several drivers."""

TRIAD = """tmm: 1
units: {length: mm}
points: {O: [0, 0], E: [200, -40], F: [260, 160]}
links:
  1: {points: [O, A], length: 40}
  2: {points: [A, B], length: 120}
  3: {points: {B: [0, 0], C: [80, 0], D: [40, 60]}}
  4: {points: [C, E], length: 90}
  5: {points: [D, F], length: 110}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 90 deg, B: [110, 60], C: [190, 50], D: [155, 115]}
masses: {3: {mass: 2 kg, inertia: 0.01, centre: [40, 20]}}
"""
GEARED = """tmm: 1
units: {length: mm}
points: {O: [0, 0], D: [150, 0]}
links:
  1: {points: [O, A], length: 40}
  2: {points: [A, B], length: 160}
  3: {points: [B, C], length: 160}
  4: {points: [D, C], length: 40}
gears:
  z: {between: [1, 4], teeth: [30, 30], module: 5 mm}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 90 deg, B: [139, 120]}
masses: {2: {mass: 2 kg, inertia: 0.01, centre: {on: AB}}}
"""
PLANET = """tmm: 1
units: {length: mm}
points: {O: [0, 0]}
links:
  1: {name: carrier, points: [O, A], length: 60}
  2: {name: planet, points: [A, B], length: 20}
gears:
  z: {between: [0, 2], carrier: 1, teeth: [40, 20]}
driver: {link: 1, speed: 60 rpm}
masses: {2: {mass: 2 kg, inertia: 0.01, centre: {on: AB}}}
"""
RACK = """tmm: 1
units: {length: mm}
points: {O: [0, 0]}
guides: {x: {through: [0, -50]}}
links:
  1: {points: [O], also: {A: [50, 0]}}
  2: {points: [B], slides: {on: x}}
racks:
  k: {wheel: 1, rack: 2, radius: 50}
driver: {link: 1, speed: 60 rpm}
loads: {F: {on: 2, force: [10, 0]}}
"""
CAM = """tmm: 1
units: {length: mm}
points: {O: [0, 0]}
guides: {y: {through: [0, 0], angle: 90 deg}}
links:
  1: {points: [O], also: {A: [50, 0]}}
  2: {points: [B], slides: {on: y}}
cams:
  c:
    cam: 1
    follower: 2
    offset: 30
    law: [{over: 120 deg, rise: 20}, {over: 60 deg}, {over: 120 deg, rise: -20, law: cosine}, {over: 60 deg}]
driver: {link: 1, speed: 60 rpm}
masses: {2: {mass: 2 kg}}
"""
CYLINDER = """tmm: 1
units: {length: mm}
points: {O: [0, 0], D: [300, 0]}
links:
  1: {name: cylinder, points: [O, P], length: 100}
  2: {name: piston, points: [B], slides: {on: 1, along: OP}}
  3: {name: lever, points: [D, B], length: 150, also: {K: [250, 0]}}
driver: {link: 2, on: 1, speed: 50 mm/s}
sketch: {at: 280, B: [250, 140]}
springs: {s: {between: [0, 3], at: [O, K], rate: 2 N/mm, free: 100}}
positions: {at: [200, 250, 300, 350, 400]}
loads: {F: {on: 3, at: K, force: [0, -100]}}
"""
TWO = """tmm: 1
units: {length: mm}
points: {O: [0, 0], D: [300, 0]}
links:
  1: {points: [O, A], length: 100}
  2: {points: [A, B], length: 200}
  3: {points: [B, C], length: 200}
  4: {points: [D, C], length: 100}
driver:
  - {link: 1, speed: 1 rad/s}
  - {link: 4, speed: 2 rad/s, at: 90 deg}
sketch: {at: 90 deg, B: [150, 230]}
masses: {2: {mass: 2 kg, inertia: 0.01, centre: {on: AB}}}
"""
SLIDER = """tmm: 1
units: {length: mm}
points: {O: [0, 0]}
guides: {x: {through: [0, 0]}}
links:
  1: {points: [O, A], length: 50}
  2: {points: [A, B], length: 150}
  3: {points: [B], slides: {on: x}}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 60 deg, B: [160, 0]}
loads: {F: {on: 3, force: [-1000, 0]}}
friction: {coefficient: 0.1, radius: 5}
"""
LOCKED = """tmm: 1
units: {length: mm}
points: {O: [0, 0], D: [300, 0], E: [400, 0]}
links:
  1: {points: [O, A], length: 100}
  2: {points: [A, B], length: 250}
  3: {points: [B, D], length: 200}
  4: {points: [D, P], length: 100}
  5: {points: [P, E], length: 80}
driver: {link: 1, speed: 1 rad/s}
sketch: {at: 60 deg, B: [274, 198], P: [368, 73]}
"""
RING = """tmm: 1
units: {length: mm}
points: {O: [0, 0], P: [100, 0], Q: [50, 80]}
links:
  1: {points: [O], also: {A: [30, 0]}}
  2: {points: [P], also: {B: [30, 0]}}
  3: {points: [Q], also: {C: [30, 0]}}
gears:
  a: {between: [1, 2], ratio: 1}
  b: {between: [2, 3], ratio: 2}
  c: {between: [3, 1], ratio: 0.5}
driver: {link: 1, speed: 1 rad/s}
"""
EVERYTHING = {
    "triad": TRIAD,
    "geared": GEARED,
    "planet": PLANET,
    "rack": RACK,
    "cam": CAM,
    "cylinder": CYLINDER,
    "two": TWO,
    "slider": SLIDER,
}
