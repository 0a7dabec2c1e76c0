"""Shared parts of laws of partial slip: scales, claims, gross slip, stiffness, cautions."""

from __future__ import annotations

import math
from typing import ClassVar, NamedTuple

import numpy as np

from contactlab.contracts import NormalMotion, SteppedTangentialLaw, WholeImpact, sliding
from contactlab.impact.hertz import slips_throughout
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Array, Real

#: Phases at which the friction load is compared with Hertz's, and the relative tolerance.
PHASES = np.linspace(0.1, 0.9, 9) * math.pi
CLOSE = 1e-6


class Scales(NamedTuple):
    """Units of the scaled variables in SI; floats, or arrays of the batch shape.

    Attributes
    ----------
    radius : float or array
        a, the largest contact radius, in m.
    displacement : float or array
        kappa R/(mu a²), in 1/m: scaled displacement per metre; 0 without friction.
    force : float or array
        mu P_max, in N.
    normal_force : float or array
        P_max of a Hertz contact of radius a, in N.
    work : float or array
        mu P_max times mu a²/(kappa R), in J.
    """

    radius: Real
    displacement: Real
    force: Real
    normal_force: Real
    work: Real

    @classmethod
    def of(cls, scene: Scene, normal: NormalMotion) -> Scales:
        """Return the scales of the largest contact, theory §1."""
        return cls.at(scene, normal.maximum_radius)

    @classmethod
    def at(cls, scene: Scene, radius: Real) -> Scales:
        """Return the scales of a contact of a radius in m."""
        pair, friction = scene.pair, scene.friction_coefficient
        peak = (4.0 / 3.0) * pair.effective_modulus * radius**3 / pair.radius
        slip = friction * radius**2 / (pair.stiffness_ratio * pair.radius)
        # 0 without friction, by no branch: numbers and arrays alike
        per_slip = (friction > 0.0) / (slip + (friction == 0.0))
        return cls(radius, per_slip, friction * peak, peak, friction * peak * slip)

    def pressure(self, radius: Real, load: Real) -> Real:
        """Return p, the load at a radius over that of a Hertz contact: 1 under Hertz's law."""
        cube = self.normal_force * radius**3
        return load / (cube + (cube == 0.0))

    @property
    def metres(self) -> Real:
        """Metres of displacement per scaled unit, 1/``displacement``; 0 without friction."""
        scaled: Array = np.asarray(self.displacement)
        metres: Real = (scaled > 0.0) / (scaled + (scaled == 0.0))
        return metres


class PartialSlip(SteppedTangentialLaw):
    """Base of laws that divide the contact into parts, each of them stuck or slipping."""

    offers: ClassVar[frozenset[str]] = frozenset({"partial_slip", "elliptic"})
    needs: ClassVar[frozenset[str]] = frozenset({"radius"})

    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return the whole-impact answers, with those of gross slip by (44) and (46)."""
        return (*super().whole_impacts(scene, normal), *gross_slip(scene, normal))

    def stiffness(self, scene: Scene, normal: NormalMotion) -> Real:
        """Return 2 G* a, Mindlin's stiffness of the largest contact fully stuck."""
        return scene.pair.tangential_stiffness(normal.maximum_radius)


def gross_slip(scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
    """Return the answers of eq. (45), for impacts of elastic Hertz contacts; else none."""
    if "elastic_hertz" not in normal.claims:
        return ()
    where = slips_throughout(scene.psi1, scene.chi)
    if where is False:  # a single impact; a batch has a mask
        return ()
    reason = "the impact slips from start to end, eq. (45)"
    return (sliding(scene, normal, where=where, reason=reason, stops=False),)


def hemisphere(normal: NormalMotion) -> tuple[str, ...]:
    """Return the caution of an assumed hemispherical pressure, empty if none is assumed."""
    # Without the claim ``hertzian_pressure`` the friction law makes the assumption. With the claim
    # the normal law makes it, unless the friction load is Hertz's at the contact radius.
    if "hertzian_pressure" not in normal.claims:
        return (
            "model: the friction law assumes Hertz's pressure profile; the normal law does not "
            "state its own.",
        )
    if "elastic_hertz" in normal.claims or _hertzian(normal):
        return ()
    return (
        "model: the normal law assumes Hertz's pressure profile for its damping force too; no "
        "theory gives that profile.",
    )


def _hertzian(normal: NormalMotion) -> bool:
    """Return whether the friction load is that of a Hertz contact of the same radius."""
    pair, shape = normal.scene.pair, normal.scene.shape
    contact = normal.at(PHASES.reshape(-1, *(1 for _ in shape))).contact
    radius = contact.radius
    hertz = (4.0 / 3.0) * pair.effective_modulus * radius**3 / pair.radius
    off = np.abs(np.asarray(contact.friction_load) - hertz)
    return bool(np.all(~(off > CLOSE * hertz)))
