"""Subcommands of other distributions, and contactlab's own, which come by the same door."""

import importlib
import pkgutil
import re
import sys
from pathlib import Path

import pytest

import contactlab.cli
from contactlab.registration.manager import commands

HELLO = (
    Path(__file__).parents[2] / "examples" / "third_party_command" / "contactlab_hello.py"
).read_text("utf-8")
HOOK = "import contactlab\n@contactlab.hookimpl\ndef contactlab_command(parser): "


@pytest.fixture
def hello(install):
    install("contactlab-hello", "contactlab_hello", HELLO, "command.hello")


def test_a_command_of_another_distribution_runs(hello, run):
    page = (Path(contactlab.__file__).parent / "guide" / "extending-command.md").read_text("utf-8")
    (told,) = re.findall(r"```text\n(.*?)```", page, re.DOTALL)
    assert run("hello", "Ada") == (0, told, "")
    assert run("hello", "Ada", "--psi1", "9").out.endswith("psi2 = 3.235\n")


def test_it_is_listed_and_imported_only_when_it_is_called(hello, run):
    listed = " ".join(run("--help").out.split())
    assert "hello Greet somebody with a bounce. (contactlab-hello 1.5)" in listed
    assert run("materials").status == 0
    assert "contactlab_hello" not in sys.modules
    own = run("hello", "--help").out
    assert "contactlab_hello" in sys.modules
    assert "whom to greet" in own
    assert "examples:\n  contactlab hello Ada\n" in own


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["hello"], "contactlab hello: error: the following arguments are required: name"),
        (["hello", "Ada", "--psi1", "a"], "--psi1"),
        (["hello", "Ada", "--psi2", "1"], "did you mean '--psi1'?"),
        (["helo", "Ada"], "did you mean 'hello'?"),
        (["hello", "Ada", "--psi1", "nan"], "contactlab hello: error: psi1 = nan"),
    ],
)
def test_slips_of_the_pen_are_told_as_of_any_command(hello, run, words, told):
    ran = run(*words)
    assert ran.status == 2
    assert ran.out == ""
    assert told in ran.err
    assert len(ran.err.splitlines()) == 1


@pytest.mark.parametrize(
    ("source", "told"),
    [
        ("import not_there_at_all", "could not be imported: ModuleNotFoundError"),
        ("raise SystemExit(3)", "could not be imported: SystemExit"),
        ("def broken(:", "could not be imported: SyntaxError"),
        ("", "has no hook"),
        ("import contactlab\n@contactlab.hookimpl\ndef contactlab_law(): pass", "has no hook"),
        (HOOK.replace("command", "comand") + "pass", "does not fit the hooks"),
        (HOOK.replace("(parser)", "(parser, more)") + "pass", "does not fit the hooks"),
        (HOOK + "1/0", "raised when asked for its command: ZeroDivisionError"),
        (HOOK + "pass", "returned None, which runs no command"),
    ],
)
def test_a_broken_command_says_so_and_harms_no_other(install, run, source, told):
    install("broken", "broken_command", source, "command.hello")
    ran = run("hello")
    assert (ran.status, ran.out) == (1, "")
    assert told in ran.err
    assert "'command.hello' of broken 1.5" in ran.err
    assert len(ran.err.splitlines()) == 1
    assert " hello " in run("--help").out
    assert run("materials").status == 0


def test_a_command_prints_nothing_on_stdout_before_it_runs(install, run):
    install("loud", "loud_command", f"print('imported')\n{HELLO}", "command.hello")
    ran = run("hello", "Ada")
    assert ran.err == "imported\n"
    assert "imported" not in ran.out


def test_a_command_has_options_of_its_own(install, run, tmp_path):
    """Of a figure without a style, and a file that is only read."""
    source = HELLO.replace(
        "    return greet\n",
        "    import pathlib\n    parser.add_argument('--figure', type=pathlib.Path)\n"
        "    parser.add_argument('--scene', type=pathlib.Path)\n    return greet\n",
    )
    install("drawing", "drawing_command", source, "command.hello")
    assert run("hello", "Ada").status == 0
    assert run("hello", "Ada", "--scene", tmp_path / "a.toml").status == 0


def test_the_class_of_a_law_is_no_command(install, run):
    install("wrong", "wrong_command:Law", "class Law: pass", "command.hello")
    ran = run("hello")
    assert ran.status == 1
    assert "name a module in the entry point" in ran.err


def test_a_name_of_two_distributions_is_neithers(hello, install, run):
    install(
        "greetings", "contactlab_greetings", HELLO.replace("Hello", "Greetings"), "command.hello"
    )
    refused = run("hello", "Ada")
    assert refused.status == 2
    calls = [f"contactlab {name}:hello" for name in ("contactlab-hello", "greetings")]
    assert all(call in refused.err for call in calls)
    assert run("greetings:hello", "Ada").out.startswith("Greetings Ada")
    assert run("contactlab-hello:hello", "Ada").out.startswith("Hello Ada")


def test_a_name_of_contactlabs_own_stays_contactlabs(install, run):
    install("rival", "rival_command", HELLO, "command.materials")
    assert run("materials").out.startswith("material ")
    assert run("rival:materials", "Ada").out.startswith("Hello Ada")


@pytest.mark.parametrize("blocked", ["contactlab-hello", "command.hello"])
def test_a_command_can_be_blocked(hello, run, monkeypatch, blocked):
    monkeypatch.setenv("CONTACTLAB_BLOCK_PLUGINS", blocked)
    assert run("hello", "Ada").status == 2
    assert "hello" not in run("--help").out
    monkeypatch.setenv("CONTACTLAB_BLOCK_PLUGINS", "command.materials")
    assert run("materials").status == 2


def test_one_module_offers_a_law_and_a_command(install, run):
    law = "\n@contactlab.hookimpl\ndef contactlab_law(name):\n    return Mine\n"
    source = HELLO + (
        "from contactlab_laws.coulomb import Coulomb\n"
        "class Mine(Coulomb):\n    api_version = Coulomb.api_version\n"
    )
    install("both", "both_hooks", source + law, "command.hello", "tangential.mine")
    assert run("hello", "Ada").status == 0
    ran = run("run", "--psi1", "9", "--chi", "1.4412", "--tangential", "mine")
    assert ran.status == 0
    assert "mine (both 1.5)" in ran.out


def test_a_command_is_no_law(hello, run):
    listed = run("plugins", "list")
    assert listed.err == ""
    assert "command.hello" in listed.out
    assert run("plugins", "show", "command.hello").status == 0


def test_own_commands_are_the_modules_that_have_the_hook():
    """None is named in the core."""
    with_hook = {
        each.name
        for each in pkgutil.iter_modules(contactlab.cli.__path__)
        if hasattr(importlib.import_module(f"contactlab.cli.{each.name}"), "contactlab_command")
    }
    own = commands("contactlab")
    assert own.keys() >= with_hook
    modules = {f"contactlab.cli.{name}" for name in with_hook}
    assert {info.module for info in own.values()} >= modules


def test_a_blocked_name_of_contactlabs_own_goes_to_no_other(install, run, monkeypatch):
    install("greetings", "contactlab_greetings", HELLO, "command.run")
    monkeypatch.setenv("CONTACTLAB_BLOCK_PLUGINS", "contactlab")
    assert run("run", "Ada").status == 2
    assert run("greetings:run", "Ada").out.startswith("Hello Ada")
    assert "\n    run " not in run("--help").out
