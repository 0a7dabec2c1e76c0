"""Impacts in which friction changes the approach: normal and tangential motion together (§14)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Self

import attrs
import numpy as np

from contactlab.contracts import faults, judges
from contactlab.contracts.law import Law, resolution_of
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.normal import NormalLaw
from contactlab.contracts.restitution import restitution_of
from contactlab.contracts.status import Status
from contactlab.contracts.tangential import Errors, TangentialLaw
from contactlab.contracts.tangential_motion import Observer
from contactlab.impact import kinetics
from contactlab.impact.cautions import OUTSIDE
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import every, spread
from contactlab.numeric.types import Array, Index, Real
from contactlab.outcome.history import Recorder
from contactlab.outcome.motion import Motion
from contactlab.outcome.plan import ENDLESS, MARCHED, Clause, PlanColumns
from contactlab.registry import stand_ins
from contactlab.registry.composition import Laws
from contactlab.solve.answers import Mask, check_motion, separates
from contactlab.solve.normal_motion import try_normal
from contactlab.solve.way import ONE_BY_ONE, WHOLE, Masks, Prepared, Way, ask, halves

#: Imbalance of the energy books that is no failure: where W is nearly singular the energy is the
#: small difference of large products. Beyond a law's own bound the declared errors grow instead.
CANCELS = 1e-4
#: Shares of W_nn that friction leaves, 1 - W_nt²/(W_nn W_tt), and the largest errors from each down
#: to a tenth of it, where abs(lam) > 1: of V2 over max(1, V2) and psi2 over max(1, psi1), in 1,200
#: random planar impacts by 50 springs and 200 steps.
NEAR_SINGULAR = ((0.1, 0.07), (0.01, 0.4), (0.001, 1.2))
#: Springs of gatherings that are solved at a time.
IN_CACHE = 25_000
#: Least slip about which cautions are asked, over the larger of two.
LITTLE = 1e-3
#: Statuses by which a law ends a whole batch: its impacts are then solved one by one.
GIVEN_UP = (Status.LAW_RAISED, Status.MALFORMED, Status.NON_FINITE)
#: Statuses of impacts that were not followed to an end although the law's answers were sound.
WITHOUT_END = (Status.NOT_SEPARATED, Status.TOO_FEW_STEPS, Status.UNRESOLVED)
#: Sentence of a plan on such impacts.
BOTH_MOTIONS = "normal and tangential motion together: {}"
OF_CONTACT = "restitution: set for a frictionless impact; that of the bodies follows from it"
OF_SPHERES = "sizes in cautions of laws: measured on spheres. For this body they are a rough guide."


class Coupled(Way):
    """Impacts whose approach friction changes, or whose slip turns."""

    __slots__ = ()

    both = as_integrator = True
    at_a_time = 1000  # their springs stay in the cache
    cancels = CANCELS

    @classmethod
    def of(cls, where: Index, scene: Scene, laws: Laws) -> Self:
        """Return the way of such impacts, under laws that have an answer to them."""
        return cls(where, scene, stand_ins.stand_in(laws, scene))

    def prepare(self, history: bool | str) -> Prepared:
        """Return the approach without friction and columns of the plan, or raise LawFaultError."""
        scene, laws = self.scene, self.laws
        if history and laws.capability.coupled is not None:
            self.refuse_history(history)
        normal = try_normal(laws, scene.central)
        try:
            bound = judges.books_bound_of(laws.tangential, normal.scene)
            return Prepared(normal, [], self._columns(normal), bound)
        except BaseException as error:
            faults.blame(laws.tangential, error)
            raise

    def _columns(self, normal: NormalMotion) -> PlanColumns:
        """Return the columns of the plan: who answers, and the declared errors."""
        scene, laws = self.scene, self.laws
        law = laws.capability.coupled if scene.links is None else None
        apart, known = separates(normal), MARCHED if law is None else 0
        many = isinstance(apart, np.ndarray)
        code = np.where(apart, known, ENDLESS) if many else known if apart else ENDLESS
        errors: object
        if normal._known == "nothing":  # without an approach there is nothing to ask
            errors = Errors()
        elif law is not None:
            errors = law.errors(scene, normal, np.inf, laws.capability.accuracy)
        elif scene.links is None:
            errors = laws.integrator.errors(scene, normal, laws.tangential)
        else:  # laws declare errors of one contact
            code, errors = np.full(scene.shape, MARCHED), Errors()
        psi2, rate, *_ = judges.judge_errors(laws.tangential, errors, scene.shape)
        psi2, rate = spread(psi2, scene.shape), spread(rate, scene.shape)
        return PlanColumns(code, psi2, () if law is None else (WHOLE,), rate)

    def solve(self, prepared: Prepared, recorder: Recorder | None) -> Motion:
        """Return the motion; impacts that fail within a batch are solved again alone."""
        scene, normal = self.scene, prepared.normal
        if normal._known == "nothing":
            return Motion.nothing(
                scene.shape, normal.status, normal.detail, axes=kinetics.slip_axes(scene)
            )
        motion = self._end_as_alone(self._answer(normal, recorder), normal)
        if recorder is None and kinetics.batch_of(scene) not in ((), (1,)):
            return self._apart(motion)
        return motion

    def _answer(self, normal: NormalMotion, observer: Observer | None) -> Motion:
        """Return the motion that law or integrator answers, or raise LawFaultError."""
        scene, able = self.scene, self.laws.capability
        law = able.coupled if scene.links is None else None
        blamed: Law = self.laws.integrator if law is None else law
        try:
            if law is not None:
                answer = law.solve_coupled(scene, normal, able.accuracy, observer)
            else:  # other laws have stand-ins
                assert able.marcher is not None
                assert able.causal is not None
                answer = able.marcher.integrate_coupled(scene, normal, able.causal, observer)
                if scene.links is not None and answer.contacts is None:
                    told = "the answer is that of each contact alone, and not of the gathering"
                    raise faults.LawFaultError(Status.MALFORMED, faults.sentence(blamed, told, 1))
            axes = kinetics.slip_axes(scene)
            moved = check_motion(answer, scene.shape, axes)
            if moved.normal is None and np.any(np.asarray(moved.status) == Status.SUCCESS):
                told = "the answer has not the ends of its normal motion"
                raise faults.LawFaultError(Status.MALFORMED, faults.sentence(blamed, told, 1))
            return Motion.combine(normal, moved, axes)
        except BaseException as error:
            faults.blame(blamed, error)
            raise

    def _end_as_alone(self, motion: Motion, normal: NormalMotion) -> Motion:
        """Return a motion whose impacts without an end have the status of the approach alone."""
        ended = separates(normal)
        if every(ended):
            return motion
        lost = np.isin(np.asarray(motion.status, dtype=object), np.array(WITHOUT_END, dtype=object))
        where = np.logical_not(ended) & lost
        if not self.scene.shape:
            same = attrs.evolve(motion, status=normal.status, detail=normal.detail)
            return same if where else motion
        status = np.where(where, normal.status, motion.status)
        detail = np.where(where, normal.detail, motion.detail)
        return attrs.evolve(motion, status=status, detail=detail)

    def _apart(self, motion: Motion) -> Motion:
        """Return the motion of a batch with the impacts that one beside them made fail."""
        statuses = np.asarray(motion.status, dtype=object)
        again = np.isin(statuses, np.array(GIVEN_UP, dtype=object))
        if not again.any():
            return motion
        part = self.taking(again if self.scene.links is None else again.any(axis=-1))
        size, shape = part.scene.shape[0], self.scene.shape
        if size == shape[0]:
            _, repeated = part.solve_parts(halves(size, most=ONE_BY_ONE))
        else:
            _, repeated = part.outcome(False, None)
        return Motion.merge([(np.ones(shape, dtype=bool), motion), (again, repeated)], shape)

    def line(self, scene: Scene) -> Array:
        """Return the first tangent, along which slip has either sign."""
        return np.array([1.0, 0.0])

    @property
    def scene_of_cautions(self) -> Scene:
        """The central impacts at the larger slip: at first touch, or as pressure alone leaves it.

        Sizes of cautions grow with the slip, and pressure makes slip where there is none at first.
        """
        return self._at_slip(np.maximum(*self._slips()))

    @property
    def _gripping(self) -> Scene:
        """The central impacts at the smaller slip, but no less than a little of the larger.

        Some cautions hold only for contacts that grip.
        """
        slips = self._slips()
        return self._at_slip(np.maximum(np.minimum(*slips), LITTLE * np.maximum(*slips)))

    def _slips(self) -> tuple[Real, Real]:
        """Return the slip speed at first touch, and the slip speed that pressure alone leaves."""
        scene = self.scene
        drag = kinetics.coupling(scene, 2.0 * np.asarray(scene.normal_speed))
        return kinetics.slip_speed(scene), kinetics.size_of(
            scene, np.asarray(scene.slip_velocity) - drag
        )

    def _at_slip(self, slip: Real) -> Scene:
        """Return the central impacts at a slip speed."""
        scene = self.scene
        slip = spread(slip, scene.shape)
        return attrs.evolve(scene.central, tangential_velocity=slip).with_index(scene.index)

    def most_at_a_time(self) -> float:
        """Return how many impacts, or gatherings, have springs that stay in the cache."""
        if self.scene.links is None:
            return self.at_a_time
        law = self.laws.tangential
        springs = 1 if law.resolution is None else resolution_of(law) or 1
        return max(1.0, IN_CACHE // (self.scene.shape[-1] * max(springs, 1)))

    def how(self) -> str:
        """Return words on how the normal motion is found."""
        return "with the tangential motion"

    def one_by_one(self, masks: Masks) -> Mask:
        """Return the impacts that a law takes one by one, if it does."""
        return masks.ended

    def remarks(self, masks: Masks) -> list[Clause]:
        """Return words on both motions together, and on the meaning of the restitution."""
        affected = bool(np.any(self.scene.lam))
        why = "friction affects the approach" if affected else "the slip changes its direction"
        said = [BOTH_MOTIONS.format(why)]
        e = restitution_of(self.laws.normal)
        if e is not None and np.any(e != 1.0):
            said.append(OF_CONTACT)
        return [Clause(text, masks.known) for text in said]

    def errors(self, columns: PlanColumns) -> Mapping[str, Real]:
        """Return the errors of psi2 and of the restitution."""
        return {"psi2": columns.psi2_error, "the normal restitution": columns.restitution_error}

    def motion_of_cautions(self, motion: Motion | None) -> None:
        """Return None: friction changed the normal motion of the run."""

    def cautions_of_laws(self, scene: Scene, normal: NormalMotion, known: Mask) -> list[str]:
        """Return the cautions of the laws, at the smaller slip too where shear shares the loss."""
        said, law = super().cautions_of_laws(scene, normal, known), self.laws.tangential
        if self.laws.capability.shares_loss:
            grip = self._gripping if every(known) else self._gripping.take(known)
            usual = TangentialLaw.cautions(law, grip, normal)
            said += [text for text in ask(law, law.cautions, grip, normal) if text not in usual]
        return said

    def cautions_of_contact(self, scene: Scene, normal: NormalMotion) -> list[str]:
        """Return the cautions of yield and of a large contact, which hold for any bodies."""
        return list(NormalLaw.cautions(self.laws.normal, scene, normal))

    def own_cautions(self, of_laws: bool) -> list[str]:
        """Return a sentence for each doubt about coupled impacts alone."""
        scene, able = self.scene, self.laws.capability
        said = [OF_SPHERES] if of_laws else []
        if not scene.planar and "partial_slip" in able.tangential_claims:
            said.append(
                "model: where the slip turns, each spring is limited separately, and not the "
                "traction at every point. psi2 is off by up to 0.1, mostly by less than 0.01."
            )
        return said + _near_singular(scene) if able.coupled is None else said


def _near_singular(scene: Scene) -> list[str]:
    """Return a caution where steps lose accuracy: friction can jam, and W is nearly singular."""
    jams = kinetics.size_of(scene, np.asarray(scene.lam)) > 1.0
    least = float(np.min(kinetics.free_share(scene), where=jams, initial=1.0))
    if least > NEAR_SINGULAR[0][0]:
        return []
    sizes = [f"by up to {error:g}" for share, error in NEAR_SINGULAR if least > share / 10.0]
    known = sizes[0] if sizes else f"by an amount {OUTSIDE}"
    return [
        f"numerical error: friction can jam, and W is nearly singular ({least:.2g}). Here 50 "
        f"springs in 200 steps were off {known}; in the plane fronts is exact."
    ]
