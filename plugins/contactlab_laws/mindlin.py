"""A spring with a cap: the friction of LAMMPS, LIGGGHTS, YADE, Kratos and MFiX."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.contracts import (
    Increment,
    NormalContact,
    NormalMotion,
    TangentialResponse,
    WholeImpact,
    sliding,
)
from contactlab.impact.cautions import OUTSIDE
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import spread
from contactlab.numeric.checks import NON_NEGATIVE, POSITIVE, choice, quantity
from contactlab.numeric.types import Mask, Real
from contactlab_laws.one_spring import (
    InPlane,
    OneSpring,
    along,
    critical_share,
    cut,
    move_in_plane,
    with_dashpot,
)

FORMS = ("displacement", "displacement_rescaled", "increment", "increment_rescaled")

_NO_BOOK = "the energy books leave out what the changing stiffness adds or removes"
#: The checks that each form fails by its nature, with the factors 1 and 2/3.
FAILURES: Mapping[str, Mapping[str, str]] = {
    "displacement": {
        "normal_load_alone": "F = 2 G* b u: the force on a sheared contact grows with its radius",
        "random_paths": "energy in the spring grows with the radius, and is returned",
        "partial_unloading": "sheared, then pressed more, the stiffer spring returns more energy",
        "books": _NO_BOOK,
        "impact_bounds": "bodies may slip faster than they met, by up to 6.4 %",
        "impact_books": _NO_BOOK,
    },
    "displacement_rescaled": {
        "normal_load_alone": "F = 2 G* b u: the force on a sheared contact grows with its radius",
        "closed_cycles": "pressed before unloading, the spring returns more than it took",
        "random_paths": "energy in the spring grows with the radius, and is returned",
        "partial_unloading": "sheared, then pressed more, the stiffer spring returns more energy",
        "books": _NO_BOOK,
        "impact_books": _NO_BOOK,
    },
    "increment": {
        "partial_unloading": "sheared, then pressed less, the softer spring returns more energy",
        "books": _NO_BOOK,
        "impact_books": _NO_BOOK,
    },
    "increment_rescaled": {"books": _NO_BOOK, "impact_books": _NO_BOOK},
}
#: Checks that pass with a stiffness factor of 2/3: the law then does what it does with a factor of
#: 1 at two thirds of psi1 and chi, where the scenes of the check show no gain.
SOFTER = frozenset({"impact_bounds"})
#: Checks that pass with a dashpot of 0.2 and more, which absorbs the energy that the spring makes.
TAKEN = frozenset({"closed_cycles", "random_paths", "partial_unloading", "impact_bounds"})
PATH = (
    "model: one spring. Along random paths the force is off by up to 0.5 mu N, and load cycles at "
    "a held displacement change the force. springs do neither."
)
_MADE = "model: this spring can create energy. {}"
#: Cautions of the forms that make energy, with the size at any stiffness factor: between elastic
#: spheres, and under damped normal laws. Measured over 12,000 impacts a form, chi up to 300, and
#: 60,000 damped ones, chi up to 30, under the five normal laws that take a restitution.
ELASTIC = {
    "displacement": _MADE.format(
        "Bodies may leave with 6.4 % more slip velocity than they arrived with."
    ),
    "displacement_rescaled": _MADE.format("The gain is up to 7.5 % of the energy of slip."),
    "increment": _MADE.format(
        "Bodies may leave with 5.2 % more slip velocity than they arrived with."
    ),
}
#: Largest chi of these impacts, elastic and damped, and least restitution of the damped ones.
ELASTIC_CHI, DAMPED_CHI, LEAST_E = 300.0, 30.0, 0.5
_DAMPED = "Under damped normal laws of e = 0.5 the slip velocity may grow by up to {}."
DAMPED_GAIN = {
    "displacement": _MADE.format(_DAMPED.format("14 % (26 % for chi near 30)")),
    "displacement_rescaled": _MADE.format(_DAMPED.format("11 %")),
    "increment": _MADE.format(_DAMPED.format("15 %")),
}


class State(NamedTuple):
    """Twice G* in Pa, masses in kg, the friction coefficient, and the memory of the spring."""

    modulus: Real
    normal_mass: Real
    tangential_mass: Real
    friction_coefficient: Real
    held: Real  # displacement u in m, or force of the spring in N, by the form
    spring: Real  # force of the spring in N
    force: Real  # F in N


@attrs.frozen(kw_only=True)
class MindlinCap(OneSpring):
    """The stiffness of a contact that sticks all over, k = 2 G* b, under Coulomb's cap mu P.

    No part of the contact slips before the whole does. The energy that the changing
    stiffness makes or loses is in no energy book and shows as the imbalance of the books.

    Parameters
    ----------
    form : str
        ``"displacement"``: F = k u, u losing the excess over the cap on slip (LAMMPS
        ``mindlin``, LIGGGHTS); ``"displacement_rescaled"``: the same, u multiplied with b/b
        before while b shrinks (LAMMPS ``mindlin_rescale``); ``"increment"``: dF = k du, F cut to
        the cap (LAMMPS ``mindlin/force``, YADE); ``"increment_rescaled"``: the same, F
        multiplied with b/b before while b shrinks (LAMMPS ``mindlin_rescale/force``, Kratos).
    stiffness_factor : float
        k over 2 G* b, Mindlin's stiffness; 2/3 for k = (16/3) G b instead of 8 G b, with 1/G the
        sum of (2 - nu)/G of the bodies (Di Renzo & Di Maio 2005). LAMMPS, LIGGGHTS, YADE, Kratos
        and MFiX have 1.
    damping : float
        Constant of a dashpot beside the spring, over 2 sqrt(k M_n) with the stiffness k of the
        instant: sqrt(5/6) ln e/sqrt(ln² e + pi²) in size in LIGGGHTS. 0 for none.

    References
    ----------
    Mindlin, J. Appl. Mech. 16 (1949) 259-268, for the stiffness; Thornton, Cummins &
    Cleary, Powder Technol. 210 (2011) 189-197, doi:10.1016/j.powtec.2011.01.013, for the rescaled
    form; Di Renzo & Di Maio, Chem. Eng. Sci. 60 (2005) 1303-1312, doi:10.1016/j.ces.2004.10.004,
    for the factor 2/3.
    """

    api_version: ClassVar[int] = 2
    needs: ClassVar[frozenset[str]] = frozenset({"radius"})

    form: str = choice(*FORMS, default="displacement")
    stiffness_factor: float = quantity("1", rule=POSITIVE, default=1.0)
    damping: float = quantity("1", rule=NON_NEGATIVE, default=0.0)

    def _list_failures(self) -> Mapping[str, str]:
        """Return the checks that this form fails by its nature, with the path that shows it."""
        passed = TAKEN if self.damping else SOFTER if self.stiffness_factor < 1.0 else frozenset()
        failed = {name: why for name, why in FAILURES[self.form].items() if name not in passed}
        return {**failed, **super()._list_failures()}

    def cautions(self, scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
        """Return the cautions of every law, of partial slip, and of energy that the form makes."""
        elastic = "elastic_hertz" in normal.claims
        gains, most = (ELASTIC, ELASTIC_CHI) if elastic else (DAMPED_GAIN, DAMPED_CHI)
        made = [gains[self.form]] if self.form in gains else []
        least = LEAST_E * (1.0 - 1e-5) * scene.normal_speed
        if made and not np.all((scene.chi <= most) & (-normal.final_rate >= least)):
            made = [_MADE.format(f"by an amount {OUTSIDE}")]
        return (*super().cautions(scene, normal), *made)

    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return the whole-impact answers, with elastic impacts at the cap from start to end."""
        answers = super().whole_impacts(scene, normal)
        if "elastic_hertz" not in normal.claims or self.damping:
            return answers
        stiffer = self._stiffer(scene)
        where = self._slips_throughout(stiffer.psi1, stiffer.chi)
        reason = "the force is at Coulomb's cap from start to end"
        return (*answers, sliding(scene, normal, where=where, reason=reason, stops=False))

    def _stiffer(self, scene: Scene) -> Scene:
        """Return the scene in which the law with factor 1 does what this law does in ``scene``."""
        # The equations hold G* times the factor only: psi1 and chi grow as the factor.
        if self.stiffness_factor == 1.0:
            return scene
        modulus = self.stiffness_factor * scene.pair.effective_shear_modulus
        pair = attrs.evolve(scene.pair, effective_shear_modulus=modulus)
        friction, speed, slip = scene.friction_coefficient, scene.normal_speed, scene.slip_velocity
        return Scene(None, None, friction, speed, slip, pair=pair)

    def _slips_throughout(self, psi1: Real, chi: Real) -> Mask:
        """Return True where the force is at the cap from start to end."""
        # Gross slip goes on while the cap changes slower than the spring: in scaled variables while
        # psi >= r V, r = 2/3 in the displacement form (F = 1.5 b u, cap b³), 1 in the increment
        # form; if rescaled, in unloading 1/3 and 2/3.
        loading = 2.0 / 3.0 if self.form.startswith("displacement") else 1.0
        unloading = loading - (1.0 / 3.0 if self.form.endswith("rescaled") else 0.0)
        return np.abs(psi1) >= np.maximum(
            np.maximum(loading, 2.0 * np.asarray(chi)), 4.0 * np.asarray(chi) - unloading
        )

    def stiffness(self, scene: Scene, normal: NormalMotion) -> Real:
        """Return k of the largest contact in N/m."""
        return self._modulus(scene) * normal.maximum_radius

    def _modulus(self, scene: Scene) -> Real:
        """Return the stiffness per metre of contact radius, in Pa."""
        return self.stiffness_factor * scene.pair.tangential_stiffness(1.0)

    def path_cautions(self) -> tuple[str, ...]:
        """Return the caution of one spring for the whole contact."""
        return (PATH,)

    def start(self, scene: Scene, normal: NormalMotion) -> State:
        """Return a spring at rest."""
        zero = spread(0.0, scene.shape)
        pair = scene.pair
        masses = (pair.normal_mass, pair.tangential_mass)
        modulus = self._modulus(scene)
        return State(modulus, *masses, scene.friction_coefficient, zero, zero, zero)

    def advance(
        self,
        state: State | InPlane,
        increment: Increment,
        before: NormalContact,
        after: NormalContact,
    ) -> tuple[TangentialResponse, State | InPlane]:
        """Return the force after the step, and the work of the mean force on the slip."""
        if isinstance(state, InPlane):
            return move_in_plane(self, state, increment, before, after)
        stiffness: Real = state.modulus * after.radius
        cap = state.friction_coefficient * after.friction_load
        # x + (x == 0) divides without a branch and without a warning, one impact and many alike
        compliance = (stiffness > 0.0) / (stiffness + (stiffness == 0.0))
        kept, moved = state.held, increment.displacement
        rescaled = self.form.endswith("rescaled")
        if rescaled:
            shrinks, wide = after.radius < before.radius, before.radius + (before.radius == 0.0)
            kept = kept * np.where(shrinks, after.radius / wide, 1.0)
        if self.form.startswith("displacement"):
            if rescaled:  # u/b grows by the mean of 1/b times dD, b² changing evenly
                moved = moved * np.where(shrinks, 2.0 * after.radius / (wide + after.radius), 1.0)
            trial = kept + moved
            held = cut(trial, cap * compliance)
            spring, slip = stiffness * held, trial - held
        else:
            mean = state.modulus * _mean_radius(before.radius, after.radius)
            if rescaled:  # F/b grows by 2 G* dD: exact
                mean = np.where(shrinks, stiffness, mean)
            trial = kept + mean * moved
            spring = held = cut(trial, cap)
            slip = (trial - held) * ((mean > 0.0) / (mean + (mean == 0.0)))
        force, work = spring, 0.5 * along(spring + state.spring, slip)
        if self.damping:
            constant = critical_share(self.damping, stiffness, state.normal_mass)
            force = with_dashpot(spring, constant, increment, state.tangential_mass, cap)
            viscous = force - spring + state.force - state.spring
            work = work + 0.5 * along(viscous, increment.displacement)
        work = np.maximum(work, 0.0)
        if not np.shape(state.force):
            held, spring, force, work = float(held), float(spring), float(force), float(work)
        return TangentialResponse(force, work), state._replace(
            held=held, spring=spring, force=force
        )


def _mean_radius(before: Real, after: Real) -> Real:
    """Return the mean contact radius over a step in which its square changes evenly."""
    total = before + after
    squares = before * before + before * after + after * after
    return (2.0 / 3.0) * squares / (total + (total == 0.0))
