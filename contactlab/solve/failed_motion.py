"""Normal motions without a course: the law failed, or no step can follow them."""

from __future__ import annotations

import math

import numpy as np

from contactlab.contracts.contact import NormalContact
from contactlab.contracts.law import Law
from contactlab.contracts.motion import NormalMotion, NormalSample
from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.numeric import arrays as batch
from contactlab.numeric.types import Index, Real


class _UnknownMotion(NormalMotion):
    """A normal motion whose numbers are all NaN."""

    def __init__(self, law: Law, scene: Scene) -> None:
        self.law, self.scene = law, scene
        unknown = batch.spread(math.nan, scene.shape)
        self.duration = self.maximum_radius = self.maximum_approach = unknown
        self.maximum_force = self.final_rate = self.total_load_impulse = unknown

    def at(self, phase: Real) -> NormalSample:
        """Return a sample whose values are all NaN."""
        nothing = math.nan * (np.asarray(phase) + self.duration)
        contact = NormalContact(nothing, nothing, nothing, nothing)
        return NormalSample(nothing, nothing, nothing, contact, nothing)

    def phase(self, fraction: Real) -> Real:
        """Return pi times the fraction."""
        return math.pi * np.asarray(fraction)


class FailedMotion(_UnknownMotion):
    """The normal motion of impacts whose normal law failed."""

    accuracy = math.nan
    _known = "nothing"

    def __init__(self, law: Law, scene: Scene, status: Status, detail: str) -> None:
        super().__init__(law, scene)
        shape = scene.shape
        self.status, self.detail = (
            batch.spread_object(status, shape),
            batch.spread_object(detail, shape),
        )

    def take(self, part: Index) -> FailedMotion:
        """Return the motion of some impacts."""
        status, detail = (
            np.ravel(np.asarray(entry, dtype=object))[0] for entry in (self.status, self.detail)
        )
        return FailedMotion(self.law, self.scene.take(part), status, detail)


class UnfollowedMotion(_UnknownMotion):
    """A normal motion with only a rate at separation and a load impulse."""

    accuracy = 0.0
    _known = "ends"

    def __init__(self, law: Law, scene: Scene, rate: Real) -> None:
        super().__init__(law, scene)
        self.final_rate = batch.spread(rate, scene.shape)
        lost: Real = scene.normal_speed - self.final_rate
        self.total_load_impulse = batch.spread(scene.pair.normal_mass * lost, scene.shape)

    def take(self, part: Index) -> UnfollowedMotion:
        """Return the motion of some impacts."""
        rate = batch.take(self.final_rate, self.scene.shape, part)
        return UnfollowedMotion(self.law, self.scene.take(part), rate)
