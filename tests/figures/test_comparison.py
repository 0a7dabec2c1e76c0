"""Laws side by side: which curve has which values, colour and name, of numbers written out."""

from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

import contactlab
from contactlab import Scene, Simulation
from contactlab.figures.comparison import all_laws
from contactlab.outcome.style import LAW_COLOURS, LAW_DASHES
from contactlab.study.comparison import compare
from contactlab.study.comparison_figure import differences, forces_over_contact, laws_over_sweep
from tests.present import ROOT

X = np.linspace(0.0, 4.0, 9)
REFERENCE = 0.5 * X  # a range of 2


class Scripted:
    """A comparison whose laws have the values given; bands of a tenth."""

    def __init__(self, laws, scene=None, varied=None, agreements=(), half=0.1, models=None):
        self.models = models or {}
        self.laws, self.names, self.half = laws, list(laws), half
        self.scene = scene or Scene.nondimensional(psi1=X, chi=1.0)
        self.varied = varied or {"psi1": X}
        self.agreements = agreements

    def values(self, quantity, name):
        return self.laws[name]

    def difference(self, quantity, name):
        return self.laws[name] - self.laws[self.names[0]]

    def model(self, name):
        return self.models.get(name, "")

    def band(self, quantity, name):
        return np.full(len(X), self.half)


def measured(quantity="psi2", against="psi1", label="code", **entries):
    item = {
        "quantity": quantity, "against": against, "label": label, "x": np.array([1.0, 2.0]),
        "values": np.array([0.25, 0.5]), "x_error": np.array([0.1, 0.2]),
        "error": np.array([0.3, 0.4]),
    }  # fmt: skip
    return SimpleNamespace(
        measured=SimpleNamespace(**(item | entries)),
        difference=lambda _: np.array([0.5, -0.5]),
    )


def panels(width=9.0):
    figure = Figure(figsize=(width, 7.0))
    FigureCanvasAgg(figure)
    return figure.subplots(2)


LAWS = {
    "$exact": REFERENCE,
    "near": REFERENCE + 0.019,  # within a hundredth of the range of 2
    "near rescaled": REFERENCE - 0.019,
    "far": REFERENCE + 1.0,
    "far second": REFERENCE + 0.5,
    "aside": REFERENCE - 2.0,
    "just": REFERENCE + 0.021,
    "free": X.copy(),  # no force: psi2 = psi1
}


@pytest.fixture(scope="module")
def drawn():
    agreements = (
        measured(),
        measured("rebound_spin"),
        measured(against="chi"),
        measured(label="b"),
    )
    upper, lower = panels()
    assert all_laws(upper, lower, Scripted(LAWS, agreements=agreements), "psi2") == (upper, lower)
    return upper, lower


@pytest.fixture(scope="module")
def named():
    """The same without the law that is too near to the first for a name of its own."""
    upper, lower = panels()
    agreements = (
        measured(),
        measured("rebound_spin"),
        measured(against="chi"),
        measured(label="b"),
    )
    laws = {name: values for name, values in LAWS.items() if name != "just"}
    models = {"$exact": "exact"}
    all_laws(upper, lower, Scripted(laws, agreements=agreements, models=models), "psi2")
    return upper, lower


def test_other_codes_are_points_without_lines(drawn, named):
    points = [line for line in drawn[0].lines if line.get_marker() != "None"]
    assert [(line.get_marker(), line.get_label()) for line in points] == [("o", "code"), ("s", "b")]
    for line in points:
        np.testing.assert_array_equal(line.get_data(), ([1.0, 2.0], [0.25, 0.5]))
        assert (line.get_linestyle(), line.get_markerfacecolor()) == ("None", "white")
    legend = named[0].get_legend()
    assert [text.get_text() for text in legend.get_texts()] == [r"\$exact", "code", "b"]
    assert named[1].get_ylabel() == r"law $-$ exact"


def test_laws_and_measured_values_over_a_sweep():
    laws = {"a$": REFERENCE, "b": REFERENCE + 1.0}
    agreement = measured(label="data$")
    axes = laws_over_sweep(Figure().subplots(), Scripted(laws, half=0.3), "psi2", agreement)
    first, second = axes.lines[:2]
    for line, number, values in ((first, 0, REFERENCE), (second, 1, REFERENCE + 1.0)):
        assert line.get_color() == LAW_COLOURS[number]
        np.testing.assert_array_equal(line.get_data(), (X, values))
    assert second._unscaled_dash_pattern == LAW_DASHES[1]
    bands = axes.collections[:2]
    assert [tuple(band.get_facecolor()[0][:3]) for band in bands] == [
        to_rgba(colour)[:3] for colour in LAW_COLOURS[:2]
    ]
    (errors,) = axes.containers
    points, caps, (across, up) = errors
    np.testing.assert_array_equal(points.get_data(), ([1.0, 2.0], [0.25, 0.5]))
    assert len(caps) == 4
    np.testing.assert_allclose(across.get_segments()[0][:, 0], [0.9, 1.1])
    np.testing.assert_allclose(up.get_segments()[1][:, 1], [0.1, 0.9])
    assert (axes.get_xlabel(), axes.get_title()) == (r"local angle of incidence $\psi_1$", "")
    assert axes.get_ylabel() == r"local angle of reflexion $\psi_2$"
    assert [text.get_text() for text in axes.get_legend().get_texts()] == [
        r"a\$", "b", r"data\$"
    ]  # fmt: skip


def test_differences_are_from_what_is_measured_or_from_the_first_law():
    laws = {f"law{number}": REFERENCE + number for number in range(8)}
    axes = differences(Figure().subplots(), Scripted(laws), "psi2", measured())
    zero, *lines = axes.lines
    assert list(zero.get_ydata()) == [0.0, 0.0]
    assert "".join(line.get_marker() for line in lines) == "os^Dv<os"
    for number, line in enumerate(lines):
        np.testing.assert_array_equal(line.get_data(), ([1.0, 2.0], [0.5, -0.5]))
        assert line.get_color() == LAW_COLOURS[number % 6]
    assert axes.get_ylabel() == "law $-$ measured"
    axes = differences(Figure().subplots(), Scripted(laws), "psi2")
    assert len(axes.lines) == 1 + 7
    np.testing.assert_allclose(axes.lines[1].get_ydata(), 1.0)
    assert axes.lines[1].get_color() == LAW_COLOURS[1]
    assert axes.get_ylabel() == "law $-$ law0"
    assert axes.get_xlabel() == r"local angle of incidence $\psi_1$"


def grid():
    """Two chi by three psi1, or the other way round."""
    scene = Scene.grid(psi1=[1.0, 2.0, 3.0], chi=[1.0, 1.5])
    varied = {"psi1": np.repeat([1.0, 2.0, 3.0], 2), "chi": np.tile([1.0, 1.5], 3)}
    return Scripted({"a": np.arange(6.0)}, scene, varied)


def test_a_grid_has_a_curve_for_each_other_value():
    """Along the entry with most values, parted by gaps."""
    compared = grid()
    compared.band = lambda *_: np.zeros(6)
    axes = laws_over_sweep(Figure().subplots(), compared, "psi2")
    gap = np.nan
    x, values = axes.lines[0].get_data()
    np.testing.assert_array_equal(x, [1.0, 2.0, 3.0, gap, 1.0, 2.0, 3.0, gap])
    np.testing.assert_array_equal(values, [0.0, 2.0, 4.0, gap, 1.0, 3.0, 5.0, gap])
    assert axes.get_title() == "a curve for each chi"
    along = laws_over_sweep(Figure().subplots(), compared, "psi2", measured(against="chi"))
    np.testing.assert_array_equal(
        along.lines[0].get_ydata(), [0.0, 1.0, gap, 2.0, 3.0, gap, 4.0, 5.0, gap]
    )
    assert along.get_title() == "a curve for each psi1"


def test_what_is_measured_against_another_entry_has_no_curve():
    axes = laws_over_sweep(
        Figure().subplots(), Scripted({"a": REFERENCE}), "psi2", measured(against="chi")
    )
    assert np.isnan(axes.lines[0].get_xdata()).all()
    assert axes.get_xlabel() == r"inertia ratio $\chi$"
    assert axes.get_title() == ""
    outside = laws_over_sweep(Figure().subplots(), grid_of_two(), "psi2", measured(against="spin"))
    assert outside.get_title() == ""


def grid_of_two():
    compared = grid()
    compared.band = lambda *_: np.zeros(6)
    return compared


def test_forces_of_each_law_lie_within_one_limit():
    scene = Scene.nondimensional(psi1=2.0, chi=1.0)
    laws = {"springs$": Simulation(tangential="springs"), "rigid": Simulation(tangential="coulomb"),
            "spring": Simulation(tangential="linear_spring")}  # fmt: skip
    compared = compare(scene, laws, history=True)
    axes = forces_over_contact(Figure().subplots(), compared)
    _, upper, lower, *lines = axes.lines
    np.testing.assert_array_equal(upper.get_ydata(), -lower.get_ydata())
    assert upper.get_ydata().max() == pytest.approx(1.0, abs=1e-3)
    drawn = {line.get_label(): line for line in lines}
    assert set(drawn) == {r"springs\$ (elastic)", "rigid", "spring"}
    assert len(drawn) == len(lines) == sum(bool(run.result.history) for run in compared.runs)
    words = {"springs$": " (elastic)", "rigid": "", "spring": ""}
    for number, run in enumerate(compared.runs):
        if not run.result.history or not run.result.history.time.size:
            assert run.name not in drawn
            continue
        line = drawn[run.name.replace("$", r"\$") + words[run.name]]
        assert line.get_color() == LAW_COLOURS[number]
        peak = run.result.motion.maximum_force
        np.testing.assert_allclose(line.get_ydata()[1:] * peak, run.result.history.tangential_force)
    assert axes.get_ylim() == (-1.05, 1.05)
    assert axes.get_legend()._loc == 3  # lower left


def test_a_comparison_plots_itself(tmp_path):
    """A curve a law over a sweep, forces over one impact, on axes given or of a new figure."""
    pyplot = pytest.importorskip("matplotlib.pyplot")
    laws = {"exact": Simulation(), "rigid": Simulation(tangential="coulomb")}
    swept = contactlab.compare(Scene.nondimensional(psi1=X, chi=1.0), laws)
    given = Figure().subplots()
    assert swept.plot(axes=given) is given
    for line, law in zip(given.lines, laws, strict=True):
        assert np.array_equal(line.get_ydata(), swept.values("psi2", law))
    try:
        own = swept.plot("tangential_restitution", width="one")
        assert [own.figure] == [pyplot.figure(number) for number in pyplot.get_fignums()[-1:]]
        assert np.array_equal(
            own.lines[0].get_ydata(),
            swept.values("tangential_restitution", "exact"),
            equal_nan=True,
        )
    finally:
        pyplot.close("all")
    once = Scene.nondimensional(psi1=1.2, chi=1.0)
    forces = contactlab.compare(once, laws, history=True).plot(axes=Figure().subplots())
    assert len(forces.lines) >= len(laws)
    for refused, quantity, words in (
        (swept, "psi3", "psi3"),
        (contactlab.compare(once, laws), None, "history=True"),
        (contactlab.compare(once, laws, history=True), "psi2", "leave it out"),
    ):
        with pytest.raises(ValueError, match=words):
            refused.plot(quantity)


def test_a_comparison_with_an_experiment_plots_what_was_measured():
    file = contactlab.read_scene(ROOT / "examples" / "kharaz2001.toml")
    axes = contactlab.compare(file, {"exact": Simulation()}).plot(axes=Figure().subplots())
    (bars,) = axes.containers
    assert np.array_equal(bars.lines[0].get_xdata(), file.measured[0].x)
