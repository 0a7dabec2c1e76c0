"""Drops of a ball: heights before and after a bounce, and times of taps on the floor.

A flight of height h without air begins and ends with the speed sqrt(2 g h), one of duration d with
g d/2. So the normal restitution of a bounce is sqrt(h2/h1), or d2/d1.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from contactlab.numeric.types import Array
from contactlab.numeric.units import convertible, factor
from contactlab_fit.csv_columns import name_and_unit

#: Standard gravity in m/s²; local gravity differs by up to 0.3 %.
GRAVITY = 9.80665
#: Headings of drops, and their units.
DROP, BOUNCE, TAP = "drop_height", "bounce_height", "t_bounce"
DROPS = {DROP: "m", BOUNCE: "m", TAP: "s"}
#: Assumptions about drops.
TAKEN = (
    f"gravity = {GRAVITY} m/s², of flights without air",
    "tangential_velocity = 0 m/s: the ball comes straight down",
)


def find_drops(headings: Mapping[str, str]) -> dict[str, tuple[str, float]]:
    """Return the headings of a drop by name, each with the factor to SI; empty for another table.

    Parameters
    ----------
    headings : mapping of str to str
        Name or heading to be read, by heading.

    Raises
    ------
    ValueError
        If a heading has no unit of its quantity, or the height of a bounce stands alone.
    """
    found: dict[str, tuple[str, float]] = {}
    for text, alias in headings.items():
        try:
            _, name, unit = name_and_unit(alias)
            unit = unit or name_and_unit(text)[2]
        except ValueError:
            continue  # the reader of headings refuses it
        if name not in DROPS:
            continue
        own = DROPS[name]
        if (times := factor(unit, own)) is None:
            reason = f"{unit} is no unit of it" if unit else "has no unit"
            raise ValueError(f"heading {text!r}: {reason}; give it in {convertible(own)}")
        if name in found:
            raise ValueError(f"heading {text!r}: {name} is there twice")
        found[name] = text, times
    if found and set(found) not in ({DROP, BOUNCE}, {TAP}):
        rule = "drops have drop_height and bounce_height, or the times t_bounce alone"
        raise ValueError(f"{rule}; had: {', '.join(found)}")
    return found


def restitutions(columns: Mapping[str, Array]) -> tuple[Array, Array]:
    """Return speed in m/s and normal restitution of each bounce, shapes (n,).

    Parameters
    ----------
    columns : mapping of str to array
        ``drop_height`` and ``bounce_height`` in m, or ``t_bounce`` in s.

    Raises
    ------
    ValueError
        If a height is not positive, a ball rises above its drop, or times do not grow or leave
        fewer than two flights, or a flight is longer than the one before it.
    """
    if TAP in columns:
        return _of_taps(columns[TAP])
    before, after = columns[DROP], columns[BOUNCE]
    for name, heights in columns.items():
        if not (heights > 0.0).all():
            raise ValueError(f"{name}: must be positive; heights are of the lowest point")
    if (higher := np.flatnonzero(after > before)).size:
        row = f"row {higher[0] + 1}: {after[higher[0]]:.4g} m after {before[higher[0]]:.4g} m"
        raise ValueError(f"{BOUNCE}: is above {DROP} in {row}; exchange the two, or check the row")
    return np.sqrt(2.0 * GRAVITY * before), np.sqrt(after / before)


def _of_taps(times: Array) -> tuple[Array, Array]:
    """Return speeds and restitutions of the taps between the first and the last."""
    flights = np.diff(times)
    if len(flights) < 2:
        raise ValueError(f"{TAP}: has {len(times)} taps; a restitution needs three")
    if not (flights > 0.0).all():
        raise ValueError(f"{TAP}: must grow; give the times of one ball, in their order")
    if (longer := np.flatnonzero(np.diff(flights) > 0.0)).size:
        place = int(longer[0]) + 2
        rule = f"the time to tap {place + 1} is longer than the one to tap {place}"
        raise ValueError(f"{TAP}: {rule}; was one missed? Give each row of taps alone")
    return 0.5 * GRAVITY * flights[:-1], flights[1:] / flights[:-1]


def tell_restitutions(speed: Array, restitution: Array) -> str:
    """Return the restitution of each bounce in words, of ten at most."""
    each = ", ".join(
        f"{e:.3f} at {v:.3g} m/s" for v, e in zip(speed[:10], restitution, strict=False)
    )
    return f"normal_restitution of the bounces: {each}" + (", ..." if len(speed) > 10 else "")
