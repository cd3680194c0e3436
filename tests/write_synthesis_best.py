"""Writes the best known of `tmm bench synthesis`, the least of 10 long runs: python tests/write_synthesis_best.py.

A long run has 4 times the candidates in 4 times the generations of an ordinary one, and another seed.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

from tmm_cli.bench import SEARCHED, load_candidates
from tmm_cli.synthesis import find_best

BEST = Path(__file__).parent.parent / "tmm_cli" / "bench" / "data" / "synthesis" / "best.json"

LONG_RUNS, LONGER = 10, 4  # for the best known: so many times the population in so many times the generations


def long_runs():
    """The best of long runs of SEARCHED, as `known` of tmm_cli.bench.searches reads it."""
    search = load_candidates(SEARCHED)
    population, generations = LONGER * search.population, LONGER * search.generations
    search.task = replace(search.task, population=population, generations=generations)
    runs = []
    for seed in range(101, 101 + LONG_RUNS):  # others than those that are measured against them
        print(f"{SEARCHED}, long run from seed {seed}")
        search.task = replace(search.task, seed=seed)
        one = find_best(search)
        runs.append(
            (one.missed, one.values[0], seed, [float(v) for v in one.numbers], population * len(one.evolved.history))
        )
    _, objective, seed, numbers, _ = min(runs)
    names = [parameter.name for parameter in search.task.parameters]
    return {
        "problem": SEARCHED,
        "objective": objective,
        "numbers": dict(zip(names, numbers, strict=True)),
        "seed": seed,
        "population": population,
        "generations": generations,
        "runs": [{"seed": s, "objective": f, "missed": m, "evaluations": n} for m, f, s, _, n in runs],
    }


if __name__ == "__main__":
    BEST.write_text(json.dumps(long_runs(), indent=1) + "\n", encoding="utf-8")
