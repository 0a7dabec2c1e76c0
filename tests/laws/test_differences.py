"""The sizes in cautions: of separately limited springs, and of the choice of a normal law."""

import re
from types import SimpleNamespace

import numpy as np
import pytest

from contactlab import Scene, Simulation, create
from contactlab_laws.differences.table import choice, springs

SCENE = Scene.nondimensional(psi1=1.0, chi=1.2)


class Unknown:
    """A normal law that was not measured."""


#: Springs whose shear is elastic: those that share a loss keep to Coulomb's law at every point.
ELASTIC = create("tangential.springs", shear_loss=0.0)


def cautions(psi1, chi, *, tangential=ELASTIC, **laws):
    scene = Scene.nondimensional(psi1=psi1, chi=chi)
    return [str(each) for each in Simulation(tangential=tangential, **laws).plan(scene).cautions]


def size(psi1, chi, name, e):
    """Return the size that the caution of springs gives."""
    told = cautions(psi1, chi, normal=create(f"normal.{name}", restitution=e))
    found = [re.search(r"limited separately.*off by up to ([\d.e-]*\d)", text) for text in told]
    return next((float(each[1]) for each in found if each), 0.0)


@pytest.mark.parametrize(
    ("name", "e", "psi1", "chi", "exact"),
    [
        # annuli, rings tied to their edges and another solver agree on these
        ("hunt_crossley", 0.2, 4.346, 5.652, -1.498),
        ("kuwabara_kono", 0.2, 3.172, 6.0, -0.1275),
        ("hunt_crossley", 0.4, 2.937, 3.682, -0.1107),
    ],
)
def test_the_size_bounds_the_error_of_springs_far_from_solid_spheres(name, e, psi1, chi, exact):
    laws = Simulation(
        normal=create(f"normal.{name}", restitution=e),
        tangential=create("tangential.springs", springs=120, shear_loss=0.0),
        integrator=create("integrator.symplectic", steps=480),
    )
    off = abs(laws.run(Scene.nondimensional(psi1=psi1, chi=chi)).psi2 - exact)
    assert 0.1 < off <= size(psi1, chi, name, e) < 5.0 * off


def test_what_was_not_measured_has_no_number():
    for chi, e in ((30.0, 0.5), (0.01, 0.5), (1.2, 0.05)):
        told = cautions(1.0, chi, normal=create("normal.tsuji", restitution=e))
        (text,) = [each for each in told if "limited separately" in each]
        assert "outside the measured range" in text
    motion = SimpleNamespace(law=Unknown(), final_rate=-1.0, scene=SCENE, claims=frozenset())
    assert "outside the measured range" in springs(SCENE, motion)[0]
    assert choice(SCENE, motion) == ()


def test_elastic_contacts_without_friction_or_slip_have_no_caution():
    assert size(1.0, 1.2, "tsuji", 1.0) == 0.0
    assert size(0.0, 1.2, "tsuji", 0.5) == 0.0
    assert not any("separately" in text for text in cautions(1.0, 1.2))
    assert size(1.0, 1.2, "hunt_crossley", 0.99) == 0.0  # below a thousandth


def test_the_worst_of_a_batch_is_told():
    alone = size(2.0, 5.0, "hunt_crossley", 0.3)
    assert size([1.0, 2.0], [0.1, 5.0], "hunt_crossley", 0.3) == alone > 0.1


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("hunt_crossley", r"0\.3 \(tsuji\)"),
        ("tsuji", r"0\.04 \(kuwabara_kono\) to 0\.6 \(linear\)"),
    ],
)
def test_the_caution_of_the_choice_of_normal_law(name, text):
    """Theory §11: at e = .8 Hunt and Crossley's law is .19, a linear spring .5 from Tsuji's."""
    told = cautions(2.0, 1.2, normal=create(f"normal.{name}", restitution=0.8))
    assert any(re.search(f"elastic shear.*{text}", each) for each in told)


@pytest.mark.parametrize("e", [0.5, 0.9])
def test_the_choice_of_a_viscous_law_where_shear_shares_the_loss(e):
    """Viscous laws of one restitution, and a linear spring beside them, which shares nothing."""
    laws = {
        name: Simulation(normal=create(f"normal.{name}", restitution=e), tangential="springs")
        for name in ("tsuji", "hunt_crossley", "kuwabara_kono", "viscoelastic", "linear")
    }
    psi1, chi = (each.ravel() for each in np.meshgrid(np.linspace(0.2, 9.0, 45), (0.8, 1.2, 1.8)))
    scene = Scene.nondimensional(psi1=psi1, chi=chi)
    psi2 = {name: simulation.sweep(scene).check().psi2 for name, simulation in laws.items()}
    off = {name: np.abs(each - psi2["tsuji"]).max() for name, each in psi2.items()}
    told = {
        name: " ".join(cautions(2.0, 1.2, tangential="springs", normal=laws[name].normal))
        for name in ("tsuji", "hunt_crossley", "kuwabara_kono")
    }
    for name in ("hunt_crossley", "kuwabara_kono"):
        text = re.search(r"damped shear.*up to ([\d.]+) \(tsuji\)", told[name])
        assert 0.5 * float(text[1]) < off[name] < float(text[1])
    least, most = re.search(
        r"damped shear.*up to ([\d.]+) \(kuwabara_kono\) to ([\d.]+) \(", told["tsuji"]
    ).groups()
    assert off["kuwabara_kono"] < float(least)
    assert max(off.values()) < float(most)
