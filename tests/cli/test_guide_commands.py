"""The commands that the guide shows run as they stand."""

import re
import shlex
import shutil
from importlib import import_module
from pathlib import Path

import pytest

from contactlab.cli.guide import text
from contactlab.registration.manager import commands
from contactlab.registration.names import KINDS, full_name, kind_of
from contactlab.registry.registry import REGISTRY

COMMANDS = commands("contactlab")
#: Commands of folders that can be taken out.
OF_FOLDERS = {"explore", "fit", "report"}
EXAMPLES = Path(__file__).parents[2] / "examples"
PAGE = text("command-line")
SECTIONS = dict(re.findall(r"^## `(\w+)`\n(.*?)(?=^## )", PAGE, re.MULTILINE | re.DOTALL))


def lines(markdown):
    return re.findall(r"^    contactlab (.*)$", markdown, re.MULTILINE)


def test_every_command_has_a_row_in_the_table():
    """The page is of a whole installation: folders of plugins may be taken out."""
    rows = re.findall(r"^\| [^|`]+ \| `(\w+)` \|$", PAGE, re.MULTILINE)
    assert len(rows) == len(set(rows))
    assert COMMANDS.keys() <= set(rows) <= COMMANDS.keys() | OF_FOLDERS
    assert set(SECTIONS) <= set(rows)


@pytest.mark.parametrize("command", COMMANDS)
def test_the_laws_in_the_examples_of_a_help_text_are_installed(command):
    examples = import_module(COMMANDS[command].module).__doc__
    options = r"--(normal|tangential|integrator|ghost) (\S+)|plugins \w+ (\w+\.\w+)"
    for kind, listed, shown in re.findall(options, examples):
        kind = "tangential" if kind == "ghost" else kind
        for name in (listed or shown).replace("exact,", "").split(","):
            full = name if kind_of(name) in KINDS else full_name(kind, name)
            assert REGISTRY.law_class(full)


@pytest.mark.slow
@pytest.mark.parametrize("command", [name for name in COMMANDS if name in SECTIONS])
def test_the_examples_of_a_command_run(run, command, tmp_path, monkeypatch):
    shutil.copytree(EXAMPLES, tmp_path / "examples", ignore=shutil.ignore_patterns("*_plugin"))
    monkeypatch.chdir(tmp_path)
    assert lines(SECTIONS[command])
    for line in lines(SECTIONS[command]):
        words = shlex.split(line)
        assert words[0] == command
        ran = run(*words)
        assert ran.status == 0, f"{line}: {ran.err}"
        for option in ("--out", "--figure", "--history"):
            if option in words:
                assert (tmp_path / words[words.index(option) + 1]).exists(), line


@pytest.mark.slow
def test_the_first_commands_of_a_newcomer_run(run, tmp_path, monkeypatch):
    shutil.copytree(EXAMPLES, tmp_path / "examples", ignore=shutil.ignore_patterns("*_plugin"))
    monkeypatch.chdir(tmp_path)
    section = text("getting-started").partition("## On the command line")[2]
    assert len(lines(section)) >= 4
    for line in lines(section):
        assert run(*shlex.split(line)).status == 0, line


#: Commands that other tests run, for they are long.
LONG = ("bench", "stability", "compare --all", "validate")


@pytest.mark.slow
def test_the_commands_told_at_once_run(run, tmp_path, monkeypatch):
    shutil.copytree(EXAMPLES, tmp_path / "examples", ignore=shutil.ignore_patterns("*_plugin"))
    monkeypatch.chdir(tmp_path)
    commands = lines(PAGE.partition("## A tour in fifteen lines")[2].partition("\n## ")[0])
    assert len(commands) == 15
    for line in commands:
        if not line.startswith(LONG):
            ran = run(*shlex.split(line))
            assert ran.status == 0, f"{line}: {ran.err}"
