"""Writes the best known of `tmm bench synthesis`, the least of 10 long runs: python tests/write_synthesis_best.py.

A long run has 4 times the candidates in 4 times the generations of an ordinary one, and another seed.
"""

from __future__ import annotations

import json
from pathlib import Path

from tmm_cli.bench.searches import long_runs

BEST = Path(__file__).parent.parent / "tmm_cli" / "bench" / "data" / "synthesis" / "best.json"

if __name__ == "__main__":
    BEST.write_text(json.dumps(long_runs(print), indent=1) + "\n", encoding="utf-8")
