"""Headings in the words of other programs, and the names that they probably mean."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping

import numpy as np

from contactlab.impact.scene import entry_unit
from contactlab.numeric.names import nearest
from contactlab.numeric.units import CONVERSIONS
from contactlab.outcome.columns import QUANTITIES
from contactlab.scene_file.entries import ENTRIES
from contactlab_fit.conventions import ForeignHeadingsError, readings, ways
from contactlab_fit.csv_columns import (
    ERROR,
    HEADING,
    measurable,
    name_and_unit,
)

#: Words for the time after an impact, and for the time before it.
AFTER = {"out", "after", "post", "rebound", "exit", "outgoing", "final", "reflected", "2", "r"}
BEFORE = {
    "in", "before", "pre", "impact", "incident", "inbound", "incoming", "initial", "1", "i",
    "descent", "landing", "approach", "attack", "incidence",
}  # fmt: skip
#: Words for directions; the last of the normal ones that a table has is taken.
TANGENTIAL = {"x", "t", "tangential", "horizontal", "vx", "vt"}
CONTACT = {"slip", "sliding"}
NORMAL = {"y", "z", "n", "normal", "vertical", "vy", "vz", "vn"}
SPEEDS = {"v", "vel", "velocity", "speed", "vx", "vy", "vz", "vt", "vn", "u"}
ANGLES = {"angle", "theta", "alpha"}
SPINS = {"spin", "omega", "w", "rpm", "rotation", "backspin", "topspin", "wz", "wy"}
#: All these words; a heading with any other one is not guessed.
VOCABULARY = AFTER | BEFORE | TANGENTIAL | NORMAL | SPEEDS | ANGLES | SPINS | CONTACT
VOCABULARY |= {"ball", "of", "from", "the", "surface", "grazing", ""}
#: Names for whole headings, as patterns. A launch monitor tells sizes: struck from above the
#: contact, a ball leaves with the spin that is negative here.
WHOLE = {
    r"side_?spin": "",  # after the impact, about an axis that no scene of a plane has
    r"spin_loft": "angle_deg",
    r"attack_angle|angle_of_attack": "",  # of the club's path over ground; the incidence: its loft
    r"club(head)?_speed": "speed",
    r"back_?spin|(total_)?spin_rate": "-rebound_spin",
    r"e|e_?n|cor|(normal_)?(coefficient_of_)?restitution": "normal_restitution",
    r"e_?t(ang)?|e_tangential|tangential_cor|cor_t(angential)?": "e_t",
    r"(tangential_)?coefficient_of_(tangential_)?restitution|tangential_coefficient": "e_t",
    r"slip_restitution": "-beta0",
    r"t_?c|contact_(time|duration)|duration": "contact_time",
    r"ball_speed": "rebound_speed",
    r"launch_angle": "rebound_angle_deg",
}
#: Likeness of letters from which a heading is a misspelt name: "spni" for spin has 0.75.
MISSPELT = 0.72
#: Columns in the frame of the ground, of no use beside a club's speed.
OF_THE_GROUND = ("rebound_speed", "rebound_angle_deg")
#: Remedy for a missing angle of incidence on a club.
LOFT = (
    "the incidence is the loft of the face less the attack angle (spin loft), which no column "
    "tells: write angle_deg under [impact] of the scene"
)
#: Velocities before the impact that other columns determine.
RIVALS = (
    ({"normal_speed", "tangential_velocity"}, {"speed", "angle_deg"}),
    ({"speed", "angle_deg"}, {"normal_speed", "tangential_velocity"}),
    ({"normal_speed"}, {"speed"}),
    ({"speed"}, {"normal_speed", "tangential_velocity"}),
)


def foreign(
    unknown: Mapping[str, object], known: Collection[str], refused: list[str]
) -> tuple[str, ...]:
    """Return a sentence on columns that are left out because their headings are unknown.

    Parameters
    ----------
    unknown : mapping of str to array
        Columns whose headings name nothing here.
    known : collection of str
        Names that other columns have.
    refused : list of str
        Sentences on headings that are refused whatever the others are.

    Raises
    ------
    ValueError
        If there are such sentences.
    ForeignHeadingsError
        If some of the headings look like other words for quantities.
    """
    guesses, twice = _guesses(unknown, known)
    rest = [heading for heading in unknown if heading not in guesses and heading not in twice]
    club = _club(unknown)
    ground = [text for text in rest if (club and _guess(text) in OF_THE_GROUND) or _attacks(text)]
    left_out = "; ".join(
        f"left out, {why}: {', '.join(text.strip() for text in texts)}"
        for why, texts in (
            ("for they are of the ground, where the club's speed is relative", ground),
            ("for others tell the same velocities", twice),
            ("for nothing here has such names", [text for text in rest if text not in ground]),
        )
        if texts
    )
    named = {name.lstrip("-") for each in guesses.values() for name in each}
    if any(map(_attacks, ground)) and "angle_deg" not in {*known, *named}:
        left_out = f"{left_out}; {LOFT}"
    if guesses:
        parts = [left_out] if left_out else []
        parts = [*refused, "headings look like other words for quantities here", *parts]
        raise ForeignHeadingsError("; ".join(parts), readings(guesses))
    if refused:
        raise ValueError(". And ".join(refused))
    return (left_out,) if left_out else ()


def _guesses(
    unknown: Mapping[str, object], known: Collection[str]
) -> tuple[dict[str, dict[str, str]], list[str]]:
    """Return the ways to read each column, each name once, and columns that others determine."""
    found: dict[str, dict[str, str]] = {}
    meant: dict[str, str] = {}
    errors: dict[str, str] = {}
    taken = {*known}
    headings = sorted(unknown, key=lambda text: "vz" not in text.lower())  # z before y
    club = _club(unknown)
    if any("loft" in text.lower() and "spin" in text.lower() for text in unknown):
        headings.sort(key=lambda text: "loft" not in text.lower())
    for text in headings:
        guess = _guess(text)
        if guess == "spin" and guess in taken:
            guess = "rebound_spin"
        name = guess.lstrip("-")
        if name_and_unit(text)[0]:
            errors[text] = name
            continue
        if not guess or name in taken or (club and name in OF_THE_GROUND):
            continue
        try:
            numbers = np.asarray(unknown[text], dtype=float)
        except (TypeError, ValueError):  # words
            continue
        sized = numbers[np.isfinite(numbers)]
        if not sized.size:
            continue
        taken.add(name)
        if name == "rebound_normal_velocity" and np.all(sized >= 0.0):
            guess = f"-{name}"  # away from the target is negative here
        if name == "normal_speed" and np.all(sized <= 0.0):
            guess = f"-{name}"
        meant[text] = name
        each = ways(text, guess, sized, club=club)
        found[text] = {_with_unit(text, way, club=club): words for way, words in each.items()}
    for text, name in errors.items():
        if name in measurable() and name in taken:  # an error of either sign is the same
            found[text] = {_with_unit(text, name, club=club).replace(name, f"{name}{ERROR}"): ""}
    twice: set[str] = set()
    for had, rivals in RIVALS:
        names = {*known, *meant.values()} - {meant[text] for text in twice}
        if had <= names:
            twice |= {text for text, name in meant.items() if name in rivals}
    kept = {text: found[text] for text in unknown if text in found and text not in twice}
    return kept, [text for text in unknown if text in twice]


def _attacks(text: str) -> bool:
    """Return whether a heading names the angle at which a club's path meets the ground."""
    return re.search(r"attack", text.lower()) is not None


def _club(headings: Iterable[str]) -> bool:
    """Return whether headings are those of a launch monitor that measures the club."""
    return any("club" in text.lower() for text in headings)


def _guess(text: str) -> str:
    """Return the name that a heading probably means, with its sign; empty for none."""
    plain = re.sub(r"([a-z])([A-Z])", r"\1_\2", HEADING.sub(r"\1", text.strip()))
    name = name_and_unit(plain)[1]
    for pattern, meant in WHOLE.items():
        if re.fullmatch(pattern, name):
            return meant
    words = set(re.split(r"[^a-z0-9]+", re.sub(r"(?<=[a-z])(\d)$", r"_\1", name)))
    after = bool(words & AFTER)
    if not words <= VOCABULARY:
        return _nearest(name)
    if words & SPINS:
        sign = "-" if "topspin" in words else ""
        return f"{sign}{'rebound_spin' if after else 'spin'}"
    if words & ANGLES:
        return "rebound_angle_deg" if after else "angle_deg"
    if words & (SPEEDS | CONTACT):
        if words & CONTACT:
            return "rebound_slip_velocity" if after else ""
        if words & TANGENTIAL:
            return "rebound_tangential_velocity" if after else "tangential_velocity"
        if words & NORMAL:
            return "rebound_normal_velocity" if after else "normal_speed"
        return "rebound_speed" if after else "speed"
    return _nearest(name)


def _nearest(name: str) -> str:
    """Return the quantity that a misspelt name means; empty for none."""
    dotted = "." in name
    known = [each for each in (*ENTRIES, *measurable()) if ("." in each) is dotted]
    stripped = name.strip("|")
    near = re.search(r"did you mean '([\w.]+)'", nearest(stripped, known, alike=MISSPELT))
    alike = near and near[1].count("_") == name.count("_")  # a word more is another quantity
    return near[1] if near and alike else ""


def _with_unit(text: str, guess: str, *, club: bool) -> str:
    """Return a name with the unit of its heading, or that of SI if the heading tells none."""
    name = guess.lstrip("-")
    if name.endswith(("_deg", ")")):
        return guess
    own = entry_unit(name) if name in ENTRIES else QUANTITIES[name].unit
    if own == "1":
        return guess
    turns = own == "rad/s" and (club or "rpm" in text.lower())
    stated = name_and_unit(text)[2] or ("rpm" if turns else own)
    return f"{guess} ({stated})" if (stated, own) in CONVERSIONS else f"{guess} ({own})"
