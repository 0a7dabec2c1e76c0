"""A normal law as the equation of motion of its impacts, in units in which all look alike."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import faults
from contactlab.contracts.contact import NormalContact
from contactlab.contracts.normal import NormalLaw
from contactlab.contracts.status import Status
from contactlab.impact.hertz import hertz_scales
from contactlab.impact.scene import Scene
from contactlab.numeric import arrays as batch
from contactlab.numeric.checks import shown

Array = NDArray[np.float64]


class ScaledNormalLaw:
    """A normal law and its memory in the course of the impacts of a scene.

    Scaled approaches (over the normal speed times ``unit``), rates (over the normal speed) and
    impulses of the friction load (over the momentum at first touch) of all impacts stand in one
    array, shape (3, items).

    Attributes
    ----------
    items : int
        Impacts.
    speed, mass, radius : array, shape (items,)
        Normal speed (m/s), and normal mass (kg) and radius (m) of the pair.
    unit : array, shape (items,)
        Of time, in s: the duration of a Hertz impact.
    momentum : array, shape (items,)
        At first touch, in N s.
    active : array of bool, shape (items,)
        Impacts still in contact: the others stand still.
    finite : bool
        Whether the forces found last were.
    steps, time : int, float
        The step, from 1, and the time in s, for the sentence of a fault.
    """

    def __init__(self, law: NormalLaw, scene: Scene) -> None:
        self.law, self.scene, self.shape = law, scene, scene.shape
        self.items = math.prod(self.shape)
        self.speed = self._one_an_item(scene.normal_speed)
        self.mass = self._one_an_item(scene.pair.normal_mass)
        self.radius = self._one_an_item(scene.pair.radius)
        self.unit = self._one_an_item(hertz_scales(scene).duration)
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
        if not self.shape:  # as floats: several times faster
            contact = self._respond(scaled)[0].complete
            one, other = float(contact.force), float(contact.friction_load)
            self.finite = math.isfinite(one) and math.isfinite(other)
            response = self.response.item()
            return np.array([scaled[1], [-one * response], [other * response]])
        force, _, _, load = self.contact(scaled)
        self.finite = bool(np.isfinite(np.where(self.active, force + load, 0.0)).all())
        slope = np.stack([scaled[1], -force * self.response, load * self.response])
        return np.where(self.active, slope, 0.0)

    def contact(self, scaled: Array) -> tuple[Array, Array, Array, Array]:
        """Return force, radius, overlap and friction load, shape (items,) each."""
        return tuple(self._one_an_item(entry) for entry in self._respond(scaled)[0].complete)

    def remember(self, scaled: Array) -> None:
        """Replace the state by the one that the law has where the impacts are."""
        self.state = self._respond(scaled)[1]

    def fault(self, status: Status, what: str) -> faults.LawFaultError:
        """Return the error of a law that failed."""
        detail = faults.sentence(self.law, what, self.steps, self.time)
        return faults.LawFaultError(status, detail)

    def _respond(self, scaled: Array) -> tuple[NormalContact, Any]:
        """Return contact and new state as the law gives them.

        Raises
        ------
        LawFaultError
            If the law raises, or returns anything else.
        """
        approach, rate = self.in_si(scaled)
        try:
            with np.errstate(all="ignore"):  # and whatever a law makes of it ends here
                if self.shape:
                    arrays = (batch.locked(each.reshape(self.shape)) for each in (approach, rate))
                    contact, state = self.law.respond(self.state, *arrays)
                else:
                    contact, state = self.law.respond(self.state, approach.item(), rate.item())
            if not isinstance(contact, NormalContact):
                raise TypeError(f"respond gave {shown(contact)}, not a NormalContact")
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # a plug-in may not end the process
            raise self.fault(Status.LAW_RAISED, faults.raised(error)) from error
        for entry in contact:
            usual = type(entry) is float or entry is None
            if not usual and faults.malformed(entry, self.shape):
                raise self.fault(Status.MALFORMED, f"the answer {shown(entry)}")
        return contact, state

    def _one_an_item(self, entry: Any) -> Any:
        """Return a quantity of the scene's shape, or common to all, with shape (items,)."""
        if not self.shape:
            return np.array([entry], dtype=np.float64)
        return np.array(np.broadcast_to(entry, self.shape), dtype=np.float64).reshape(-1)
