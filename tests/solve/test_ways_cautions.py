"""Cautions of laws: what holds for spheres holds for bodies, by the same row."""

from __future__ import annotations

import re

import pytest

from contactlab import (
    Encounter,
    Scene,
    Simulation,
    collide,
    create,
)
from contactlab.study.posed import pose
from tests.solve.any_scene import (
    BALL,
    BATCHES,
    BY_SPRINGS,
    DOWN,
    FLOOR,
    OFF_CENTRE,
    ONES,
    WAYS,
    meeting,
)

FIVE_STEPS = create("integrator.symplectic", steps=5)
ELASTIC_SHEAR = {
    "tangential": create("tangential.springs", shear_loss=0.0),
    "integrator": "symplectic",
}
SPRINGS_WORDS = ("each spring is limited separately", "pressure profile")
SHARED_WORDS = ("equal damping", "damping law")
CAUTIONED = [
    ({"normal": "tsuji", **ELASTIC_SHEAR}, (*SPRINGS_WORDS, "damping law", "given, using")),
    ({"normal": "tsuji"}, (*SHARED_WORDS, "given, using")),
    ({"tangential": "coulomb"}, ("rigid contact",)),
    ({"tangential": "mindlin_cap"}, ("one spring", "create energy")),
    ({"tangential": "linear_spring", "integrator": FIVE_STEPS}, ("one spring", "steps raised")),
]
#: Laws whose normal motion is solved, which takes longer.
SOLVED = [
    ({"normal": "hunt_crossley", **ELASTIC_SHEAR}, (*SPRINGS_WORDS, "damping law")),
    ({"normal": "hunt_crossley", **BY_SPRINGS}, SHARED_WORDS),
    ({"normal": "jkr", **BY_SPRINGS}, SPRINGS_WORDS),
    ({"normal": "thornton", **BY_SPRINGS}, SPRINGS_WORDS),
    ({"normal": "walton_braun", **BY_SPRINGS}, (*SPRINGS_WORDS, "damping law")),
]
ROWS = [
    pytest.param(
        scene,
        laws,
        words,
        id="-".join((*(str(law) for law in laws.values()), name)),
        marks=[pytest.mark.slow] * (name == "batch" or laws.get("normal") in ("jkr", "thornton")),
    )
    for scenes, table in (
        (WAYS | {"central batch": BATCHES["central"]}, CAUTIONED),
        (ONES, SOLVED),
    )
    for laws, words in table
    for name, scene in scenes.items()
]


@pytest.mark.parametrize(("scene", "laws", "words"), ROWS)
def test_the_laws_own_cautions_hold(scene, laws, words):
    """And where friction changes the approach their sizes are said to be of spheres."""
    simulation = Simulation(**laws)
    scene = pose(scene, simulation.laws)
    result = simulation.run(scene).check()
    told, planned = str(result), [str(clause) for clause in simulation.plan(scene).cautions]
    for word in words:
        assert any(word in text for text in result.cautions), word
        assert word in told
        if word != "steps raised":
            assert any(word in text for text in planned), word
    coupled = scene.inverse_mass is not None
    assert any("measured on spheres" in text for text in result.cautions) is coupled


@pytest.mark.parametrize("coupling", [{}, {"lam": 1e-6, "eta": 1e-6}], ids=["central", "planar"])
def test_a_spring_far_off_is_told_so(coupling):
    """Truth is -1.498, by Coulomb's law at every point."""
    laws = Simulation(normal=create("normal.hunt_crossley", restitution=0.2), **ELASTIC_SHEAR)
    result = laws.run(Scene.nondimensional(psi1=4.346, chi=5.652, **coupling)).check()
    sizes = re.search(r"psi2 is off by up to ([\d.]*\d)", str(result))
    assert sizes is not None
    assert abs(result.psi2 + 1.498) < float(sizes.group(1))


@pytest.mark.slow
@pytest.mark.parametrize(
    "met",
    [Encounter(BALL, FLOOR, 0.3, normal=DOWN, velocity=(0.5, 0.3, -1.0)), meeting(),
     meeting(contact=(0.02, 0.0, -0.1)), OFF_CENTRE],
    ids=["sphere", "central", "planar", "space"],
)  # fmt: skip
@pytest.mark.parametrize("restitution", [0.3, 0.9])
def test_cautions_of_a_restitution(met, restitution):
    """A given restitution is not called taken by default."""
    made = collide(met, restitution=restitution)
    slides = met is OFF_CENTRE and restitution == 0.3  # from touch to separation: mu decides
    told = any("equal damping" in text for text in made.cautions)
    assert told is not slides
    assert not any("using" in text for text in made.cautions)
    assert not any("default" in str(clause) for clause in made.result.plan.computed)
