"""The arguments of every subcommand: their help, their examples, one spelling each."""

from __future__ import annotations

import argparse
import re
import shlex
from importlib.util import find_spec

import pytest

from contactlab.cli import main as module
from contactlab.registration.manager import commands

COMMANDS = commands("contactlab")


def parser_of(command):
    (parser,) = (
        module._parser({command: COMMANDS[command]}, True)
        ._subparsers._group_actions[0]
        .choices.values()
    )
    return parser


def arguments(parser):
    """Return the arguments of a parser and of its own subcommands."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for inner in action.choices.values():
                yield from arguments(inner)
        elif not isinstance(action, argparse._HelpAction):
            yield action


@pytest.mark.parametrize("command", COMMANDS)
def test_every_argument_is_told_in_the_help(run, command):
    told = run(command, "--help").out
    for action in arguments(parser_of(command)):
        name = action.option_strings[0] if action.option_strings else action.metavar
        assert name in told or command == "plugins"
        assert action.help or action.metavar.startswith("FILE")
        if action.type:  # what it is called in the help says what to write
            assert action.metavar or action.type.__name__ == "finite"


@pytest.mark.parametrize("command", COMMANDS)
def test_the_examples_of_the_help_are_accepted(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    parser = parser_of(command)
    examples = re.findall(rf"^  contactlab {command}(.*)$", parser.epilog, re.MULTILINE)
    assert examples
    for line in examples:
        words = re.split(r" [>|] ", line)[0]
        if ".parquet" in words and find_spec("pyarrow") is None:
            continue
        assert parser.parse_args(shlex.split(words))


@pytest.mark.parametrize("command", COMMANDS)
def test_an_option_is_written_in_full(run, command):
    """A letter less could mean another option in a later version."""
    for action in arguments(parser_of(command)):
        for option in action.option_strings:
            ran = run(command, option[:-1], "x")
            assert ran.status == 2
            assert ran.out == ""


def test_the_arguments_before_a_command(run):
    told = run("--help").out
    assert "show the traceback of an error (before COMMAND)" in told
    assert "exit status: 0 success, 1 a run failed, 2 bad input, 130 interrupted" in told
    assert all(f"\n  {command} " in told for command in COMMANDS)
    headings = re.findall(r"^(\w[\w ]*):$", told, re.MULTILINE)
    assert headings[:4] == ["compute", "judge a law", "show", "take away"]
