"""The option --lang: every command has it; what machines read has no language."""

from __future__ import annotations

import json
import os

import pytest
import typer
from typer.testing import CliRunner

from kinlab.cli import app
from kinlab.errors import OptionError
from kinlab.host.language import language


def run(*words, **settings):
    return CliRunner().invoke(app, words, **settings)


def commands(group, before=()):
    for name, command in group.commands.items():
        if hasattr(command, "commands"):
            yield from commands(command, (*before, name))
        else:
            yield (*before, name), command


def test_every_command_has_it():
    found = dict(commands(typer.main.get_command(app)))
    assert len(found) >= 15 and ("fivebar", "size") in found and ("check",) in found
    for name, command in found.items():
        assert [one.name for one in command.params].count("lang") == 1, name


def test_json_is_the_same_in_every_language():
    plain = run("check", "001.tau1", "--json", "--samples", "5")
    asked = run("check", "001.tau1", "--json", "--samples", "5", "--lang", "zh")
    told = run("check", "001.tau1", "--json", "--samples", "5", env={"KINLAB_LANG": "zh"})
    assert plain.exit_code == 0 and json.loads(plain.stdout)["ok"] is True
    assert asked.stdout == plain.stdout == told.stdout


def test_the_language_ends_with_the_command():
    assert run("list", "--lang=zh").exit_code == 0
    assert language() == "en" and os.environ["KINLAB_LANG"] == "en"


def test_a_language_that_we_do_not_speak_is_refused():
    refused = run("list", "--lang", "fr")
    assert isinstance(refused.exception, OptionError) and "'fr'" in str(refused.exception)
    assert run("list", "--lang").exit_code == 2


@pytest.mark.parametrize("words", [("--help",), ("check", "--help")])
def test_help_is_given_in_any_language(words):
    assert run(*words, "--lang", "zh").exit_code == 0
    assert run("--lang", "zh", *words).exit_code == 0
