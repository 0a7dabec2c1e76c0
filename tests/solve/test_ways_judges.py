"""Judges of what laws answer: what is refused of spheres is refused of bodies, by the same row."""

from __future__ import annotations

import itertools
import math
from typing import ClassVar

import attrs
import numpy as np
import pytest

from contactlab import Simulation, load_path
from contactlab.contracts import CausalTangentialLaw, Errors, NormalContact, NormalLaw
from contactlab.contracts.contact import TOUCH
from contactlab.contracts.tangential import TangentialResponse
from contactlab.impact.hertz import hertz_stiffness
from tests.longer import longer
from tests.solve.any_scene import FEW, ONES, SPRINGS, every_way, one_scene, statuses
from tests.solve.test_eccentric import rod

#: How often a normal law was asked.
ASKED = [0]
#: Numbers of laws that differ in nothing else.
NUMBERS = itertools.count(1)


@attrs.frozen(kw_only=True)
class Contact(NormalLaw):
    """Hertz's contact, but for one mistake."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"radius", "hertzian_pressure"})

    how: str = "none"
    number: int = 0

    def start(self, scene):
        return hertz_stiffness(scene), scene.pair.radius

    def respond(self, state, approach, rate):
        ASKED[0] += 1
        stiffness, size = state
        inside = np.maximum(approach, 0.0) + 0.0 * approach
        force, radius, overlap = stiffness * inside**1.5, (size * inside) ** 0.5, approach
        parting = np.asarray(rate) < 0.0
        if self.how == "doubled":
            force = force * (1.0 + parting)
        if self.how == "2 % more":
            force = force * (1.0 + 0.02 * parting)
        if self.how == "negative":
            radius = -radius
        if self.how == "negative where deep":
            radius = radius * np.where(inside > 0.5, -1.0, 1.0)
        if self.how == "held":
            force, overlap = stiffness * abs(approach) ** 1.5 * np.sign(approach), abs(approach)
        if self.how == "without force":
            force = 0.0 * force
        if self.how == "at rest":
            force = 0.01 * rate + 0.0 * force
        if self.how == "list":
            force = np.asarray(force).tolist() if np.ndim(force) else [float(force)]
        if self.how in ("held", "without force", "at rest"):
            overlap = abs(approach) + TOUCH
        return NormalContact(force, radius, overlap), state


#: Mistakes of a normal law, and the status.
NORMAL = {
    "doubled": "UNBALANCED",
    "2 % more": "UNBALANCED",
    "negative": "MALFORMED",
    "negative where deep": "MALFORMED",
    "list": "MALFORMED",
    "without force": "NOT_SEPARATED",
    "none": "SUCCESS",
}


@every_way
@pytest.mark.parametrize("how", [*longer("2 % more"), *sorted(NORMAL.keys() - {"2 % more"})])
def test_a_mistake_of_a_normal_law_has_one_status(scene, how):
    laws = Simulation(normal=Contact(how=how), tangential=FEW.tangential, integrator=FEW.integrator)
    result = laws.run(scene)
    assert set(statuses(result)) == {NORMAL[how]}
    assert np.isnan(result.psi2).all() == (how != "none")


@one_scene
def test_energy_from_nothing_is_seen_beside_any_tangential_law(scene):
    """Also where no bound of the energy books is declared."""
    for tangential in ("mindlin_cap", "linear_spring"):
        laws = Simulation(normal=Contact(how="doubled"), tangential=tangential)
        assert statuses(laws.run(scene)) == ["UNBALANCED"]


@pytest.mark.parametrize("name", ["central", "planar", *longer("space")])
@pytest.mark.parametrize("how", ["held", "without force", "at rest"])
def test_a_contact_that_never_ends_costs_some_usual_impacts(name, how):
    """By how often the normal law is asked, whatever the clock says."""
    laws = {"tangential": SPRINGS.tangential, "integrator": SPRINGS.integrator}
    counts = []
    for law in (Contact(), Contact(how=how)):
        ASKED[0] = 0
        fresh = attrs.evolve(law, number=next(NUMBERS))  # motions of equal laws are kept
        result = Simulation(normal=fresh, **laws).run(ONES[name])
        counts.append(ASKED[0])
    assert statuses(result) == ["NOT_SEPARATED"]
    assert "the bodies do not separate" in result.failures[0]
    assert counts[1] <= 20 * counts[0]


@pytest.mark.parametrize("how", ["negative", "negative where deep"])
@pytest.mark.parametrize("shape", [(), (2,)])
def test_a_radius_below_zero_is_refused_along_a_path(how, shape):
    scene = ONES["central"]
    depth = np.linspace(0.0, 1.0, 50).reshape(-1, *(1 for _ in shape)) * np.ones(shape)
    path = load_path(scene, depth, depth, normal=Contact(how=how))
    assert {status.name for status in np.ravel(np.array(path.status, dtype=object))} == {
        "MALFORMED"
    }
    assert "radius below zero" in path.detail


@attrs.frozen
class Slider(CausalTangentialLaw):
    """Viscous friction that is declared, or answered, as told."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"vectors"})

    name: str = ""
    value: object = None

    def _or(self, name, value):
        return self.value if self.name == name else value

    def start(self, scene, normal):
        return 0.1 * np.max(scene.pair.tangential_mass / normal.duration)

    def stiffness(self, scene, normal):
        return self._or("stiffness", 1.0)

    def books_bound(self, scene):
        return self._or("books_bound", 1.0)

    def errors(self, scene, normal, steps, accuracy=None):
        return self._or("errors", Errors())

    def advance(self, state, increment, before, after):
        force = np.asarray(increment.velocity) * state
        work = (force * increment.displacement).reshape(*np.shape(after.force), -1).sum(axis=-1)
        work = work if work.ndim else float(work)
        if self.name == "signs":
            work, loss = (-work, 2.0 * work) if self.value == "work" else (2.0 * work, -work)
            return TangentialResponse(
                force if force.ndim else float(force), work, True, loss
            ), state
        answer = {"force": force, "friction_work": work, "settled": True, "shear_loss": 0.0 * work}
        if self.name in answer:
            like = np.asarray(answer[self.name])
            value = like + self.value if self.value is not list else like
            answer[self.name] = [value.tolist()] if self.value is list else value
        return TangentialResponse(**answer), state


#: What a tangential law declares or answers that is no answer.
TANGENTIAL = [
    ("stiffness", math.nan), ("stiffness", [1.0]), ("stiffness", -1.0), ("stiffness", None),
    ("books_bound", math.nan), ("books_bound", [0.1]), ("books_bound", -1.0),
    ("errors", Errors([1e-3])), ("errors", Errors(-1.0)), ("errors", (1e-3, 1e-3)),
    ("force", list), ("friction_work", list), ("shear_loss", list), ("settled", list),
    ("settled", math.nan),
]  # fmt: skip


@every_way
@pytest.mark.parametrize(("name", "value"), TANGENTIAL)
def test_what_is_no_number_of_a_tangential_law_is_malformed(scene, name, value):
    result = Simulation(tangential=Slider(name, value), integrator=FEW.integrator).run(scene)
    assert set(statuses(result)) == {"MALFORMED"}
    assert "Slider" in result.failures[0]
    assert "needs at least" not in result.failures[0]


@one_scene
@pytest.mark.parametrize("below", ["work", "shear"])
def test_work_below_zero_is_not_balanced_by_another(scene, below):
    """The books close: what one entry lacks the other has too much."""
    laws = Simulation(tangential=Slider("signs", below), integrator=FEW.integrator)
    fast = attrs.evolve(scene, tangential_velocity=20.0 * np.asarray(scene.tangential_velocity))
    assert statuses(laws.run(fast)) == ["UNBALANCED"]


@pytest.mark.parametrize("friction", [1e5, 1e6])
@pytest.mark.parametrize("slip", [0.0, 0.5])
def test_books_beyond_what_is_declared_raise_the_declared_error(friction, slip):
    """For mu from 10 on e is linear in 1/mu: 1e3 and 1e4 give the limit to 1e-8."""
    scene = rod(45.0, slip=slip, friction=friction).scene
    result = Simulation().run(scene).check()
    e = [
        Simulation().run(rod(45.0, slip=slip, friction=mu).scene).normal_restitution
        for mu in (1e3, 1e4)
    ]
    limit = e[1] + (e[1] - e[0]) * (1e-4 - 1.0 / friction) / (1e-3 - 1e-4)
    assert abs(result.normal_restitution - limit) <= result.plan.restitution_error
    assert result.plan.restitution_error > abs(result.energy.relative_imbalance)
    told = f"the normal restitution: below {result.plan.restitution_error:.2g}"
    assert told in str(result.plan)
