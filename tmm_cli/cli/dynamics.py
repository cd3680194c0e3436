"""`tmm dynamics`."""

from __future__ import annotations

from tmm_cli.cli.common import Files, Json, Out, Position, Settings, Variant, Variants, WithDigits, each
from tmm_cli.cli.opening import opened, variant_settings
from tmm_cli.cli.reporting import report
from tmm_cli.language import _
from tmm_cli.problem import ProblemError
from tmm_cli.synthesis import solve

SHOWN = ("dynamics", "law-of-motion", "balancing", "shaking")


def dynamics(
    files: Files,
    as_json: Json = False,
    out: Out = None,
    position: Position = None,
    digits: WithDigits = False,
    settings: Settings = None,
    variants: Variants = None,
    variant: Variant = None,
) -> None:
    """Law of motion: what drives the machine, its flywheel, speeds of the driver; and balancing."""

    def work(file: str) -> int:
        problem = opened(file, variant_settings(file, variants, variant, settings), position, digits).whole
        if problem.dynamics is None and problem.balancing is None:
            missing = ProblemError(
                _("nothing is asked of the law of motion or of balancing"),
                path=("dynamics",),
                allowed="dynamics: {delta: 1/30}, balancing: {counterweights: {1: {}}}",
            )
            raise missing.located(problem.file, problem.source)
        return report(solve(problem, "forces", position), SHOWN, as_json, out, digits)

    each(files, work, as_json=as_json, out=out)
