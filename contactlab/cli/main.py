"""The command ``contactlab``: runs a subcommand, and prints each error on one line."""

from __future__ import annotations

import argparse
import contextlib
import importlib
import os
import re
import sys
import traceback
import warnings
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, NoReturn

import contactlab
from contactlab.cli.arguments import (
    BAD_INPUT,
    BROKEN_PIPE,
    FAILED,
    INTERRUPTED,
    check_outputs,
)
from contactlab.cli.terminal import fitted
from contactlab.compose.registry import PluginWarning
from contactlab.contracts.status import Status
from contactlab.numeric.names import nearest

if TYPE_CHECKING:
    from _typeshed import SupportsWrite

#: Subcommands, each a module of this package.
COMMANDS = (
    "run", "sweep", "compare", "fit", "bench", "stability", "validate", "figures", "animate",
    "explore", "report", "kernel", "cite", "materials", "plugins", "guide",
)  # fmt: skip

EPILOG = """examples:
  contactlab run --psi1 1.2 --chi 1.4412
  contactlab run examples/steel_ball.toml
  contactlab compare examples/kharaz2001.toml --figure kharaz.png
  contactlab figures --out figures
  contactlab plugins list
  contactlab guide choosing

exit status: 0 success, 1 a run failed, 2 bad input, 130 interrupted
"""


class Parser(argparse.ArgumentParser):
    """A parser whose errors are one line that names ``--help``."""

    def error(self, message: str) -> NoReturn:
        """Print the message with the nearest match to a wrong choice, and exit."""
        wrong = re.search(r"invalid choice: '(.*?)' \(choose from (.*)\)", message)
        if wrong:
            words = re.findall(r"[\w-]+", wrong[2])
            message += f"; {nearest(wrong[1], words)}"
        unknown = re.match(r"unrecognized arguments: (--[\w-]+)", message)
        if unknown:
            message += f"; {nearest(unknown[1], self._option_string_actions)}"
        message = message.rstrip("; ")
        self.exit(BAD_INPUT, f"{self.prog}: error: {message} (see {self.prog} --help)\n")

    def _print_message(self, message: str, file: SupportsWrite[str] | None = None) -> None:
        """Print help or an error; the method of argparse hides write errors."""
        print(message, end="", file=sys.stderr if file is None else file)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit status."""
    words = sys.argv[1:] if arguments is None else list(arguments)
    parsed = argparse.Namespace(command="", traceback=False)
    with fitted(), _warned():
        try:
            status = _execute(_join_negative_numbers(words), parsed)
            sys.stdout.flush()
        except KeyboardInterrupt:
            print("contactlab: interrupted", file=sys.stderr)
            return INTERRUPTED
        except BrokenPipeError:
            _leave_stdout()  # the reader has closed the pipe
            return BROKEN_PIPE
        except (ValueError, contactlab.PluginError, contactlab.ImpactError, OSError) as error:
            if parsed.traceback:
                traceback.print_exc()
            name = f"contactlab {parsed.command}".strip()
            print(f"{name}: error: {_one_line(error)}", file=sys.stderr)
            if isinstance(error, OSError):
                _leave_stdout()
            if isinstance(error, contactlab.ImpactError) and error.status is Status.INTERRUPTED:
                return INTERRUPTED
            return BAD_INPUT if isinstance(error, ValueError) else FAILED
    return status


def _execute(words: list[str], parsed: argparse.Namespace) -> int:
    """Parse the words into ``parsed``, run the subcommand and return its status."""
    try:
        _, unknown = _parser(_needed(words)).parse_known_args(words, parsed)
        if unknown:
            parsed.parser.error(f"unrecognized arguments: {' '.join(unknown)}")
    except SystemExit as stop:  # argparse has printed help, version or the error
        return stop.code if isinstance(stop.code, int) else BAD_INPUT
    check_outputs(parsed)
    status: int = parsed.execute(parsed)
    return status


@contextlib.contextmanager
def _warned() -> Iterator[None]:
    """Print warnings about plug-ins on one line, as errors."""
    with warnings.catch_warnings():
        show_other = warnings.showwarning

        def show(message: Warning | str, category: type[Warning], *where: Any) -> None:
            if issubclass(category, PluginWarning):
                print(f"contactlab: warning: {message}", file=sys.stderr)
            else:
                show_other(message, category, *where)

        warnings.simplefilter("always", PluginWarning)
        warnings.showwarning = show  # type: ignore[assignment]
        yield


def _leave_stdout() -> None:
    """Send stdout to the null device if it cannot be flushed, so that the exit does not fail."""
    try:
        sys.stdout.flush()
    except OSError:
        with contextlib.suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _needed(words: Sequence[str]) -> Sequence[str]:
    """Return the subcommands that the parser needs: the one in ``words``, or all for help."""
    for word in words:
        if word in COMMANDS:
            return (word,)
        if word.startswith("--v") or word.startswith("--t"):
            continue
        return COMMANDS
    return ()


def _parser(names: Sequence[str]) -> argparse.ArgumentParser:
    """Return the parser with the subcommands ``names``, importing only their modules."""
    raw = argparse.RawDescriptionHelpFormatter
    parser = Parser(
        prog="contactlab",
        description="Oblique impact of elastic bodies, with contact laws as plug-ins.",
        epilog=EPILOG,
        formatter_class=raw,
    )
    parser.add_argument("--version", action="version", version=contactlab.__version__)
    parser.add_argument(
        "--traceback", action="store_true", help="show the traceback of an error (before COMMAND)"
    )
    commands = parser.add_subparsers(
        dest="command", metavar="COMMAND", required=True, parser_class=Parser
    )
    for name in names:
        module = importlib.import_module(f"contactlab.cli.{name}")
        summary, _, examples = str(module.__doc__).partition("\n\n")
        examples = examples.replace("Examples\n--------", "examples:")
        command = commands.add_parser(
            name,
            help=summary,
            description=summary,
            epilog=examples,
            formatter_class=raw,
            allow_abbrev=False,
        )
        module.add_arguments(command)
        command.set_defaults(execute=module.execute, parser=command)
    return parser


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
