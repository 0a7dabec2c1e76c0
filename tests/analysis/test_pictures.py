"""Pictures as files, and as the value of a notebook's cell."""

from __future__ import annotations

import pytest

from contactlab.figures.files import save


def draw(axes):
    axes.plot([0.0, 1.0], [0.0, 1.0])


@pytest.mark.parametrize(
    ("end", "png", "svg"), [("png", True, False), ("svg", False, True), ("pdf", False, False)]
)
def test_a_notebook_shows_what_was_saved(tmp_path, end, png, svg):
    path = tmp_path / f"line.{end}"
    picture = save(path, draw)
    assert picture.path == path
    assert picture._repr_png_() == (path.read_bytes() if png else None)
    assert picture._repr_svg_() == (path.read_text("utf-8") if svg else None)
