"""The base class of all laws: kind, needs, offers, and the version of the contract."""

from __future__ import annotations

from abc import ABC
from types import MappingProxyType
from typing import Any, ClassVar

from contactlab.impact.scene import Scene

#: Version of the contracts in this package. A plug-in states the version it was written for.
API_VERSION = 2


class Law(ABC):
    """Base of normal laws, tangential laws and integrators.

    Contract
    --------
    1. A law is immutable and holds parameters only (``attrs.frozen(kw_only=True)``). The same
       object may serve any number of simulations at once. A law can be pickled.
    2. ``api_version`` is set in the class itself, to the version the law was written for.
    3. The base classes of a law determine how it is run. ``offers`` are further claims, in
       words, which ``contactlab.testing`` checks. ``needs`` are the claims that a tangential
       law requires of its normal law. Words in use:

       ========================  ====================================================
       ``radius``                the normal contact knows its contact radius
       ``hertzian_pressure``     pressure is a hemisphere over that radius, eq. (3)
       ``elastic_hertz``         the normal motion is the elastic impact of eqs (2)-(7)
       ``partial_slip``          the contact slips from its edge inwards: at fixed normal
                                 load the force is Cattaneo and Mindlin's; elastic impacts
                                 converge to the axisymmetric continuum's
       ``rigid``                 bodies do not deform tangentially: they slip until the slip
                                 velocity is zero or contact ends, and then roll without
                                 tangential force
       ``no_friction``           the tangential force is zero
       ========================  ====================================================

    4. ``resolution`` names the parameter that makes answers finer, or is None: a count
       (``steps``, ``annuli``), finer the greater, or ``tolerance``, finer the smaller.
    5. Parameters have words as names. Each parameter is checked when the law is made; a bad
       value raises a ``ValueError`` that names the parameter. A ``quantity`` of a law is one
       number and refuses arrays (``plain_options``).
    6. ``expected_failures`` maps the checks of ``contactlab.testing`` that the law fails by
       its nature to the reasons. It is a class variable; one that depends on parameters is
       declared ``ClassVar[Any]``, and is a ``property`` of a function.
    7. Arrays passed to a law are read-only; writing to them raises an error.
    8. ``elliptic`` says that the law holds on an elliptic contact, of which ``Pair`` has the radius
       of the circle as stiff, and G* along t1; a law of vectors has G* along t2 too,
       ``cross_stiffness_ratio`` times that. Of other laws the plan says there that they were made
       for a circle.
    9. ``refuses(other)`` says why the law does not run beside another law; ``accept(scene)``
       raises a ``ValueError`` for a scene that the law cannot run.
    """

    kind: ClassVar[str]
    api_version: ClassVar[int]
    needs: ClassVar[frozenset[str]] = frozenset()
    offers: ClassVar[frozenset[str]] = frozenset()
    resolution: ClassVar[str | None] = None
    plain_options: ClassVar[bool] = True
    elliptic: ClassVar[bool] = False
    #: A mapping of str to str; a checker would refuse a law with a dict of them.
    expected_failures: ClassVar[Any] = MappingProxyType({})

    def refuses(self, other: Law) -> str | None:
        """Return why this law does not run beside ``other``; None, the default, if it does.

        Parameters
        ----------
        other : Law
            A law of another kind.

        Returns
        -------
        str or None
            The reason: ``"it has no pressure over the radius"``. The message of the ``ValueError``
            adds the names of both laws.
        """
        return None

    def accept(self, scene: Scene) -> None:  # noqa: B027 most laws run every scene
        """Do nothing, or raise a ``ValueError`` if the law cannot run ``scene``.

        Parameters
        ----------
        scene : Scene
            One impact or a batch.

        Raises
        ------
        ValueError
            With the argument of the scene, its value, the rule and a remedy.
        """
