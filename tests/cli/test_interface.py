"""The arguments of every subcommand, written out: names, defaults, choices, types and help."""

from __future__ import annotations

import argparse
import itertools

import pytest

from contactlab.cli import main as module

SUFFIXES = (".json", ".csv", ".npz", ".png", ".pdf", ".svg", ".gif", ".html", ".toml", "")
#: Arguments that several subcommands share.
SHARED = {
    "LAWS": """
--normal NAME type=str: name of the normal law
--tangential NAME type=str: name of the tangential law
--integrator NAME type=str: name of the integrator
SET""",
    "SEVERAL": """
--normal A,B,... type=names: name of the normal law, or several
--tangential A,B,... type=names: name of the tangential law, or several
--integrator A,B,... type=names: name of the integrator, or several
SET""",
    "SET": """
--set KIND.OPTION=VALUE dest=settings default=[] type=setting Append: option of a law: \
tangential.annuli=50, integrator.steps=500; may be repeated""",
    "LOOK": """
--style choices=print,slides default=print: of the figure
--width choices=one,two: columns of a page that the figure fills, with its text in the sizes of \
print""",
    "PSI1": """
scene SCENE.toml nargs=?: a scene or a sweep
--psi1 type=finite: non-dimensional angle of incidence (29), without a file
--chi type=finite: inertia ratio (38): 1.4412 for a solid sphere, nu = 0.3
LAWS""",
    "RANGES": """
--psi1 START:STOP:COUNT type=numbers: angle of incidence (29); or one number
--chi START:STOP:COUNT type=numbers: inertia ratio (38); or one number""",
    "COLUMN": """
--column HEADING=NAME default=[] type=_column Append: name a column of the CSV: 'impact angle \
[deg]=incidence_angle'; a name with - before turns the sign, 'remark=#' leaves the column unread; \
may be repeated""",
    "MEASURED": """
--measured DATA.csv type=Path: measured impacts to set beside the laws, with the headings of \
contactlab fit
COLUMN""",
    "PROGRESS": """
--progress --no-progress BooleanOptional: show progress on stderr (default: only on a terminal)""",
    "REPORT": """
--law NAME Append: a law, installed or of a plug-in, such as tangential.mine, integrator.mine or \
normal.mine; may be repeated (default: all of a kind, under Hertz's normal law)
--quick StoreTrue: fewer scenes and resolutions
--budget SECONDS default=inf type=finite: begin no further run after this time
--figure FILE .png.pdf.svg: also draw it (.png, .pdf or .svg)
LOOK
--csv FILE.csv .csv
--json StoreTrue: print JSON instead of the table
PROGRESS""",
}
COMMANDS = {
    "run": """
PSI1
--json StoreTrue: print JSON instead of the table
--out FILE .json.csv.npz: also write .json, .csv or .npz
--history FILE.csv .csv: also write the history of a single impact
--figure FILE .png.pdf.svg: also draw the forces over the contact, or psi2 over psi1 (.png, .pdf \
or .svg)
LOOK
--stick-slip FILE .png.pdf.svg: also draw regions of stick and slip over the contact of a single \
impact
--estimate --no-estimate default=True BooleanOptional: estimate the numerical error of a single \
impact by finer runs (the default)
PROGRESS""",
    "sweep": """
scene SCENE.toml nargs=?: a sweep, instead of ranges
RANGES
LAWS
--json StoreTrue: print JSON instead of the table
--csv StoreTrue: print psi1, chi, psi2 as CSV
--out FILE .json.csv.npz
--resume StoreTrue: keep finished impacts in a folder beside --out, and continue a stopped sweep
--workers N type=int: share the work among N processes
--figure FILE .png.pdf.svg: also draw psi2 over psi1 (.png, .pdf or .svg)
LOOK
PROGRESS""",
    "compare": """
scene SCENE.toml nargs=?: a scene or a sweep (default: psi2 over psi1 of a solid sphere, chi = \
49/34)
RANGES
MEASURED
--all StoreTrue: every installed tangential law that fits, one row a law
SEVERAL
--quantity A,B,... type=names: quantities to compare (default: the measured quantities, or psi2)
--figure FILE .png.pdf.svg: also draw the comparison (.png, .pdf or .svg)
LOOK
--loops FILE .png.pdf.svg: also draw friction force over displacement, at constant and at \
oscillating load
--estimate-error StoreTrue: estimate the numerical error of each law for the figure's bands \
(--all always does)
--json StoreTrue: print JSON instead of tables
--csv StoreTrue: print CSV instead of tables
PROGRESS""",
    "fit": """
files FILE nargs=+ required: DATA.csv and SCENE.toml, or a SCENE.toml that holds measured values
--fit A,B,... default=['friction_coefficient'] type=names: friction_coefficient (default), \
stiffness_ratio, or options of the laws chosen, such as normal.restitution
--laws A,B,... default=['exact'] type=names: tangential laws, the first reported and all ranked; \
exact (default) is the exact elastic law, computed from a table
--normal NAME type=str: name of the normal law
--integrator NAME type=str: name of the integrator
SET
--quantity A,B,... type=names: measured quantities to fit (default: all)
--bootstrap SAMPLES default=200 type=int: samples of the bootstrap of the first law (default 200; \
0 for none)
COLUMN
--figure FILE .png.pdf.svg: draw measured values, laws and residuals (.png, .pdf or .svg)
LOOK
--csv FILE.csv .csv: write the residuals
--json StoreTrue: print JSON instead of tables
PROGRESS""",
    "bench": """
REPORT
--markdown StoreTrue: print a row or two for each law, as Markdown""",
    "stability": """
REPORT""",
    "validate": """
--figures DIR type=Path: draw a picture of each source in this folder
--json StoreTrue: print JSON instead of the tables
PROGRESS""",
    "figures": """
--out DIR type=Path required: folder for the files
--only 1,2,... default=[1, 2, 3, 4] type=_numbers: numbers of the figures to draw (default: all)
--format choices=png,pdf,svg default=png: format of the pictures
LOOK
LAWS
PROGRESS""",
    "animate": """
PSI1
--ghost A,B,... default=[] type=names: tangential laws whose spheres part from this one after the \
contact, as outlines
--out FILE.gif .gif required
PROGRESS""",
    "explore": """
--angle default=35.0 type=finite: first angle in degrees from the normal (default: 35)
--speed default=2.0 type=finite: first speed in m/s (default: 2)
--spin default=100.0 type=finite: first spin in rad/s (default: 100)
--friction default=0.8 type=finite: first friction (default: 0.8)
--material NAME default=pmma: of ball and block (default: pmma)
--predict StoreTrue: ask for a prediction first
--out FILE.html default=explore.html .html: (default: explore.html)
PROGRESS""",
    "report": """
scene SCENE.toml required: a scene or a sweep
--tangential A,B,... type=names: tangential laws to compare with the file's own (default: fronts \
and coulomb, if they fit its normal law)
--normal NAME: normal law in place of the file's own
--integrator NAME: integrator in place of the file's own
MEASURED
--out FILE.html .html required
PROGRESS""",
    "kernel": """
--out DIR type=Path required: folder; made if it is not there""",
    "cite": """
scene SCENE.toml nargs=?: a scene or a sweep
SEVERAL""",
    "materials": """
name NAME nargs=?: leave it out for the list
--json StoreTrue: print JSON instead of the table""",
    "plugins": """
[list] name, kind, distribution and version of every law
--json StoreTrue: print JSON
[show] description and options of a law
name NAME required: such as tangential.annulus, or my-laws:tangential.annulus
--json StoreTrue: print JSON
[check] check a law against its contract; exit 1 if it fails
name NAME required: such as tangential.annulus, or my-laws:tangential.annulus
PROGRESS
--json StoreTrue: print JSON""",
    "guide": """
topic TOPIC nargs=?: leave it out for the list
section SECTION nargs=?: number of a section, for theory""",
}


def expected(text):
    """Return the lines of a text with what is shared in its place."""
    lines = text.replace("\\\n", "").strip().splitlines()
    found = [expected(SHARED[line]) if line in SHARED else [line] for line in lines]
    return list(itertools.chain.from_iterable(found))


def taken(convert, folder):
    """Return the suffixes that a converter to a file takes."""
    good = []
    for suffix in SUFFIXES:
        try:
            assert convert(str(folder / f"a{suffix.upper()}")) == folder / f"a{suffix.upper()}"
        except argparse.ArgumentTypeError:
            continue
        good.append(suffix)
    return "".join(good)


def line(action, folder):
    words = [*action.option_strings] or [action.dest]
    words += [action.metavar] if action.metavar else []
    words += [f"nargs={action.nargs}"] if action.nargs else []
    if action.option_strings and action.dest != action.option_strings[0][2:].replace("-", "_"):
        words.append(f"dest={action.dest}")
    words += [f"choices={','.join(action.choices)}"] if action.choices else []
    words += [f"default={action.default}"] if action.default not in (None, False) else []
    if action.type:
        convert = action.type.__qualname__ == "file_of.<locals>.convert"
        name = taken(action.type, folder) if convert else f"type={action.type.__name__}"
        words.append(name)
    words += ["required"] if action.required else []
    kind = type(action).__name__.strip("_").removesuffix("Action")
    words += [kind] if kind != "Store" else []
    told = (action.help or "").removesuffix(" (default: %(default)s)")  # of some versions of Python
    return " ".join(words) + (f": {told}" if told else "")


def described(parser, folder):
    """Return a line for each argument of a parser, in the order of its help."""
    lines = []
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            helps = {choice.dest: choice.help for choice in action._choices_actions}
            for name, inner in action.choices.items():
                lines += [f"[{name}] {helps[name]}", *described(inner, folder)]
        elif not isinstance(action, argparse._HelpAction):
            lines.append(line(action, folder))
    return lines


@pytest.mark.parametrize("command", module.COMMANDS)
def test_the_arguments_of_a_command(command, tmp_path):
    (parser,) = module._parser([command])._subparsers._group_actions[0].choices.values()
    assert described(parser, tmp_path) == expected(COMMANDS[command])
    assert parser.prog == f"contactlab {command}"
    assert not parser.allow_abbrev
    assert parser.formatter_class is argparse.RawDescriptionHelpFormatter
    assert "examples:\n  contactlab " in parser.epilog


def test_the_arguments_before_a_command():
    parser = module._parser([])
    assert parser.prog == "contactlab"
    assert parser.description == (
        "Oblique impact of elastic bodies, with contact laws as plug-ins."
    )
    assert parser.epilog.splitlines()[-1] == (
        "exit status: 0 success, 1 a run failed, 2 bad input, 130 interrupted"
    )
    assert parser.formatter_class is argparse.RawDescriptionHelpFormatter
    found = {action.dest: action for action in parser._actions}
    assert list(found) == ["help", "version", "traceback", "command"]
    assert found["traceback"].help == "show the traceback of an error (before COMMAND)"
    assert found["command"].required
    assert found["command"].metavar == "COMMAND"


@pytest.mark.parametrize(
    ("command", "forms"), [("compare", ["json", "csv"]), ("sweep", ["json", "csv"])]
)
def test_forms_of_output_exclude_each_other(command, forms):
    (parser,) = module._parser([command])._subparsers._group_actions[0].choices.values()
    (group,) = parser._mutually_exclusive_groups
    assert [action.dest for action in group._group_actions] == forms
