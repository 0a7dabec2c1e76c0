"""The contract as a page of the guide, from the code: ``python -m tests.house.contract_page``."""

import inspect
import re
import textwrap

from contactlab import contracts
from contactlab.contracts.law import API_VERSION
from tests.present import PACKAGE

FILE = PACKAGE / "guide" / "extending.md"
HEADING = "## The contract on a page\n"
INTRODUCTION = f"""
This is all of the contract, printed from the classes (version {API_VERSION}). A star marks what a
law must write; the rest has a safe default. A class has the members of the classes before it that
it is derived from. `contactlab.contracts` has all names; those of classes that one derives from or
returns stand in `contactlab` too.
"""
CLASSES = (
    "Law", "NormalLaw", "ClosedFormNormalLaw", "UnfollowedNormalLaw", "TangentialLaw",
    "SteppedTangentialLaw", "CausalTangentialLaw", "AllStepsTangentialLaw", "PathTangentialLaw",
    "WholeImpactTangentialLaw", "CoupledTangentialLaw", "ResolvingTangentialLaw", "Integrator",
    "CoupledIntegrator",
)  # fmt: skip
VALUES = (
    "NormalContact", "NormalMotion", "NormalSample", "Increment", "TangentialResponse",
    "WholeImpact", "Errors", "Cost", "Sample", "TangentialMotion",
)  # fmt: skip
#: A section of a docstring with its text.
SECTION = re.compile(r"(?:^|\n)([A-Z][\w ]+)\n-{3,}\n(.*?)(?=\n[A-Z][\w ]+\n-{3,}\n|\Z)", re.DOTALL)
#: An entry of a section: names, and the indented text.
ENTRY = re.compile(r"^(\w[\w, ]*?) : .*\n((?:    .*\n?)+)", re.MULTILINE)
#: An attribute of a class with the comment before it.
ATTRIBUTE = re.compile(r"#: (.*)\n    (\w+): (?:ClassVar\[)?(.*?)\]?(?: = .*)?$", re.MULTILINE)


def page():
    """Return the text of the page."""
    laws = "\n".join(map(_law, CLASSES))
    values = "\n".join(map(_value, VALUES))
    return (
        f"{HEADING}{INTRODUCTION}\n{laws}\n### What goes in and comes out\n\n```text\n{values}```\n"
    )


def _law(name):
    """Return heading, rules and members of a class of laws."""
    law = getattr(contracts, name)
    bases = [base.__name__ for base in law.__bases__ if base.__name__ in CLASSES]
    title = f"### {name}" + (f"({', '.join(bases)})" if bases else "")
    doc = inspect.getdoc(law)
    rules = _plain(dict(SECTION.findall(doc)).get("Contract", "").rstrip())
    members = "".join(_members(law))
    parts = [title, _plain(_summary(doc)), *([rules] if rules else [])]
    return "\n\n".join([*parts, *([f"```text\n{members}```"] if members else [])]) + "\n"


def _members(law):
    """Yield the members that a class adds, each with the line that describes it."""
    for text, name, kind in ATTRIBUTE.findall(inspect.getsource(law)):
        if name.startswith("_"):
            continue
        must = "  " if name in vars(law) else "* "
        yield f"{must}{name}: {kind}\n      {text}\n"
    for name, member in vars(law).items():
        if name.startswith("_"):
            continue
        must = "* " if name in law.__abstractmethods__ else "  "
        if isinstance(member, property):
            yield f"{must}{name}: {member.fget.__annotations__['return']}\n"
            yield f"      {_summary(member.__doc__)}\n"
        elif inspect.isfunction(member):
            yield f"{must}{name}{_signature(member)}\n      {_summary(member.__doc__)}\n"


def _signature(function):
    """Return arguments with types, without the law, and what is returned."""
    signature = inspect.signature(function)
    arguments = [*signature.parameters.values()][1:]
    text = str(signature.replace(parameters=arguments)).replace("'", "")
    return re.sub(r"\bAny\b", "State", text)


def _value(name):
    """Return a class of values with its entries."""
    value = getattr(contracts, name)
    doc = inspect.getdoc(value)
    lines = [f"{name}: {_summary(doc)}"]
    if inspect.isabstract(value):
        lines += [f"    {line}" for line in "".join(_members(value)).splitlines()]
    for names, text in ENTRY.findall(
        dict(SECTION.findall(doc + "\n")).get("Attributes", "") + "\n"
    ):
        entry = f"{names}: {' '.join(text.split())}".replace("``", "")
        lines += textwrap.wrap(entry, 100, initial_indent="    ", subsequent_indent="        ")
    return "\n".join(lines) + "\n"


def _summary(doc):
    return doc.strip().splitlines()[0].replace("``", "")


def _plain(text):
    """Return text of a docstring as Markdown, with the table of words as one of Markdown."""
    before, *table, after = re.split(r"\n *=+  =+\n", text) if "====" in text else (text, "")
    rows = re.sub(r"\n {20,}", " ", table[0]) if table else ""
    rows = re.sub(r"^ *(``\w+``) +(.*)$", r"| \1 | \2 |", rows, flags=re.MULTILINE)
    if rows:
        rows = f"\n| word | what a law claims by it |\n|---|---|\n{rows}\n"
    return f"{before}{rows}{after}".replace("``", "`")


def written():
    """Return the text of the guide with the page as it is now."""
    return FILE.read_text(encoding="utf-8").partition(HEADING)[0] + page()


if __name__ == "__main__":
    FILE.write_text(written(), encoding="utf-8")
