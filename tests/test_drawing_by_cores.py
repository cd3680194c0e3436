"""Many sheets are drawn by several processes: the same files in the same order, whatever becomes of a process."""

import os
import time
from functools import partial

import pytest
from bank import moved

from tmm_cli.cli import LEAST_JOBS, drawing, run_on_all_cores
from tmm_cli.drawing.layout import large_sheet_files
from tmm_cli.drawing.run import sheet_files, sheet_jobs


@pytest.fixture(autouse=True)
def _two_cores(monkeypatch):
    monkeypatch.setattr(drawing.os, "cpu_count", lambda: 2)


def numbered(n):
    return [(f"{n}.svg", b"")], set()


def ending(parent, n):
    """Ends its process, unless it is this one."""
    if os.getpid() != parent:
        os._exit(1)
    return numbered(n)


def lasting(folder, n):
    time.sleep(0.05)
    (folder / str(n)).touch()
    return numbered(n)


def test_several_processes_write_the_same_files_in_the_same_order():
    results = moved("sine")
    assert len(sheet_jobs(results)) >= LEAST_JOBS
    assert list(sheet_files(results, runner=run_on_all_cores)) == list(sheet_files(results))


def test_large_sheets_are_the_same_whoever_draws_and_writes_them():
    results = moved("sine")
    asked = (results, "A3", ["pdf", "svg"], lambda note: None)
    assert list(large_sheet_files(*asked, run_on_all_cores, all_positions=False)) == list(
        large_sheet_files(*asked, all_positions=False)
    )


def test_jobs_of_a_process_that_was_ended_are_done_here():
    jobs = [partial(numbered, 0), *(partial(ending, os.getpid(), n) for n in range(1, LEAST_JOBS))]
    assert [name for written, __ in run_on_all_cores(jobs) for name, __ in written] == [
        f"{n}.svg" for n in range(LEAST_JOBS)
    ]


def test_who_stops_before_the_end_does_not_wait_for_all(tmp_path):
    found = run_on_all_cores([partial(lasting, tmp_path, n) for n in range(40)])
    next(found)
    found.close()
    assert 0 < len(list(tmp_path.iterdir())) < 40
