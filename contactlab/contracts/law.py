"""The base class of all laws: what a law claims, what it needs, and the version of the contract."""

from __future__ import annotations

from abc import ABC
from functools import lru_cache
from types import MappingProxyType
from typing import Any, ClassVar

import attrs

from contactlab.impact.scene import Scene

#: Version of the contracts in this package. A plug-in states the version it was written for.
API_VERSION = 2
NO_WORDS: frozenset[str] = frozenset()


class Law(ABC):
    """Base of normal laws, tangential laws and integrators.

    Contract
    --------
    1. A law is immutable, holds parameters only (``attrs.frozen(kw_only=True)``) and can be
       pickled. One object may serve any number of simulations; arrays that it is given are
       read-only. Each parameter is checked when the law is made, under a word as its name.
    2. ``api_version`` is set in the class itself, to the version the law was written for.
    3. The base classes of a law determine how it is run. ``offers`` are its further claims, which
       ``contactlab.testing`` checks: a constant of the class, to which a subclass adds by
       ``Parent.offers | {...}``. Words in use:

       ========================  ====================================================
       ``radius``                the normal contact knows its contact radius b: b² from R z, of
                                 elastic spheres, to 2 R z, the section of a sphere
       ``hertzian_pressure``     pressure is a hemisphere over that radius, eq. (3)
       ``elastic_hertz``         the normal motion is the elastic impact of eqs (2)-(7)
       ``kelvin_voigt``          in unloading the pressure is Hertz's over b² = R (z + A z')
       ``viscous``               P is b³ in Hertz's units at rest and more in approach, b² = R z,
                                 without memory: tangential laws may share its loss
       ``similar``               motions of all impacts are one in units of Hertz's impact
       ``plastic``               bodies yield: there is no caution about yield
       ``partial_slip``          the contact slips from its edge inwards: at fixed normal
                                 load the force is Cattaneo and Mindlin's; elastic impacts
                                 converge to the axisymmetric continuum's
       ``rigid``                 bodies do not deform tangentially: they slip until the slip
                                 velocity is zero or contact ends, and then roll without
                                 tangential force
       ``no_friction``           the tangential force is zero
       ``shares_loss``           the force depends on the slip velocity too, through the loss of
                                 a viscous normal law: increments then have ``sampled``
       ``slip_speed``            mu has a factor from 0 to 1 of the slip speed
       ``vectors``               slip may turn: displacements, velocities and forces of shape
                                 (..., 2), in length at most mu times the friction load
       ``normal_spin``           whole-impact answers have ``normal_spin_change``, odd in the spin
       ``elliptic``              it holds on an ellipse: ``Pair`` has the radius of the circle as
                                 stiff, G* along t1, and ``cross_stiffness_ratio``
       ``several_contacts``      an integrator marches the contacts of a gathering, the last axis
                                 of a scene with ``links``, together: its motion has ``contacts``
       ``controls_error``        the ``tolerance`` of an integrator bounds the error of psi2 over
                                 max(1, abs(psi1)) that it adds to that of the law
       ========================  ====================================================

    4. ``needs`` are the words of the normal law, and the classes of the other laws, beside which
       alone the law runs: a constant too. Parameters take words away from both by ``waives``.
    5. ``resolution`` names the parameter that makes answers finer, or is None: a count
       (``steps``), finer the greater, or ``tolerance``, finer the smaller. An option may be None,
       which nobody named, and then is declared with what is ``usual``.
    6. ``expected_failures`` maps the checks of ``contactlab.testing`` that the law fails by
       its nature to the reasons.
    """

    #: An option of a law is one number, for all impacts.
    _plain_options: ClassVar[bool] = True
    #: The base class has no kind.
    _kind: ClassVar[str] = ""
    #: How laws of the class are run: the words of its contracts.
    _ways: ClassVar[frozenset[str]] = frozenset()
    #: Version of the contracts that the law was written for.
    api_version: ClassVar[int]
    #: Words that the law claims.
    offers: ClassVar[frozenset[str]] = frozenset()
    # ``Any``: a checker would refuse ``needs: ClassVar = frozenset({"radius"})`` in a law.
    #: Words of the normal law, and classes of the other laws, beside which the law runs.
    needs: ClassVar[Any] = frozenset()
    #: Parameter that makes answers finer.
    resolution: ClassVar[str | None] = None
    #: Checks that the law fails by its nature, with the reasons.
    expected_failures: ClassVar[Any] = MappingProxyType({})

    def __init_subclass__(
        cls, *, kind: str | None = None, way: str | None = None, **options: Any
    ) -> None:
        """Set the kind of the laws of a contract, and how they are run."""
        super().__init_subclass__(**options)
        if kind is not None:
            cls._kind = kind
        none = frozenset[str]()
        inherited = [getattr(base, "_ways", none) for base in cls.__bases__]
        cls._ways = none.union(*inherited, () if way is None else {way})

    @classmethod
    def _own_class(cls) -> type[Law]:
        return cls

    def waives(self) -> frozenset[str]:
        """Return the words of ``offers`` and ``needs`` that these parameters take away; none here.

        A subclass adds to ``super().waives()``.
        """
        return NO_WORDS

    def accept(self, scene: Scene) -> None:  # noqa: B027 most laws run every scene
        """Raise a ``ValueError``, with argument, value, rule and remedy, for a scene it cannot run.

        Parameters
        ----------
        scene : Scene
            One impact or a batch.
        """


def law_kind(law: Law | type[Law]) -> str:
    """Return ``"normal"``, ``"tangential"`` or ``"integrator"``.

    Parameters
    ----------
    law : Law or type
    """
    return law._kind


def class_of(law: Law | type[Law]) -> type[Law]:
    """Return the class of a law, or a class as it is."""
    return law._own_class()


def claims(law: Law) -> frozenset[str]:
    """Return the words that a law offers with its parameters.

    Parameters
    ----------
    law : Law
    """
    waived = law.waives()
    return law.offers.difference(waived) if waived else law.offers


def requirements(law: Law) -> frozenset[str | type]:
    """Return the words and classes that a law needs with its parameters.

    Parameters
    ----------
    law : Law
    """
    required: frozenset[str | type] = law.needs.difference(law.waives())
    return required


def resolution_of(law: Law) -> Any:
    """Return the resolution of a law, named or usual; None if the law has none.

    Parameters
    ----------
    law : Law
    """
    if law.resolution is None:
        return None
    named = getattr(law, law.resolution)
    return _usual(type(law), law.resolution) if named is None else named


@lru_cache(maxsize=128)
def _usual(law: type[Law], name: str) -> float | None:
    """Return the usual value of an option; None if the option states none."""
    option = attrs.fields_dict(law).get(name) if attrs.has(law) else None
    usual: float | None = None if option is None else option.metadata.get("usual")
    return usual
