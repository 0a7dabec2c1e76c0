"""The site in a browser: built without a warning, index, a page of the gallery, the search."""

from __future__ import annotations

import html
import json
import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote
from xml.etree import ElementTree

import pytest

import contactlab
from contactlab.cli.guide import pages as guide_pages
from contactlab.cli.guide import topics as guide_topics
from contactlab_pages.explore import explore_page

pytestmark = pytest.mark.browser
TOP = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    out = tmp_path_factory.mktemp("site")
    done = subprocess.run(
        [TOP / ".ci" / "site" / "build", out],
        env={**os.environ, "PYTHON": sys.executable},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    return out


def test_the_index_leads_to_the_guide(site, opened):
    page = opened(site / "index.html")
    assert page.find_element("tag name", "h1").text.startswith("contactlab")
    page.find_element("link text", "Theory").click()
    assert page.find_element("tag name", "h1").text.startswith("Theory")


def test_topics_stand_in_groups_and_code_can_be_copied(site, opened):
    page = opened(site / "index.html")
    captions = [each.text for each in page.find_elements("css selector", ".sidebar-tree .caption")]
    assert len(captions) == 5
    assert page.find_elements("css selector", "button.copybtn")
    assert page.find_elements("link text", "Changelog")
    told = page.find_element("css selector", "article").text
    assert "Who are you?" in told
    assert "pip install" in told


def test_a_page_of_the_gallery_shows_picture_and_output(site, opened):
    page = opened(site / "gallery" / "stick_slip_map.html")
    pictures = page.find_elements("css selector", "article img.sphx-glr-single-img")
    assert [picture.get_property("naturalWidth") > 500 for picture in pictures] == [True]
    assert (
        "of the springs in contact stick"
        in page.find_element("css selector", ".sphx-glr-script-out").text
    )


def test_formulas_are_typeset_and_drawings_left(site, opened):
    page = opened(site / "theory.html")
    page.find_element("link text", "theory-impact").click()
    fraction = page.find_element("css selector", ".formula math mfrac")
    assert fraction.size["height"] > 1.4 * page.find_element("css selector", "p").size["height"] / 3
    assert len(page.find_elements("css selector", "math")) > 35
    places = [each.rect["x"] for each in page.find_elements("css selector", ".formula mtd")]
    assert len(set(places)) > 4  # columns in line
    page = opened(site / "theory-springs.html")
    assert any("edge slip" in each.text for each in page.find_elements("css selector", "pre"))


def test_no_formula_is_left_as_latex(site):
    for topic in guide_pages():
        page = (site / f"{topic}.html").read_text("utf-8")
        formulas = re.findall(r"<math.*?</math>", page, re.DOTALL)
        for formula in formulas:
            ElementTree.fromstring(formula)
            assert not re.search(r"\\|&amp;|\$|&#x00026;", formula), topic
        prose = re.sub(r"<(math|pre|code|script)\b.*?</\1>", "", page, flags=re.DOTALL)
        assert not re.search(r"\$[^$<]*\$", prose), topic


def test_every_page_of_the_guide_has_a_picture_that_is_there(site, opened):
    for topic in guide_topics():
        page = opened(site / f"{topic}.html")
        pictures = page.find_elements("css selector", "article img")
        assert pictures, topic
        assert all(picture.get_property("naturalWidth") > 300 for picture in pictures), topic


def test_on_a_phone_a_law_stands_above_its_words(site, opened):
    page = opened(site / "laws.html")
    screen = {"width": 390, "height": 844, "deviceScaleFactor": 1, "mobile": True}
    page.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", screen)
    try:
        rows = page.find_elements("css selector", "article table:first-of-type tbody tr")
        name, words = (each.rect for each in rows[0].find_elements("css selector", "td"))
        assert words["y"] >= name["y"] + name["height"]
        assert words["width"] > 300
    finally:
        page.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def test_the_reference_leads_from_each_public_name_to_its_source(site, opened):
    page = opened(site / "reference.html")
    told = page.find_element("css selector", "article").text
    assert [name for name in contactlab.__all__ if name not in told] == []
    page.find_element("link text", "Scene").click()
    source = page.find_element("css selector", "dt[id='contactlab.Scene'] a[href*=_modules]")
    page.get(source.get_attribute("href"))
    assert "class Scene" in page.find_element("css selector", "article").text


def test_notebooks_open_and_run(site, tmp_path):
    """The code of a notebook runs where no file is, with the options of a kernel."""
    books = {path.stem: path for path in site.rglob("*.ipynb")}
    code = {}
    for name, path in books.items():
        cells = json.loads(path.read_text("utf-8"))["cells"]
        code[name] = "\n\n".join(
            "".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"
        )
        compile(code[name], name, "exec")
        assert "__file__" not in code[name]
    done = subprocess.run(
        [sys.executable, "-", "-f", "kernel.json"],
        input=code["experiment"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "kharaz2001.png").exists()


@pytest.mark.parametrize(
    ("word", "pages"),
    [
        ("gyration", set()),
        ("robot", {"Any two bodies"}),
        ("batch", {"Any two bodies"}),
        ("annulus", set()),
        ("pluggy", set()),
        ("golf", {"Any two bodies", "A golf ball hit by the toe and the heel of a driver"}),
    ],
)
def test_the_search_finds_a_word(site, opened, word, pages):
    page = opened(site / "search.html")
    box = page.find_element("css selector", "input[name=q]")
    box.send_keys(word)
    box.submit()
    page.implicitly_wait(20)
    assert page.find_elements("css selector", "ul.search li")
    first = [each.text for each in page.find_elements("css selector", "ul.search li > a")[:4]]
    assert pages <= set(first)


def test_commands_of_the_guide_are_links(site):
    """To the page of the topic, or to the section that is named."""
    for page in guide_pages():
        text = (site / f"{page}.html").read_text("utf-8")
        prose = re.sub(r"<pre\b.*?</pre>", "", text, flags=re.DOTALL)
        for before, code in re.findall(r"(<a [^>]*>)?(<code\b.*?</code>)", prose, re.DOTALL):
            words = " ".join(html.unescape(re.sub("<[^>]*>", " ", code)).split())
            if typed := re.fullmatch(r"contactlab guide ([a-z-]+)( \d+)?", words):
                assert before, (page, words)
                target = re.search('href="([^"]*)"', before)[1]
                if typed[2]:
                    assert f"#{typed[2].strip()}-" in target
                else:
                    assert target in (f"{typed[1]}.html", "#")


def test_the_explorer_is_the_page_of_the_command(site):
    assert (site / "explore.html").read_text("utf-8") == explore_page()


def test_on_a_phone_wide_formulas_are_scrolled_and_say_so(site, opened):
    screen = {"width": 390, "height": 844, "deviceScaleFactor": 1, "mobile": True}
    wide = 0
    for topic in guide_pages():
        page = opened(site / f"{topic}.html")
        page.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", screen)
        try:
            found = page.execute_script(
                "return [...document.querySelectorAll('article math')].map(math => {"
                "const box = math.closest('.formula, .table-wrapper'), style = getComputedStyle("
                "box || math); return [math.getBoundingClientRect().right,"
                "style.overflowX, style.backgroundImage.split('linear-gradient').length - 1,"
                "style.backgroundAttachment]})"
            )
        finally:
            page.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
        for right, overflow, shades, attachment in found:
            if right > 390:
                wide += 1
                assert (overflow, shades) == ("auto", 4), topic
                assert attachment == "local, local, scroll, scroll"
    assert wide > 5


def test_on_a_phone_panels_side_by_side_keep_their_size(site, opened):
    page = opened(site / "load-paths.html")
    screen = {"width": 390, "height": 844, "deviceScaleFactor": 1, "mobile": True}
    page.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", screen)
    try:
        picture, place = page.execute_script(
            "const img = document.querySelector('article img[src*=hysteresis]');"
            "const place = img.closest('.panels');"
            "return [img.width, [place.clientWidth, getComputedStyle(place).overflowX]]"
        )
    finally:
        page.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    assert picture > 650
    assert place[0] < 390
    assert place[1] == "auto"


def test_symbols_within_a_line_have_the_size_of_its_letters(site, opened):
    page = opened(site / "theory-impact.html")
    sizes = page.execute_script(
        "return [...document.querySelectorAll('article p > math')].map(math => [math, math"
        ".parentElement].map(each => getComputedStyle(each).fontSize))"
    )
    assert len(sizes) > 10
    assert all(symbol == letters for symbol, letters in sizes)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_pictures_are_dark_where_the_page_is(site, opened, scheme):
    page = opened(site / "laws.html")
    feature = {"name": "prefers-color-scheme", "value": scheme}
    page.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [feature]})
    try:
        filters = page.execute_script(
            "return [...document.querySelectorAll('article img')].map("
            "e => getComputedStyle(e).filter)"
        )
    finally:
        page.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})
    assert filters
    assert all(each.startswith("invert") == (scheme == "dark") for each in filters)


def test_the_gallery_is_in_its_order_and_has_every_script(site):
    text = (site / "gallery" / "index.html").read_text("utf-8")
    shown = re.findall(r'<a class="reference internal" href="(\w+)\.html', text)
    scripts = {path.stem for path in (TOP / "examples").glob("*.py")}
    assert list(dict.fromkeys(shown))[:3] == ["one_impact", "signs", "law_swap"]
    assert scripts <= set(shown)


class Accessible(HTMLParser):
    """Collect icons, headings without a level, and links of thumbnails without a name."""

    def __init__(self):
        super().__init__()
        self.icons, self.levelless, self.thumbnails = [], [], []
        self.pictured = False

    def handle_starttag(self, tag, attributes):
        told = dict(attributes)
        if tag == "link" and "icon" in told.get("rel", "").split():
            self.icons.append(told["href"])
        if told.get("role") == "heading" and not told.get("aria-level", "").isdigit():
            self.levelless.append(told)
        if "sphx-glr-thumbcontainer" in told.get("class", ""):
            self.pictured = True
        elif tag == "a" and self.pictured:
            self.thumbnails.append((told["href"], told.get("aria-label")))
            self.pictured = False


def test_a_reader_of_a_screen_is_told_of_headings_and_thumbnails(site):
    for topic in ("index", "search", "theory-impact", "gallery/index"):
        found = Accessible()
        found.feed((site / f"{topic}.html").read_text("utf-8"))
        assert found.levelless == []
        (icon,) = found.icons
        assert ElementTree.parse((site / topic).parent / icon.split("?")[0]).getroot() is not None
    names = dict(found.thumbnails)  # of the gallery
    assert len(names) == len(found.thumbnails) > 20
    for page, name in names.items():
        text = (site / "gallery" / page).read_text("utf-8")
        heading = re.search(r"<h1>(.*?)<a ", text)[1]
        assert name == html.unescape(re.sub("<[^>]*>", "", heading)), page


@pytest.mark.parametrize("width", [390, 1240])
def test_what_is_scrolled_is_reached_by_the_keyboard(site, opened, width):
    screen = {"width": width, "height": 844, "deviceScaleFactor": 1, "mobile": width < 400}
    places = []
    for topic in ("load-paths", "theory-impact", "laws"):
        page = opened(site / f"{topic}.html")
        page.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", screen)
        try:
            places += page.execute_async_script(
                "const done = arguments[0]; requestAnimationFrame(() => setTimeout(() => done("
                "[...document.querySelectorAll('article *')].filter(e => e.clientWidth && "
                "['auto', 'scroll'].includes(getComputedStyle(e).overflowX))"
                ".map(e => [e.scrollWidth > e.clientWidth, e.tabIndex === 0]))))"
            )
        finally:
            page.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    assert any(scrolled for scrolled, _ in places)
    assert all(scrolled == reached for scrolled, reached in places)


def test_links_within_the_site_lead_somewhere(site):
    """Every link of every page to a file of the site finds it, and its anchor."""
    anchors, broken = {}, []
    pages = sorted(site.rglob("*.html"))
    for page in pages:
        text = page.read_text("utf-8")
        anchors[page.resolve()] = set(map(html.unescape, re.findall(r'\bid="([^"]+)"', text)))
    for page in pages:
        written = re.sub(r"<script\b.*?</script>", "", page.read_text("utf-8"), flags=re.DOTALL)
        for link in re.findall(r'<a\b[^>]*\bhref="([^"]+)"', written):
            target, _, anchor = html.unescape(link).partition("#")
            if re.match(r"[a-z]+:", target):
                continue
            path = (page.parent / unquote(target)).resolve() if target else page.resolve()
            if not path.exists() or (anchor and path in anchors and anchor not in anchors[path]):
                broken.append((page.name, link))
    assert broken == []
