"""Settings of the site; ``.ci/site/build`` lays the sources out."""

import os
import re
import sys
from pathlib import Path
from typing import Any

import contactlab

sys.path.insert(0, str(Path(__file__).parent))
from examples import NOT_RUN, Pictures, arguments

project = "contactlab"
author = "The contactlab developers"
copyright = "The contactlab developers, MIT licence"
release = version = contactlab.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.viewcode",
    "sphinx.ext.napoleon",
    "sphinx_gallery.gen_gallery",
    "sphinx_copybutton",
]
copybutton_exclude = ".linenos, .gp, .go"  # no prompts and no output
myst_enable_extensions = ["colon_fence"]
myst_heading_anchors = 3
napoleon_numpy_docstring = True
napoleon_google_docstring = False
napoleon_use_ivar = True  # attributes are documented where they are declared, once
autodoc_typehints = "none"  # the docstrings tell types, with shapes and units
autodoc_member_order = "bysource"

html_theme = "furo"
html_title = f"contactlab {version}"
html_theme_options = {"navigation_with_keys": True}
exclude_patterns = ["gallery-source"]
html_extra_path = ["explore.html"]
html_static_path = ["site.css"]
html_css_files = ["site.css"]
autosummary_generate = False  # the tables lead to the pages of the rooms
html_copy_source = html_show_sourcelink = True
suppress_warnings = [
    "config.cache",  # the gallery's order is an object, not a word
    "ref.python",  # words of types, such as "shape", are taken for names that several classes have
]

sphinx_gallery_conf = {
    "examples_dirs": os.environ["CONTACTLAB_EXAMPLES"],
    "gallery_dirs": "gallery",
    "filename_pattern": rf"/(?!{'|'.join(NOT_RUN)})\w+\.py$",
    "reset_argv": arguments,
    "image_scrapers": (Pictures(),),
    "reset_modules": (),
    "capture_repr": (),  # what a script prints; the pictures are found as files
    "matplotlib_animations": False,
    "remove_config_comments": True,
    # A kernel has options of its own, which a script would take for its.
    "first_notebook_cell": "import sys\n\nsys.argv = sys.argv[:1]",
    "min_reported_time": 1e9,
    "show_memory": False,
    "download_all_examples": False,
}


def attributes_apart(*given: Any) -> None:
    """Give each of several attributes that are documented together a line of its own.

    Sphinx reads the first of ``:ivar start, end:`` as the type of the last.
    """
    lines: list[str] = given[-1]
    apart: list[str] = []
    for line in lines:
        field = re.match(r":(ivar|vartype) (\w+(?:, \w+)+):(.*)", line)
        names = field[2].split(", ") if field else []
        apart += [f":{field[1]} {name}:{field[3]}" for name in names] if field else [line]
    lines[:] = apart


def left_out(*given: Any) -> bool | None:
    """Leave out fields of named tuples that the docstring of the class documents."""
    return True if (given[3].__doc__ or "").startswith("Alias for field number") else None


def not_followed(_: Any, module: str, name: str) -> str | None:
    """Leave the source of ``fit`` to the page of its room, to which that file leads back.

    A page of source leads back to one module, the first that documents a name of it.
    """
    return module if (module, name) == ("contactlab", "fit") else None


def setup(app: Any) -> None:
    """Have the attributes taken apart after napoleon has read the docstrings."""
    app.connect("viewcode-follow-imported", not_followed)
    app.connect("autodoc-skip-member", left_out)
    app.connect("autodoc-process-docstring", attributes_apart, priority=900)
