"""What every plug-in object has in common: a kind, needs, offers, and an interface version."""

from __future__ import annotations

from abc import ABC
from collections.abc import Mapping
from typing import ClassVar

#: Version of the contracts in this package. A plug-in states the one it was written for.
API_VERSION = 1


class Law(ABC):
    """Base of normal laws, tangential laws and integrators.

    Contract
    --------
    1. An object is immutable and holds parameters only (``attrs.frozen(kw_only=True)``):
       the same object may serve any number of simulations at once, and it pickles.
    2. ``api_version`` is set in the class itself to the version it was written for.
    3. ``needs`` and ``offers`` are sets of words. A composition fits if each part's needs
       are offered by the other two. Words in use:

       ========================  ====================================================
       ``radius``                the normal contact knows its contact radius
       ``hertzian_pressure``     pressure is a hemisphere over that radius, eq. (3)
       ``closed_form_motion``    the normal motion is known in closed form
       ``elastic_hertz``         that motion is the elastic impact of eqs (2)-(7)
       ``advance``               the tangential law is a return mapping over a step
       ``phases``                the tangential law is a sequence of smooth phases
       ``steps``                 the integrator calls ``advance``
       ``events``                the integrator runs phases and locates their ends
       ``partial_slip``          the contact slips from its edge inwards: at fixed normal
                                 load its force is Cattaneo and Mindlin's (a claim, held by
                                 ``contactlab.testing``)
       ========================  ====================================================

       An integrator needs what it calls, ``advance`` or ``phases``. A law that can be run in
       one way only needs that way of its integrator (``steps`` or ``events``), so that a
       refusal can name what would fit; a law that offers both needs neither.

    4. ``resolution`` names the parameter that makes answers finer, if there is one: a count
       (``steps``, ``annuli``) that grows, or ``tolerance``, which shrinks.
    5. Words in the names of parameters; each is checked when the object is made and
       refused with a ``ValueError`` that names it.
    6. ``expected_failures`` names the checks of ``contactlab.testing`` that the law fails by
       its nature, each with the reason: a class variable, or a property if it depends on the
       parameters.
    """

    kind: ClassVar[str]
    api_version: ClassVar[int]
    needs: ClassVar[frozenset[str]] = frozenset()
    offers: ClassVar[frozenset[str]] = frozenset()
    resolution: ClassVar[str | None] = None

    @property
    def expected_failures(self) -> Mapping[str, str]:
        """Checks that fail by the law's nature, with the reasons; none by default."""
        return {}
