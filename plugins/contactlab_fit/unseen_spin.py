"""The spin of a ball in a film without an angle, from the moment about the contact."""

from __future__ import annotations

import attrs
import numpy as np

from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Real
from contactlab_fit.measurements import Measurements

#: The velocity that friction changes together with the spin.
ALONG = "rebound_tangential_velocity"
FIRST = (
    "spin = 0 rad/s before the first bounce of each throw; before later ones it follows from the "
    "moment about the contact"
)


def with_spins(table: Measurements, scene: Scene, spin: Real | None) -> Measurements:
    """Return the impacts of a film without an angle with their spins before.

    Parameters
    ----------
    table : Measurements
        With ``thrown``.
    scene : Scene
        Impacts of a ball on a level floor.
    spin : float or None
        Spin before the first bounce, in rad/s, if the scene has it; None takes 0.

    Raises
    ------
    ValueError
        If bounces follow one another and the bodies are others.

    Notes
    -----
    The forces of a level floor have no moment about the point of contact, whatever the law of
    friction: I w - m R v, with w positive where v grows, is the same before and after each bounce,
    and in flight. So w - w0 = (v - v0)/(K² R) with the velocity v0 and the spin w0 of the throw.
    The error of v0 is common to its later bounces; a rebound moves by at most about as much.
    """
    velocity, first = table.given["tangential_velocity"], table.thrown["velocity"]
    seen = np.isfinite(first)
    change = np.where(seen, velocity - first, 0.0)
    later = change != 0.0
    taken = () if spin is not None else (FIRST,)
    given, errors, measured = dict(table.given), dict(table.errors), dict(table.measured)
    notes = table.notes
    if later.any():
        ball = scene.sphere
        if not isinstance(ball, Sphere) or not isinstance(scene.target, HalfSpace):
            raise ValueError(
                f"{table.source or 'the film'}: angle: is missing. For this body the spin between "
                "bounces cannot be inferred; add a column angle (deg)"
            )
        per_velocity = 1.0 / (ball.gyration_ratio**2 * ball.radius)
        given["spin"] = (0.0 if spin is None else spin) + change * per_velocity
        if ALONG in errors:
            wider = np.hypot(errors[ALONG], table.thrown["error"])
            errors[ALONG] = np.where(later, wider, errors[ALONG])
    if not seen.all() and ALONG in measured:
        measured[ALONG] = np.where(seen, measured[ALONG], np.nan)
        notes = (
            *notes,
            f"{ALONG}: left out after bounces of unknown spin: the throw has too few frames "
            "before its first bounce",
        )
        if not seen.any():
            del measured[ALONG], errors[ALONG]
    return attrs.evolve(
        table,
        given=given,
        measured=measured,
        errors=errors,
        notes=notes,
        taken=(*table.taken, *taken),
        thrown={},
    )
