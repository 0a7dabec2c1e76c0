"""What three laws can do: found once when they are composed, as every run asks it."""

from __future__ import annotations

from typing import NamedTuple

from contactlab.contracts.integrator import CoupledIntegrator, Integrator, accuracy_of
from contactlab.contracts.law import Law, claims, resolution_of
from contactlab.contracts.normal import ClosedFormNormalLaw, NormalLaw, UnfollowedNormalLaw
from contactlab.contracts.path import PathTangentialLaw
from contactlab.contracts.tangential import (
    CausalTangentialLaw,
    CoupledTangentialLaw,
    ResolvingTangentialLaw,
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
    closed, unfollowed, whole, path, causal, coupled, resolving, marcher : law or None
        The law, if it is derived from that class.
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
    """

    closed: ClosedFormNormalLaw | None
    unfollowed: UnfollowedNormalLaw | None
    whole: WholeImpactTangentialLaw | None
    path: PathTangentialLaw | None
    causal: CausalTangentialLaw | None
    coupled: CoupledTangentialLaw | None
    resolving: ResolvingTangentialLaw | None
    marcher: CoupledIntegrator | None
    accuracy: float | None
    normal_claims: frozenset[str]
    tangential_claims: frozenset[str]
    shares_loss: bool
    refusing: tuple[Law, ...]
    unnamed: tuple[Law, ...]
    reads: bool

    @classmethod
    def of(cls, normal: NormalLaw, tangential: TangentialLaw, integrator: Integrator) -> Capability:
        """Return what three laws can do."""
        laws: tuple[Law, ...] = normal, tangential, integrator
        return cls(
            closed=normal if isinstance(normal, ClosedFormNormalLaw) else None,
            unfollowed=normal if isinstance(normal, UnfollowedNormalLaw) else None,
            whole=tangential if isinstance(tangential, WholeImpactTangentialLaw) else None,
            path=tangential if isinstance(tangential, PathTangentialLaw) else None,
            causal=tangential if isinstance(tangential, CausalTangentialLaw) else None,
            coupled=tangential if isinstance(tangential, CoupledTangentialLaw) else None,
            resolving=tangential if isinstance(tangential, ResolvingTangentialLaw) else None,
            marcher=integrator if isinstance(integrator, CoupledIntegrator) else None,
            accuracy=accuracy_of(integrator),
            normal_claims=claims(normal),
            tangential_claims=claims(tangential),
            shares_loss=shares_loss(tangential, normal),
            refusing=tuple(filter(may_refuse, laws)),
            unnamed=tuple(filter(_leaves_resolution, laws)),
            reads=any(options_read(type(law)) for law in laws),
        )


def _leaves_resolution(law: Law) -> bool:
    """Return whether a law has a usual resolution, and nobody named another."""
    return (
        law.resolution is not None
        and getattr(law, law.resolution, law) is None
        and resolution_of(law) is not None
    )
