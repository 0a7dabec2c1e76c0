"""The abilities of three laws, worked out once when they are composed, as every run asks."""

from __future__ import annotations

from typing import Any, NamedTuple

from contactlab.contracts.integrator import CoupledIntegrator, Integrator, accuracy_of
from contactlab.contracts.law import Law, claims, resolution_of
from contactlab.contracts.normal import ClosedFormNormalLaw, NormalLaw, UnfollowedNormalLaw
from contactlab.contracts.path import PathTangentialLaw
from contactlab.contracts.tangential import (
    CausalTangentialLaw,
    CoupledTangentialLaw,
    ResolvingTangentialLaw,
    SteppedTangentialLaw,
    TangentialLaw,
    WholeImpactTangentialLaw,
    shares_loss,
)
from contactlab.registry.acceptance import may_refuse
from contactlab.registry.read_options import options_read


class Capability(NamedTuple):
    """Three laws by the base classes that say how they are run, and what they claim.

    Attributes
    ----------
    accuracy : float or None
        Error of psi2 over max(1, abs(psi1)) that the integrator controls.
    normal_claims, tangential_claims : frozenset of str
        Words that the laws offer, with their parameters.
    shares_loss : bool
        True if the tangential law loses energy in shear as the normal law in pressure.
    refusing : tuple of Law
        The laws that may refuse a scene.
    unnamed : tuple of Law
        The laws that have a resolution, and nobody named it.
    reads : bool
        True if a law has options that materials give, or that each impact has its own of.
    unasked : bool
        True if no law refuses spheres, chooses a resolution for them, or leaves some unfollowed.
    closed, unfollowed, whole, path, stepped, causal, coupled, resolving, marcher : law or None
        The law, if it is derived from that class.
    """

    accuracy: float | None
    normal_claims: frozenset[str]
    tangential_claims: frozenset[str]
    shares_loss: bool
    refusing: tuple[Law, ...]
    unnamed: tuple[Law, ...]
    reads: bool
    unasked: bool
    closed: ClosedFormNormalLaw | None = None
    unfollowed: UnfollowedNormalLaw | None = None
    whole: WholeImpactTangentialLaw | None = None
    path: PathTangentialLaw | None = None
    stepped: SteppedTangentialLaw | None = None
    causal: CausalTangentialLaw | None = None
    coupled: CoupledTangentialLaw | None = None
    resolving: ResolvingTangentialLaw | None = None
    marcher: CoupledIntegrator | None = None

    @classmethod
    def of(cls, normal: NormalLaw, tangential: TangentialLaw, integrator: Integrator) -> Capability:
        """Return what three laws can do."""
        laws: tuple[Law, ...] = normal, tangential, integrator
        by_way: dict[str, Any] = {way: law for law in laws for way in law._ways}
        refusing, unnamed = tuple(filter(may_refuse, laws)), tuple(filter(_leaves_resolution, laws))
        return cls(
            accuracy=accuracy_of(integrator),
            normal_claims=claims(normal),
            tangential_claims=claims(tangential),
            shares_loss=shares_loss(tangential, normal),
            refusing=refusing,
            unnamed=unnamed,
            reads=any(options_read(type(law)) for law in laws),
            unasked=not (refusing or unnamed or "unfollowed" in by_way),
            **by_way,
        )


def _leaves_resolution(law: Law) -> bool:
    """Return whether a law has a usual resolution, and nobody named another."""
    return (
        law.resolution is not None
        and getattr(law, law.resolution, law) is None
        and resolution_of(law) is not None
    )
