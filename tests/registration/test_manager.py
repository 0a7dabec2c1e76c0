"""The one manager: lazy by kind, answered by many, in an order that no history changes."""

import os
import subprocess
import sys

import pytest

import contactlab
from contactlab import Material, Scene, Simulation
from contactlab.impact.material import Entry
from contactlab.outcome.columns import QUANTITIES, Column, columns
from contactlab.registration.installed import PluginWarning

GIVEN = {"young_modulus": 1e9, "poisson_ratio": 0.3, "density": 1e3}
SOURCED = {"elastic_source": "own", "density_source": "own"}
SOURCE = """
import contactlab
from contactlab.impact.material import Entry
@contactlab.hookimpl
def contactlab_materials():
    return [Entry(name=NAME, young_modulus=MODULUS, poisson_ratio=0.3, density=1e3,
                  elastic_source="own", density_source="own")]
"""


def lab(name, modulus):
    return SOURCE.replace("NAME", repr(name)).replace("MODULUS", str(modulus))


@pytest.fixture
def registered():
    """Register plug-ins for one test."""
    names = []

    def call(plugin, name=None):
        names.append(contactlab.register(plugin, name))

    yield call
    for name in names:
        contactlab.plugin_manager().unregister(name=name)


class Lab:
    """Brings one material and one column."""

    def __init__(self, name="unobtainium"):
        self.name = name

    @contactlab.hookimpl
    def contactlab_materials(self):
        return [Entry(name=self.name, **GIVEN, **SOURCED)]

    @contactlab.hookimpl
    def contactlab_columns(self):
        return [Column("twice", "1", value=lambda result: 2.0 * result.psi2)]


def test_what_is_registered_is_known_at_once_and_forgotten(registered):
    result = Simulation().run(Scene.nondimensional(psi1=[1.2, 2.0], chi=1.44))
    assert "twice" not in QUANTITIES
    registered(Lab(), "lab")
    assert Material.named("unobtainium").density == 1e3
    assert {n: v for n, _, v in columns(result)}["twice"] == pytest.approx(2 * result.psi2)
    assert contactlab.plugin_manager().get_plugin("lab").name == "unobtainium"
    contactlab.plugin_manager().unregister(name="lab")
    registered(Lab(), "lab")
    with pytest.raises(ValueError, match="already registered"):
        registered(Lab(), "lab")


def test_a_wrapper_changes_what_all_others_bring(registered):
    class Denser:
        @contactlab.hookimpl(wrapper=True)
        def contactlab_materials(self):
            found = yield
            return [each for each in found for each in [[e for e in each if e.name != "lead"]]]

    assert "lead" in contactlab.materials.names()
    registered(Denser(), "denser")
    assert "lead" not in contactlab.materials.names()
    assert "steel" in contactlab.materials.names()


def test_a_hook_may_leave_out_arguments_and_first_is_asked_first(registered):
    class Careful:
        @contactlab.hookimpl
        def contactlab_cautions(self, scene):
            return ["careful"]

    class First:
        @contactlab.hookimpl(tryfirst=True)
        def contactlab_cautions(self):
            return ["first"]

    registered(First(), "first")
    registered(Careful(), "careful")
    result = Simulation().run(Scene.nondimensional(psi1=1.2, chi=1.44))
    said = [str(text) for text in result.plan.cautions]
    assert said[-2:] == ["first (this program)", "careful (this program)"]


def test_unknown_hooks_and_arguments_are_refused_and_leave_nothing(registered):
    class Misspelt:
        @contactlab.hookimpl
        def contactlab_material(self):
            return []

    with pytest.raises(contactlab.PluginError, match="contactlab_material"):
        contactlab.register(Misspelt(), "misspelt")
    assert not contactlab.plugin_manager().has_plugin("misspelt")


def test_what_is_no_law_or_an_unfinished_one_is_refused_and_stops_no_other():
    class Unfinished(contactlab.SteppedTangentialLaw):
        api_version = 2

        def start(self, scene, normal):
            return 0.0

    class Undated(Unfinished):
        api_version = 1

        def advance(self, state, increment, before, after):
            return 0.0

    for law, told in ((Unfinished, "lacks advance"), (Undated, "api_version is 1")):
        with pytest.raises(contactlab.PluginError, match=told):
            contactlab.register(law)
    with pytest.raises(ValueError, match="plugin = 'smooth': is not the class of a law"):
        contactlab.register("smooth")
    assert Simulation(tangential="coulomb").run(Scene.nondimensional(psi1=1.2, chi=1.44)).psi2 == 0


def test_a_law_is_registered_by_name(registered):
    class Mine(contactlab.contracts.WholeImpactTangentialLaw):
        api_version = 2

        def whole_impacts(self, scene, normal):
            return ()

    registered(Mine, "tangential.mine")
    assert isinstance(contactlab.create("tangential.mine"), Mine)
    contactlab.plugin_manager().unregister(name="tangential.mine")
    with pytest.raises(ValueError, match="no friction law"):
        contactlab.create("tangential.mine")
    registered(Mine, "tangential.mine")


def test_names_follow_the_rule_of_distributions(install, monkeypatch):
    install("lab-a", "lab_a", lab("goo", 1e6), "materials.a")
    install("lab-b", "lab_b", lab("goo", 2e6), "materials.b")
    install("lab-c", "lab_c", lab("steel", 3e6), "materials.c")
    assert Material.named("steel").young_modulus > 1e11
    assert Material.named("lab-c:steel").young_modulus == pytest.approx(3e6)
    with pytest.raises(ValueError, match="goo"):
        Material.named("goo")
    assert Material.named("lab-b:goo").young_modulus == pytest.approx(2e6)
    monkeypatch.setenv("CONTACTLAB_BLOCK_PLUGINS", "lab-a")
    assert Material.named("goo").young_modulus == pytest.approx(2e6)
    assert Material.named("steel").young_modulus > 1e11


def test_a_broken_plugin_is_told_once_and_takes_nothing_from_others(install):
    install("broken", "broken_lab", "raise RuntimeError('boom')", "materials.broken")
    assert Material.named("steel").density == 7850.0  # nothing of others is read
    with pytest.warns(PluginWarning, match=r"boom \(broken_lab.py, line 1\)"):
        assert "steel" in contactlab.materials.names()
    assert Material.named("lead").density > 1e4


def test_a_hook_without_its_entry_point_is_refused(install):
    two = lab("goo", 1e6) + "\n@contactlab.hookimpl\ndef contactlab_cautions(): return []\n"
    install("two", "two_hooks", two, "materials.two")
    with pytest.warns(PluginWarning, match="has contactlab_cautions, but no entry point cautions"):
        contactlab.materials.names()


CODE = """
import sys, contactlab
{first}
{second}
hooks = contactlab.plugin_manager()._find_hooks("contactlab_materials", "")
asked = [info.module for info, _ in hooks]
print(asked)
"""


def test_the_order_does_not_hang_on_what_was_asked_first(install, tmp_path):
    both = lab("a", 1e6) + "\n@contactlab.hookimpl\ndef contactlab_columns(): return []\n"
    install("lab-a", "lab_a", lab("x", 1e6), "materials.a")
    install("lab-b", "lab_b", both, "materials.b", "columns.b")
    paths = os.pathsep.join(sys.path)
    quantities = "from contactlab.outcome.columns import QUANTITIES as Q; len(Q)"
    asked = "contactlab.materials.names()", quantities
    told = set()
    for first, second in (asked, asked[::-1]):
        code = CODE.format(first=first, second=second)
        done = subprocess.run(
            [sys.executable, "-c", code],
            capture_output=True,
            text=True,
            check=True,
            env=os.environ | {"PYTHONPATH": paths},
        )
        told.add(done.stdout)
    assert told == {"['contactlab.impact.material', 'lab_a', 'lab_b']\n"}


def test_nothing_is_imported_before_its_kind_is_asked_for():
    code = (
        "import sys, contactlab\n"
        "contactlab.plugin_manager()\n"
        "heavy = {'numpy', 'scipy', 'matplotlib'} & set(sys.modules)\n"
        "assert not heavy, heavy\n"
        "contactlab.Simulation().run(contactlab.Scene.nondimensional(psi1=1.2, chi=1.44))\n"
        "late = {'contactlab.study', 'contactlab_fit', 'contactlab_pages', 'matplotlib'}\n"
        "assert not late & set(sys.modules), late & set(sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
