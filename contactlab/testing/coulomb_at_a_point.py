"""Checks of Coulomb's law at every point of the contact, for laws whose fields give tractions.

The fields are ``radius`` (m) and ``traction`` (Pa), or ``radius``, ``displacement`` and ``limit``
(m) of springs. The traction of springs follows from Abel's integral.
"""

from __future__ import annotations

import numpy as np

from contactlab.contracts import NormalLaw, SteppedTangentialLaw
from contactlab.numeric.types import Array
from contactlab.outcome.history import Recorder
from contactlab.registry.registry import REGISTRY
from contactlab.testing.check import NotApplicableError, apply_if, check, hold
from contactlab.testing.laws import StronglyDampedHertz
from contactlab.testing.load_paths import FRICTION, scene
from contactlab.testing.ways import meet, ways

#: (chi, psi1) of impacts in which stick and slip alternate.
IMPACTS = ((1.4411764706, 0.5), (1.4411764706, 2.0), (3.0, 1.2), (3.0, 3.0))
#: Bound of the excess of the traction, over the mean of mu p, for discretised laws.
ROOM = 0.05
#: Contact radius over the largest, below which the contact has too few points.
SMALL = 0.3


@check(SteppedTangentialLaw)
def coulomb_at_a_point(law: SteppedTangentialLaw) -> None:
    """In elastic Hertz impacts the traction nowhere exceeds mu p, p being the hemisphere (3)."""
    _hold(law, REGISTRY.create("normal.hertz"))


@check(SteppedTangentialLaw, nature="each spring is limited separately")
def coulomb_at_a_point_damped(law: SteppedTangentialLaw) -> None:
    """Under a damped normal law the traction nowhere exceeds mu p.

    Limits of single springs do not ensure this there.
    """
    _hold(law, StronglyDampedHertz())


def _hold(law: SteppedTangentialLaw, normal_law: NormalLaw) -> None:
    """Hold that abs(q) <= mu p at every point along impacts under a normal law."""
    try:
        way = next(way for way in ways(law, normal_law) if way.integrator is not None)
    except (NotApplicableError, StopIteration):
        sentence = f"No integrator runs it under {type(normal_law).__name__}."
        raise NotApplicableError(sentence) from None
    worst, where = -np.inf, ""
    for chi, psi1 in IMPACTS:
        recorder = Recorder((), with_fields=True)
        meet(way, psi1, chi, recorder=recorder)
        history = recorder.history()
        fields = history.fields
        springs = {"radius", "displacement", "limit"} <= set(fields)
        apply_if(
            springs or {"radius", "traction"} <= set(fields),
            "The law tells no tractions: fields has neither radius and traction, nor radius, "
            "displacement and limit of springs.",
        )
        modulus = float(np.asarray(scene(psi1, chi).pair.effective_shear_modulus))
        largest = float(history.contact_radius.max())
        for row, edge in enumerate(history.contact_radius.tolist()):
            if edge < SMALL * largest:
                continue
            positions = np.asarray(fields["radius"][row], float)
            if "traction" in fields:
                inside = positions < edge
                radii, tractions = (
                    positions[inside],
                    np.asarray(fields["traction"][row], float)[inside],
                )
            else:
                radii, tractions = springs_traction(
                    positions, np.asarray(fields["displacement"][row], float), edge, modulus
                )
            peak = 1.5 * FRICTION * float(history.normal_force[row]) / (np.pi * edge**2)
            excess = np.abs(tractions) - peak * np.sqrt(np.maximum(1.0 - (radii / edge) ** 2, 0.0))
            worst_here = (
                float(np.max(excess, initial=-np.inf)) / (2.0 / 3.0 * peak) if peak else -np.inf
            )
            if worst_here > worst:
                at = float(radii[int(excess.argmax())]) / edge
                worst, where = worst_here, f"psi1 = {psi1}, chi = {chi:.3g}, r = {at:.2g} b"
    hold(
        worst <= ROOM,
        f"The traction exceeds mu p by {worst:.2g} of the mean of mu p, at {where} under "
        f"{type(normal_law).__name__}; {ROOM} is the bound.",
    )


def springs_traction(
    places: Array, displacement: Array, edge: float, modulus: float
) -> tuple[Array, Array]:
    """Return radii (m) and tractions (Pa) of a bundle of springs, shape (number inside b,).

    q(r) = -(G*/pi) times the integral of w'(s)/sqrt(s² - r²) from r to b (Abel). The result is
    exact if w is linear in s² between springs, and zero at b.

    Parameters
    ----------
    places, displacement : array, shape (n,)
        Distance s from the axis and deflection w of the springs, in m.
    edge : float
        Contact radius b, in m.
    modulus : float
        Effective shear modulus G*, in Pa.
    """
    inside = places < edge
    knots = np.append(places[inside], edge) ** 2
    values = np.append(displacement[inside], 0.0)
    radii = np.sqrt(0.5 * (knots[1:] + knots[:-1]))
    slopes = np.diff(values) / np.diff(knots)
    roots = np.sqrt(np.maximum(knots[None, :] - radii[:, None] ** 2, 0.0))
    return radii, -(2.0 * modulus / np.pi) * (np.diff(roots, axis=1) @ slopes)
