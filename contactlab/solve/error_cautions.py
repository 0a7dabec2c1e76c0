"""Cautions of a march: a large declared error, or no declared error where errors are large."""

from __future__ import annotations

import math

import attrs
import numpy as np

from contactlab.contracts.law import Law, law_kind
from contactlab.contracts.motion import NormalMotion
from contactlab.impact import kinetics
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import every, some, spread
from contactlab.numeric.types import Array, Mask, Real
from contactlab.outcome.plan import Clause
from contactlab.registry.composition import Laws
from contactlab.registry.registry import REGISTRY
from contactlab.solve.normal_motion import normal_motion

#: Declared errors of psi2 above this are cautioned of, with a resolution that leaves so much.
LARGE, LEFT = 0.02, 2e-3
#: chi + abs(eta) from which a march by partial slip that declares no error is cautioned of: the
#: default of springs is off by 0.007 there, and by ten times as much at three times this.
LARGE_CHI = 10.0
#: Turns in which a resolution is sought; errors fall as its square, so that two mostly suffice.
TURNS = 8


def of_errors(laws: Laws, scene: Scene, error: Real, marched: Mask, advice: str) -> list[Clause]:
    """Return the cautions of impacts that are marched.

    ``error`` is the declared one of psi2. Without ``advice`` an estimate exists.
    """
    error = np.asarray(error)
    clauses = []
    if some(large := np.asarray(marched & (error > LARGE))):
        part = scene if every(large) else scene.take(large)
        text = f"numerical error of psi2: up to {{:.2g}} (stated); {_remedy(laws, part)}"
        clauses.append(Clause(text, large, (spread(error, scene.shape),)))
    if advice and "partial_slip" in laws.capability.tangential_claims and np.isnan(error).any():
        size = spread(
            kinetics.largest_chi(scene) + kinetics.size_of(scene, np.asarray(scene.eta)),
            scene.shape,
        )
        if some(unknown := np.asarray(marched & np.isnan(error) & (size >= LARGE_CHI))):
            text = f"numerical error of psi2: not stated at chi + abs(eta) = {{:.3g}}{advice}"
            clauses.append(Clause(text, unknown, (size,)))
    return clauses


def _remedy(laws: Laws, scene: Scene) -> str:
    """Return the resolution of both laws that leaves little error."""
    normal = normal_motion(laws.normal, scene.central)
    law: Law = laws.tangential
    integrator: Law = laws.integrator
    for _ in range(TURNS):
        errors, own = _errors(laws, normal, scene)
        if np.nanmax(errors) <= LEFT:
            pair = " and ".join(map(_resolution, (law, integrator)))
            return f"{pair} reduce the error to {LEFT:g}"
        try:
            law, integrator = _finer(law, own), _finer(integrator, errors - own)
        except ValueError:  # beyond what the law allows
            break
        laws = laws.change(tangential=law, integrator=integrator)
    return "finer resolutions reduce the error"


def _errors(laws: Laws, normal: NormalMotion, scene: Scene) -> tuple[Array, Array]:
    """Return the declared errors, and the part that steps do not change."""
    all_of = laws.integrator.errors(scene, normal, laws.tangential).psi2
    own = laws.tangential.errors(scene, normal, math.inf).psi2
    return np.asarray(all_of), np.nan_to_num(own)


def _finer(law: Law, errors: Array) -> Law:
    """Return a law whose share of the error is at most half of what may be left."""
    times = float(np.nanmax(errors)) / (0.5 * LEFT)
    if times <= 1.0 or law.resolution is None:
        return law
    value = getattr(law, law.resolution)
    finer = value / times
    if (
        law.resolution != "tolerance"
    ):  # errors fall as its square; a doubling grid needs an even one
        finer = 2 * math.ceil(0.5 * math.sqrt(times) * value)
    return attrs.evolve(law, **{law.resolution: finer})  # type: ignore[misc]


def _resolution(law: Law) -> str:
    """Return the name of a law, with its resolution."""
    name = f"{law_kind(law)}.{REGISTRY.short_name(law)}"
    if law.resolution is None:
        return name
    return f"{name} with {law.resolution}={getattr(law, law.resolution)}"
