"""Impacts from a film: positions over time before and after each bounce."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.checks import POSITIVE, real, refuse
from contactlab.numeric.types import Array, Real
from contactlab.numeric.units import CONVERSIONS, factor
from contactlab_fit.conventions import ForeignHeadingsError, Reading
from contactlab_fit.csv_columns import (
    NUMBER,
    name_and_unit,
    read_numbers,
    read_text,
)
from contactlab_fit.drops import GRAVITY, tell_restitutions
from contactlab_fit.measurements import Measurements, column_of

#: Columns of a film and their units; without z the flight stays in the plane of x and y.
FILM = {"t": "s", "frame": "1", "x": "m", "y": "m", "z": "m", "angle": "rad"}
#: Ways to write that a place is in pixels.
PIXELS = ("px", "pixel", "pixels", "pix")
#: Other names of columns.
ALSO = {"time": "t", "angle_deg": "angle", "rotation": "angle", "height": "y"}
#: Headings of frames and of times, and those of places that programs write.
FRAME, TIMES = ("frame",), ("t", "time", "t (s)", "time (s)")
PLACE = re.compile(r"([xyz])\d*")
#: Relative differences of the fall from g that are told, and that refuse the film.
TOLD, REFUSED = 0.03, 0.15
#: Columns before the impact.
GIVEN = ("normal_speed", "tangential_velocity", "spin")
#: Least count of frames of a flight.
FRAMES = 5
#: A pause of so many frames ends a throw, and so does a time that goes back.
PAUSE = 8.0
#: A lowest place counts as a touch if the ball rises by so many times the scatter on both sides.
RISE = 6.0
#: And by at least so many m.
LEAST_RISE = 1e-6
#: A normal distribution's standard deviation over its median deviation.
NORMAL = 1.4826
#: Scatter about parabolas over that of frames in turn, and over the range of y, that is refused.
ROUGH, FLAT = 5.0, 2e-3
#: Most passes that sort the frames next to a touch.
PASSES = 20


class Flight(NamedTuple):
    """One flight: ``lines`` are (value, slope) over time of x, z, angle and of y + g t²/2.

    ``rests`` are the residuals of each, shape (frames,); ``reach`` the root of the sum of the
    squared times about their mean, in s, over which a scatter is the standard error of a slope.
    """

    lines: Mapping[str, tuple[float, float]]
    rests: Mapping[str, Array]
    reach: float


def read_flight(
    content: str | Path | Mapping[str, object],
    *,
    columns: Mapping[str, str] | Sequence[str] | None = None,
    frame_rate: float | None = None,
) -> Measurements:
    """Return the bounces of a film as measured impacts, with standard errors.

    Parameters
    ----------
    content : path or mapping
        Columns ``t (s)``, ``x (m)`` and ``y (m)`` of the centre of the ball, ``y`` upwards from a
        level floor; optionally ``z (m)`` and ``angle (deg)``, which grows from x to y. Any number
        of bounces. A time that goes back, or a pause, begins another throw. Positions in ``(px)``
        are scaled so that the flights fall with g, and y is turned if it grows downwards. Frames
        in which the ball is held, or lies at rest, are left out and told.
    columns : mapping of str to str, or sequence of str, optional
        Names for headings of another kind, ``{"frame time [ms]": "t"}``; ``"-y"`` turns a sign. A
        sequence names the columns of a file without headings.
    frame_rate : float, optional
        Frames a second, for a column ``frame`` in place of ``t``.

    Returns
    -------
    Measurements
        Velocities along the normal and along the way of the ball over the floor in m/s, and with
        ``angle`` spins in rad/s. Without it a fit takes the spins before each bounce from the
        moment about the contact, of a ball that is thrown with the spin of the scene.

    Raises
    ------
    ValueError
        If the film cannot be read, has no bounce with enough frames on both sides, or does not
        fall with the acceleration of gravity, as with a wrong unit or frame rate.

    Notes
    -----
    Frames between touches are fitted by parabolas that fall with g, by least squares; a touch is
    where two of them meet. Air and the duration of contact are left out. The scatter is that of
    all frames of the film about their parabolas. Errors of velocities before the impact are added
    to those after it.
    """
    source = ""
    table: Mapping[str, object]
    if isinstance(content, str | Path):
        source = str(content)
        table = read_numbers(_table_of(read_text(Path(content)), source, columns), source)
    elif isinstance(content, Mapping):
        table = content
    else:
        raise refuse("film", content, "must be a CSV file, or a mapping of columns")
    names = columns if isinstance(columns, Mapping) else {}
    names = {text.strip(): name for text, name in names.items()}
    rate = None if frame_rate is None else real("frame_rate", frame_rate, rule=POSITIVE)
    try:
        film, in_pixels = _film(table, names, rate)
        found = _bounces(film, in_pixels=in_pixels)
    except ForeignHeadingsError as error:
        said = f"{source}: {error.said}" if source else error.said
        raise ForeignHeadingsError(said, error.readings) from None
    except ValueError as error:
        raise ValueError(f"{source}: {error}" if source else str(error)) from None
    return attrs.evolve(found, source=source)


def _table_of(text: str, source: str, columns: object) -> str:
    """Return the text of a film with one line of headings: the last before the numbers.

    Programs that track marks write the names of marks above it, or below.
    """
    lines = [line for line in text.splitlines() if line.strip()]
    cells = [re.split(r"[;\t]" if re.search(r"[;\t]", line) else ",", line) for line in lines]
    first = next((place for place, row in enumerate(cells) if NUMBER.match(row[0].strip())), 0)
    headings = [n for n in range(first) if len(cells[n]) == len(cells[first]) > 1]
    if isinstance(columns, Mapping) or columns is None:
        above = lines[:first] if not headings else [lines[headings[-1]]]
        return "\n".join((*above, *lines[first:]))
    if headings:
        remedy = "name them by --column 'HEADING=x', a mapping in Python"
        raise ValueError(f"{source}: has headings; {remedy}")
    mark = next((mark for mark in (";", "\t") if mark in lines[first]), ",")
    return "\n".join((mark.join(map(str, columns)), *lines[first:]))  # type: ignore[call-overload]


def _film(
    table: Mapping[str, object], names: Mapping[str, str], rate: Real | None
) -> tuple[dict[str, Array], bool]:
    """Return the columns of a film in SI, or with places in pixels, and True for pixels.

    Frames that lack a number are left out.
    """
    film: dict[str, Array] = {}
    in_pixels: set[bool] = set()
    for text, values in table.items():
        alias = names.get(text.strip(), text)
        sign = -1.0 if alias is not text and alias.startswith("-") else 1.0
        _, name, unit = name_and_unit(alias.removeprefix("-") if sign < 0.0 else alias)
        unit = unit or (name_and_unit(text)[2] if alias is not text else "")
        if name == "angle_deg":
            unit = unit or "deg"
        name = ALSO.get(name, name)
        if name not in FILM or alias.strip().startswith("#"):
            continue
        own = FILM[name]
        if name == "frame":
            film["t"] = column_of(text, values, gaps=True) / _need_rate(rate, table)
            continue
        if own == "m":
            in_pixels.add(unit in PIXELS)
        if own == "m" and unit in PIXELS:
            film[name] = sign * column_of(text, values, gaps=True)
            continue
        if (times := factor(unit, own)) is None:
            known = ", ".join(f"({each})" for each, to in CONVERSIONS if to == own)
            reason = f"is in {unit}, which is not known here" if unit else "has no unit"
            more = ", (px)" if own == "m" else ""
            raise ValueError(
                f"heading {text!r}: {reason}; write '{name} ({own})', or {known}{more}"
            )
        film[name] = sign * times * column_of(text, values, gaps=True)
    for name in ("t", "x", "y"):
        if name not in film:
            _tell_places(table, film)
            raise ValueError(
                f"{name}: is missing; a film needs the columns t (s), x (m), y (m); name one by "
                f"--column 'HEADING={name}'. Columns found: {', '.join(table)}"
            )
    if len(in_pixels) > 1:
        raise ValueError("x, y, z: some are in pixels and some are not; give all in one unit")
    whole = np.all([np.isfinite(values) for values in film.values()], axis=0)
    return {name: values[whole] for name, values in film.items()}, in_pixels == {True}


def is_film(headings: Iterable[str]) -> bool:
    """Return whether headings are of times and of places, as those of a film."""
    names = {text.strip().lower() for text in headings}
    return bool(names & {*FRAME, *TIMES}) and bool({*map(_place, headings)} >= {"x", "y"})


def _place(heading: str) -> str:
    """Return x, y or z for a heading of a place, such as X1; empty for another."""
    found = PLACE.fullmatch(name_and_unit(heading)[1])
    return found[1] if found else ""


def _tell_places(table: Mapping[str, object], film: Mapping[str, Array]) -> None:
    """Refuse headings such as X1 and Y1 with what they probably mean, in pixels or in m."""
    found = {text: place for text in table if (place := _place(text)) and place not in film}
    units = {name_and_unit(text)[2] for text in found}
    if not {"t", "x", "y"} <= {*found.values(), *film} or len({*found.values()}) < len(found):
        return
    told = {"(px)": "places are in pixels", "(m)": "places are in m"}
    if units != {""}:
        told = {"": ""}
    ways = [
        Reading(words, {text: f"{place} {unit}".strip() for text, place in found.items()})
        for unit, words in told.items()
    ]
    raise ForeignHeadingsError("headings look like other words for those of a film", ways)


def _need_rate(rate: Real | None, table: Mapping[str, object]) -> Real:
    """Return the frame rate, or refuse frames without it."""
    if rate is None:
        raise ValueError(
            "frame: needs the frames a second; give --fps 240 (frame_rate=240 in Python), or the "
            f"times t (s); had: {', '.join(table)}"
        )
    return rate


def _bounces(film: dict[str, Array], *, in_pixels: bool) -> Measurements:
    """Return the impacts of a film."""
    throws = list(_throws(film))
    step = float(np.median(np.concatenate([np.diff(throw["t"]) for throw in throws])))
    pairs: list[tuple[Flight, Flight, float, Flight | None]] = []
    notes: list[str] = []
    if in_pixels:
        throws, scale = _scale(throws)
        notes.append(scale)
    throws, left_out = _in_flight(throws)
    notes += left_out
    every: list[Flight] = []
    for throw in throws:
        flights, times = _flights(throw, step)
        every += [flight for flight in flights if flight]
        for one, other, time in zip(flights, flights[1:], times, strict=False):
            if one and other:
                pairs.append((one, other, time, flights[0]))
            else:
                notes.append(
                    f"bounces with fewer than {FRAMES} frames before or after are left out"
                )
    if not pairs:
        raise ValueError(
            f"no bounce has {FRAMES} frames before and after; give more frames, or check that y "
            "is the height of the centre and grows upwards (else --column 'y=-y')"
        )
    fall = _fall(throws, step)
    scatter = {
        name: _scatter([flight.rests[name] for flight in every]) for name in film if name != "t"
    }
    noise = max(_noise(throw["t"], throw["y"]) for throw in throws if len(throw["t"]) > 2)
    if scatter["y"] > ROUGH * noise + FLAT * max(float(np.ptp(throw["y"])) for throw in throws):
        raise ValueError(
            f"y: the flights are no parabolas, off by {scatter['y']:.2g} m (rms); check that y is "
            "the height of the centre, grows upwards (else --column 'y=-y'), on a level floor"
        )
    rows = [_row(*pair, scatter) for pair in pairs]
    columns = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    thrown = {name: columns.pop(f"thrown_{name}") for name in ("velocity", "error")}
    told = [name for name in columns if f"{name}_error" in columns]
    measured = [name for name in told if columns[f"{name}_error"].all()]
    notes += [
        f"{name} is left out: its positions have no scatter"
        for name in told
        if name not in measured
    ]
    restitution = -columns["rebound_normal_velocity"] / columns["normal_speed"]
    notes.append(tell_restitutions(columns["normal_speed"], restitution))
    level = () if "z" in film else ("z = 0 m: the ball stays in the plane of x and y",)
    return Measurements(
        given={name: columns[name] for name in GIVEN if name in columns},
        measured={name: columns[name] for name in measured},
        errors={name: columns[f"{name}_error"] for name in measured},
        notes=(*dict.fromkeys(notes), *fall),
        taken=(f"gravity = {GRAVITY} m/s², of flights without air", *level),
        thrown={} if "angle" in film else thrown,
    )


def _throws(film: dict[str, Array]) -> Iterator[dict[str, Array]]:
    """Yield the frames of each throw from time 0 on, with angles that do not jump by a turn."""
    step = np.diff(film["t"])
    forward = step[step > 0.0]
    if not forward.size:
        raise ValueError("t: does not grow; give the time of each frame")
    ends = np.flatnonzero((step <= 0.0) | (step > PAUSE * float(np.median(forward)))) + 1
    for frames in np.split(np.arange(len(film["t"])), ends):
        throw = {name: values[frames] for name, values in film.items()}
        throw["t"] = throw["t"] - throw["t"][0]
        if "angle" in throw:
            throw["angle"] = np.unwrap(throw["angle"])
        yield throw


def _in_flight(throws: list[dict[str, Array]]) -> tuple[list[dict[str, Array]], list[str]]:
    """Return throws without frames in which the ball is held or at rest, and words on those frames.

    At its ends a throw stands still if its height does not change beyond the scatter for longer
    than a flight could take within it.
    """
    kept, held, rested = [], 0, 0
    for throw in throws:
        t, y = throw["t"], throw["y"]
        band = RISE * max(_noise(t, y), LEAST_RISE) if len(t) > 2 else 0.0
        first, last = 0, len(t)
        longest = 4.0 * math.sqrt(band / GRAVITY)  # up and down within twice the band
        moved = np.flatnonzero(np.abs(y - np.median(y[:FRAMES])) > band)
        if moved.size and t[moved[0]] - t[0] > longest:
            first = int(moved[0])
        moved = np.flatnonzero(np.abs(y - np.median(y[-FRAMES:])) > band)
        if moved.size and t[-1] - t[moved[-1]] > longest:
            last = int(moved[-1]) + 1
        held, rested = held + first, rested + len(t) - last
        kept.append({name: values[first:last] for name, values in throw.items()})
    told = [(held, "before the ball is let go"), (rested, "after it has come to rest")]
    return kept, [f"{count} frames {when} are left out" for count, when in told if count]


def _scale(throws: list[dict[str, Array]]) -> tuple[list[dict[str, Array]], str]:
    """Return throws in m whose places are in pixels, so that flights fall with g, and a note."""
    bends = np.concatenate([_bends(throw) for throw in throws])
    free = np.abs(bends) > 0.5 * np.quantile(np.abs(bends), 0.9) if bends.size else bends
    if not np.any(free):
        raise ValueError("y (px): no flight is long enough to find the scale; give y in m")
    bend = float(np.median(bends[free]))
    scale = -GRAVITY / bend

    def to_metres(throw: dict[str, Array]) -> dict[str, Array]:
        sizes = {"x": abs(scale), "y": scale, "z": abs(scale)}
        return {name: values * sizes.get(name, 1.0) for name, values in throw.items()}

    turned = "; y grows downwards, and is turned" if scale < 0.0 else ""
    told = f"1 px is {1e3 * abs(scale):.3g} mm, for the flights to fall with g{turned}"
    return [to_metres(throw) for throw in throws], told


def _bends(throw: dict[str, Array]) -> Array:
    """Return second derivatives of y over time of short pieces that parabolas fit."""
    t, y = throw["t"], throw["y"]
    if len(t) < FRAMES:
        return np.empty(0)
    noise, bends = _noise(t, y), []
    for first in range(len(t) - 2 * FRAMES):
        piece = slice(first, first + 2 * FRAMES)
        parabola, (rest, *_) = np.polynomial.polynomial.polyfit(
            t[piece] - t[first], y[piece], 2, full=True
        )
        if float(np.sum(rest)) < 2 * FRAMES * (3.0 * noise) ** 2:
            bends.append(2.0 * parabola[2])
    return np.array(bends)


def _flights(throw: dict[str, Array], step: float) -> tuple[list[Flight | None], list[float]]:
    """Return the flights of a throw, None for those of too few frames, and the times of touch.

    Frames within one interval of a touch are left out: the ball may deform in them.
    """
    t = throw["t"]
    times = [float(t[frame]) for frame in _touches(throw["t"], throw["y"])]
    flights: list[Flight | None] = []
    for _ in range(PASSES):
        ends = [-math.inf, *times, math.inf]
        flights = [
            _flight(throw, (t > start + step) & (t < end - step)) for start, end in pairwise(ends)
        ]
        met = [
            _meeting(one, other) if one and other else time
            for one, other, time in zip(flights, flights[1:], times, strict=False)
        ]
        if np.allclose(met, times, rtol=0.0, atol=1e-3 * step):
            break
        times = met
    return flights, times


def _touches(t: Array, y: Array) -> list[int]:
    """Return the frames nearest to the touches: the lowest, from which y rises on both sides."""
    from scipy.signal import find_peaks  # only a film needs it

    if len(t) < 3:
        return []
    frames, _ = find_peaks(-y, prominence=max(RISE * _noise(t, y), LEAST_RISE))
    return [int(frame) for frame in frames]


def _noise(t: Array, y: Array) -> float:
    """Return the scatter of y in m, from the bends of three frames in turn."""
    step = np.diff(t)
    bends = np.diff(np.diff(y) / step) * 0.5 * (step[1:] + step[:-1])
    return NORMAL * float(np.median(np.abs(bends - np.median(bends)))) / math.sqrt(6.0)


def _flight(throw: dict[str, Array], frames: NDArray[np.bool_]) -> Flight | None:
    """Return the lines through some frames, by least squares; None if there are too few."""
    from scipy.linalg import lstsq  # only a fit needs scipy

    t = throw["t"][frames]
    if len(t) < FRAMES:
        return None
    middle = float(np.mean(t))
    names = [name for name in throw if name != "t"]
    values = np.stack([throw[name][frames] for name in names], axis=-1)
    values[:, names.index("y")] += 0.5 * GRAVITY * t**2
    matrix = np.stack([np.ones_like(t), t - middle], axis=-1)
    lines, *_ = lstsq(matrix, values)
    rests = values - matrix @ lines
    return Flight(
        lines={
            name: (float(lines[0, k] - lines[1, k] * middle), float(lines[1, k]))
            for k, name in enumerate(names)
        },
        rests={name: rests[:, k] for k, name in enumerate(names)},
        reach=float(np.sqrt(np.sum((t - middle) ** 2))),
    )


def _meeting(one: Flight, other: Flight) -> float:
    """Return the time in s at which two parabolas with the same fall meet."""
    (a, b), (c, d) = one.lines["y"], other.lines["y"]
    return (a - c) / (d - b)


def _scatter(rests: list[Array]) -> float:
    """Return the standard deviation of frames about lines, each of two numbers."""
    freedom = sum(len(each) - 2 for each in rests)
    return math.sqrt(sum(float(each @ each) for each in rests) / freedom)


def _row(
    one: Flight, other: Flight, time: float, first: Flight | None, scatter: Mapping[str, float]
) -> dict[str, float]:
    """Return the numbers of one impact, and of the ``first`` flight of its throw."""
    fall = GRAVITY * time
    before, after, thrown = (
        np.array([each.lines[name][1] for name in ("x", "z") if name in each.lines])
        for each in (one, other, first or one)
    )
    way = np.ones(1)
    if len(before) > 1:
        way = before / (math.copysign(float(np.hypot(*before)), before[0]) or 1.0)
    spread = np.array([scatter[name] for name in ("x", "z") if name in scatter])
    both = math.hypot(1.0 / one.reach, 1.0 / other.reach)
    row = {
        "normal_speed": fall - one.lines["y"][1],
        "tangential_velocity": float(before @ way),
        "rebound_normal_velocity": fall - other.lines["y"][1],
        "rebound_normal_velocity_error": scatter["y"] * both,
        "rebound_tangential_velocity": float(after @ way),
        "rebound_tangential_velocity_error": float(np.linalg.norm(spread * way)) * both,
        "thrown_velocity": float(thrown @ way) if first else math.nan,
        "thrown_error": float(np.linalg.norm(spread * way)) / (first or one).reach,
    }
    if "angle" in one.lines:
        row |= {
            "spin": one.lines["angle"][1],
            "rebound_spin": other.lines["angle"][1],
            "rebound_spin_error": scatter["angle"] * both,
        }
    return row


def _fall(throws: list[dict[str, Array]], step: float) -> list[str]:
    """Return a note if the flights do not fall with g, and refuse flights far from g."""
    numbers, weights = [], []
    for throw in throws:
        t = throw["t"]
        ends = [-math.inf, *(t[frame] for frame in _touches(t, throw["y"])), math.inf]
        for start, end in pairwise(ends):
            frames = (t > start + step) & (t < end - step)
            if np.sum(frames) > FRAMES:
                part = t[frames] - np.mean(t[frames])
                numbers.append(
                    -2.0 * np.polynomial.polynomial.polyfit(part, throw["y"][frames], 2)[2]
                )
                weights.append(np.sum((part**2 - np.mean(part**2)) ** 2))
    if not weights:
        return []
    mean = float(np.average(numbers, weights=weights))
    told = f"the flights fall with {mean:.3g} m/s² in place of {GRAVITY:.3g}"
    if abs(mean / GRAVITY - 1.0) > REFUSED:
        raise ValueError(
            f"y: {told}; check its unit, the frame rate behind t, and that y grows upwards "
            "(--column 'y=-y' turns it)"
        )
    if abs(mean / GRAVITY - 1.0) > TOLD:
        return [f"{told}: the scale of the film or its frame rate may be off, or air counts"]
    return []
