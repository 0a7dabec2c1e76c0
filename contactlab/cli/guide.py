"""Print a topic of the guide, or list the topics.

Examples
--------
  contactlab guide
  contactlab guide choosing
  contactlab guide theory 5
  contactlab guide glossary slip
  contactlab guide theory-springs | less
"""

from __future__ import annotations

import argparse
import re
import shutil
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from contactlab.cli.formulas import readable
from contactlab.numeric.checks import refuse
from contactlab.numeric.names import nearest
from contactlab.registration.hooks import Execute, hookimpl
from contactlab.registration.manager import MANAGER
from contactlab.registration.names import PAGE, short_name

#: Topics in reading order by group; each is a file of ``contactlab/guide``.
USE = "Use"
GROUPS = {
    USE: (
        "getting-started", "choosing", "command-line", "any-two-bodies",
        "several-contacts", "load-paths", "many-machines", "engines", "for-a-paper",
    ),
    "Trust": ("how-far-to-trust", "plans-and-statuses", "units-and-signs"),
    "Extend": ("laws", "extending"),
    "Look up": ("glossary", "theory"),
}  # fmt: skip
#: Parts of the long topics, whose own pages begin with a table of them.
PARTS = {
    "extending": (
        "extending-contact", "extending-impacts", "extending-kit", "extending-integrator",
        "extending-command", "extending-knowledge",
    ),
    "theory": (
        "theory-impact", "theory-springs", "theory-methods", "theory-coupling",
        "theory-normal-laws", "theory-more-laws", "theory-loss", "theory-elliptic", "theory-spin",
        "theory-contacts", "beyond-the-paper", "theory-references",
    ),
}  # fmt: skip


def add_pages() -> dict[str, Path]:
    """Return the pages of plug-ins by name: files of the packages that their entry points name."""
    infos = [info for info in MANAGER.installed(PAGE) if info.usable and info.meant]
    found = {short_name(info.name): resource(info.module, info.name) for info in infos}
    return {name: path for name, path in found.items() if path is not None}


@cache
def resource(package: str, name: str) -> Path | None:
    """Return the file of a page in a package, which is not imported; None if there is none."""
    spec = find_spec(package)
    for folder in (spec and spec.submodule_search_locations) or ():
        if (path := Path(folder, f"{short_name(name)}.md")).is_file():
            return path
    return None


def groups() -> dict[str, tuple[str, ...]]:
    """Return the topics by group; pages of plug-ins end the first."""
    return GROUPS | {USE: GROUPS[USE] + tuple(sorted(add_pages()))}


def topics() -> tuple[str, ...]:
    """Return all topics in reading order."""
    return tuple(topic for group in groups().values() for topic in group)


def pages() -> tuple[str, ...]:
    """Return all topics, each with its parts."""
    return tuple(page for topic in topics() for page in (topic, *PARTS.get(topic, ())))


#: Longest line of prose, however wide the terminal is.
WIDEST = 100
GLOSSARY = "glossary"
#: Signs of LaTeX that no word has: a page that has ``\\psi_1`` is found by psi1.
LATEX = str.maketrans("", "", "\\_{}$")
#: Heading of a numbered section, such as ``## 5. The slip front``.
SECTION = re.compile(r"^## (\d+)\. ", re.MULTILINE)


@hookimpl
def contactlab_command(parser: argparse.ArgumentParser) -> Execute:
    """Add the topic and the section."""
    parser.add_argument(
        "topic", nargs="?", metavar="TOPIC", help="a topic, or a part of one; without it, the list"
    )
    parser.add_argument(
        "section", nargs="?", metavar="SECTION",
        help="number of a section, for theory; a word, for the glossary",
    )  # fmt: skip
    return execute


def execute(arguments: argparse.Namespace) -> int:
    """Print the list of topics, a topic, or one section of a topic."""
    if arguments.topic is None:
        width = max(map(len, topics()))
        for group, members in groups().items():
            print(group)
            for topic in members:
                print(f"  {topic.ljust(width)}  {summary(topic)}")
        print("\ncontactlab guide TOPIC prints a topic.")
        return 0
    shown = text(arguments.topic)
    if arguments.section is not None:
        glossary = arguments.topic.removesuffix(".md") == GLOSSARY
        parts = entries(shown) if glossary else sections(arguments.topic)
        asked = arguments.section.lower().lstrip("§")
        if asked not in parts:
            what = "entry" if glossary else "section"
            hint = nearest(asked, parts, alike=0.75) if glossary else ""
            raise refuse(
                "section",
                arguments.section,
                f"is not {'an' if glossary else 'a'} {what} of {arguments.topic!r}",
                hint or "leave it out for the whole topic",
            )
        shown = parts[asked]
    width = min(shutil.get_terminal_size().columns, WIDEST)
    print(readable(shown.rstrip(), width))
    return 0


def whole(topic: str) -> str:
    """Return the Markdown of a topic with all its parts."""
    return "\n".join(map(text, (topic, *PARTS.get(topic.removesuffix(".md"), ()))))


def text(topic: str) -> str:
    """Return the Markdown of a topic, or of a part of one."""
    from importlib import resources  # only when the guide is read

    name = topic.removesuffix(".md")
    if name not in pages():
        read = ", ".join(map(repr, about(name)))
        hint = nearest(name, pages(), alike=0.75) or f"read of {name} in {read}; " * bool(read)
        raise refuse("topic", topic, "is not in the guide", f"{hint}known: {', '.join(topics())}")
    if name in add_pages():
        return add_pages()[name].read_text("utf-8")
    return resources.files("contactlab").joinpath("guide", f"{name}.md").read_text("utf-8")


def about(word: str) -> list[str]:
    """Return at most three pages that have a word, those with most headings and lines first."""
    found = {}
    for topic in pages():
        known = text(topic).lower().translate(LATEX).splitlines()
        lines = [line for line in known if word.lower().translate(LATEX) in line]
        if lines:
            found[topic] = (sum(line.startswith("#") for line in lines), len(lines))
    return sorted(found, key=lambda topic: found[topic], reverse=True)[:3]


def summary(topic: str) -> str:
    """Return the summary of a topic: the line below its title."""
    return text(topic).split("\n", 3)[2]


def sections(topic: str) -> dict[str, str]:
    """Return the numbered sections of a topic and its parts by number, each with its heading."""
    found = {}
    for page in (topic, *PARTS.get(topic.removesuffix(".md"), ())):
        markdown = text(page)
        starts = list(SECTION.finditer(markdown))
        stops = [*(start.start() for start in starts), len(markdown)][1:]
        for start, stop in zip(starts, stops, strict=True):
            found[start[1]] = markdown[start.start() : stop]
    return found


def entries(markdown: str) -> dict[str, str]:
    """Return the entries of the glossary by term, symbol and name in code, in small letters."""
    found: dict[str, str] = {}
    for row in re.findall(r"^\| (.* \|)$", markdown, re.MULTILINE):
        cells = [cell.strip() for cell in row.removesuffix(" |").split(" |")]
        between = ", ".join(cell for cell in cells[1:-1] if cell)
        entry = f"{cells[0]} ({between}): {cells[-1]}".replace(" ()", "")
        middle = " ".join(cells[1:-1]).replace("\\", "")
        names = re.findall(r"(\w+)(?:\(\w+\))?`|\$(\w+)\$", middle)
        for word in (*cells[0].split(", "), *map("".join, names)):
            found.setdefault(word.lower(), entry)
    return found
