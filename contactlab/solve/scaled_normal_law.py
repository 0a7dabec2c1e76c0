"""The dimensionless normal equation of motion of a scene under a normal law."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlab.contracts import faults
from contactlab.contracts.contact import NormalContact
from contactlab.contracts.normal import NormalLaw
from contactlab.contracts.status import Status
from contactlab.impact.hertz import hertz_scales
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import flat, lock_arrays
from contactlab.numeric.checks import quote
from contactlab.numeric.types import Array, Real

#: Types of an entry of a contact that are always well formed.
PLAIN = (float, np.float64, type(None))


class ScaledNormalLaw:
    """A normal law and its state for the impacts of a scene, as (3, items) scaled equations.

    The rows of a scaled array are the approach over the normal speed times ``unit``, the rate over
    the normal speed, and the load impulse over the momentum at first touch.

    Attributes
    ----------
    items : int
        Number of impacts.
    speed, mass, radius : array, shape (items,)
        Normal speed (m/s), and normal mass (kg) and radius (m) of the pair.
    unit, length : array, shape (items,)
        Unit of time in s, the duration of a Hertz impact, and unit of approach in m.
    momentum : array, shape (items,)
        Momentum at first touch, in N s.
    active : array of bool, shape (items,)
        True for impacts in contact; the others do not move.
    finite : bool
        True if all forces of the last evaluation were finite.
    steps, time : int, float
        Number of the step, from 1, and time in s, for the sentence of a fault.
    """

    def __init__(self, law: NormalLaw, scene: Scene) -> None:
        self.law, self.scene, self.shape = law, scene, scene.shape
        self.items = math.prod(self.shape)
        self.speed = self._per_item(scene.normal_speed)
        self.mass = self._per_item(scene.pair.normal_mass)
        self.radius = self._per_item(scene.pair.radius)
        self.unit = self._per_item(hertz_scales(scene).duration)
        self.length, self.momentum = self.speed * self.unit, self.mass * self.speed
        #: Change of the scaled rate in a unit of time under 1 N.
        self.response = self.unit / self.momentum
        self.active = np.ones(self.items, dtype=bool)
        self.steps, self.time, self.finite = 1, 0.0, True
        with np.errstate(all="ignore"), faults.blaming(self.law):
            self.state = self.law.start(self.scene)

    def in_si(self, scaled: Array) -> tuple[Array, Array]:
        """Return approach (m) and rate (m/s), shape (..., items) each."""
        return scaled[..., 0, :] * self.length, scaled[..., 1, :] * self.speed

    def slope(self, scaled: Array) -> Array:
        """Return the derivatives of scaled approach, rate and impulse, shape (3, items)."""
        forces, _, _, loads = self.contact(scaled)
        self.finite = bool(np.isfinite(np.where(self.active, forces + loads, 0.0)).all())
        slope = np.stack([scaled[1], -forces * self.response, loads * self.response])
        return np.where(self.active, slope, 0.0)

    def contact(self, scaled: Array) -> Array:
        """Return force (N), radius (m), overlap (m) and friction load (N), shape (4, items)."""
        rows = np.empty((4, *self.shape))
        for row, entry in enumerate(self._answer(scaled)[0].complete):
            rows[row] = entry
        return rows.reshape(4, self.items)

    def remember(self, scaled: Array) -> None:
        """Store the state that the law returns at these scaled values."""
        self.state = self._answer(scaled)[1]

    def fault(self, status: Status, what: str) -> faults.LawFaultError:
        """Return the error with a sentence on law, step and time."""
        detail = faults.sentence(self.law, what, self.steps, self.time)
        return faults.LawFaultError(status, detail)

    def _answer(self, scaled: Array) -> tuple[NormalContact, Any]:
        """Return contact and new state at scaled values."""
        approach, rate = (lock_arrays(each.reshape(self.shape)) for each in self.in_si(scaled))
        return self.respond(approach, rate)

    def respond(self, approach: Real, rate: Real) -> tuple[NormalContact, Any]:
        """Return contact and new state in SI, or raise LawFaultError if the law does not."""
        try:
            with np.errstate(all="ignore"):  # restores the settings if the law changes them
                contact, state = self.law.respond(self.state, approach, rate)
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # a plug-in may not end the process
            raise self.fault(Status.LAW_RAISED, faults.tell_error(error, self.law)) from error
        if not isinstance(contact, NormalContact):
            what = f"respond gave {quote(contact)}, not a NormalContact"
            raise self.fault(Status.LAW_RAISED, what)
        for entry in contact:
            if type(entry) not in PLAIN and faults.is_malformed(entry, self.shape):
                raise self.fault(Status.MALFORMED, f"the answer {quote(entry)}")
        return contact, state

    def _per_item(self, entry: Real) -> Array:
        """Return a scalar or an array of the scene's shape as an array of shape (items,)."""
        return flat(np.array(entry, dtype=np.float64), self.shape)
