"""Impacts of spheres: the normal motion comes first, then slip along a line."""

from __future__ import annotations

import math
from collections import Counter
from typing import Any

import numpy as np

from contactlab.contracts import faults, judges
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.sampled_motion import Ends
from contactlab.contracts.status import Status, succeeded
from contactlab.contracts.tangential_motion import Observer, TangentialMotion
from contactlab.contracts.whole_impact import WholeImpact
from contactlab.impact.error_model import psi_magnitude
from contactlab.impact.inverse_mass import unit_slip
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import are_zeros, every, plain, some, spread, zeros
from contactlab.numeric.types import Array, Index, Mask, Places, Real
from contactlab.outcome.history import Recorder
from contactlab.outcome.motion import Motion
from contactlab.outcome.plan import ENDLESS, MARCHED, PlanColumns, Reason
from contactlab.solve.answers import Answered, answers, check_motion, separates, show
from contactlab.solve.normal_motion import try_normal
from contactlab.solve.way import ONE_BY_ONE, Prepared, Way, halves

#: Error of a closed form, over max(1, |psi1|).
CLOSED_FORM = 1e-12
#: Statuses of a law's fault with which an integrator ends a whole batch.
GIVEN_UP = (Status.LAW_RAISED, Status.MALFORMED, Status.NON_FINITE, Status.UNSETTLED)
#: Entries that few answers have; the others have 0.
SELDOM = ("shear_loss", "normal_spin_change")
#: Relative difference of errors that counts as none.
ROUNDING = 1e-12


class Decoupled(Way):
    """Impacts that friction slows along a line without a change of the approach."""

    __slots__ = ()

    both = as_integrator = False
    at_a_time = math.inf
    cancels = 0.0

    @property
    def scene_of_cautions(self) -> Scene:
        """The impacts themselves."""
        return self.scene

    def how(self) -> str:
        """Return words on how the normal motion is found."""
        if self.laws.capability.closed is not None:
            return "in closed form"
        law = self.laws.capability.unfollowed
        if law is not None and law.unfollowed_rate(self.scene) is not None:
            return "by its rebound alone, as no step can follow it"
        return "integrated from first touch to separation"

    def prepare(self, history: bool | str) -> Prepared:
        """Return normal motion, answers and columns of the plan, or raise LawFaultError."""
        scene, laws = self.scene, self.laws
        normal = try_normal(laws, scene)
        try:
            size, accuracy = psi_magnitude(scene), laws.capability.accuracy
            most = math.inf if accuracy is None else accuracy * (1.0 + ROUNDING) * size
            always = laws.capability.whole is not None
            law = (laws.asked or laws).tangential  # whole impacts need no resolution
            answered = answers(normal, law, always=always, history=history, largest_error=most)
            bound = judges.books_bound_of(laws.tangential, scene)
            return Prepared(normal, answered, self._columns(normal, answered, size), bound)
        except BaseException as error:
            faults.blame(laws.tangential, error)
            raise

    def solve(self, prepared: Prepared, recorder: Recorder | None) -> Motion:
        """Return the motion by whole-impact answers where there are any, else marched."""
        normal, answered, columns, _ = prepared
        if answered and recorder is None and not normal.scene.shape:
            return Motion.combine(normal, answered[0].answer)
        marched = columns.code == MARCHED
        return Motion.combine(normal, self._tangential(normal, answered, marched, recorder))

    def line(self, scene: Scene) -> Array:
        """Return the direction of slip at first touch, which slip keeps."""
        return unit_slip(scene.slip_velocity)  # type: ignore[arg-type]  # vectors in space

    def _columns(self, normal: NormalMotion, answered: list[Answered], size: Real) -> PlanColumns:
        """Return the columns of the plan: why impacts are not marched, and the declared error.

        Errors are relative to ``size``, that of psi.
        """
        shape = normal.scene.shape
        if not shape and answered:  # one impact has one answer
            answer = answered[0].answer
            reason = Reason(answer.reason, answer.balanced, answer.fields is not None)
            known = CLOSED_FORM + 2.0 * normal.accuracy if answer.normal is None else math.nan
            return PlanColumns(0, self._error(normal, answered, False, size), (reason,), known)
        if not shape:
            code: int | Places = MARCHED if separates(normal) else ENDLESS
            marched: Mask = code == MARCHED
        else:
            code = np.where(separates(normal), MARCHED, ENDLESS)
            for place, one in enumerate(answered):
                code[one.where] = place
            marched = code == MARCHED
        reasons = tuple(
            Reason(each.reason, each.balanced, each.fields is not None) for _, each in answered
        )
        # the load impulse of a frictionless impact is M_n v1 (1 + e), at most twice M_n v1
        restitution: Real = CLOSED_FORM + 2.0 * normal.accuracy
        for each in answered:
            if each.answer.normal is not None:
                restitution = math.nan  # the law changed it, without a declared error
        if shape:
            restitution = np.full(shape, restitution)
        return PlanColumns(code, self._error(normal, answered, marched, size), reasons, restitution)

    def _error(
        self, normal: NormalMotion, answered: list[Answered], marched: Mask, size: Real
    ) -> Real:
        """Return the declared error of psi2: of one impact a float, of a batch an array."""
        scene = normal.scene
        rounding = CLOSED_FORM * size + normal.accuracy * 4.0 * scene.chi
        if not (scene.shape or marched):
            return float(rounding + answered[0].answer.psi2_error if answered else rounding)
        if not scene.shape:
            return plain(self._declare(normal))
        error = spread(rounding, scene.shape)
        for one in answered:
            error = error + np.where(one.where, one.answer.psi2_error, 0.0)
        return plain(np.where(marched, self._declare(normal), error) if some(marched) else error)

    def _declare(self, normal: NormalMotion) -> Real:
        """Return the error of psi2 that the integrator declares of marched impacts."""
        if normal._known == "ends" or math.isnan(normal.accuracy):
            return math.nan  # no better than a motion of unknown error, or without a course
        laws, scene = self.laws, normal.scene
        with np.errstate(all="ignore"):
            errors = laws.integrator.errors(scene, normal, laws.tangential)
        return judges.judge_errors(laws.tangential, errors, scene.shape).psi2

    def _tangential(
        self,
        normal: NormalMotion,
        answered: list[Answered],
        marched: Mask,
        recorder: Recorder | None,
    ) -> TangentialMotion | WholeImpact:
        """Return the tangential motion by answers where there are any, else marched."""
        shape = normal.scene.shape
        if every(marched):
            return self._march(normal, recorder)
        if recorder is not None and not some(marched):
            show(normal, answered, recorder)
        if not shape:
            if not answered:
                return TangentialMotion.nothing((), normal.status, normal.detail)
            return answered[0].answer
        motion = _join_answers(normal, answered)
        if not some(marched):
            return motion
        parts = [(np.ones(shape, dtype=bool), motion), (marched, self._march(normal.take(marched)))]
        return TangentialMotion.merge(parts, shape)

    def _march(self, normal: NormalMotion, observer: Observer | None = None) -> TangentialMotion:
        """Return the tangential motion; in a batch only the impacts that fail have no answer."""
        # With an observer, failures are not isolated: the observer would be called again.

        def part(index: Index) -> TangentialMotion:
            return self._march(normal.take(index))

        laws, shape = self.laws, normal.scene.shape
        if shape == (1,) and observer is None:  # one impact is faster as plain numbers
            return TangentialMotion.join([part(0)], shape)
        try:
            with np.errstate(under="ignore"):  # harmless, even where a user has numpy raise
                given = laws.integrator.integrate(normal.scene, normal, laws.tangential, observer)
            motion = check_motion(given, shape)
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # a plug-in may not end the process
            sentence = faults.sentence(laws.integrator, faults.tell_error(error), 1)
            motion = TangentialMotion.nothing(shape, Status.LAW_RAISED, sentence)
        if not shape or observer is not None or succeeded(motion.status):
            return motion
        given_up = np.isin(motion.status, np.array(GIVEN_UP, dtype=object))
        if not given_up.any():
            return motion
        if not given_up.all():
            again = [(np.ones(shape, dtype=bool), motion), (given_up, part(given_up))]
            return TangentialMotion.merge(again, shape)
        parts = halves(*shape, most=ONE_BY_ONE)
        return TangentialMotion.join([part(each) for each in parts], shape)


def _join_answers(normal: NormalMotion, answered: list[Answered]) -> TangentialMotion:
    """Return the tangential motion of a batch by its whole-impact answers, NaN elsewhere."""
    shape = normal.scene.shape
    change, work = np.full((2, *shape), math.nan)
    seldom: dict[str, Any] = {
        name: zeros(shape)
        if all(are_zeros(getattr(answer, name)) for _, answer in answered)
        else np.full(shape, math.nan)
        for name in SELDOM
    }
    status, detail = (np.full(shape, each, dtype=object) for each in (normal.status, normal.detail))
    counters: Counter[str] = Counter()
    for where, answer in answered:
        np.copyto(change, answer.slip_velocity_change, where=where)
        np.copyto(work, answer.friction_work, where=where)
        for name, column in seldom.items():
            if column.flags.writeable:  # zeros are shared
                np.copyto(column, getattr(answer, name), where=where)
        if not isinstance(normal.detail, str):
            detail[where] = ""
        if answer.status is not Status.SUCCESS:
            np.copyto(status, np.asarray(answer.status, dtype=object), where=where)
            detail[where & (status != Status.SUCCESS)] = answer.detail
        if answer.counter is not None:
            counters[answer.counter] += int(np.count_nonzero(where))
    own = None
    if any(answer.normal is not None for _, answer in answered):
        parts = [(where, each.normal and each.normal.take(where)) for where, each in answered]
        own = Ends.merge([(np.ones(shape, dtype=bool), None), *parts], shape)
    return TangentialMotion(
        slip_velocity_change=change,
        friction_work=work,
        **seldom,
        status=status,
        detail=detail,
        counters=dict(counters),
        normal=own,
    )
