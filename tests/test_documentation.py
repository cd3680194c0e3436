"""The pages in problems/docs: links, commands, files and output are right, references are what the program says."""

from __future__ import annotations

import re
from pathlib import Path

import documentation
import pytest
import yaml
from documentation import COMMAND, REFERENCES, files_of, folder_of, pages, parsed, run, shows, steps_of
from reference_of_format import DOCS, PROBLEMS, ROOT, missing_words, slug

from tmm_cli import load

PAGES = [*pages(), *(DOCS / name for name in REFERENCES), PROBLEMS / "README.md"]
LINK = re.compile(r"\]\(([^)\s]+)\)")


def text_of(page: Path) -> str:
    return page.read_text(encoding="utf-8")


def named(page: Path) -> str:
    return page.name


@pytest.mark.parametrize("name", REFERENCES)
def test_a_reference_is_what_the_program_says(name):
    assert text_of(DOCS / name) == documentation.reference(name), f"run `{COMMAND}`, read the difference, commit it"


def test_every_key_has_its_unit_its_meaning_and_an_example():
    assert not missing_words()


def anchors(page: Path) -> set[str]:
    """Anchors of the headings of a page, as GitHub makes them."""
    prose = re.sub(r"^```.*?^```$", "", text_of(page), flags=re.M | re.S)
    return {slug(re.sub(r"[`*]", "", heading)) for heading in re.findall(r"^#+ (.*)$", prose, re.M)}


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_every_link_leads_somewhere(page):
    for link in LINK.findall(text_of(page)):
        if link.startswith(("http:", "https:", "mailto:")):
            continue
        path, __, anchor = link.partition("#")
        target = page.parent / path if path else page
        assert target.exists(), link
        if anchor:
            assert anchor in anchors(target), link


@pytest.mark.parametrize("page", pages(), ids=named)
def test_every_block_of_yaml_is_yaml_and_every_file_loads(page, tmp_path):
    for kind, block in documentation.BLOCK.findall(text_of(page)):
        if kind == "yaml":
            assert yaml.safe_load(block) is not None
    for name, content in files_of(text_of(page)).items():
        if "task: optimal" in content or "\nstructure:" in content:
            continue  # a search, or a chain: its command runs it
        (tmp_path / name).write_text(content, encoding="utf-8")
        assert load(str(tmp_path / name)).linkage is not None


@pytest.mark.parametrize("page", pages(), ids=named)
def test_every_command_runs_and_prints_what_the_page_shows(page):
    text = text_of(page)
    with folder_of(text) as folder:
        for step in steps_of(text):
            if not step.runs:
                assert all(parsed(command) for command in step.commands if command.startswith("tmm"))
                continue
            assert run(step, folder) == step.exit_code, "\n".join((*step.commands, *step.printed[-5:]))
            if step.shown:
                shown = text[slice(*step.shown)]
                assert shows(shown, step.printed), f"{step.commands}: run `{COMMAND} {page.name}`, read the difference"
        for picture in documentation.pictures_of(text):
            same = documentation.same_picture(DOCS / picture, folder / "outputs" / picture)
            assert same, f"{picture}: run `{COMMAND} {page.name}` and look at it"


def test_every_command_of_the_readme_is_one_that_the_program_takes():
    text = text_of(ROOT / "README.md").replace("\\\n", " ")
    calls = re.findall(r"\.venv/bin/(tmm [^\n`&]*)", text)
    assert len(calls) > 4
    assert all(parsed(call) for call in calls)


def test_the_readme_of_the_package_names_only_paths_that_exist():
    text = text_of(ROOT / "tmm_cli" / "README.md")
    named_paths = set(re.findall(r"`((?:[\w.-]+/)+[\w.-]*|[\w.-]+\.(?:py|pyi|txt|md|toml))`", text))
    named_paths |= set(re.findall(r"(?<= )tests/[\w/]+\.py", text))
    missing = [
        path for path in sorted(named_paths) if not (ROOT / "tmm_cli" / path).exists() and not (ROOT / path).exists()
    ]
    assert len(named_paths) > 50
    assert missing == ["__init__.pyi"], "the stub of any subpackage"
