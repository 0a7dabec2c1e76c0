"""Measured impacts on a body that moves: a club, a racket, a puck, the second ball."""

from __future__ import annotations

import numpy as np

from contactlab.numeric.types import Array
from contactlab.scene_file.entries import STRUCK_KEYS

#: Columns of the struck body: its velocity along the normal and along the surface, and its spin.
VELOCITY, SPIN = STRUCK_KEYS[:2], STRUCK_KEYS[2]
#: Rebound angles, of which one may be measured beside the rebound speed.
ANGLES = {"rebound_angle_deg": np.pi / 180.0, "rebound_angle": 1.0}
NORMAL, TANGENTIAL, SPEED = (
    "rebound_normal_velocity", "rebound_tangential_velocity", "rebound_speed",
)  # fmt: skip


def to_the_struck_body(
    given: dict[str, Array], measured: dict[str, Array], errors: dict[str, Array]
) -> None:
    """Change columns from the frame of the laboratory to that of the struck surface.

    Only relative velocities count in an impact: the answer is that for a struck body at rest. The
    columns of the struck surface are taken out. Spins, contact times, and the restitutions of the
    normal motion and of slip are the same in both frames.

    Raises
    ------
    ValueError
        If a column cannot be changed without another one.
    """
    normal, tangential = _velocity(given)
    zero = np.zeros_like(normal)
    u_n, u_t = (given.pop(name, zero) for name in VELOCITY)
    if "tangential_restitution" in measured:  # of the centre, in the frame of the laboratory
        _refuse_errors(errors, "tangential_restitution", TANGENTIAL)
        along = measured.pop("tangential_restitution") * tangential
        measured.setdefault(TANGENTIAL, along)
    angles = [name for name in ANGLES if name in measured]
    if angles or SPEED in measured:
        if len(angles) != 1 or SPEED not in measured:
            raise ValueError(
                f"{', '.join([*angles, *measured.keys() & {SPEED}])}: where the struck body moves, "
                f"{SPEED} and one rebound angle are needed together, or {NORMAL} and {TANGENTIAL}"
            )
        for name in (SPEED, angles[0]):
            _refuse_errors(errors, name, f"{NORMAL} and {TANGENTIAL}")
        size, angle = measured.pop(SPEED), measured.pop(angles[0]) * ANGLES[angles[0]]
        measured.setdefault(NORMAL, -size * np.cos(angle))
        measured.setdefault(TANGENTIAL, size * np.sin(angle))
    for name in ("local_rebound_angle", "local_rebound_angle_deg"):
        if name in measured:
            raise ValueError(
                f"{name}: is not the same to a struck body that moves; give {NORMAL} and "
                f"{TANGENTIAL}"
            )
    for name, frame in ((NORMAL, u_n), (TANGENTIAL, u_t)):
        if name in measured:
            measured[name] = measured[name] - frame
    normal, tangential = normal - u_n, tangential - u_t
    if not np.all(normal > 0.0):
        row = int(np.argmin(normal))
        raise ValueError(
            f"{VELOCITY[0]}: in impact {row + 1} the bodies part, at {-normal[row]:.4g} m/s; it is "
            "positive away from the sphere, negative towards it"
        )
    given["speed"] = np.hypot(normal, tangential)
    given["angle_deg"] = np.degrees(np.arctan2(tangential, normal))


def _velocity(given: dict[str, Array]) -> tuple[Array, Array]:
    """Return the velocity of the sphere, normal and tangential, and take it out of the columns."""
    if {"normal_speed", "tangential_velocity"} <= given.keys():
        return given.pop("normal_speed"), given.pop("tangential_velocity")
    if {"normal_speed", "angle_deg"} <= given.keys():
        normal = given.pop("normal_speed")
        return normal, normal * np.tan(np.radians(given.pop("angle_deg")))
    if {"speed", "angle_deg"} <= given.keys():
        speed, angle = given.pop("speed"), np.radians(given.pop("angle_deg"))
        return speed * np.cos(angle), speed * np.sin(angle)
    raise ValueError(
        f"{VELOCITY[0]}: needs columns for the velocity of the sphere: speed and angle_deg, or "
        "normal_speed and tangential_velocity; 0 for a ball at rest"
    )


def _refuse_errors(errors: dict[str, Array], name: str, others: str) -> None:
    """Refuse a standard error that would have to be changed with its quantity."""
    if name in errors:
        raise ValueError(f"{name}_error: cannot be taken to a moving body; give errors of {others}")
