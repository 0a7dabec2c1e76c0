"""The tangential motion of an impact, and its instants as an observer sees them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Generic, NamedTuple, Self, TypeAlias

import attrs

from contactlab.contracts.batch_motion import BatchMotion
from contactlab.contracts.contact import NormalContact
from contactlab.contracts.contacts import Contacts
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.sampled_motion import Ends
from contactlab.numeric.types import Each, Mask, Real


def no_fields() -> Mapping[str, Any]:
    """Return no arrays over the contact."""
    return {}


class Sample(NamedTuple):
    """One instant of an impact, as passed to an observer.

    Attributes
    ----------
    time : float or array, shape (...,)
        Time in s, 0 at first touch.
    approach, normal_velocity : float or array
        Approach in m and its rate in m/s, positive in compression.
    contact : NormalContact
        The normal contact.
    slip_velocity : float or array
        v_x in m/s; along t1 and t2, shape (..., 2), where the scene has vectors.
    tangential_force : float or array
        F in N, positive where it opposes a positive slip velocity; shape (..., 2) as the slip.
    fields : callable
        Returns the law's arrays over the contact radius; observers call it only if they keep them.
    """

    time: Real
    approach: Real
    normal_velocity: Real
    contact: NormalContact
    slip_velocity: Real
    tangential_force: Real
    fields: Callable[[], Mapping[str, Any]] = no_fields


#: A function that is called with each instant, and must not change its argument. If its attribute
#: ``stepwise`` is False, it never calls ``Sample.fields``, so a law may take all steps in one call.
Observer: TypeAlias = Callable[[Sample], None]


@attrs.frozen(kw_only=True, eq=False, slots=False)  # frozen slots are slow to fill
class TangentialMotion(BatchMotion, Generic[Each]):
    """The tangential motion of an impact or a batch; entries have the batch shape.

    Attributes
    ----------
    slip_velocity_change : float or array
        Change of v_x in m/s; shape (..., 2) where the scene has vectors. It is not added to v_x,
        which may be so large that the sum would lose digits of the change.
    friction_work : float or array
        Friction work in J, summed over the answers of the tangential law.
    shear_loss : float or array
        Energy in J that the bodies lost in shear, summed likewise; 0 unless the contact is viscous.
    status : Status or array of Status
        How the run of each impact ended.
    detail : str or array of str
        What failed, at which step and time; empty on success. An integrator may give one
        sentence for a batch, which goes to the impacts that failed.
    counters : mapping of str to int
        Operations counted: ``steps``, ``evaluations``, ``rejected``, ...
    normal_spin_change : float or array
        Change of the spin about the normal in rad/s; 0 of laws that do not answer it.
    normal : NormalMotion, Ends or None
        The normal motion that came of the friction, if the friction changes it. Restitution,
        duration and maxima of the result are then those of this motion, and the energy books take
        the dissipation that the normal law declares. Motions of both together always have it.
    contacts : Contacts or None
        What each contact of a gathering went through; None of impacts of one contact.
    """

    slip_velocity_change: Each = attrs.field(metadata={"vectors": True})
    friction_work: Real
    shear_loss: Real = 0.0
    normal_spin_change: Real = attrs.field(default=0.0, metadata={"rare": True})
    normal: NormalMotion | Ends | None = None
    contacts: Contacts | None = None

    @classmethod
    def merge(cls, parts: Sequence[tuple[slice | Mask, Self]], shape: tuple[int, ...]) -> Self:
        """Return one motion of ``shape``, with the ends of the normal motions of the parts.

        Parameters
        ----------
        parts, shape
            As of ``BatchMotion.merge``.
        """
        motion = super().merge(parts, shape)
        contacts = [(where, part.contacts) for where, part in parts]
        if any(each is not None for _, each in contacts):
            motion = attrs.evolve(motion, contacts=Contacts.merge(contacts, shape))
        normals = [(where, part.normal) for where, part in parts]
        if all(normal is None for _, normal in normals):
            return motion
        return attrs.evolve(motion, normal=Ends.merge(normals, shape))
