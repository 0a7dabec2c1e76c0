"""Pictures of fits: what is measured, what the laws predict, residuals and names."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from contactlab import Material, Scene, Simulation, Sphere
from contactlab_fit import fit
from contactlab_fit.figures import draw_fits, draw_measurements, residuals

ANGLES = np.array([10.0, 10.0, 20.0, 30.0, 50.0])
BALL = Sphere(0.01, Material.named("steel"))
BODIES = Scene(BALL, BALL, 0.1, normal_speed=1.0)
TABLE = {
    "angle_deg": ANGLES,
    "tangential_restitution": np.array([0.52, 0.58, np.nan, 0.70, 0.84]),
    "rebound_spin (rad/s)": np.array([-8.0, -9.0, -14.0, -18.0, -15.0]),
}


@pytest.fixture(scope="module")
def exact():
    return fit(TABLE, BODIES)


def test_each_law_has_a_smooth_curve_and_its_points(exact):
    rigid = fit(TABLE, BODIES, simulation=Simulation(tangential="coulomb"))
    laws = {"exact": exact, "$rigid": rigid}
    axes = draw_measurements(Figure().subplots(), laws, "tangential_restitution")
    curve, points, other, others, *_ = axes.lines
    assert list(points.get_xdata()) == [10.0, 10.0, 30.0, 50.0]  # where it is measured
    x, y = curve.get_data()
    assert (len(x) > 90, x[0], x[-1]) == (True, 10.0, 50.0)
    slip = np.tan(np.radians(x))  # the bodies of the fit, at its friction
    friction = laws["exact"]["friction_coefficient"]
    scene = Scene(BALL, BALL, friction, np.cos(np.radians(x)), np.cos(np.radians(x)) * slip)
    np.testing.assert_allclose(y, Simulation().run(scene).tangential_restitution, atol=1e-6)
    np.testing.assert_allclose(np.interp(points.get_xdata(), x, y), points.get_ydata())
    np.testing.assert_allclose(np.interp(others.get_xdata(), *other.get_data()), others.get_ydata())
    assert other.get_label().startswith(r"\$rigid: friction coefficient 0.")
    names = [text.get_text() for text in axes.get_legend().get_texts()]
    assert names[2] == "measured"
    assert axes.get_xlabel() == "angle of incidence from the normal (°)"


@pytest.mark.slow
def test_errors_are_bars_and_residuals_are_measured_less_predicted():
    errors = np.full(5, 0.05)
    found = fit(TABLE | {"tangential_restitution_error": errors}, BODIES)
    above = draw_measurements(Figure().subplots(), {"a": found}, "tangential_restitution")
    below = residuals(Figure().subplots(), {"a": found}, "tangential_restitution")
    ((line, _, bars),) = below.containers
    np.testing.assert_allclose(line.get_ydata(), found.residuals["tangential_restitution"])
    segments = [above.containers[0][2][0].get_segments(), bars[0].get_segments()]
    for each in segments:
        np.testing.assert_allclose(np.diff(np.array([s[:, 1] for s in each if s.size])), 0.1)
    assert "rad/s" in residuals(Figure().subplots(), {"a": found}, "rebound_spin").get_ylabel()


def test_a_fit_predicts_other_impacts(exact):
    made = exact.predict(angle_deg=[10.0, 30.0])
    kept = exact.predicted["tangential_restitution"][[0, 3]]
    np.testing.assert_allclose(made.tangential_restitution, kept, rtol=1e-9)
    assert exact.predict(angle_deg=10.0, speed=2.0).scene.normal_speed > 1.9
    with pytest.raises(ValueError, match="radius"):
        exact.predict(radius=0.1)
    with pytest.raises(ValueError, match="lengths"):
        exact.predict(angle_deg=[1.0, 2.0], speed=[1.0, 2.0, 3.0])


def test_without_an_angle_the_abscissa_is_what_varies():
    spin = np.array([-50.0, 0.0, 50.0, 100.0])
    rebounds = Simulation().sweep(
        Scene(BALL, BALL, 0.1, normal_speed=np.ones(4), tangential_velocity=0.3, spin=spin)
    )
    table = {"spin (rad/s)": spin, "tangential_velocity (m/s)": np.full(4, 0.3),
             "normal_speed (m/s)": np.ones(4),
             "rebound_spin (rad/s)": rebounds.rebound_spin}  # fmt: skip
    axes = draw_measurements(Figure().subplots(), {"a": fit(table, BODIES)}, "rebound_spin")
    assert axes.get_xlabel() == "angle of incidence from the normal (°)"
    del table["tangential_velocity (m/s)"], table["normal_speed (m/s)"]
    table["rebound_spin (rad/s)"] = (
        Simulation().sweep(Scene(BALL, BALL, 0.1, normal_speed=np.ones(4), spin=spin)).rebound_spin
    )
    axes = draw_measurements(Figure().subplots(), {"a": fit(table, BODIES)}, "rebound_spin")
    assert "rad/s" in axes.get_xlabel()


@pytest.mark.slow
def test_each_quantity_has_a_column_under_one_legend(exact, tmp_path, monkeypatch):
    draw_fits(tmp_path / "fit.png", {"a": exact}, width="two")
    assert (tmp_path / "fit.png").read_bytes()[1:4] == b"PNG"
    kept = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, *_, **__: kept.append(figure))
    draw_fits(tmp_path / "fit.png", {"a": exact})
    assert {axes.get_legend() for axes in kept[0].axes} == {None}
    assert len(kept[0].legends) == 1
