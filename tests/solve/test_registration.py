"""What a class of laws must have is checked at every door; what parameters waive."""

import json

import pytest

import contactlab
from contactlab import PluginError, Simulation, read_scene
from contactlab.cli.main import main
from contactlab.contracts import claims
from contactlab.contracts.law import requirements

FILE = """
import attrs
from contactlab import Integrator, NormalContact, NormalLaw, SteppedTangentialLaw, TangentialMotion
from contactlab.registry.registry import REGISTRY

Springs = REGISTRY.law_class("tangential.springs")
Symplectic = REGISTRY.law_class("integrator.symplectic")


@attrs.frozen(kw_only=True)
class OldOrder(Integrator):
    api_version = 2
    needs = frozenset({SteppedTangentialLaw})

    def integrate(self, normal, tangential, scene, observer=None):
        raise AssertionError("run with arguments exchanged")


@attrs.frozen(kw_only=True)
class OldErrors(Symplectic):
    api_version = 2

    def errors(self, normal, tangential, scene):
        raise AssertionError("run with arguments exchanged")


@attrs.frozen(kw_only=True)
class OldResolution(Symplectic):
    api_version = 2

    def resolution_for(self, scene, normal, tangential):
        raise AssertionError("not asked")


@attrs.frozen(kw_only=True)
class OldCoupled(Symplectic):
    api_version = 2

    def integrate_coupled(self, normal, tangential, scene, observer=None):
        raise AssertionError("run with arguments exchanged")


@attrs.frozen(kw_only=True)
class AnyOrder(Symplectic):
    api_version = 2

    def cautions(self, *given):
        raise AssertionError("run with arguments exchanged")


@attrs.frozen(kw_only=True)
class ByParameter(NormalLaw):
    api_version = 2
    offers = property(lambda self: frozenset({"radius"}))

    def start(self, scene):
        return None

    def respond(self, state, approach, rate):
        return NormalContact(approach, approach, approach), None


@attrs.frozen(kw_only=True)
class NeedsInAList(Springs):
    api_version = 2
    needs = ["radius"]


@attrs.frozen(kw_only=True)
class Weighed(Springs):
    api_version = 2
    offers = Springs.offers | {"normal_spin"}
    weight: float
"""
#: Classes by kind, with a word or two of why they are refused.
REFUSED = {
    ("integrator", "OldOrder"): "OldOrder.integrate has the arguments (normal, tangential, scene",
    ("integrator", "OldErrors"): "(scene, normal, tangential), in this order",
    ("integrator", "OldResolution"): "resolution_for is not asked; return the resolution",
    ("integrator", "OldCoupled"): "OldCoupled.integrate_coupled has the arguments",
    ("integrator", "AnyOrder"): "AnyOrder.cautions has the arguments (given)",
    ("normal", "ByParameter"): "ByParameter.offers must be a frozenset",
    ("tangential", "NeedsInAList"): "NeedsInAList.needs must be a frozenset",
}
SCENE = """
[sphere]
radius = 0.01
material = "steel"
[target]
kind = "half-space"
material = "steel"
[impact]
friction_coefficient = 0.2
speed = 1.0
angle_deg = 15.0
[simulation]
{kind} = "mine.py:{name}"
"""


def by_object(folder, kind, name):
    module = {}
    exec(FILE, module)
    Simulation(**{kind: module[name]()})


def by_name(folder, kind, name):
    Simulation(**{kind: f"{folder}/mine.py:{name}"})


def by_create(folder, kind, name):
    contactlab.create(f"{folder}/mine.py:{name}")


def by_scene_file(folder, kind, name):
    (folder / "scene.toml").write_text(SCENE.format(kind=kind, name=name))
    _ = read_scene(folder / "scene.toml", allow_code=True).laws.simulation()


DOORS = (by_object, by_name, by_create, by_scene_file)


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "mine.py").write_text(FILE)
    return tmp_path


@pytest.mark.parametrize(("kind", "name"), REFUSED)
@pytest.mark.parametrize("door", DOORS)
def test_a_class_that_breaks_the_contract_is_refused_at_every_door(folder, door, kind, name):
    with pytest.raises((ValueError, PluginError)) as caught:
        door(folder, kind, name)
    assert REFUSED[kind, name] in str(caught.value)
    assert "0x" not in str(caught.value)


@pytest.mark.parametrize("name", ["OldOrder", "ByParameter"])
def test_the_command_line_refuses_it_too(folder, name, capsys):
    assert main(["plugins", "check", f"{folder}/mine.py:{name}"]) != 0
    told = "".join(capsys.readouterr())
    assert "must be a frozenset" in told or "in this order" in told


def test_a_law_is_shown_without_being_made(folder, capsys):
    """One with an option that has no default, too."""
    assert main(["plugins", "show", f"{folder}/mine.py:Weighed", "--json"]) == 0
    shown = json.loads(capsys.readouterr().out)
    assert {"vectors", "partial_slip", "shares_loss", "normal_spin"} <= set(shown["offers"])


@pytest.mark.parametrize(
    ("name", "options", "waived"),
    [
        ("tangential.springs", {}, set()),
        ("tangential.springs", {"shear_loss": 0.0}, {"shares_loss"}),
        ("normal.tsuji", {"restitution": 1.0}, {"viscous"}),
        ("normal.tsuji", {"restitution": 0.9}, set()),
        ("normal.hunt_crossley", {"damping": 0.3}, {"similar"}),
        ("normal.hunt_crossley", {"restitution": 1.0}, {"viscous"}),
        ("normal.viscoelastic", {"restitution": 0.8}, set()),
        ("normal.kuwabara_kono", {"relaxation_time": 0.0}, {"viscous", "similar"}),
    ],
)
def test_parameters_take_words_away_and_a_derived_class_loses_none(name, options, waived):
    assert_waived(name, options, waived)


def assert_waived(name, options, waived):
    """Words of a law's class are those of the law, but for what its parameters waive."""
    law = contactlab.create(name, **options)
    words = type(law).offers | type(law).needs
    assert claims(law) | requirements(law) == words - waived
    derived = type("Derived", (type(law),), {"offers": type(law).offers | {"elliptic"}})
    assert claims(derived(**options)) == claims(law) | {"elliptic"}
