"""Pictures of fits: what is measured, what the laws predict, residuals and names."""

from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure

from contactlab.figures import fitting as figures
from contactlab.figures.fitting import draw_fits, measured_and_laws, residuals
from contactlab.figures.style import LAW_COLOURS

ANGLES = np.array([10.0, 10.0, 20.0, 30.0])
E_T = np.array([0.5, 0.7, np.nan, 0.9])


class Measured(SimpleNamespace):
    def __len__(self):
        return 4


def fit(predicted=(0.5, 0.6, 0.7, 0.8), given=None, errors=None):
    """A fit of four measurements, of which one lacks its restitution."""
    measurements = Measured(
        measured={"tangential_restitution": E_T, "rebound_spin": 100.0 * ANGLES},
        errors={"tangential_restitution": np.full(4, 0.05)} if errors is None else errors,
        given={"angle_deg": ANGLES} if given is None else given,
    )
    values = {"tangential_restitution": np.array(predicted), "rebound_spin": 99.0 * ANGLES}
    return SimpleNamespace(
        measurements=measurements,
        predicted=values,
        residuals={name: measurements.measured[name] - values[name] for name in values},
        parameters={"friction_coefficient": SimpleNamespace(value=0.12345),
                    "tangential.springs.loss": SimpleNamespace(value=2.0)},
    )  # fmt: skip


def test_each_law_has_a_curve_of_means_and_points():
    fits = {"$one": fit(), "two": fit((0.1, 0.3, 0.4, 0.5))}
    axes = measured_and_laws(Figure().subplots(), fits, "tangential_restitution")
    curve, points, other, others, *_ = axes.lines
    assert list(curve.get_xdata()) == [10.0, 30.0]  # where it is measured
    assert list(curve.get_ydata()) == pytest.approx([0.55, 0.8])
    assert list(points.get_ydata()) == [0.5, 0.6, 0.8]
    assert list(other.get_ydata()) == pytest.approx([0.2, 0.5])
    assert list(others.get_ydata()) == [0.1, 0.3, 0.5]
    assert [line.get_color() for line in axes.lines[:4]] == [LAW_COLOURS[0]] * 2 + [
        LAW_COLOURS[1]
    ] * 2
    assert [line.get_marker() for line in axes.lines[:4]] == ["o", "o", "s", "s"]
    assert (curve.get_linestyle(), points.get_linestyle()) == ("-", "None")
    assert (curve.get_markevery(), points.get_markevery()) == ([], None)
    assert curve.get_label() == r"\$one: friction coefficient 0.123, loss 2"
    (errors,) = axes.containers
    np.testing.assert_array_equal(errors[0].get_data(), (ANGLES, E_T))
    np.testing.assert_allclose(errors[2][0].get_segments()[0][:, 1], [0.45, 0.55])
    assert axes.get_xlabel() == "angle of incidence from the normal (°)"
    assert axes.get_ylabel() == r"tangential restitution $e_t$"
    names = [text.get_text() for text in axes.get_legend().get_texts()]
    assert names[2] == "measured"


def test_values_without_errors_have_no_bars():
    axes = measured_and_laws(Figure().subplots(), {"a": fit(errors={})}, "rebound_spin")
    assert axes.containers[0][2] == ()
    assert axes.get_ylabel() == r"rebound spin $\omega_2$ (rad/s)"


def test_residuals_are_measured_less_predicted():
    fits = {f"law{number}": fit() for number in range(7)}
    axes = residuals(Figure().subplots(), fits, "tangential_restitution")
    assert list(axes.lines[0].get_ydata()) == [0.0, 0.0]
    drawn = [container[0] for container in axes.containers]
    assert "".join(line.get_marker() for line in drawn) == "os^Dv<o"
    for number, line in enumerate(drawn):
        np.testing.assert_allclose(line.get_ydata(), [0.0, 0.1, np.nan, 0.1])
        np.testing.assert_array_equal(line.get_xdata(), ANGLES)
        assert (line.get_color(), line.get_linestyle()) == (LAW_COLOURS[number % 6], "None")
    np.testing.assert_allclose(axes.containers[0][2][0].get_segments()[1][:, 1], [0.05, 0.15])
    assert axes.get_ylabel() == "measured $-$ law"
    assert axes.get_xlabel() == "angle of incidence from the normal (°)"


@pytest.mark.parametrize(
    ("given", "x", "label"),
    [
        ({"angle_deg": ANGLES, "speed": ANGLES}, ANGLES, "angle of incidence from the normal (°)"),
        (
            {"normal_speed": 2.0 * np.ones(4), "tangential_velocity": np.array([0, 2, -2, 2])},
            [0.0, 45.0, -45.0, 45.0], "angle of incidence from the normal (°)",
        ),
        (
            {"normal_speed": np.full(4, 2.0), "spin": np.array([1.0, 2.0, 3.0, 4.0])},
            [1.0, 2.0, 3.0, 4.0], "spin (rad/s)",
        ),
        ({"normal_speed": np.full(4, 2.0)}, [1.0, 2.0, 3.0, 4.0], "impact"),
    ],
)  # fmt: skip
def test_the_abscissa_is_the_angle_or_what_varies(given, x, label):
    found, words = figures._abscissa(fit(given=given))
    assert list(found) == pytest.approx(list(x))
    assert words == label


def test_each_quantity_has_a_column_and_one_legend_serves_all(tmp_path, monkeypatch):
    kept = []
    monkeypatch.setattr(
        figures, "save", lambda path, draw, **words: kept.append((path, draw, words))
    )
    draw_fits(tmp_path / "fit.png", {"a": fit()}, width="two")
    ((path, draw, words),) = kept
    assert path == tmp_path / "fit.png"
    assert words == {"rows": 2, "columns": 2, "heights": (2.0, 1.0), "width": "two"}
    figure = Figure(layout="constrained")
    axes = figure.subplots(2, 2, sharex="col")
    draw(axes)
    assert [each.get_ylabel() for each in axes.ravel()] == [
        r"tangential restitution $e_t$", r"rebound spin $\omega_2$ (rad/s)", "measured $-$ law",
        "measured $-$ law (rad/s)",
    ]  # fmt: skip
    assert [each.get_xlabel() == "" for each in axes.ravel()] == [True, True, False, False]
    assert all(each.get_legend() is None for each in axes.ravel())
    (legend,) = figure.legends
    assert [text.get_text().partition(":")[0] for text in legend.get_texts()] == ["a", "measured"]
    assert legend._ncols == 2
