"""Results: what holds for spheres holds for bodies, by the same row."""

from __future__ import annotations

import pickle

import attrs
import numpy as np
import pytest

from contactlab import (
    Scene,
    collide,
)
from contactlab.impact import kinetics
from tests.solve.any_scene import (
    EXACT,
    FEW,
    OFF_CENTRE,
    ONES,
    SPRINGS,
    each_batch,
    every_way,
    meeting,
    one_scene,
)


@pytest.mark.parametrize("psi1", [-1.5, -0.3, 0.0, 0.8])
def test_a_planar_impact_beside_impacts_in_space_is_that_of_the_plane(psi1):
    """Slip against t1 too, alone and in a batch, told as a vector or as a number."""
    groups = {"chi": 1.4, "lam": 0.2, "eta": 0.5}
    planar = Scene.nondimensional(psi1=psi1, **groups)
    alone = EXACT.run(planar)
    batch = EXACT.run(Scene.stack([ONES["space"], planar, ONES["central"]]))
    single = EXACT.run(batch.scene.take(1))
    for found in (batch.psi2[1], single.psi2):
        assert found == pytest.approx([alone.psi2, 0.0], abs=1e-14)
    assert batch.energy.friction_work[1] == pytest.approx(alone.energy.friction_work, rel=1e-12)
    assert np.linalg.norm(batch.impulse[1] - alone.impulse) < 1e-13


@each_batch
def test_estimates_of_an_item_are_numbers(scene):
    """And those of the impact alone."""
    result = FEW.run(scene, estimate_error=True)
    for place, item in enumerate(result):
        alone = FEW.run(scene.take(place), estimate_error=True)
        for name in ("psi2_error_estimate", "restitution_error_estimate"):
            estimate = getattr(item, name)
            assert isinstance(estimate, float)
            assert estimate == getattr(result, name)[place]
            assert estimate == pytest.approx(getattr(alone, name), rel=1e-6)


@every_way
def test_a_misspelt_attribute_is_told_its_neighbour(scene):
    result = EXACT.run(scene)
    with pytest.raises(AttributeError, match="did you mean 'energy'"):
        _ = result.energie
    with pytest.raises(AttributeError, match="no attribute 'psi2_eror'"):
        _ = result.plan.psi2_eror


@pytest.mark.parametrize("met", [meeting(), OFF_CENTRE], ids=["central", "space"])
def test_a_misspelt_attribute_of_a_collision(met):
    with pytest.raises(AttributeError, match="did you mean 'velocity'"):
        _ = collide(met).velocty


@every_way
def test_a_notebook_shows_what_str_says(scene):
    result = EXACT.run(scene)
    assert result._repr_html_().startswith("<pre>ImpactResult(")
    assert repr(result).split(";")[0] in result._repr_html_().replace("&#x27;", "'")


@every_way
def test_a_history_under_even_steps(scene):
    """Also of a batch; its last instants are those of the motion."""
    history = FEW.run(scene, history=True).history
    instants = len(history.time)
    assert history.normal_force.shape == (instants, *scene.shape)
    assert history.slip_velocity.shape == (instants, *scene.shape, *kinetics.slip_axes(scene))
    peak = FEW.run(scene).motion.maximum_force
    assert history.normal_force.max(axis=0) == pytest.approx(peak, rel=0.02)


@every_way
def test_fields_of_a_history(scene):
    """Springs that stick and slip; displacements have the components of the slip."""
    fields = FEW.run(scene, history="fields").history.fields
    assert set(fields) == {"radius", "displacement", "limit", "stuck", "slipping"}
    assert fields["displacement"].shape == (*fields["radius"].shape, *kinetics.slip_axes(scene))
    for name in ("radius", "limit", "displacement"):
        assert fields[name].dtype == np.float64
    sizes = np.abs(fields["displacement"])
    if kinetics.slip_axes(scene):
        sizes = np.linalg.norm(fields["displacement"], axis=-1)
        assert np.abs(fields["displacement"][..., 1]).max() > 0.0
    slips = fields["slipping"] != 0
    assert slips.any()
    assert fields["stuck"].any()
    assert not (slips & fields["stuck"]).any()
    assert sizes[slips] == pytest.approx(fields["limit"][slips], rel=1e-9)
    if not kinetics.slip_axes(scene):
        assert (fields["slipping"][slips] == np.sign(fields["displacement"][slips])).all()


@one_scene
def test_a_run_with_fields_says_where_there_are_none(scene):
    result = EXACT.run(scene, history="fields")
    told = any("stick/slip fields" in str(clause) for clause in result.plan.left_out)
    assert told is (not result.history.fields)


@every_way
def test_normal_motion(scene):
    """The approach without friction lasts 2.94327 (Hertz)."""
    assert EXACT.normal_motion(scene).duration == pytest.approx(2.9432751842)


@every_way
def test_figures(scene, tmp_path):
    if scene.shape:
        axes = EXACT.run(scene).plot("psi1", "psi2", width="one")
        assert len(axes.lines) + len(axes.collections) > 0
    else:
        axes = FEW.run(scene, history=True).plot(width="two")
        with pytest.raises(ValueError, match="leave them out"):
            EXACT.run(scene).plot("psi1", "psi2")
    width = axes.figure.get_size_inches()[0]
    assert width == pytest.approx(3.37 if scene.shape else 6.9, abs=0.4)
    axes.figure.savefig(tmp_path / "figure.png")


@every_way
def test_a_pickled_result_equals_itself(scene):
    """Two runs are equal but for the run time, and results of other laws are not."""
    result, again = FEW.run(scene), FEW.run(scene)
    assert pickle.loads(pickle.dumps(result)) == result
    assert again == result
    assert attrs.evolve(again, run_time=-1.0) == result
    assert SPRINGS.run(scene) != result
    with_history = FEW.run(scene, history="fields")
    assert pickle.loads(pickle.dumps(with_history)) == with_history == FEW.run(
        scene, history="fields"
    )  # fmt: skip
    assert with_history != result


def test_a_pickled_collision_has_the_same_vectors():
    made = collide(OFF_CENTRE, FEW)
    again = pickle.loads(pickle.dumps(made))
    assert again.to_dict() == made.to_dict()
    assert again.result == made.result
