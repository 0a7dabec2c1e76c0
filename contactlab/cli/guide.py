"""Print a topic of the guide, or list the topics.

Examples
--------
  contactlab guide
  contactlab guide choosing
  contactlab guide theory 5
  contactlab guide theory | less
"""

from __future__ import annotations

import argparse
import difflib
import re

from contactlab.numeric.checks import refuse

#: Topics in the order in which a newcomer reads them; each is a file of ``contactlab/guide``.
TOPICS = (
    "getting-started", "units-and-signs", "choosing", "how-far-to-trust", "plans-and-statuses",
    "for-a-paper", "command-line", "fitting", "extending", "version-2", "theory", "glossary",
)  # fmt: skip
#: The heading of a numbered section, as in ``## 5. The slip front``.
SECTION = re.compile(r"^## (\d+)\. ", re.MULTILINE)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the topic and the section."""
    parser.add_argument("topic", nargs="?", metavar="TOPIC", help="leave it out for the list")
    parser.add_argument(
        "section", nargs="?", metavar="SECTION", help="number of one section, of the theory"
    )


def execute(arguments: argparse.Namespace) -> int:
    """Print the list of topics, a topic, or one section of it."""
    if arguments.topic is None:
        width = max(map(len, TOPICS))
        for topic in TOPICS:
            print(f"{topic.ljust(width)}  {summary(topic)}")
        print("\ncontactlab guide TOPIC prints one of them.")
        return 0
    found = text(arguments.topic)
    if arguments.section is not None:
        found = sections(found).get(arguments.section.lstrip("§"), "")
        if not found:
            raise refuse(
                "section",
                arguments.section,
                f"is not a section of {arguments.topic!r}",
                "leave it out for the whole topic",
            )
    print(found.rstrip())
    return 0


def text(topic: str) -> str:
    """Return the Markdown of a topic.

    Raises
    ------
    ValueError
        If there is no such topic, with the nearest match.
    """
    from importlib import resources  # only those who read the guide pay for it

    name = topic.removesuffix(".md")
    if name not in TOPICS:
        nearest = difflib.get_close_matches(name, TOPICS, n=1, cutoff=0.4)
        hint = f"did you mean {nearest[0]!r}? " if nearest else ""
        raise refuse("topic", topic, "is not in the guide", f"{hint}known: {', '.join(TOPICS)}")
    return resources.files("contactlab").joinpath("guide", f"{name}.md").read_text("utf-8")


def summary(topic: str) -> str:
    """Return the line below the title, which says what a topic is about."""
    return text(topic).split("\n", 3)[2]


def sections(markdown: str) -> dict[str, str]:
    """Return the numbered sections of a topic by their numbers, each from its heading on."""
    starts = list(SECTION.finditer(markdown))
    ends = [*(start.start() for start in starts), len(markdown)][1:]
    return {
        start[1]: markdown[start.start() : end] for start, end in zip(starts, ends, strict=True)
    }
