"""A spring of constant stiffness with Coulomb's cap."""

from __future__ import annotations

from typing import ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.contracts import (
    Increment,
    NormalContact,
    NormalMotion,
    TangentialResponse,
)
from contactlab.contracts.sampled_motion import SampledMotion
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import spread
from contactlab.numeric.checks import NON_NEGATIVE, POSITIVE, quantity
from contactlab.numeric.types import Real
from contactlab_laws.one_spring import (
    InPlane,
    OneSpring,
    along,
    critical_share,
    cut,
    move_in_plane,
    with_dashpot,
)

#: Bound of the imbalance of the energy books at the fewest steps admitted, where it is largest: it
#: falls as the square of the steps. A dashpot adds the share of a step in which the velocity
#: reverses.
COARSEST_BOOKS = 0.05

PATH = (
    "model: one spring, as stiff as an impact as deep as the path. Along random paths the "
    "force is off by up to 2 mu N."
)


class State(NamedTuple):
    """Stiffness (N/m), dashpot (N s/m), M_t (kg), mu; forces of spring and contact (N)."""

    stiffness: Real
    constant: Real
    tangential_mass: Real
    friction_coefficient: Real
    spring: Real
    force: Real


@attrs.frozen(kw_only=True)
class LinearSpring(OneSpring):
    """F = k_t u + c v_x within mu L: spring and dashpot, in series with a slider.

    The stiffness is the same from first touch to separation, k_t = ``stiffness_ratio`` times
    k_n = M_n v1²/z², the stiffness of the linear spring that is compressed as far as this
    contact, z (Di Renzo & Di Maio 2004). So the law needs no contact radius. Along a given path,
    which has no speed, k_n is 2 W/z², W the work of P up to the greatest approach: the same.

    Parameters
    ----------
    stiffness_ratio : float, optional
        k_t over k_n; kappa of the bodies, Mindlin's ratio, if not given.
    damping : float
        c over 2 sqrt(k_t M_n); 0 for no dashpot. Its work counts as friction work.

    References
    ----------
    Cundall & Strack, Géotechnique 29 (1979) 47-65, doi:10.1680/geot.1979.29.1.47; Di Renzo &
    Di Maio, Chem. Eng. Sci. 59 (2004) 525-541, doi:10.1016/j.ces.2003.09.037.
    """

    api_version: ClassVar[int] = 2

    stiffness_ratio: float | None = quantity("1", rule=POSITIVE, default=None)
    damping: float = quantity("1", rule=NON_NEGATIVE, default=0.0)

    def books_bound(self, scene: Scene) -> Real:
        """Return the bound at the fewest steps; without a dashpot the books close to rounding."""
        return COARSEST_BOOKS

    def stiffness(self, scene: Scene, normal: NormalMotion) -> Real:
        """Return k_t in N/m."""
        pair = scene.pair
        ratio = pair.stiffness_ratio if self.stiffness_ratio is None else self.stiffness_ratio
        if isinstance(normal, SampledMotion):  # a path has no speed; an impact: 2 W = M_n v1²
            deepest = normal.maximum_approach
            return 2.0 * ratio * normal.compression_work / (deepest * deepest)
        frequency = scene.normal_speed / normal.maximum_approach
        return ratio * pair.normal_mass * frequency * frequency

    def path_cautions(self) -> tuple[str, ...]:
        """Return the caution of one spring for the whole contact."""
        return (PATH,)

    def start(self, scene: Scene, normal: NormalMotion) -> State:
        """Return the spring at rest."""
        zero = spread(0.0, scene.shape)
        stiffness = self.stiffness(scene, normal)
        return State(
            stiffness,
            critical_share(self.damping, stiffness, scene.pair.normal_mass),
            scene.pair.tangential_mass,
            scene.friction_coefficient,
            zero,
            zero,
        )

    def advance(
        self,
        state: State | InPlane,
        increment: Increment,
        before: NormalContact,
        after: NormalContact,
    ) -> tuple[TangentialResponse, State | InPlane]:
        """Return the force, and the friction work: the work that the spring does not store."""
        if isinstance(state, InPlane):
            return move_in_plane(self, state, increment, before, after)
        limit = state.friction_coefficient * after.friction_load
        trial = state.spring + state.stiffness * increment.displacement
        spring = force = cut(trial, limit)
        # The mean of the forces before and after: as contact ends a spring lets go of all it holds.
        work = 0.5 * along(state.spring + spring, trial - spring) / state.stiffness
        if self.damping:
            force = with_dashpot(spring, state.constant, increment, state.tangential_mass, limit)
            viscous = force - spring + state.force - state.spring
            work = work + 0.5 * along(viscous, increment.displacement)
        work = np.maximum(work, 0.0)
        if not np.ndim(state.force):
            force, spring, work = float(force), float(spring), float(work)
        return TangentialResponse(force, work), state._replace(spring=spring, force=force)
