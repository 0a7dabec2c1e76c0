"""Attributes that an object does not have: what is told, and who must not notice."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

import contactlab
from contactlab import Encounter, HalfSpace, Material, Scene, Simulation, Sphere
from contactlab.attributes import CLASSES, named_attributes, public_names
from contactlab.scene_file import read_scene
from tests.cli.conftest import EXAMPLES

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
BALL = Sphere(6.35e-3, STEEL)
SCENE = Scene(BALL, HalfSpace(STEEL), 0.15, 1.93, 0.9, -40.0)
ENCOUNTER = Encounter(
    BALL, HalfSpace(STEEL), friction_coefficient=0.15, normal=[0, 0, -1], velocity=[1.0, 0, -2.0]
)
RESULT = Simulation(tangential="coulomb").run(SCENE, history=True)
COLLISION = contactlab.collide(ENCOUNTER, Simulation(tangential="coulomb"))
GRID = Scene.grid(chi=[1.2, 1.4], psi1=[0.5, 1.0])
FILE = read_scene(EXAMPLES / "steel_ball.toml")
OBJECTS = (
    STEEL, BALL, SCENE.target, SCENE.pair, SCENE, GRID, ENCOUNTER, COLLISION, RESULT, RESULT.plan,
    RESULT.history, RESULT.motion, RESULT.energy, Simulation(), FILE,
)  # fmt: skip


def complaint(thing, name):
    with pytest.raises(AttributeError) as raised:
        getattr(thing, name)
    assert raised.value.name == name
    return str(raised.value)


@pytest.mark.parametrize(
    ("thing", "name", "words"),
    [
        (RESULT, "spin", "did you mean 'rebound_spin' or 'scene.spin'?"),
        (RESULT, "mu", "did you mean 'scene.friction_coefficient'?"),
        (RESULT, "e_t", "did you mean 'tangential_restitution'?"),
        (RESULT, "psi_2", "did you mean 'psi2'?"),
        (RESULT, "duration", "did you mean 'motion.duration'?"),
        (RESULT, "normal_forse", "did you mean 'history.normal_force'?"),
        (RESULT, "E", "did you mean 'scene.sphere.material.young_modulus'?"),
        (RESULT.plan, "caution", "did you mean 'cautions'?"),
        (SCENE, "radius", "Scene: radius is not an attribute; did you mean 'sphere.radius'?"),
        (GRID, "mu", "Grid: mu is not an attribute; did you mean 'friction_coefficient'?"),
        (BALL, "density", "did you mean 'material.density'?"),
        (STEEL, "nu", "did you mean 'poisson_ratio'?"),
        (ENCOUNTER, "v", "did you mean 'velocity'"),
        (COLLISION, "psi2", "did you mean 'result.psi2'?"),
        (RESULT.history, "t", "did you mean 'time'?"),
        (RESULT.history, "force", "'normal_force' or 'tangential_force'"),
        (Simulation(), "law", "did you mean 'tangential'?"),
        (FILE, "radius", "did you mean 'scene.sphere.radius'?"),
        (BALL, "nonsense", "it has gyration_ratio, mass, material, radius"),
    ],
)
def test_the_name_that_was_meant(thing, name, words):
    assert words in complaint(thing, name)


@pytest.mark.parametrize("thing", OBJECTS, ids=lambda thing: type(thing).__name__)
def test_what_is_told_is_there(thing):
    """Every name that a hint can give is found by following it, or leads to None."""
    for name in ("mu", "spin", "radius", "psi2", "E", "duration", "force", "rho"):
        if hasattr(thing, name):
            continue
        _, asked, hint = complaint(thing, name).partition("did you mean ")
        for path in hint.rstrip("?").split(" or ") if asked else ():
            found = thing
            for step in path.strip("'").split("."):
                found = None if found is None else getattr(found, step)


@pytest.mark.parametrize("thing", OBJECTS, ids=lambda thing: type(thing).__name__)
def test_nobody_notices_who_only_looks(thing):
    for name in ("_repr_png_", "_ipython_display_", "__array_interface__", "__deepcopy__"):
        assert not hasattr(thing, name)
        assert "did you mean" not in complaint(thing, name)
    assert not hasattr(thing, "nonsense")
    assert getattr(thing, "nonsense", 3) == 3
    for other in (copy.copy(thing), copy.deepcopy(thing), pickle.loads(pickle.dumps(thing))):
        assert type(other) is type(thing)
        assert public_names(type(other)) == public_names(type(thing))
        assert repr(other) == repr(thing)


def test_an_object_that_is_not_made_yet_says_what_it_lacks():
    empty = Scene.__new__(Scene)
    assert "did you mean" not in complaint(empty, "spin")


def test_a_property_that_fails_is_told_as_it_fails():
    @named_attributes
    class Half:
        @property
        def whole(self):
            return np.pi.nonsense

    try:
        with pytest.raises(AttributeError, match="nonsense"):
            _ = Half().whole
        with pytest.raises(AttributeError, match="did you mean 'whole'"):
            _ = Half().hole
    finally:
        del CLASSES["Half"]
