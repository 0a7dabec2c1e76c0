"""Arguments that several subcommands share, and their conversion."""

from __future__ import annotations

import argparse
import contextlib
import csv
import json
import math
import os
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO, TypedDict

import attrs

from contactlab.cli import BAD_INPUT as BAD_INPUT
from contactlab.cli import FAILED as FAILED
from contactlab.cli import INTERRUPTED as INTERRUPTED
from contactlab.cli import OK as OK
from contactlab.numeric.progress import progress as progress  # exported to the subcommands
from contactlab.outcome.files import distinct, replace_file, unwritable
from contactlab.registration.hooks import Execute
from contactlab.registration.manager import MANAGER
from contactlab.registration.names import KINDS, full_name

if TYPE_CHECKING:
    from contactlab.impact.scene import Scene
    from contactlab.outcome.style import Look, Width
    from contactlab.runs.simulation import Simulation
    from contactlab.scene_file import SceneFile
    from contactlab.study.benchmark import Benchmark
    from contactlab.study.stability import Stability


def finite(text: str) -> float:
    """Return the text as a finite number."""
    try:
        value = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number{_range_hint(text)}") from None
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text!r}: must be a finite number")
    return value


def whole_number(text: str) -> int:
    """Return the text as a whole number."""
    try:
        return int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number") from None


def _range_hint(text: str) -> str:
    """Return how to write a range if the text looks like one, else nothing."""
    written = re.fullmatch(
        r"([+-]?[\d.]+) *(?:-|:|,|\.\.|to) *([+-]?[\d.]+)(?::[\d.]+)?", text.strip()
    )
    if not written:
        return ""
    example = f"{written[1]}:{written[2]}:71"
    return f"; a range is START:STOP:COUNT, {example}, in contactlab run, sweep and compare"


def names(text: str) -> list[str]:
    """Return the names in a list separated by commas, without repetition."""
    words = [name.strip() for name in text.split(",") if name.strip()]
    if not words:
        raise argparse.ArgumentTypeError("needs at least one name")
    if len(set(words)) < len(words):
        raise argparse.ArgumentTypeError(f"{text!r}: a name is repeated")
    return words


def setting(text: str) -> tuple[str, Any]:
    """Return (path, value) of ``tangential.annuli=50``; the value is written as in TOML."""
    path, equals, value = text.partition("=")
    if not equals or not path.strip() or not value.strip():
        raise argparse.ArgumentTypeError(f"{text!r}: write it as tangential.annuli=50")
    import tomllib  # only for --set

    try:
        return path.strip(), tomllib.loads(f"value = {value.strip()}")["value"]
    except tomllib.TOMLDecodeError:
        with contextlib.suppress(ValueError):
            return path.strip(), float(value)  # .5 is a number, though not in TOML
        word = value.strip()  # words need no quotes, and refusals say True or False
        return path.strip(), {"True": True, "False": False}.get(word, word)
    except (RecursionError, ValueError) as error:  # nested too deep, or too many digits
        raise argparse.ArgumentTypeError(f"{path.strip()}: {error}") from None


def file_of(*suffixes: str) -> Callable[[str], Path]:
    """Return a converter of text to a writable path with one of the suffixes."""

    def convert(text: str) -> Path:
        path = Path(text)
        if path.suffix.lower() not in suffixes:
            raise argparse.ArgumentTypeError(f"{text!r}: must end in {' or '.join(suffixes)}")
        if why_not := unwritable(path):
            raise argparse.ArgumentTypeError(f"{text!r}: {why_not}")
        return path

    return convert


#: Endings of files that commands write or read, which no folder has.
OF_FILES = {".png", ".pdf", ".svg", ".gif", ".csv", ".json", ".npz", ".toml", ".html", ".c", ".js"}


def folder_of(text: str) -> Path:
    """Return the path of a folder for files, or refuse a name that is empty, or that of a file."""
    path = Path(text)
    file = path.suffix.lower() in OF_FILES and not text.endswith(("/", os.sep))
    if not text or ((os.path.exists(path) or file) and not os.path.isdir(path)):
        what = ("is the name of a file" if file else "is a file") if text else "is no name"
        raise argparse.ArgumentTypeError(f"{text!r}: {what}; give a folder")
    return path


def add_file(
    parser: argparse.ArgumentParser,
    option: str,
    *suffixes: str,
    words: str = "",
    required: bool = False,
) -> None:
    """Add an option for a file to write, with ``words`` as its help."""
    metavar = "FILE" if suffixes[1:] else f"FILE{suffixes[0]}"
    convert = file_of(*suffixes)
    parser.add_argument(
        option, type=convert, metavar=metavar, required=required, help=words or None
    )


def add_names(
    parser: argparse.ArgumentParser, option: str, words: str, *, default: list[str] | None = None
) -> None:
    """Add an option for a list of names, with ``words`` as its help."""
    parser.add_argument(option, type=names, default=default, metavar="A,B,...", help=words)


def add_json(parser: argparse._ActionsContainer, instead_of: str = "the table") -> None:
    """Add ``--json``."""
    words = f"print JSON instead of {instead_of}"
    parser.add_argument("--json", action="store_true", help=words)


def add_forms(parser: argparse.ArgumentParser, instead_of: str = "the table") -> None:
    """Add ``--json`` and ``--csv``, of which one is printed."""
    form = parser.add_mutually_exclusive_group()
    add_json(form, instead_of)
    words = f"print CSV instead of {instead_of}"
    form.add_argument("--csv", action="store_true", help=words)


#: Suffixes of pictures, as in ``contactlab.figures.files.FORMATS``, which loads matplotlib.
PICTURES = (".png", ".pdf", ".svg")


def add_figure(parser: argparse.ArgumentParser, words: str) -> None:
    """Add ``--figure`` with ``words`` as its help, ``--style`` and ``--width``."""
    add_file(parser, "--figure", *PICTURES, words=f"{words} (.png, .pdf or .svg)")
    add_look(parser)


def add_look(parser: argparse.ArgumentParser) -> None:
    """Add ``--style`` and ``--width``."""
    parser.add_argument(
        "--style", choices=("print", "slides"), default="print", help="look of the figure"
    )
    parser.add_argument(
        "--width",
        choices=("one", "two"),
        help="columns of a printed page that the figure fills",
    )


class Drawing(TypedDict, total=False):
    """Options of ``contactlab.figures.files.save``."""

    look: Look
    width: Width | None


def look(arguments: argparse.Namespace) -> Drawing:
    """Return the options ``look`` and ``width`` of ``contactlab.figures.files.save``."""
    return {"look": arguments.style, "width": arguments.width}


def check_outputs_first(execute: Execute) -> Execute:
    """Return a command that refuses outputs which cannot all be written before it runs."""

    def run(arguments: argparse.Namespace) -> int:
        check_outputs(arguments)
        return execute(arguments)

    return run


def check_outputs(arguments: argparse.Namespace) -> None:
    """Refuse one file for two options, and --style or --width where no figure is drawn."""
    values = vars(arguments)
    drawn = any(values.get(name) for name in ("figure", "loops", "stick_slip"))
    if "figure" in values and not drawn:
        for name in ("style", "width"):
            if values[name] not in (None, "print"):
                raise ValueError(f"--{name}: is for a figure; add --figure FILE")
    outputs = {f"--{name}": path for name, path in values.items() if isinstance(path, Path)}
    distinct({"SCENE.toml": values.get("scene"), **outputs})


def save(
    *writings: tuple[Path | None, Callable[[Path], object]],
    progress_wanted: bool | None,
    interrupted: bool = False,
) -> int:
    """Write each file whose path is not None, and return the exit status.

    After an interruption the finished part goes beside the file, as ``NAME.partial.SUFFIX``; a file
    of an earlier run stays as it was. A later complete run tells of the partial file. A file that
    cannot be written, or that Ctrl-C meets, is reported on stderr, so that the other files and the
    printed results of long work are not lost. A function that has nothing to write says so, and
    returns False.
    """
    status = OK
    wanted = [(path, write) for path, write in writings if path is not None]
    with progress(progress_wanted, "files") as counted:
        for done, (path, write) in enumerate(wanted, start=1):
            partial = path.with_name(f"{path.stem}.partial{path.suffix}")
            target = partial if interrupted else path
            try:
                if write(target) is False:
                    continue
            except OSError as error:
                print(f"contactlab: error: {target} is not written: {error}", file=sys.stderr)
                status = FAILED
                continue
            except KeyboardInterrupt:
                for left, _ in wanted[done - 1 :]:
                    print(f"contactlab: interrupted: {left} is not written", file=sys.stderr)
                return INTERRUPTED
            if interrupted:
                print(f"contactlab: interrupted: what is done is in {partial}", file=sys.stderr)
            elif partial.exists():
                note = f"{path} is complete; {partial} is left from an interrupted run"
                print(f"contactlab: note: {note}", file=sys.stderr)
            if counted is not None:
                counted(done, len(wanted))
    return status


def make_folder(folder: Path) -> None:
    """Make the folder of ``--out``, or refuse it before the work."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ValueError(f"--out {folder}: cannot make the folder: {error.strerror}") from None
    if why_not := unwritable(folder / "file"):
        raise ValueError(f"--out {folder}: {why_not}")


@contextlib.contextmanager
def working(wanted: bool | None, what: str) -> Iterator[Callable[[int, int], object] | None]:
    """Yield the progress line, or None; what laws print meanwhile goes to stderr."""
    with progress(wanted, what) as counted, contextlib.redirect_stdout(sys.stderr):
        yield counted


def tell_normal_spin(scene: Scene, *simulations: Simulation | None) -> None:
    """Print on stderr the changes by spin about the normal, where no plan is shown.

    Nothing is said if all ``simulations`` answer it; None stands for ``contactlab.rebound``.
    """
    from contactlab.outcome.normal_spin_words import with_normal_spin  # only for vectors

    answered = all(
        each is not None and "normal_spin" in each.laws.capability.tangential_claims
        for each in simulations
    )
    _, _, cautions = with_normal_spin(((), (), ()), scene, answered=answered)
    tell_cautions(cautions)


def tell_cautions(cautions: Iterable[object]) -> None:
    """Print cautions on stderr."""
    for sentence in cautions:
        print(f"contactlab: caution: {sentence}", file=sys.stderr)


def print_json(content: object, stream: TextIO | None = None) -> None:
    """Print JSON on stdout, or into a stream; NaN has to be None before."""
    print(json.dumps(content, indent=2, allow_nan=False), file=stream)


def items_csv(kind: type, items: Iterable[object], stream: TextIO) -> None:
    """Write CSV with one row for each item of an attrs class, its fields as columns."""
    names = [field.name for field in attrs.fields(kind)]
    rows = ([getattr(item, name) for name in names] for item in items)
    csv.writer(stream, lineterminator="\n").writerows([names, *rows])


def report(
    arguments: argparse.Namespace,
    *drawings: tuple[Path | None, Callable[[Path], object]],
    content: Callable[[], object],
    to_csv: Callable[[TextIO], object],
    text: Callable[[], str],
    interrupted: bool,
) -> int:
    """Write ``--out`` and the drawings, print in the form chosen, and return the exit status.

    ``content`` is for JSON; ``to_csv`` writes CSV into a stream.
    """

    def write(path: Path) -> None:
        with replace_file(path) as stream:
            if path.suffix.lower() == ".json":
                print_json(content(), stream)
            else:
                to_csv(stream)

    saved = save(
        (arguments.out, write),
        *drawings,
        progress_wanted=arguments.progress,
        interrupted=interrupted,
    )
    if arguments.json:
        print_json(content())
    elif arguments.csv:
        to_csv(sys.stdout)
    else:
        print(text())
    return saved


def add_laws(
    parser: argparse.ArgumentParser, *, kinds: Sequence[str] = KINDS, many: bool = False
) -> None:
    """Add ``--set`` and an option for each kind of law; with ``many`` a list of names."""
    for kind in kinds:
        word = "integrator" if kind == "integrator" else f"{kind} law"
        parser.add_argument(
            f"--{kind}",
            type=names if many else str,
            metavar="A,B,..." if many else "NAME",
            help=f"name of the {word}" + (", or several" if many else "") + "; or file.py:Class",
        )
    if "normal" in kinds:
        add_restitution(parser)
    parser.add_argument(
        "--set",
        type=setting,
        action="append",
        default=[],
        dest="settings",
        metavar="KIND.OPTION=VALUE",
        help="option of a law: tangential.annuli=50, integrator.steps=500; may be repeated",
    )


def add_restitution(parser: argparse.ArgumentParser) -> None:
    """Add ``--restitution``."""
    parser.add_argument(
        "--restitution",
        type=_number_or_words,
        metavar="E",
        help="coefficient of restitution, in place of a normal law. A function of the speed: "
        "'1 - 0.02 v^(1/5)'. A table, speed in m/s to e: 0.5:0.95,2:0.9",
    )


def add_one_restitution(parser: argparse.ArgumentParser) -> None:
    """Add ``--restitution``, one number."""
    words = "coefficient of restitution, in place of a normal law"
    parser.add_argument("--restitution", type=_one_number, metavar="E", help=words)


def _number_or_words(text: str) -> float | str:
    """Return a number; or the text as it is, if v or a colon shows a formula or a table."""
    if re.search("[v:]", text):
        return text
    try:
        return finite(text)
    except argparse.ArgumentTypeError as error:
        forms = "e as in 0.9, '1 - 0.02 v^(1/5)' or 0.5:0.95,2:0.9"
        raise argparse.ArgumentTypeError(f"{error}; write {forms}") from None


def _one_number(text: str) -> float:
    """Return a coefficient of restitution that holds at every speed."""
    try:
        return finite(text)
    except argparse.ArgumentTypeError as error:
        raise argparse.ArgumentTypeError(f"{error}; write one for all scenes, as 0.9") from None


def add_progress(parser: argparse.ArgumentParser, default: str = "only on a terminal") -> None:
    """Add ``--progress``, with what is its ``default``."""
    parser.add_argument(
        "--progress",
        action=argparse.BooleanOptionalAction,
        default=None,
        help=f"show progress on stderr (default: {default})",
    )


def add_report(parser: argparse.ArgumentParser, progress: str = "only on a terminal") -> None:
    """Add laws, size and outputs of a report over all laws."""
    for kind, default in (("normal", "hertz"), ("tangential", "all"), ("integrator", "all")):
        words = f"names of laws, or file.py:Class (default: {default})"
        add_names(parser, f"--{kind}", words)
    parser.add_argument("--quick", action="store_true", help="fewer scenes and resolutions")
    add_time_limit(parser, "stop after this time, and report what is done")
    add_figure(parser, "also draw it")
    add_file(parser, "--out", ".csv", ".json", words="also write .csv or .json")
    add_forms(parser)
    add_progress(parser, progress)


def add_time_limit(parser: argparse.ArgumentParser, words: str) -> None:
    """Add ``--time-limit`` with ``words`` as its help."""
    parser.add_argument("--time-limit", type=_seconds, metavar="SECONDS", help=words)


def _seconds(text: str) -> float:
    """Return the text as a positive time in s."""
    if (seconds := finite(text)) <= 0.0:
        raise argparse.ArgumentTypeError(f"{text!r}: must be positive, in seconds")
    return seconds


def choose_laws(arguments: argparse.Namespace) -> list[str] | None:
    """Return the laws named for a report over all laws, each with its kind; None if none is."""
    chosen = {kind: getattr(arguments, kind) or [] for kind in KINDS}
    return [full_name(kind, name) for kind in KINDS for name in chosen[kind]] or None


def say_why_incomplete(report: Benchmark | Stability) -> str:
    """Return why a report over all laws is not complete."""
    return "interrupted" if report.interrupted else "the time limit was reached"


def scene_file(arguments: argparse.Namespace, read: Callable[..., SceneFile]) -> SceneFile:
    """Return the scene file of a command, or its replacement by an option of a plug-in.

    ``read`` returns the file; ``defaults`` are velocities to use where the file has none.
    """
    found: SceneFile | None = MANAGER.hook.contactlab_scene_file(arguments=arguments, read=read)
    return read(defaults=None) if found is None else found
