"""Calls that do not fit a signature: what is told, and to whom."""

from __future__ import annotations

import inspect
import pickle

import attrs
import pytest

import contactlab
from contactlab import HalfSpace, Material, Pair, Scene, Simulation, Sphere
from contactlab.signatures import ArgumentError, named_arguments

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
SCENE = Scene.nondimensional(psi1=1.2, chi=1.4412)


@named_arguments("Scene(ball, plate, friction_coefficient=0.2, normal_speed=1.0)")
@attrs.frozen
class Likeness:
    """A class with the arguments of a scene."""

    sphere: object
    target: object
    friction_coefficient: float
    normal_speed: float
    tangential_velocity: float = 0.0
    spin: float = 0.0


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: Sphere(0.01), "Sphere: material is missing; write it as Sphere("),
        (lambda: Sphere(), "radius, material are missing"),
        (lambda: Sphere(R=0.01, material=STEEL), "R is not an argument; did you mean 'radius'?"),
        (lambda: Sphere(0.01, STEEL, 0.3), "0.3 is one too many; it takes at most 2 without"),
        (lambda: Sphere(0.01, STEEL, radius=1), "radius is given twice, as 0.01 by its place"),
        (lambda: Sphere(0.01, STEEL, M=3.0), "did you mean 'mass'?"),
        (lambda: Material(208e9, 0.3), "208000000000.0 is one too many; it takes every one by"),
        (lambda: Material(E=208e9, nu=0.3), "E is not an argument; did you mean 'young_modulus'?"),
        (lambda: Material(young_modulus=208e9), "poisson_ratio is missing"),
        (lambda: Material(G=8e10, poisson_ratio=0.3), "did you mean 'shear_modulus'?"),
        (lambda: Material(young_modulus=1e9, nu=0.3), "did you mean 'poisson_ratio'?"),
        (lambda: Material(young_modulus=1e9, poisson_ratio=0.3, rho=1), "did you mean 'density'?"),
        (lambda: HalfSpace(), "material is missing"),
        (lambda: HalfSpace(STEEL, 3), "3 is one too many"),
        (lambda: Pair(radius=1.0), "effective_modulus, effective_shear_modulus, normal_mass, "),
        (lambda: contactlab.create("tangential.annulus", 50), "create: 50 is one too many"),
        (lambda: contactlab.create("tangential.annulus", 50, annuli=60), "50 is one too many"),
        (lambda: contactlab.create(), "name is missing"),
        (lambda: contactlab.read_scene(), "path is missing"),
        (lambda: contactlab.rebound(1.2), "chi is missing"),
        (lambda: contactlab.rebound(psi=1.2, chi=1.0), "did you mean 'psi1'?"),
        (lambda: Sphere(d=0.02, material=STEEL), "did you mean 'radius'?"),
        (lambda: Material.named(), "name is missing; write it as Material.named('steel')"),
        (lambda: Simulation(friction="springs"), "did you mean 'tangential'?"),
        (lambda: Simulation("springs"), "takes every one by name; write it as Simulation(tang"),
        (lambda: Simulation().run(), "scene is missing; write it as Simulation().run(scene"),
        (lambda: Simulation.run(SCENE), "scene is missing; write it as Simulation().run(scene"),
        (lambda: Simulation().run(SCENE, True), "True is one too many"),
        (lambda: Simulation().run(SCENE, hist=True), "did you mean 'history'?"),
        (lambda: Simulation().plan(), "plan: scene is missing"),
        (lambda: Simulation().sweep(), "sweep: scenes is missing"),
        (lambda: Scene.stack(), "scenes is missing; write it as Scene.stack("),
        (lambda: Scene.nondimensional(1.2, 1.4), "write it as Scene.nondimensional(psi1=1.2, chi"),
        (lambda: Likeness(1, 2, mu=0.2, normal_speed=1.0), "'friction_coefficient'?"),
        (lambda: Likeness(1, 2, 0.2, v1=1.0), "did you mean 'normal_speed'?"),
        (lambda: Likeness(1, 2, 0.2, 1.0, v=1.0), "did you mean 'tangential_velocity'?"),
        (lambda: Likeness(1, 2, 0.2, 1.0, omega=1.0), "did you mean 'spin'?"),
        (lambda: Likeness(1, 2, 0.2, 1.0, qqq=1.0), "qqq is not an argument; it takes sphere, "),
    ],
)
@pytest.mark.parametrize("caught", [TypeError, ValueError])
def test_a_call_that_does_not_fit(call, words, caught):
    with pytest.raises(caught) as found:
        call()
    assert isinstance(found.value, ArgumentError)
    assert words in str(found.value)
    assert "write it as " in str(found.value)
    assert "\n" not in str(found.value)


def test_every_example_is_a_call_that_fits():
    namespace = vars(contactlab) | {"steel": STEEL, "glass": STEEL}
    for call in (Sphere, HalfSpace, Material, lambda: contactlab.create(),
                 lambda: contactlab.rebound()):  # fmt: skip
        with pytest.raises(ArgumentError) as found:
            call()
        example = str(found.value).partition("write it as ")[2]
        eval(example, namespace)


def test_an_error_inside_is_not_the_callers():
    @named_arguments("f(1)")
    def f(x):
        return x + "text"

    with pytest.raises(TypeError) as found:
        f(1)
    assert not isinstance(found.value, ArgumentError)
    assert "str" in str(found.value)


def test_what_is_decorated_is_what_it_was():
    assert list(inspect.signature(Sphere).parameters) == [
        "radius", "material", "mass", "gyration_ratio",
    ]  # fmt: skip
    ball = Sphere(0.0127, STEEL)
    assert pickle.loads(pickle.dumps(ball)) == ball
    assert attrs.evolve(ball, radius=0.02).radius == 0.02
    assert Sphere.__init__.__name__ == "__init__"
    assert contactlab.create.__doc__.startswith("Return a new law")


def test_a_call_that_fits_costs_no_look_at_the_signature(monkeypatch):
    monkeypatch.setattr(inspect, "signature", None)
    assert Sphere(0.0127, STEEL).radius == 0.0127


def test_values_of_the_wrong_kind_are_refused_with_what_was_meant():
    with pytest.raises(ValueError, match=r"by its name: Material\.named\('steel'\)"):
        Sphere(0.01, "steel")
    with pytest.raises(ValueError, match=r"of a file: read_scene\(path\)"):
        Simulation().run("scene.toml")


def test_a_sweep_takes_its_documented_arguments_through_the_check():
    found = [Simulation().run(SCENE), Simulation().run(scene=SCENE)]
    assert found[0].psi2 == found[1].psi2
    assert list(inspect.signature(Simulation.run).parameters)[1:3] == ["scene", "history"]
