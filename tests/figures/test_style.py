"""Sizes, colours, labels and lines of all figures, written out."""

import re
from pathlib import Path

import matplotlib as mpl
import pytest
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from PIL import Image

from contactlab.figures.files import as_svg, save, save_figure
from contactlab.outcome import style


@pytest.fixture
def axes():
    return Figure().subplots()


@pytest.mark.parametrize(
    ("name", "known"), [("a.png", True), ("a.PNG", True), ("a.jpg", False), ("a", False)]
)
def test_the_suffix_selects_the_format(name, known, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    figure = Figure(figsize=(0.5, 0.5))
    if known:
        save_figure(figure, name)
        assert Path(name).read_bytes()[:4] == b"\x89PNG"
        return
    words = rf"^path = '{re.escape(name)}': must end in \.png, \.pdf, \.svg$"
    with pytest.raises(ValueError, match=words):
        save_figure(figure, name)
    assert not (tmp_path / name).exists()


def test_an_element_for_a_page_has_no_date_and_no_heading():
    heights = (1.0, 1.0)
    first = as_svg(lambda axes: axes[1, 0].plot([1.0]), rows=2, heights=heights)
    assert first.startswith("<svg")
    assert "<dc:date>" not in first
    assert 'height="561.6pt"' in first  # 7.8 inches
    assert first == as_svg(lambda axes: axes[1, 0].plot([1.0]), rows=2, heights=heights)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("psi1",), r"local angle of incidence $\psi_1$"),
        (("angle_deg", "deg"), "angle of incidence from the normal (°)"),
        (("rebound_spin", "rad/s"), r"rebound spin $\omega_2$ (rad/s)"),
        (("sphere.radius", "m"), "sphere radius (m)"),
        (("own_name", "1"), "own name"),
    ],
)
def test_a_label_has_words_and_a_unit(arguments, words):
    assert style.label(*arguments) == words


def test_dollars_are_no_formula():
    assert style.verbatim("a $b$") == r"a \$b\$"


def test_colours_of_ones_own_take_the_place_of_the_palette_and_stay_on_a_slide(tmp_path):
    kept = []

    def draw(axes):
        axes.plot([0.0, 1.0], **style.law_style(3))
        kept.append(axes)

    with mpl.rc_context({"axes.prop_cycle": mpl.cycler(color=["tab:red", "#123456"])}):
        assert [style.law_style(place)["color"] for place in (0, 2)] == ["tab:red"] * 2
        save(tmp_path / "a.png", draw, look="slides")
    assert mpl.colors.to_hex(kept[0].lines[0].get_color()) == "#123456"
    assert style.law_style(0)["color"] == style.LAW_COLOURS[0]


@pytest.mark.parametrize(
    ("arguments", "size", "family", "width"),
    [
        ((), 11.0, "STIXGeneral", 1.7),
        (("slides",), 16.0, "DejaVu Sans", 2.8),
        (("print", "one"), 8.0, "STIXGeneral", 1.2),
        (("print", "two"), 9.5, "STIXGeneral", 1.7),
        (("slides", "one"), 8.0, "DejaVu Sans", 1.2),
    ],
)
def test_a_look_lasts_for_its_block(arguments, size, family, width):
    before = mpl.rcParams["font.size"]
    with style.styled(*arguments):
        assert mpl.rcParams["font.size"] == size
        assert mpl.rcParams["font.family"] == [family]
        assert mpl.rcParams["lines.linewidth"] == width
        assert not mpl.rcParams["axes.spines.top"]
        assert not mpl.rcParams["axes.spines.right"]
        assert not mpl.rcParams["legend.frameon"]
        assert mpl.rcParams["figure.constrained_layout.use"]
        assert mpl.rcParams["axes.axisbelow"]
    assert mpl.rcParams["font.size"] == before


def test_no_printed_letter_is_below_seven_points():
    """Ticks have the size of the font; "small" is 0.833 of it."""
    for sizes in style.PRINTED.values():
        assert min(value for name, value in sizes.items() if "size" in name) >= 7.0


def test_a_slide_has_a_dark_ground_light_words_and_1920_by_1080_dots(tmp_path):
    def draw(axes):
        axes.plot([0.0, 1.0], color="#0072B2")
        axes.plot([1.0, 0.0], "ko", markerfacecolor="white")
        axes.pcolormesh([[0, 1]], cmap=ListedColormap(["white", "#0072B2"]))
        axes.set_title("words")
        kept.append(axes)

    kept = []
    save(tmp_path / "a.png", draw, look="slides")
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.size == (1920, 1080)
        assert max(picture.convert("RGB").getpixel((2, 2))) < 40
    (axes,) = kept
    line, dots = axes.lines
    empty, blue = axes.collections[0].get_cmap().colors
    assert max(empty[:3]) < 0.2
    assert blue[:3] == pytest.approx((0.3, 0.613, 0.789), abs=1e-3)
    assert mpl.colors.to_rgb(axes.title.get_color()) > (0.9, 0.9, 0.9)
    assert mpl.colors.to_rgb(dots.get_markeredgecolor()) > (0.9, 0.9, 0.9)
    assert mpl.colors.to_rgb(dots.get_markerfacecolor()) < (0.2, 0.2, 0.2)
    assert mpl.colors.to_rgb(line.get_color()) == pytest.approx((0.3, 0.613, 0.789), abs=1e-3)
