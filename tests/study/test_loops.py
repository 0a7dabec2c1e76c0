"""Hysteresis loops of laws along the same paths."""

import numpy as np
import pytest
from matplotlib.figure import Figure

import contactlab
from contactlab import Scene, Simulation
from contactlab.figures.load_paths import draw_loops
from contactlab.outcome.style import LAW_COLOURS, QUIET
from contactlab.study.loops import CYCLES, QUARTER, REACH, loops

SCENE = Scene.nondimensional(psi1=1.0, chi=1.4412)


@pytest.fixture(scope="module")
def found():
    return loops(SCENE, {"springs": Simulation(tangential="springs"), "exact": Simulation()})


def forms():
    """Return springs, and each form of the capped spring."""
    names = ("displacement", "displacement_rescaled", "increment", "increment_rescaled")
    caps = {form: contactlab.create("tangential.mindlin_cap", form=form) for form in names}
    return {"springs": "springs", **caps}


def test_loops_at_constant_load_close_and_have_the_area_of_theory(found):
    assert list(found.constant) == ["springs"]
    assert "steps" in found.left_out["exact"]
    moved, force = found.constant["springs"]
    last = slice(-4 * QUARTER - 1, None)
    assert force[last][0] == pytest.approx(force[-1], abs=1e-12)
    area = np.sum(0.5 * (force[last][1:] + force[last][:-1]) * np.diff(moved[last]))
    most = 1.0 - (1.0 - REACH) ** 1.5
    theory = -4.0 * most * REACH + 8.0 * (REACH - 0.4 * (1.0 - (1.0 - REACH) ** 2.5))
    assert area == pytest.approx(theory, rel=5e-3)
    assert np.abs(force).max() == pytest.approx(most, abs=1e-3)


@pytest.mark.slow
def test_forms_of_the_capped_spring_part_where_the_load_oscillates():
    laws = {name: Simulation(tangential=law) for name, law in forms().items()}
    found = loops(SCENE, laws)
    constant = np.array([found.constant[name][1] for name in list(laws)[1:]])
    assert np.ptp(constant, axis=0).max() < 1e-9
    swinging = np.array([found.oscillating[name][1] for name in laws])
    assert np.ptp(swinging, axis=0).max() > 0.1
    assert np.abs(swinging[0]).max() <= 1.0


def test_a_capped_spring_slips_at_the_limit_of_a_load_that_oscillates():
    """The load goes as the level to the 3/2, from half the depth where the surfaces pass rest."""
    found = loops(SCENE, {"cap": Simulation(tangential="mindlin_cap")})
    _, force = found.oscillating["cap"]
    turn = np.arange(len(force)) * (0.5 * np.pi / QUARTER)
    limit = (0.75 - 0.25 * np.cos(2.0 * turn)) ** 1.5
    assert (np.abs(force) <= limit + 1e-9).all()
    slips = np.abs(force) > limit - 1e-9
    assert 0.1 < slips.mean() < 0.9


def test_a_batch_has_the_loops_of_its_first_impact(found):
    batch = Scene.nondimensional(psi1=np.array([1.0, 2.0]), chi=1.4412)
    law = {"springs": Simulation(tangential="springs")}
    assert np.array_equal(loops(batch, law).constant["springs"], found.constant["springs"])


def test_loops_are_drawn_by_name_over_the_displacement(found):
    axes = draw_loops(Figure().subplots(), found.constant, title="constant load")
    curve = next(line for line in axes.lines if line.get_label() == "springs")
    assert len(curve.get_xdata()) == 4 * QUARTER * CYCLES + 1
    assert curve.get_xdata().max() == pytest.approx(REACH)
    assert axes.get_title() == "constant load"


def test_loops_need_friction():
    smooth = Scene(*[contactlab.Sphere(0.01, contactlab.Material.named("steel"))] * 2, 0.0, 1.0)
    with pytest.raises(ValueError, match="friction_coefficient"):
        loops(smooth, {"springs": Simulation(tangential="springs")})


def test_loops_without_a_title_have_none(found):
    axes = draw_loops(Figure().subplots(), found.oscillating)
    assert axes.get_title() == ""
    assert axes.get_xlabel() == r"displacement over that of gross slip $D/D_{\mathrm{s}}$"
    assert axes.get_ylabel() == r"friction force $F/(\mu P_{\max})$"
    first, second = axes.lines
    assert (first.get_color(), list(first.get_ydata())) == (QUIET, [0.0, 0.0])
    np.testing.assert_array_equal(second.get_data(), found.oscillating["springs"])
    assert second.get_color() == LAW_COLOURS[0]
