"""Lays the examples out as sphinx-gallery wants them, and finds the pictures that they write."""

from __future__ import annotations

import ast
import re
import shutil
from pathlib import Path
from typing import Any

#: What a script may rely on and the gallery does not give it; not shown in its page.
HIDDEN = """
# sphinx_gallery_start_ignore
__doc__ = {doc!r}
# sphinx_gallery_end_ignore
"""

#: The gallery from the first impact to laws of one's own; its thumbnails stand in this order.
ORDER = (
    "one_impact", "signs", "law_swap", "sweep", "stick_slip_map", "reproduce_the_paper",
    "experiment", "fit_your_experiment", "billiards", "throw_of_billiard_balls", "superball",
    "loss_in_shear", "granular_gas", "any_two_bodies", "several_contacts", "toe_shot", "egg",
    "hysteresis", "beyond_the_paper", "custom_law", "law_in_five_minutes", "sweep_on_a_cluster",
)  # fmt: skip

#: Arguments that make a script short.
SHORT = {
    "billiards": ["--collisions", "60", "--frames", "40"],
    "granular_gas": ["--grains", "600", "--collisions", "20"],
}

#: Start processes, and are not run for the gallery; their pictures are those kept in the tree.
NOT_RUN = ("sweep_on_a_cluster",)
KEPT_PICTURE = """
.. image:: /{picture}

"""
THUMBNAIL = """
# sphinx_gallery_thumbnail_path = "{picture}"
"""


def lay_out(examples: Path, to: Path) -> None:
    """Copy the examples, the first sentence of each as its title."""
    to.mkdir(parents=True)
    kept = to.parent / "kept-pictures"
    kept.mkdir()
    for script in sorted(examples.glob("*.py")):
        text = script.read_text("utf-8")
        doc = ast.get_docstring(ast.parse(text)) or script.stem
        head, _, rest = doc.partition("\n\n")
        title, _, more = " ".join(head.split()).partition(": ")
        title = title.rstrip(".")
        rest = re.sub(r"\n\n(?=    \S)", "\n\n::\n\n", "\n\n" + rest).strip()  # commands
        words = [title, "=" * len(title), "", more[:1].upper() + more[1:], "", rest]
        code = text.split('"""', 2)[2]
        # a script in cells is a notebook, which has no file, and begins with words
        cells = code.lstrip().startswith("# %%")
        hidden = "" if cells else HIDDEN.format(doc=doc)
        if script.stem in NOT_RUN:
            picture = shutil.copy(examples / "pictures" / f"{script.stem}.png", kept)
            place = Path(picture).relative_to(to.parent).as_posix()
            words.append(KEPT_PICTURE.format(picture=place))
            hidden += THUMBNAIL.format(picture=place)
        page = '"""\n' + "\n".join(words) + '\n"""\n' + hidden + code
        (to / script.name).write_text(page, "utf-8")
    for scene in examples.glob("*.toml"):
        shutil.copy(scene, to)


def arguments(_: Any, variables: dict[str, Any]) -> list[str]:
    """Return the arguments with which a page's script is run: short ones, where it takes any."""
    return SHORT.get(Path(variables["src_file"]).stem, [])


class InOrder:
    """The key that sorts scripts as ``ORDER`` does; a script that is missing there is an error."""

    def __repr__(self) -> str:
        """Return the same for the same order, or everything is built anew."""
        return f"InOrder{ORDER}"

    def __call__(self, script: str) -> int:
        """Return the place of a script in the gallery."""
        return ORDER.index(Path(script).stem)


class Pictures:
    """A scraper of sphinx-gallery: the pictures that a script has written beside itself."""

    def __init__(self) -> None:
        self.seen: set[Path] = set()

    def __repr__(self) -> str:
        """Return the same for the same settings, or everything is built anew."""
        return "Pictures()"

    def __call__(self, _: Any, variables: dict[str, Any], settings: dict[str, Any]) -> str:
        """Move what the script wrote to where the page finds it, and return the page's part."""
        from sphinx_gallery.scrapers import figure_rst

        folder = Path(variables["src_file"]).parent
        found = []
        for picture in sorted([*folder.glob("*.png"), *folder.glob("*.gif")]):
            if picture not in self.seen:
                self.seen.add(picture)
                place = Path(next(variables["image_path_iterator"])).with_suffix(picture.suffix)
                shutil.move(picture, place)
                found.append(str(place))
        return figure_rst(found, settings["src_dir"])
