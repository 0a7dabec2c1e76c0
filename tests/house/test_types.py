"""Types say the truth: to readers of a signature, and to the type checkers of users."""

import inspect

import pytest

import contactlab
from contactlab.compose.registry import REGISTRY


@pytest.mark.parametrize("name", ["Encounter", "HalfSpace", "RigidBody", "Scene", "Sphere"])
def test_the_arguments_that_a_class_states_are_those_it_takes(name):
    made = getattr(contactlab, name)
    stated = list(inspect.signature(made).parameters.values())
    taken = list(inspect.signature(made.__attrs_init__).parameters.values())[1:]
    assert [(one.name, one.kind, one.default) for one in stated] == [
        (one.name, one.kind, one.default) for one in taken
    ]


@pytest.mark.parametrize(
    ("made", "shown"),
    [
        (contactlab.Sphere, "radius: 'Numbers', material: 'Material', *, mass: 'Numbers | None'"),
        (contactlab.Encounter, "*, normal: 'Numbers', velocity: 'Numbers', spin: 'Numbers' = (0.0"),
        (contactlab.Material, "shear_modulus: 'Numbers | None' = None, young_modulus: 'Numbers |"),
        (REGISTRY.law_class("tangential.annulus"), "*, annuli: 'int' = 50, displacement: 'str'"),
        (REGISTRY.law_class("normal.hunt_crossley"), "restitution: 'Numbers"),
    ],
)
def test_a_signature_shows_types_and_defaults(made, shown):
    assert shown in str(inspect.signature(made))
