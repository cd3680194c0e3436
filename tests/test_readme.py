"""The READMEs say what the commands print: example, excerpt, library lines, links, and a row for every problem."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from bank import IN_FOLDERS
from test_commands import tmm

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
PAGES = ("README.md", "problems/README.md", "tmm_cli/README.md", "tmm_cli/bench/README.md")


def block(language: str, number: int = 0, text: str = README) -> str:
    """A block of code of a README."""
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.M | re.S)[number]


def test_the_example_is_the_file_that_the_first_command_reads():
    file = (ROOT / "problems/shaper.yaml").read_text(encoding="utf-8")
    assert block("yaml") == file[file.index("tmm: 1") :]


def test_the_excerpt_is_what_the_first_command_prints(tmp_path):
    command = [sys.executable, "-m", "tmm_cli", "run", "problems/shaper.yaml", "--no-drawings", "-o", str(tmp_path)]
    done = subprocess.run(
        command, cwd=ROOT, env={**os.environ, "COLUMNS": "120"}, capture_output=True, encoding="utf-8", check=True
    )
    printed = [line.rstrip() for line in done.stdout.splitlines()]
    excerpt = block("text").splitlines()
    assert len(excerpt) == 6
    assert "\n".join(excerpt) in "\n".join(printed)


def test_the_library_lines_run_and_give_what_their_comments_say(monkeypatch):
    monkeypatch.chdir(ROOT)
    names: dict[str, object] = {}
    exec(block("python", text=(ROOT / "tmm_cli/README.md").read_text(encoding="utf-8")), names)
    assert f"{names['results'].strokes.k:.3f}" == "1.511"
    assert names["batch"](names["results"].motion.q)["T.1"] == pytest.approx(names["results"].reactions.balance.moment)


def test_the_teachers_command_runs_as_it_stands(tmp_path):
    call = block("sh", 3).replace("\\\n", " ").splitlines()[-1].split()
    done = tmm(*call[1:-1], tmp_path / "marks")
    assert done.returncode == 1, "one of the made-up sheets is broken"
    assert "graded: 11" in done.stderr and "impossible to grade: 1" in done.stderr
    assert {"marks.csv", "marks.xlsx", "feedback", "group.png"} <= {one.name for one in (tmp_path / "marks").iterdir()}


@pytest.mark.parametrize("page", PAGES)
def test_what_a_page_links_to_is_there(page):
    text = (ROOT / page).read_text(encoding="utf-8")
    links = re.findall(r"\]\(([^)#]+)\)", text)
    assert links
    for link in links:
        assert (ROOT / page).parent.joinpath(link).exists(), link


def test_every_problem_of_the_bank_has_its_row():
    rows = (ROOT / "problems/docs/bank.md").read_text(encoding="utf-8")
    for name in [path.stem for path in (ROOT / "problems").glob("*.yaml")] + IN_FOLDERS:
        assert f"(../{name}.yaml)" in rows, name
