"""What a synthesis asked is measured on the link that it found, whatever else that link drives."""

import json
import math

import pytest
from test_commands import tmm

DRIVES_A_ROCKER = """tmm: 1
units: {length: mm, angle: deg}
synthesis: {task: crank-slider, stroke: 120, k: 1.08, ratio: 3.5}
points: {O: [0, 0], D: [300, -200]}
guides: {x: {through: [0, -e]}}
links:
  1: {points: [O, A], length: r}
  2: {points: [A, B], length: l}
  3: {points: [B], slides: {on: x}}
  4: {points: [B, C], length: 150}
  5: {points: [C, D], length: 200}
driver: {link: 1, speed: 90 rpm}
sketch: {at: 60 deg, B: [r/2 + l, -e], C: [330, 0]}
output: 5
"""
DRIVES_A_SLIDER = """tmm: 1
units: {length: mm, angle: deg}
synthesis: {task: four-bar-by-k, l3: 250, psi1: 60, psi2: 110, k: 1.2, support: [400, 0]}
points: {A: [xA, yA], D: [400, 0]}
guides: {x: {through: [0, 300]}}
links:
  1: {points: [A, B], length: l1}
  2: {points: [B, C], length: l2}
  3: {points: [D, C], length: 250}
  4: {points: [C, E], length: 300}
  5: {points: [E], slides: {on: x}}
driver: {link: 1, speed: 60 rpm}
sketch: {at: phi2, C: [400 + 250*cos(110), 250*sin(110)], E: [650, 300]}
output: {link: 5, working: backward}
"""


@pytest.mark.parametrize(
    ("text", "asked", "output"), [(DRIVES_A_ROCKER, 0.12, "swing"), (DRIVES_A_SLIDER, math.radians(50), "slide")]
)
def test_a_synthesised_link_that_drives_the_output_is_measured_itself(tmp_path, text, asked, output):
    (tmp_path / "x.yaml").write_text(text)
    ended = tmm("kinematics", tmp_path / "x.yaml", "--json")
    assert ended.returncode == 0, ended.stderr
    found = json.loads(ended.stdout)
    assert found["output"]["kind"] == output
    measured = [m["measured"] for m in found["synthesis"]["measured"]]
    assert any(m == pytest.approx(asked, rel=1e-9) for m in measured)
