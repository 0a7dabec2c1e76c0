"""Every figure function takes and returns Axes; words are legible and overlap nothing."""

from __future__ import annotations

import functools
import importlib
import inspect
import itertools
import pkgutil
from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.image import imread
from matplotlib.text import Text

import contactlab.figures
import contactlab.outcome
import contactlab.study
from contactlab import Scene, Simulation, create
from contactlab.figures import name_curves, paper
from contactlab.figures.comparison import all_laws
from contactlab.figures.files import save, save_figure
from contactlab.outcome import style
from contactlab.scene_file import read_scene
from contactlab.study import paper_figures
from contactlab.study.comparison import compare
from tests.longer import longer

EXAMPLES = Path(__file__).parents[2] / "examples"
WIDTHS = (None, "one", "two")
#: Points; printed letters smaller than these are not read.
LEGIBLE = 6.0


def figure_functions():
    """The public functions of figures whose first argument is Axes, to draw on."""
    found = {}
    places = [
        each.name
        for room in (contactlab.figures, contactlab.outcome, contactlab.study)
        for each in pkgutil.iter_modules(room.__path__, f"{room.__name__}.")
        if room is contactlab.figures or each.name.endswith("_figure")
    ]
    for place in places:
        functions = inspect.getmembers(importlib.import_module(place), inspect.isfunction)
        for name, function in functions:
            first = next(iter(inspect.signature(function).parameters.values()), None)
            of_axes = first is not None and "Axes" in str(first.annotation)
            draws = of_axes and inspect.signature(function).return_annotation not in (
                "float",
                "bool",
            )
            if draws and not name.startswith("_") and function.__module__ == place:
                found[f"{place}.{name}"] = function
    return found


def test_every_figure_function_takes_and_returns_axes():
    found = figure_functions()
    assert len(found) > 15
    returned = {name: inspect.signature(one).return_annotation for name, one in found.items()}
    assert {name: says for name, says in returned.items() if "Axes" not in says} == {}


@pytest.fixture(scope="module")
def simulation():
    return Simulation(
        tangential=create("tangential.annulus", annuli=12),
        integrator=create("integrator.symplectic", steps=80),
    )


@pytest.fixture(scope="module")
def data(simulation):
    return {number: figure(simulation) for number, figure in paper_figures.paper_data().items()}


def drawn(draw, tmp_path, monkeypatch, **options):
    """The figure that ``save`` writes, laid out."""
    kept = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, *_, **__: kept.append(figure))
    with style.styled(width=options.get("width")):
        save(tmp_path / "f.png", draw, **options)
        canvas = FigureCanvasAgg(kept[0])
        canvas.draw()
    return kept[0], canvas.get_renderer()


def boxes(figure, renderer):
    """Every piece of text that is seen, and its box."""
    found = []
    for text in figure.findobj(Text):
        if text.get_visible() and text.get_text().strip():
            box = text.get_window_extent(renderer)
            if box.width > 0.0 and not _outside(text, figure):
                found.append((text.get_text(), text.get_fontsize(), box))
    return found


def _outside(text, figure):
    """Whether a tick's label belongs to a tick beyond the limits, which is not drawn."""
    for axes in figure.axes:
        for axis, place in ((axes.xaxis, 0), (axes.yaxis, 1)):
            low, high = sorted(axis.get_view_interval())
            for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks()):
                if text in (tick.label1, tick.label2):
                    return not low - 1e-9 <= text.get_position()[place] <= high + 1e-9
    return False


def crowded(number, width):
    """Return a figure at a width; one at each width runs by default."""
    quick = (number, width) in ((2, "one"), (4, None), (2, "two"))
    return pytest.param(number, width, marks=[] if quick else [pytest.mark.slow])


@pytest.mark.parametrize(
    ("number", "width"), [crowded(number, width) for number in range(1, 5) for width in WIDTHS]
)
def test_words_of_the_papers_figures_overlap_nothing(data, tmp_path, monkeypatch, number, width):
    draw = functools.partial(paper.draw_paper, data=data[number])
    figure, renderer = drawn(draw, tmp_path, monkeypatch, width=width)
    found = boxes(figure, renderer)
    assert len(found) > 12
    assert min(size for _, size, _ in found) >= LEGIBLE
    for (one, _, box), (other, _, another) in itertools.combinations(found, 2):
        assert not box.overlaps(another), (one, other)
    (axes,) = figure.axes
    assert axes.get_legend() is None  # names stand beside the curves
    within = figure.bbox.padded(1.0)
    for line in axes.lines:
        x, y = (np.asarray(values, dtype=float) for values in line.get_data())
        if len(x) < 3:
            continue  # lines that only guide the eye
        fine = np.linspace(0.0, len(x) - 1.0, 2000)
        points = np.column_stack([np.interp(fine, np.arange(len(x)), one) for one in (x, y)])
        dots = axes.transData.transform(points)
        for text, box in ((text, box) for text, _, box in found):
            inside = np.all((dots > box.min) & (dots < box.max), axis=1)
            assert not inside.any(), (text, line.get_label())
    for text, _, box in found:
        assert within.contains(*box.min), text
        assert within.contains(*box.max), text


def test_figures_2_and_4_show_the_exact_curve_beside_law_and_rigid_theory(data):
    for number in (2, 4):
        axes = paper.draw_paper(Figure().subplots(), data[number])
        lines = {line.get_label(): line for line in axes.lines}
        assert {"annulus law", "rigid-body theory", "exact solution"} <= set(lines)
        law, exact = lines["annulus law"], lines["exact solution"]
        assert exact.get_linewidth() < law.get_linewidth()  # one within the other: both are seen
        assert law.get_zorder() <= exact.get_zorder()


@pytest.mark.slow
def test_what_all_curves_of_a_figure_share_is_written_on_it(data):
    solid, oblique = r"$\chi$ = 1.4412", r"$\psi_1$ = 1.2"
    for number, words in {1: solid, 2: solid, 3: oblique, 4: oblique}.items():
        axes = paper.draw_paper(Figure().subplots(), data[number])
        assert words in {text.get_text() for text in axes.texts}, number


def test_the_label_of_the_band_stands_beside_its_band(data):
    """It touches neither band nor curve, and is nearer than its own width."""
    figure = Figure()
    axes = paper.draw_paper(figure.subplots(), data[4])
    renderer = FigureCanvasAgg(figure).get_renderer()
    (text,) = (one for one in axes.texts if "solid spheres" in one.get_text())
    (band,) = (one for one in axes.patches if one.get_zorder() == -1)
    box, left = text.get_window_extent(renderer), band.get_window_extent(renderer).x0
    assert box.x1 < left < box.x1 + 0.3 * box.width


def test_a_width_that_there_is_not_is_refused(simulation):
    result = simulation.run(Scene.nondimensional(psi1=[0.5, 1.2], chi=1.4))
    with pytest.raises(ValueError, match=r"'one', 'two'"):
        result.plot(width="three")
    with pytest.raises(ValueError, match="leave it out"):
        result.plot(axes=Figure().subplots(), width="one")


def test_a_plot_fills_its_column(simulation):
    from matplotlib import pyplot

    scene = Scene.nondimensional(psi1=1.2, chi=1.4)
    result = simulation.run(scene, history=True)
    for axes in (result.plot(width="one"), result.history.plot(width="one")):
        assert isinstance(axes, Axes)
        assert axes.figure.get_figwidth() == style.WIDTHS["one"]
        assert axes.xaxis.label.get_fontsize() == style.PRINTED["one"]["axes.labelsize"]
        assert axes.lines[-1].get_linewidth() == style.PRINTED["one"]["lines.linewidth"]
        pyplot.close(axes.figure)


@pytest.fixture(scope="module")
def three_laws():
    file = read_scene(EXAMPLES / "kharaz2001.toml")
    laws = {name: Simulation(tangential=name) for name in ("coulomb", "frictionless", "walton")}
    return compare(file, laws)


@pytest.mark.parametrize("width", ["one", *longer(None, "two")])
def test_long_legends_stand_clear_of_the_axes(three_laws, tmp_path, monkeypatch, width):
    def draw(axes):
        all_laws(axes[0, 0], axes[1, 0], three_laws, "psi2")

    options = {"rows": 2, "heights": (1.9, 1.0), "wide": True, "width": width}
    figure, renderer = drawn(draw, tmp_path, monkeypatch, **options)
    legends = [axes.get_legend() for axes in figure.axes if axes.get_legend()]
    if not legends:
        assert {"coulomb (rigid)", "walton"} <= {text for text, _, _ in boxes(figure, renderer)}
        return
    (legend,) = legends
    box = legend.get_window_extent(renderer).padded(-1.0)  # it may touch
    assert figure.bbox.padded(1.0).contains(*box.min)
    assert figure.bbox.padded(1.0).contains(*box.max)
    for axes in figure.axes:
        assert not box.overlaps(axes.get_window_extent(renderer))
        assert not box.overlaps(axes.xaxis.label.get_window_extent(renderer))


def test_laws_within_the_line_of_the_reference_are_named_with_it():
    file = read_scene(EXAMPLES / "kharaz2001.toml")
    laws = {"exact": Simulation(), "springs": Simulation(tangential="springs"),
            "coulomb": Simulation(tangential="coulomb")}  # fmt: skip
    upper, lower = Figure().subplots(2)
    all_laws(upper, lower, compare(file, laws), "psi2")
    named = [line.get_label() for line in upper.lines]
    assert "exact; on its line:\nsprings" in named
    assert "coulomb" in named


def test_measured_values_are_drawn_beside_all_laws():
    """Of the quantity that is drawn, and of no other."""
    file = read_scene(EXAMPLES / "kharaz2001.toml")
    comparison = compare(file, {"exact": Simulation(), "coulomb": Simulation(tangential="coulomb")})
    first, other, _ = file.measured
    upper, _ = all_laws(*Figure().subplots(2), comparison, first.quantity)
    drawn = {tuple(line.get_ydata()) for line in upper.lines}
    assert tuple(first.values) in drawn
    assert tuple(other.values) not in drawn


@pytest.mark.parametrize("width", style.WIDTHS)
def test_a_picture_is_as_wide_as_its_column(tmp_path, width):
    save(tmp_path / "p.png", lambda axes: axes.plot([0.0, 1.0]), width=width)
    pixels = imread(tmp_path / "p.png").shape[1]
    assert pixels == pytest.approx(style.WIDTHS[width] * style.RESOLUTION, abs=1)


def test_a_figure_of_ones_own_is_written_as_finely(tmp_path):
    save_figure(Figure(figsize=(2.0, 1.0)), tmp_path / "own.png")
    assert imread(tmp_path / "own.png").shape[:2] == (style.RESOLUTION, 2 * style.RESOLUTION)


def test_in_a_narrow_column_panels_stand_below_each_other(tmp_path):
    """Two columns of a curve and its residuals: four panels, the second column below the first."""
    from contactlab.figures.files import save

    kept = []
    save(tmp_path / "p.png", kept.append, rows=2, columns=2, heights=(2.0, 1.0), width="one")
    ((first, second), (below, other)) = kept[0]
    assert first.get_shared_x_axes().joined(first, below)
    assert second.get_shared_x_axes().joined(second, other)
    tops = [axes.get_position().y1 for axes in (first, below, second, other)]
    assert tops == sorted(tops, reverse=True)


@pytest.mark.slow
def test_a_name_without_room_chooses_first_in_the_next_try():
    """In the order of their crowd alone one of these six names finds no place."""
    axes = Figure(figsize=(3.2, 2.4)).subplots()
    x = np.linspace(0.0, 1.0, 60)
    shapes = np.random.default_rng(1).normal(size=(6, 3))
    lines = [axes.plot(x, a * np.sin(3 * x) + b * x + 0.3 * c)[0] for a, b, c in shapes]
    assert name_curves(axes, lines, [f"a longer law {number}" for number in range(6)])
    boxes = [text.get_window_extent() for text in axes.texts]
    assert len(boxes) == 6
    pairs = itertools.combinations(boxes, 2)
    assert not any(first.overlaps(second) for first, second in pairs)
