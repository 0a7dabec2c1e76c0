"""The site in a browser: built without a warning, index, a page of the gallery, the search."""

from __future__ import annotations

import html
import os
import re
import subprocess
import sys
from pathlib import Path
from urllib.parse import unquote

import pytest

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


def test_a_page_of_the_gallery_shows_picture_and_output(site, opened):
    page = opened(site / "gallery" / "stick_slip_map.html")
    pictures = page.find_elements("css selector", "article img.sphx-glr-single-img")
    assert [picture.get_property("naturalWidth") > 500 for picture in pictures] == [True]
    assert (
        "of the annuli in contact stick"
        in page.find_element("css selector", ".sphx-glr-script-out").text
    )


def test_the_search_finds_a_word(site, opened):
    page = opened(site / "search.html")
    box = page.find_element("css selector", "input[name=q]")
    box.send_keys("gyration")
    box.submit()
    page.implicitly_wait(20)
    assert page.find_elements("css selector", "ul.search li")


def test_links_within_the_site_lead_somewhere(site):
    """Every link of every page to a file of the site finds it, and its anchor."""
    anchors, broken = {}, []
    pages = sorted(site.rglob("*.html"))
    for page in pages:
        text = page.read_text("utf-8")
        anchors[page.resolve()] = set(map(html.unescape, re.findall(r'\bid="([^"]+)"', text)))
    for page in pages:
        for link in re.findall(r'<a\b[^>]*\bhref="([^"]+)"', page.read_text("utf-8")):
            target, _, anchor = html.unescape(link).partition("#")
            if re.match(r"[a-z]+:", target):
                continue
            path = (page.parent / unquote(target)).resolve() if target else page.resolve()
            if not path.exists() or (anchor and path in anchors and anchor not in anchors[path]):
                broken.append((page.name, link))
    assert broken == []
