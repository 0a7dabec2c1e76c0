"""One spring with a cap: what most discrete-element codes take for friction."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.checks import Mask, Real, choice
from contactlab.contracts import (
    Increment,
    NormalContact,
    NormalMotion,
    SteppedTangentialLaw,
    TangentialResponse,
    WholeImpact,
    sliding,
)
from contactlab.declared import ErrorModel
from contactlab.scene import Scene

FORMS = ("displacement", "increment", "increment_rescaled")

_NO_BOOK = "what the changing stiffness makes or loses is in no book"
#: The checks that each form fails by its nature.
FAILURES: Mapping[str, Mapping[str, str]] = {
    "displacement": {
        "normal_load_alone": "F = 2 G* b u: the force on a sheared contact grows with its radius",
        "random_paths": "energy in the spring grows with the radius, and is given back",
        "partial_unloading": "sheared and then pressed more, the stiffer spring gives more back",
        "books": _NO_BOOK,
        "impact_bounds": "light bodies come out faster than they came in, by up to 5 %",
        "impact_books": _NO_BOOK,
    },
    "increment": {
        "last_step": "the force is kept as the spring softens: letting go, it has far to slip",
        "partial_unloading": "sheared and then pressed less, the softer spring gives more back",
        "books": _NO_BOOK,
        "impact_books": _NO_BOOK,
    },
    "increment_rescaled": {"books": _NO_BOOK, "impact_books": _NO_BOOK},
}

#: Measured over 100 runs of 29 impacts against the law's own limit, see ``ErrorModel``.
ERRORS = ErrorModel(
    chi=(0.05, 0.229, 0.491, 1.05, 1.44, 2.26, 3, 4.83, 10.3, 47.5, 102, 218, 467, 1e+03),
    steps=(0.7, 1.9, 4.2, 9.8, 6.8, 32, 28, 55, 85, 1e+03, 3.1e+03, 9.5e+03, 2.9e+04, 7.7e+04),
)  # fmt: skip


class State(NamedTuple):
    """Twice G* in Pa, the friction coefficient, and what the spring remembers."""

    modulus: Real
    friction_coefficient: Real
    held: Real  # displacement u in m, or force F in N, by the form
    force: Real  # F in N


@attrs.frozen(kw_only=True)
class MindlinCap(SteppedTangentialLaw):
    """The stiffness of a contact that sticks all over, 2 G* b, under Coulomb's cap mu P.

    No part of the contact slips before the whole does. The energy that the changing
    stiffness makes or loses is in nobody's books and shows as their imbalance.

    Parameters
    ----------
    form : str
        ``"displacement"``: F = 2 G* b u, u losing the excess over the cap on slip;
        ``"increment"``: dF = 2 G* b du, F cut to the cap;
        ``"increment_rescaled"``: the same, F multiplied with b/b before while b shrinks.

    References
    ----------
    Mindlin, J. Appl. Mech. 16 (1949) 259-268, for the stiffness; Thornton, Cummins &
    Cleary, Powder Technol. 210 (2011) 189-197, for the rescaled form.
    """

    api_version: ClassVar[int] = 2
    needs: ClassVar[frozenset[str]] = frozenset({"radius"})

    form: str = choice(*FORMS, default="displacement")

    @property
    def expected_failures(self) -> Mapping[str, str]:
        """Return what its form fails: each is found out by another path."""
        return FAILURES[self.form]

    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return elastic impacts at the cap from start to end too."""
        known = super().whole_impacts(scene, normal)
        if "elastic_hertz" not in normal.offers:
            return known
        where = self._slips_throughout(scene.psi1, scene.chi)
        reason = "the force is at Coulomb's cap from start to end"
        return (*known, sliding(scene, normal, where=where, reason=reason, stops=False))

    def _slips_throughout(self, psi1: Real, chi: Real) -> Mask:
        """Return True where the force is at the cap from start to end.

        Gross slip goes on while the cap changes slower than the spring: in scaled variables
        while psi >= r V, r = 2/3 in the displacement form (F = 1.5 b u, cap b³), 1 in the
        increment form, 1 in loading and 2/3 in unloading if rescaled.
        """
        loading = 2.0 / 3.0 if self.form == "displacement" else 1.0
        unloading = 1.0 if self.form == "increment" else 2.0 / 3.0
        return np.abs(psi1) >= np.maximum(
            np.maximum(loading, 2.0 * np.asarray(chi)), 4.0 * np.asarray(chi) - unloading
        )

    def psi2_error(self, scene: Scene, normal: NormalMotion, steps: Any) -> Real:
        """Return what was measured over elastic Hertz contacts; of others nothing is declared."""
        if "elastic_hertz" not in normal.offers:
            return math.nan
        return ERRORS.psi2_error(scene, steps)

    def stiffness(self, scene: Scene, normal: NormalMotion) -> Real:
        """Return 2 G* a, of the largest contact."""
        return 2.0 * scene.pair.effective_shear_modulus * normal.maximum_radius

    def start(self, scene: Scene, normal: NormalMotion) -> State:
        """Return a spring at rest."""
        nothing: Real = np.zeros(scene.shape) if scene.shape else 0.0
        modulus = 2.0 * scene.pair.effective_shear_modulus
        return State(modulus, scene.friction_coefficient, nothing, nothing)

    def advance(
        self, state: State, increment: Increment, before: NormalContact, after: NormalContact
    ) -> tuple[TangentialResponse, State]:
        """Return the force after the step, and the work of the mean force on the slip."""
        stiffness: Any = state.modulus * after.radius
        cap = state.friction_coefficient * after.friction_load
        compliance = (stiffness > 0.0) / (stiffness + (stiffness == 0.0))
        if self.form == "displacement":
            trial = state.held + increment.displacement
            held = _cut(trial, cap * compliance)
            force, slip = stiffness * held, trial - held
        else:
            shrunk: Any = 1.0
            mean = state.modulus * _mean_radius(before.radius, after.radius)
            if self.form == "increment_rescaled":
                wide = before.radius + (before.radius == 0.0)
                shrinks = after.radius < before.radius
                shrunk = np.where(shrinks, after.radius / wide, 1.0)
                mean = np.where(shrinks, stiffness, mean)  # F/b grows by 2 G* dD: exact
            trial = state.held * shrunk + mean * increment.displacement
            force = held = _cut(trial, cap)
            slip = (trial - held) * compliance
        work = np.maximum(0.5 * (force + state.force) * slip, 0.0)
        shape = np.shape(state.force)
        if not shape:
            force, held, work = float(force), float(held), float(work)
        return TangentialResponse(force, work), State(*state[:2], held, force)


def _mean_radius(before: Any, after: Any) -> Any:
    """Return the mean contact radius over a step in which its square changes evenly."""
    total = before + after
    squares = before * before + before * after + after * after
    return (2.0 / 3.0) * squares / (total + (total == 0.0))


def _cut(value: Real, limit: Real) -> Any:
    return np.minimum(np.maximum(value, -limit), limit)
