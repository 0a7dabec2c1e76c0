"""The base of every law: its kind, needs, offers, and the version of its contract."""

from __future__ import annotations

from abc import ABC
from collections.abc import Mapping
from typing import ClassVar

#: Version of the contracts in this package. A plug-in states the one it was written for.
API_VERSION = 2


class Law(ABC):
    """Base of normal laws, tangential laws and integrators.

    Contract
    --------
    1. An object is immutable and holds parameters only (``attrs.frozen(kw_only=True)``):
       the same object may serve any number of simulations at once, and it pickles.
    2. ``api_version`` is set in the class itself to the version it was written for.
    3. What a law can do follows from the classes that it is derived from. ``offers`` are
       claims besides, words that ``contactlab.testing`` holds it to; ``needs`` are the claims
       that a tangential law depends on in its normal law. Words in use:

       ========================  ====================================================
       ``radius``                the normal contact knows its contact radius
       ``hertzian_pressure``     pressure is a hemisphere over that radius, eq. (3)
       ``elastic_hertz``         the normal motion is the elastic impact of eqs (2)-(7)
       ``partial_slip``          the contact slips from its edge inwards: at fixed normal
                                 load its force is Cattaneo and Mindlin's; elastic impacts
                                 end as the axisymmetric continuum's, the finer the closer
       ``rigid``                 bodies do not deform tangentially: an impact slips until its
                                 slip stops, if it does, and then rolls without a force
       ``no_friction``           the law makes no force
       ========================  ====================================================

    4. ``resolution`` names the parameter that makes answers finer, if there is one: a count
       (``steps``, ``annuli``) that grows, or ``tolerance``, which shrinks.
    5. Words in the names of parameters; each is checked when the object is made and
       refused with a ``ValueError`` that names it. A ``quantity`` of a law is one number: it
       refuses arrays (``plain_options``).
    6. ``expected_failures`` names the checks of ``contactlab.testing`` that the law fails by
       its nature, each with the reason: a class variable, or a property if it depends on the
       parameters.
    7. Arrays that a law is given are read-only: a law that writes in place raises an error.
    """

    kind: ClassVar[str]
    api_version: ClassVar[int]
    needs: ClassVar[frozenset[str]] = frozenset()
    offers: ClassVar[frozenset[str]] = frozenset()
    resolution: ClassVar[str | None] = None
    plain_options: ClassVar[bool] = True

    @property
    def expected_failures(self) -> Mapping[str, str]:
        """Checks that fail by the law's nature, with the reasons; none by default."""
        return {}
