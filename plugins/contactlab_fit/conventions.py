"""Headings of ambiguous sign or angle: every reading, and the fit by each."""

from __future__ import annotations

import itertools
import re
import shlex
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from contactlab.numeric.types import Array

#: A tangential restitution, of the contact point or of the centre; the literature's first.
E_T = {
    "beta0": "is -psi2/psi1 of the contact point, the beta0 of the literature",
    "-beta0": "is psi2/psi1 of the contact point",
    "tangential_restitution": "is v_t after over before of the centre",
}
#: Angles before and after, and the words for their reference.
FROM_NORMAL, FROM_SURFACE = "is from the normal", "is from the surface"
OTHER_SIDE = "is from the normal, on the other side than before"
OF_SURFACE = re.compile(r"surface|grazing|horizontal|wall|plane|floor")
OF_NORMAL = re.compile(r"normal")
#: Words of sports, whose angles are from the ground.
OF_SPORTS = re.compile(r"descent|landing|launch|approach|elevation")
#: Speeds of launch monitors without a unit.
OF_MONITORS = ("mph", "m/s", "km/h")
#: Velocities that may be magnitudes if no number is below 0.
SIGNED = ("rebound_tangential_velocity", "rebound_slip_velocity")
#: Most readings that a message lists.
LISTED = 6


class Reading(NamedTuple):
    """One way to read the headings: words on it, and names by heading."""

    words: str
    columns: Mapping[str, str]


class Result(NamedTuple):
    """The fit by one reading, in words, and whether the command runs."""

    words: str
    runs: bool


class ForeignHeadingsError(ValueError):
    """Headings that are not contactlab's names.

    ``said`` is the message, ``readings`` are the possible names, ``columns`` the first of them.
    A note of the error has each reading of several, with the command if it runs.
    """

    def __init__(
        self,
        said: str,
        readings: Sequence[Reading],
        command: str = "",
        gives: Sequence[Result] = (),
    ) -> None:
        self.said, self.readings = said, readings
        options = [
            " ".join(
                f"--column {shlex.quote(f'{text.strip()}={name}')}"
                for text, name in reading.columns.items()
            )
            for reading in readings
        ]
        if len(readings) == 1:
            what = f"paste: {command}" if command else "add"
            super().__init__(f"{said}; if these names and units are right, {what} {options[0]}")
            return
        super().__init__(f"{said}; no heading tells which of {len(readings)} readings is right:")
        results = gives or [Result("", runs=True)] * len(readings)
        for reading, more, result in zip(readings, options, results, strict=True):
            words = f"{reading.words} ({result.words})" if result.words else reading.words
            line = f"{command} {more}" if command and result.runs else more
            self.add_note(f"if {words}:\n    {line}")

    @property
    def columns(self) -> Mapping[str, str]:
        """Names by heading of the first reading."""
        return self.readings[0].columns


def ways(text: str, guess: str, numbers: Array, *, club: bool) -> dict[str, str]:
    """Return the names that a heading may mean, the likeliest first, each with words on it."""
    plain, name = text.lower(), guess.lstrip("-")
    if guess == "e_t":
        return E_T
    if name in ("angle_deg", "rebound_angle_deg") and "loft" not in plain:
        sign = "-" if guess.startswith("-") or (name == "angle_deg" and np.all(numbers < 0)) else ""
        surface = name.replace("angle_deg", "angle_from_surface_deg")
        angles = {f"{sign}{name}": FROM_NORMAL, f"{sign}{surface}": FROM_SURFACE}
        if OF_SURFACE.search(plain):
            return {f"{sign}{surface}": FROM_SURFACE}
        if OF_SPORTS.search(plain):
            angles = dict(reversed(angles.items()))
        if OF_NORMAL.search(plain):
            del angles[f"{sign}{surface}"]
        if name != "angle_deg":
            angles["" if sign else f"-{name}"] = OTHER_SIDE
        return angles
    if name in SIGNED and np.all(numbers >= 0.0):
        return {guess: "has its sign", f"|{name}|": "is a size without sign"}
    if club and name == "speed" and not re.search(r"[(\[]", text):
        return {f"{guess} ({unit})": f"is in {unit}" for unit in OF_MONITORS}
    return {guess: ""}


def readings(found: Mapping[str, Mapping[str, str]]) -> list[Reading]:
    """Return the readings of all headings, the likeliest first.

    Angles of one table are all from the normal, or all from the surface.
    """
    whole = []
    for choice in itertools.product(*(each.items() for each in found.values())):
        froms = {words for _, words in choice if words in (FROM_NORMAL, FROM_SURFACE, OTHER_SIDE)}
        if FROM_SURFACE in froms and len(froms) > 1:
            continue
        places = [
            [*each].index(name) for each, (name, _) in zip(found.values(), choice, strict=True)
        ]
        moved = sum(map(bool, places))
        told = [
            f"{text.strip()} {words}"
            for (text, each), (_, words) in zip(found.items(), choice, strict=True)
            if len(each) > 1
        ]
        names = {text: name for text, (name, _) in zip(found, choice, strict=True)}
        whole.append((moved, sum(places), Reading(" and ".join(told), names)))
    whole.sort(key=lambda one: one[:2])
    return [reading for *_, reading in whole[:LISTED]]
