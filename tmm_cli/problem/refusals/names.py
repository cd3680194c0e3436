"""Refusals of names and numbers that nothing in the file has, and of one setting of several."""

from __future__ import annotations

from tmm_cli.errors import NotOnFrameError, SettingError, UnknownNameError, UnknownPositionError
from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError, no_position, unknown_name
from tmm_cli.problem.record import Problem
from tmm_cli.problem.refusals.wording import worded


@worded.register
def _position(error: UnknownPositionError, problem: Problem) -> ProblemError:
    return no_position(error.number, error.count, "positions")


@worded.register
def _name(error: UnknownNameError, problem: Problem) -> ProblemError:
    what = _("there is no such point, link or centre of mass")
    return unknown_name(error.name, error.allowed, what, path=("links",), key=True)


@worded.register
def _on_frame(error: NotOnFrameError, problem: Problem) -> ProblemError:
    what = _("this link cannot drive: it is not joined to the frame")
    return unknown_name(error.link, error.allowed, what, path=("links",), key=True)


@worded.register
def _setting(error: SettingError, problem: Problem) -> ProblemError:
    own = worded(error.error, problem)
    return ProblemError(own.message, path=error.path, found=own.found, allowed=own.allowed)
