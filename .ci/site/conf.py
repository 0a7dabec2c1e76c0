"""Settings of the site; ``.ci/site/build`` lays the sources out."""

import os
import re
import sys
from html import unescape
from pathlib import Path
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from PIL import Image
from sphinx_gallery.directives import imgsgnode

import contactlab
from contactlab.cli.guide import PARTS, text
from contactlab.cli.guide import pages as guide_pages

sys.path.insert(0, str(Path(__file__).parent))
from examples import NOT_RUN, InOrder, Pictures, arguments

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
myst_enable_extensions = ["colon_fence", "dollarmath"]
html_math_renderer = "mathml"
myst_heading_anchors = 3
napoleon_numpy_docstring = True
napoleon_google_docstring = False
napoleon_use_ivar = True  # attributes are documented where they are declared, once
autodoc_typehints = "none"  # the docstrings tell types, with shapes and units
autodoc_member_order = "bysource"

html_theme = "furo"
html_title = f"contactlab {version}"
html_theme_options = {"navigation_with_keys": True}
exclude_patterns = ["gallery-source", "**sg_execution_times.rst"]
html_extra_path = ["explore.html"]
html_static_path = ["site.css", "site.js"]
html_css_files = ["site.css"]
html_js_files = ["site.js"]
html_favicon = "favicon.svg"
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
    "within_subsection_order": InOrder(),
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


#: Spaces that LaTeX sets and latex2mathml does not: none around a slash, a bar and behind a sign, a
#: thin one behind a function without brackets that something follows.
SPACES = {
    r"<mo>(&#x0002F;|&#x0007C;)</mo>": r'<mo stretchy="false" lspace="0" rspace="0">\1</mo>',
    r"(<mo[^>]*>&#x0(?:003D|0028|005B|2264);</mo><mo)(?=>&#x02212;)": r'\1 lspace="0" rspace="0"',
    r"<mo>([a-z]\w+)</mo>": r"<mi>\1</mi>",
    r"(<mi>[a-z]\w+</mi>)(?!<mo stretchy=.false.>&#x00028;|</m)": r'\1<mspace width=".2em"/>',
    r"<mi>&#x02032;</mi>": "<mo>&#x02032;</mo>",
}


#: What the text says to type, and a section where it names one.
TYPED = re.compile(r"contactlab guide ([a-z][a-z-]*)(?: (\d+))?")
#: A thumbnail's link: its attributes, the end of its tag, and its words.
THUMBNAIL = re.compile(
    r'(thumbcontainer"[^>]*><img[^>]*>\s*<p><a [^>]*)(><span class="doc">)([^<"]*)'
)
#: Letters of a formula from which on it has a line of its own on a phone, where it can be scrolled.
LONG = 24
#: Width over height of a picture from which on it has panels beside each other.
PANELS = 1.8


def linked(app: Any, doctree: nodes.document, page: str) -> None:
    """Make a link of each ``contactlab guide NAME``, to the page or the section that it names."""
    for literal in list(doctree.findall(nodes.literal)):
        typed = TYPED.fullmatch(" ".join(literal.astext().split()))
        if typed is None or isinstance(literal.parent, nodes.reference):
            continue
        topic, number = typed.groups()
        target, anchor = topic, ""
        for part in PARTS.get(topic, ()) if number else ():
            if heading := re.search(rf"^## ({number}\. .*)$", text(part), re.MULTILINE):
                slug = re.sub(r"[^\w -]", "", heading[1]).lower().replace(" ", "-")
                target, anchor = part, f"#{slug}"
        if target not in guide_pages():
            continue
        uri = app.builder.get_relative_uri(page, target) + anchor
        reference = nodes.reference("", "", internal=True, refuri=uri)
        literal.replace_self(reference)
        reference += literal


def scrolled(app: Any, doctree: nodes.document, _: str) -> None:
    """Give panels side by side a place that scrolls on a phone, where they keep their size."""
    for node in [*doctree.findall(nodes.image), *doctree.findall(imgsgnode)]:
        path = Path(app.srcdir, node["uri"].lstrip("/"))
        if not path.is_file():
            continue
        with Image.open(path) as picture:
            width, height = picture.size
        if width > PANELS * height and path.suffix == ".png":
            place = nodes.container(classes=["panels"])
            node.replace_self(place)
            place += node


def named(app: Any, error: Exception | None) -> None:
    """Tell readers of a screen the level of captions, and where a thumbnail leads.

    The theme leaves out the one, and the gallery hides the words of its links.
    """
    for path in [] if error else Path(app.outdir).rglob("*.html"):
        page = path.read_text("utf-8")
        told = page.replace('role="heading">', 'role="heading" aria-level="2">')
        told = THUMBNAIL.sub(r'\1 aria-label="\3"\2\3', told)
        if told != page:
            path.write_text(told, "utf-8")


def mathml(latex: str, display: str) -> str:
    """Return a formula as MathML, which browsers draw without a network."""
    formula = convert(latex, display=display)
    for before, after in SPACES.items():
        formula = re.sub(before, after, formula)
    return formula


def formula(translator: Any, node: Any) -> None:
    """Write a formula within a line."""
    written = mathml(node.astext(), "inline")
    letters = len(unescape(re.sub(r"<[^>]*>", "", written)))
    translator.body.append(
        f'<span class="formula">{written}</span>' if letters >= LONG else written
    )
    raise nodes.SkipNode


def displayed_formula(translator: Any, node: Any) -> None:
    """Write a formula of its own lines."""
    translator.body.append(f'<div class="formula">{mathml(node.astext(), "block")}</div>')
    raise nodes.SkipNode


def setup(app: Any) -> None:
    """Have formulas made, and attributes taken apart after napoleon has read the docstrings."""
    app.add_html_math_renderer("mathml", (formula, None), (displayed_formula, None))
    app.connect("viewcode-follow-imported", not_followed)
    app.connect("autodoc-skip-member", left_out)
    app.connect("doctree-resolved", linked)
    app.connect("doctree-resolved", scrolled)
    app.connect("build-finished", named)
    app.connect("autodoc-process-docstring", attributes_apart, priority=900)
