"""The command ``contactlab``: runs a subcommand, and prints each error on one line."""

from __future__ import annotations

import argparse
import ast
import contextlib
import inspect
import os
import re
import sys
import traceback
import warnings
from collections.abc import Iterator, Mapping, Sequence
from importlib.abc import InspectLoader
from importlib.machinery import ModuleSpec, PathFinder
from typing import TYPE_CHECKING, NoReturn, TextIO

import contactlab
from contactlab.cli import BAD_INPUT, BROKEN_PIPE, FAILED, INTERRUPTED
from contactlab.cli.terminal import fit_terminal
from contactlab.numeric.names import nearest
from contactlab.registration.hooks import PluginError
from contactlab.registration.installed import PluginWarning
from contactlab.registration.manager import MANAGER, command, commands
from contactlab.registration.names import PROJECT, PluginInfo

if TYPE_CHECKING:
    from _typeshed import SupportsWrite

EPILOG = """examples:
  contactlab run --psi1 1.2 --chi 1.4412
  contactlab run examples/steel_ball.toml
  contactlab compare examples/kharaz2001.toml --figure kharaz.png
  contactlab figures --out figures
  contactlab plugins list
  contactlab guide choosing

exit status: 0 success, 1 a run failed, 2 bad input, 130 interrupted
"""
#: Headings of the list of commands; commands of other distributions stand under the last.
HEADINGS = {
    "compute": ("run", "sweep", "compare", "fit"),
    "judge a law": ("bench", "stability", "validate", "plugins"),
    "show": ("figures", "animate", "explore", "report"),
    "take away": ("kernel", "cite", "materials", "guide"),
}
OTHERS = "of other plug-ins"
#: Options that were renamed; the old name is refused with the new one.
RENAMED = {
    "--laws": "--tangential",
    "--law": "--tangential (or --normal, --integrator)",
    "--budget": "--time-limit",
    "--seconds": "--time-limit",
    "--estimate": "--estimate-error",
    "--no-estimate": "--no-estimate-error",
    "--figures": "--out",
    "--inertia": "--inertia-ratio",
    "--csv": "--residuals",
}


class Parser(argparse.ArgumentParser):
    """A parser whose errors are one line that names ``--help``."""

    def error(self, message: str) -> NoReturn:
        """Print the message with the nearest match to a wrong choice, and exit."""
        wrong = re.search(r"invalid choice: '(.*?)' \(choose from (.*)\)", message)
        if wrong:
            words = re.findall(r"[\w-]+", wrong[2])
            message += f"; {nearest(wrong[1], words)}"
            if message.startswith("argument COMMAND"):  # the list would be long
                message = f"no command {wrong[1]!r}; {nearest(wrong[1], words)}"
            if wrong[1] in ("help", "version"):
                message = f"{wrong[1]} is an option: write contactlab --{wrong[1]}"
        unknown = re.match(r"unrecognized arguments: (\S+?)(?: |=|$)", message)
        if unknown:
            message += f"; {self._instead_of(unknown[1])}"
        message = message.rstrip("; ")
        self.exit(BAD_INPUT, f"{self.prog}: error: {message} (see {self.prog} --help)\n")

    def _instead_of(self, word: str) -> str:
        """Return the remedy for a word that no option takes; empty if unknown."""
        options = self._options()
        if word.endswith(".toml"):
            return "one scene at a time; give each a command of its own"
        if not word.startswith("-"):
            return f"--csv prints; to write a file: --out {word}" if "--csv" in options else ""
        new = RENAMED.get(word, "")
        if new.partition(" ")[0] in options:
            return f"{word} is now {new}"
        return nearest(word, options)

    def _options(self) -> list[str]:
        """Return the options of the parser, and of the actions below it."""
        below = [action.choices for action in self._actions if isinstance(action.choices, dict)]
        parsers = [self, *(each for choices in below for each in choices.values())]
        return [option for parser in parsers for option in parser._option_string_actions]

    def _print_message(self, message: str, file: SupportsWrite[str] | None = None) -> None:
        """Print help or an error; the method of argparse hides write errors."""
        print(message, end="", file=sys.stderr if file is None else file)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit status."""
    words = sys.argv[1:] if arguments is None else list(arguments)
    parsed = argparse.Namespace(command="", traceback=False, words=words)
    with fit_terminal(), _print_warnings():
        try:
            status = _execute(_join_negative_numbers(words), parsed)
            sys.stdout.flush()
        except KeyboardInterrupt:
            print("contactlab: interrupted", file=sys.stderr)
            return INTERRUPTED
        except BrokenPipeError:
            _leave_stdout()  # the reader has closed the pipe
            return BROKEN_PIPE
        except (ValueError, PluginError, contactlab.ImpactError, OSError) as error:
            if parsed.traceback:
                traceback.print_exc()
            name = f"contactlab {parsed.command}".strip()
            told = [_one_line(error), *getattr(error, "__notes__", ())]
            print(f"{name}: error: " + "\n  ".join(told), file=sys.stderr)
            if isinstance(error, OSError):
                _leave_stdout()
            stopped = isinstance(error, contactlab.ImpactError) and error.status
            if stopped is contactlab.Status.INTERRUPTED:
                return INTERRUPTED
            return BAD_INPUT if isinstance(error, ValueError) else FAILED
    return status


def _execute(words: list[str], parsed: argparse.Namespace) -> int:
    """Parse the words into ``parsed``, run the subcommand and return its status."""
    try:
        _, unknown = _parser(*_find_commands(words)).parse_known_args(words, parsed)
        if unknown:
            parsed.parser.error(f"unrecognized arguments: {' '.join(unknown)}")
    except SystemExit as stop:  # argparse has printed help, version or the error
        return stop.code if isinstance(stop.code, int) else BAD_INPUT
    status: int = parsed.execute(parsed)
    return status


@contextlib.contextmanager
def _print_warnings() -> Iterator[None]:
    """Print each warning about plug-ins once, on one line, as errors."""
    said: set[str] = set()
    with warnings.catch_warnings():
        show_other = warnings.showwarning

        def show(
            message: Warning | str,
            category: type[Warning],
            filename: str,
            lineno: int,
            file: TextIO | None = None,
            line: str | None = None,
        ) -> None:
            if issubclass(category, PluginWarning):
                if str(message) not in said:
                    print(f"contactlab: warning: {message}", file=sys.stderr)
                said.add(str(message))
            else:
                show_other(message, category, filename, lineno, file, line)

        warnings.simplefilter("always", PluginWarning)
        warnings.showwarning = show
        yield


def _leave_stdout() -> None:
    """Send stdout to the null device if it cannot be flushed, so that the exit does not fail."""
    try:
        sys.stdout.flush()
    except OSError:
        with contextlib.suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _find_commands(words: Sequence[str]) -> tuple[Mapping[str, PluginInfo], bool]:
    """Return the subcommands that the parser needs, and whether they are called, not listed."""
    word = next((word for word in words if not word.startswith("-")), None)
    if word is not None and (called := command(word)):
        return {word: called}, True
    if word is None and words and all(word.startswith(("--v", "--t")) for word in words):
        return {}, False
    return commands(), False


def _parser(names: Mapping[str, PluginInfo], called: bool) -> argparse.ArgumentParser:
    """Return the parser with subcommands; it imports their modules if they are called."""
    raw = argparse.RawDescriptionHelpFormatter
    about = "Oblique impact of elastic bodies, with contact laws as plug-ins."
    parser = Parser(
        prog="contactlab",
        usage="%(prog)s [-h] [--version] [--traceback] COMMAND ...",
        description=about if called else "\n\n".join([about, *_list_commands(names)]),
        epilog=EPILOG,
        formatter_class=raw,
    )
    parser.add_argument("--version", action="version", version=contactlab.__version__)
    parser.add_argument(
        "--traceback", action="store_true", help="show the traceback of an error (before COMMAND)"
    )
    subparsers = parser.add_subparsers(
        prog="contactlab",
        dest="command",
        metavar="COMMAND",
        required=True,
        parser_class=Parser,
        help=argparse.SUPPRESS,
    )
    for name, info in names.items():
        if called:
            added = subparsers.add_parser(name, formatter_class=raw, allow_abbrev=False)
            execute = MANAGER.ask(info, parser=added)
            MANAGER.gather("options", only=name, command=name, parser=added)
            if not callable(execute):
                raise PluginError(f"{info.source} returned {execute!r}, which runs no command")
            text = inspect.cleandoc(sys.modules[info.module].__doc__ or "")
            added.description, _, examples = text.partition("\n\n")
            added.epilog = examples.replace("Examples\n--------", "examples:")
            added.set_defaults(execute=execute, parser=added)
        else:
            subparsers.add_parser(name)
    return parser


def _list_commands(names: Mapping[str, PluginInfo]) -> list[str]:
    """Return the commands under their headings, a line each."""
    headings = {name: heading for heading, members in HEADINGS.items() for name in members}
    order = [*headings, *sorted(names.keys() - headings)]
    width = max(map(len, names), default=0)
    lines: dict[str, list[str]] = {}
    for name in order:
        if (info := names.get(name)) is None:
            continue
        summary = " ".join(_docstring(info.module).partition("\n\n")[0].split())
        origin = "" if info.distribution == PROJECT else f" ({info.distribution} {info.version})"
        line = f"  {name.ljust(width)}  {summary}{origin}"
        lines.setdefault(headings.get(name, OTHERS), []).append(line)
    return ["\n".join([f"{heading}:", *members]) for heading, members in lines.items()]


def _docstring(module: str) -> str:
    """Return the docstring of a module, read without an import; "" if there is none to read."""
    spec: ModuleSpec | None = None
    with contextlib.suppress(Exception):  # calling a broken command tells its fault
        parts = module.split(".")
        for count in range(1, len(parts) + 1):  # find_spec of a submodule imports the package
            folders = spec.submodule_search_locations if spec else None
            spec = PathFinder.find_spec(".".join(parts[:count]), folders)
        loader = spec.loader if spec else None
        assert isinstance(loader, InspectLoader)
        return ast.get_docstring(ast.parse(loader.get_source(module) or "")) or ""
    return ""


def _join_negative_numbers(words: list[str]) -> list[str]:
    """Join ``--psi1 -1e-3`` with "=", because argparse takes the number for an option."""
    joined: list[str] = []
    for word in words:
        if joined and joined[-1].startswith("--") and "=" not in joined[-1] and _is_negative(word):
            joined[-1] += f"={word}"
        else:
            joined.append(word)
    return joined


def _is_negative(word: str) -> bool:
    """Return whether a word is a negative number, or a range that starts with one."""
    try:
        float(word.partition(":")[0])
    except ValueError:
        return False
    return word.startswith("-")


def _one_line(error: BaseException) -> str:
    """Return the message of an error on one line; of the system's errors path and reason."""
    if isinstance(error, OSError) and error.filename and error.strerror:
        return f"{error.filename}: cannot be read or written: {error.strerror}"
    return " ".join(str(error).split()) or type(error).__name__
