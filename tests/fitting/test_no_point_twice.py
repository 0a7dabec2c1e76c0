"""A fit of an option of a law runs the impacts at no point twice."""

import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, fit
from contactlab.fitting.model import Model


def test_a_search_and_its_diagnosis_share_their_runs(monkeypatch):
    steel = Material.named("steel")
    angles = np.linspace(5.0, 60.0, 12)
    scene = Scene.at_angle(Sphere(0.01, steel), HalfSpace(steel), 0.2, speed=2.0, angle_deg=angles)
    true = Simulation(tangential=contactlab.create("tangential.walton", slip_restitution=0.35))
    noise = 0.01 * np.random.default_rng(3).normal(size=12)
    measured = {"tangential_restitution": true.sweep(scene).tangential_restitution + noise}
    runs, alive, together = [], [], Model._together

    def counted(model, points, quantities):
        alive.append(model)  # so that no other gets its id
        runs.extend((id(model), tuple(point), *quantities) for point in points.tolist())
        return together(model, points, quantities)

    monkeypatch.setattr(Model, "_together", counted)
    start = Simulation(tangential=contactlab.create("tangential.walton", slip_restitution=0.2))
    found = fit(measured, scene, parameters=["tangential.slip_restitution"], simulation=start)
    assert found["tangential.slip_restitution"] == pytest.approx(0.35, abs=0.05)
    assert len(runs) == len(set(runs)) > 20
