"""Sentences are said in the language of who reads them, and files for machines in English."""

import ast
from collections.abc import Iterator

import pytest

from tests import messages
from tmm_cli.language import N_, Phrase, _, language, spoken, translated


def said_at_import(tree: ast.AST) -> Iterator[int]:
    """Lines on which `_()` or `translated()` is called when the module is imported."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            now = [*node.args.defaults, *(d for d in node.args.kw_defaults if d), *getattr(node, "decorator_list", [])]
            for part in now:
                yield from said_at_import(ast.Expression(part))
            continue
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("_", "translated"):
            yield node.lineno
        yield from said_at_import(node)


def test_no_sentence_is_said_when_a_module_is_imported():
    # who will read it is not known yet: it is marked N_() there, and said where it is used
    found = [(file.name, line) for file in messages.sources() for line in said_at_import(ast.parse(file.read_text()))]
    assert found == []


def test_a_phrase_is_its_english_sentence_until_it_is_translated():
    phrase = Phrase("output angle {number}", number=3)
    assert phrase == "output angle 3"
    assert translated(phrase) == "output angle 3"
    assert translated(N_("a {brace} that is meant")) == "a {brace} that is meant"


def test_a_language_is_spoken_inside_only():
    with spoken("ru"):
        assert language() == "ru"
        with spoken("en"):
            assert _("position") == "position"
        assert language() == "ru"
    assert language() == "en"


@pytest.mark.parametrize("tongue", messages.TRANSLATED)
def test_a_translation_has_the_fields_of_its_message(tongue):
    for message in messages.catalogue(tongue):
        if message.id and message.string:
            assert messages.fields(message.string) == messages.fields(message.id), message.id


@pytest.mark.parametrize("tongue", messages.TRANSLATED)
def test_what_the_program_reads_is_made_of_the_catalogue(tongue):
    assert messages.read(tongue) == messages.translations(messages.catalogue(tongue))
