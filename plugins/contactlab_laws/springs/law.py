"""A bundle of springs: partial slip without a matrix."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import attrs
from numpy.typing import NDArray

from contactlab.contracts import (
    AllStepsResponse,
    CausalTangentialLaw,
    Errors,
    Increment,
    Law,
    NormalContact,
    NormalMotion,
    Resolutions,
    ResolvingTangentialLaw,
    Steps,
    TangentialLaw,
    TangentialResponse,
    WholeImpact,
    number_in,
    resolution_of,
    shares_loss,
    sliding,
    unfollowed_rate,
)
from contactlab.impact import kinetics
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import Rule, choice, count, flag, quantity, refuse
from contactlab.numeric.types import Real
from contactlab_laws.compiled import library, tell
from contactlab_laws.differences import table as differences
from contactlab_laws.jaeger.law import ProfileLaw, State
from contactlab_laws.jaeger.partial_slip import Scales
from contactlab_laws.springs import compiled, doubling, errors, viscous

#: The word that springs without a loss in shear do not offer.
NO_LOSS = frozenset({"shares_loss"})
#: Caution of too few springs beside a loss.
NOISE = (
    "springs = {} with a loss in shear are noise where the contact grips: a rounding of the speed "
    "moves psi2 by up to 0.6; take {} or more"
)
#: The rule of the loss in shear; the largest measured is that of golf balls, about 4.
SHEAR_LOSS = Rule(lambda value: (value >= 0.0) & (value <= 8.0), "must be one number from 0 to 8")


@attrs.frozen(kw_only=True)
class Springs(ProfileLaw, CausalTangentialLaw, ResolvingTangentialLaw):
    """Mindlin's partial slip as a bundle of independent springs.

    The spring at distance r from the centre touches while r < b. Its displacement w grows with
    the slip displacement D, and is held at the limit l = 3 mu P/(4 G* b³) (b² - r²) where it
    would go beyond: w <- clip(w + f D, -l, l). A spring that the growing contact meets within a
    step moves for the part f of it only. The force is 2 G* times the integral of w over r.
    Nothing is solved and nothing is searched, and the error falls as the square of springs and
    steps.

    Parameters
    ----------
    springs : int, optional
        Springs along the radius of the largest contact. With four steps to a spring the two
        errors are about equal at 100 steps; 12 springs and 80 steps leave 4e-4 in psi2
        at chi = 1.44, 3e-3 at chi = 3. Even with ``grid="doubling"``. Where nobody names springs
        nor steps, both grow with chi + abs(eta), so that psi2 is off by 2.1e-3 at most up to 1,000,
        if the march is compiled; else they are 50 and 200.
    grid : str
        What the springs span: the ``"largest"`` contact of the impact, or ``"doubling"``, a power
        of two times the radius of the pair that follows the contact as it grows and shrinks
        (theory §13). A doubling grid takes nothing from the normal motion to come, and serves
        where nobody knows this motion, as in discrete-element codes. Between a quarter of its
        springs and all of them carry the contact; it is marched step by step.
    shear_loss : float
        Relaxation time in shear over that in pressure, under a viscous normal law: 1, the
        default, is the theory of one loss for both (theory §15); 0 is shear without loss. Other
        numbers are for fits. Normal laws that are not viscous have no loss in shear.
    table : bool, optional
        Take psi2 and the loss in shear from the table of restitutions where it is there: under
        ``normal.viscoelastic`` with a restitution, chi 0.3 to 3. By default it does unless springs
        are named, or another grid or loss in shear. Impacts with a history are marched. Below a
        restitution of 0.01 psi2 is always that of ``contactlab.rebound``.

    References
    ----------
    Jaeger, Arch. Appl. Mech. 65 (1995) 478-487; Popov & Hess, Method of Dimensionality
    Reduction in Contact Mechanics and Friction (2015), ch. 5. The limit of Maw, Barber &
    Fawcett's annuli, Wear 38 (1976) 101-114, as their number grows.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = ProfileLaw.offers | {"vectors", "shares_loss"}
    resolution: ClassVar[str | None] = "springs"

    springs: int | None = count(default=None, usual=50, most=100_000)
    grid: str = choice("largest", "doubling", default="largest")
    shear_loss: float = quantity("1", rule=SHEAR_LOSS, default=1.0)
    table: bool | None = flag(default=None)

    def __attrs_post_init__(self) -> None:
        if self.grid == "doubling" and self.number % 2:
            rule = 'must be even with grid = "doubling", which merges springs in pairs'
            raise refuse("springs", self.springs, rule, f"take {self.number + 1}")

    def waives(self) -> frozenset[str]:
        """Return the word of a shared loss if these springs lose nothing in shear."""
        return super().waives() if self.shear_loss else NO_LOSS

    def resolutions(self, scene: Scene, normal: Law, integrator: Law) -> Resolutions | None:
        """Return springs and steps by chi + abs(eta), where the march is compiled."""
        alone = None if scene.inverse_mass is None else normal  # known motions are of any law
        if self.grid == "doubling" or not compiled.knows(self, alone, integrator):
            return None
        usual = float(resolution_of(self)), float(resolution_of(integrator))
        if library() is None:
            return Resolutions(*usual, f"the usual, as the march is not compiled, {tell()}")
        if scene.links is not None:  # its error was not measured over chi
            return Resolutions(*usual, "the usual, in a compiled march")
        return Resolutions(*errors.resolve(scene), "by chi + abs(eta), in a compiled march")

    def books_bound(self, scene: Scene) -> Real:
        """Return 0.05 + 0.03/n: the fewest steps leave 0.03, one spring 0.02 whatever the steps.

        Both fall as the squares of steps and springs; with 50 and 200 it is 1e-4.
        """
        return 0.05 + 0.03 / self.number

    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return the whole-impact answers, with those of gross slip throughout."""
        known = super().whole_impacts(scene, normal)
        if not shares_loss(self, normal.law) or self.shear_loss != 1.0:
            return known
        # A spring slips on while psi exceeds w' = (l - w)/A: the rate of approach if bodies of
        # Kelvin and Voigt part, less than nothing in unloading under any law.
        friction: Real = scene.friction_coefficient * normal.total_load_impulse
        reduced: Real = abs(scene.slip_velocity) - friction / scene.pair.tangential_mass
        least: Real = 0.0
        if "kelvin_voigt" in normal.claims:
            least = normal.final_rate * scene.friction_coefficient / scene.pair.stiffness_ratio
        where = (abs(scene.psi1) >= 1.0) & (reduced >= least)
        if scene.shape or where:
            reason = "the impact slips from start to end"
            known = (*known, sliding(scene, normal, where=where, reason=reason, stops=False))
        return (*known, *self._look_up(scene, normal))

    def _look_up(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return the answer of ``rebound``, where it is asked for or no step can follow."""
        if "kelvin_voigt" not in normal.claims:
            return ()
        rate = unfollowed_rate(normal.law, scene)
        e = None if rate is None else -rate / scene.normal_speed
        if rate is None and getattr(normal.law, "restitution", None) is not None:
            e = number_in(normal.law, "restitution", scene)
        named = self.springs is not None or self.grid != "largest" or self.shear_loss != 1.0
        wanted = self.table or (self.table is None and not named)
        if e is None or (rate is None and not wanted):
            return ()
        from contactlab_laws.viscoelastic import whole_impacts  # only here is the table needed

        return whole_impacts.look_up(scene, e, beyond=rate is not None)

    def errors(
        self, scene: Scene, normal: NormalMotion, steps: Real, accuracy: float | None = None
    ) -> Errors:
        """Return the errors under Hertz's law, or with a wholly shared loss; else NaN."""
        shared = shares_loss(self, normal.law)
        if shared:
            measured = self.shear_loss == 1.0 and self.number >= errors.LEAST_MEASURED
        else:
            measured = "elastic_hertz" in normal.claims
        if not measured:
            return Errors()
        if scene.inverse_mass is not None:
            found = errors.of_bodies(scene, self.even_springs(), steps, shared=shared)
        else:
            restitution = None
            if shared and "kelvin_voigt" in normal.claims:
                restitution = -normal.final_rate / scene.normal_speed
            doubling = self.grid == "doubling"
            found = errors.of_spheres(
                scene, self.number, steps, shared=shared, doubling=doubling, restitution=restitution
            )
        return errors.where_measured(found, scene, normal) if shared else found

    def cautions(self, scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
        """Return the cautions of springs, or those of their shared loss."""
        if not shares_loss(self, normal.law):
            return super().cautions(scene, normal)
        from contactlab_laws.viscoelastic import evidence  # springs without loss need none of it

        fitted = self.shear_loss != 1.0
        own = evidence.cautions(scene, normal, fitted=fitted)
        own = (*differences.choice(scene, normal, shared=True), *own)
        if self.number < errors.LEAST_MEASURED and kinetics.rubs(scene):
            own = (NOISE.format(self.number, errors.LEAST_MEASURED), *own)
        return (*TangentialLaw.cautions(self, scene, normal), *own)

    def stiffness(self, scene: Scene, normal: NormalMotion) -> Real:
        """Return 2 G* a, and half a spring more on a doubling grid, whose cells are not a's."""
        half = 2.0 / self.number if self.grid == "doubling" else 0.0  # over a > A/4
        return super().stiffness(scene, normal) * (1.0 + half)

    def start(self, scene: Scene, normal: NormalMotion) -> Any:
        """Return contacts without traction."""
        if shares_loss(self, normal.law):
            follows = self.grid == "doubling"
            unit = scene.pair.radius if follows else normal.maximum_radius
            return self._viscous(
                scene, normal, unit, spanned=None if follows else 1.0, grows=follows
            )
        if self.grid == "doubling":
            return doubling.start(scene, self.number)
        return super().start(scene, normal)

    def begin(
        self, scene: Scene, normal: NormalMotion, *, vectors: bool = False
    ) -> doubling.State | viscous.State:
        """Return springs that span the approach without friction, and double if outgrown.

        With ``vectors`` the displacements turn with the slip.
        """
        spanned = normal.maximum_radius
        if shares_loss(self, normal.law):
            return self._viscous(
                scene, normal, spanned, spanned=doubling.SPARE, grows=True, vectors=vectors
            )
        return doubling.start(scene, self.even_springs(), spanned=spanned, vectors=vectors)

    def _viscous(
        self,
        scene: Scene,
        normal: NormalMotion,
        unit: Real,
        *,
        spanned: float | None,
        grows: bool,
        vectors: bool = False,
    ) -> viscous.State:
        """Return springs that share the loss of the normal law, lengths in units of ``unit``."""
        law: Any = normal.law
        springs = self.even_springs() if grows else self.number
        return viscous.start(
            scene,
            law,
            springs,
            unit,
            shear_loss=self.shear_loss,
            spanned=spanned,
            grows=grows,
            vectors=vectors,
        )

    def even_springs(self) -> int:
        """Return the number of springs, one more if odd: a doubling grid merges pairs."""
        return self.number + self.number % 2

    def advance(
        self,
        state: State | doubling.State | viscous.State,
        increment: Increment,
        before: NormalContact,
        after: NormalContact,
    ) -> tuple[TangentialResponse, Any]:
        """Return the force after the step."""
        if isinstance(state, viscous.State):
            return viscous.advance(state, increment, after)
        if isinstance(state, doubling.State):
            return doubling.advance(state, increment, after)
        return super().advance(state, increment, before, after)

    def advance_all(
        self, scene: Scene, normal: NormalMotion, steps: Steps
    ) -> AllStepsResponse | None:
        """Return the forces of all steps; None where springs go step by step."""
        if self.grid == "doubling":
            return None
        shared = shares_loss(self, normal.law)
        if type(self) is not Springs or library() is None:  # another may differ in its steps
            return None if shared else super().advance_all(scene, normal, steps)
        if shared:
            state = self.start(scene, normal)
            path = compiled.path_of(state, scene, steps)
            return compiled.advance_all(self.number, scene, state.scales, path)
        scales = Scales.of(scene, normal)
        path = compiled.path_without_loss(scales, steps)
        return compiled.advance_all(self.number, scene, scales, path)

    def fields(self, state: State | doubling.State | viscous.State) -> Mapping[str, NDArray[Any]]:
        """Return radius, displacement and limit (m), stuck and slipping of every spring."""
        if isinstance(state, viscous.State):
            return viscous.fields(state)
        if isinstance(state, doubling.State):
            return doubling.fields(state)
        return super().fields(state)
