"""Measured slopes of psi2 over psi1: their files, and the analysis of the experimenters."""

from __future__ import annotations

import tomllib
from pathlib import Path

import attrs
import numpy as np

from contactlab.numeric.checks import GYRATION, NON_NEGATIVE, POISSON, POSITIVE, Rule, real
from contactlab.numeric.types import Array
from contactlab.outcome.files import content
from contactlab.scene_file.table import Table

#: Values of psi1 at which laws are asked, up to 4 chi, where elastic spheres slide throughout, and
#: between which lines are drawn: a slope moves by 0.001 at most.
POINTS, FINE = 32, 800
ABOUT_KEYS = ("title", "citation", "licence", "how", "notes")
BODY_KEYS = (
    "body", "target", "radius", "gyration_ratio", "poisson_ratio", "shear_modulus",
    "target_poisson_ratio", "target_shear_modulus", "restitution", "restitution_error",
    "friction_coefficient", "friction_error",
)  # fmt: skip
#: Numbers that describe a row and enter no analysis.
DESCRIBED = ("radius", "restitution_error", "friction_coefficient", "friction_error")
PAIR_KEYS = (*BODY_KEYS, "beta0", "beta0_error")
SPEED_KEYS = ("normal_speed", "slip_velocity", "rebound_normal_speed", "rebound_slip_velocity")
SPEEDS = "give the speeds of all collisions as lists, in m/s"
TELL = "write the number that was measured, or that of a table"
SLOPE = Rule(lambda value: value > -1.0, "must be greater than -1, which is slip without friction")
#: Gyration ratio of a solid sphere.
SOLID = 0.4**0.5


@attrs.frozen(kw_only=True, eq=False)
class Row:
    """A measured slope, and the impacts from which that of a law is taken.

    Attributes
    ----------
    name : str
        Body and target.
    restitution, chi : float
    beta0, error : float
        Slope -psi2/psi1 and its half-width.
    psi1 : array, shape (n,)
        Increasing; evenly spaced if the impacts are not told.
    told : bool
        True if psi1 are those of the impacts.
    """

    name: str
    restitution: float
    chi: float
    beta0: float
    error: float
    psi1: Array
    told: bool = False

    def slope_of(self, psi2: Array, restitution: float) -> float:
        """Return beta0 of a law with its own restitution, from its psi2 at ``psi1``."""
        psi1 = self.psi1
        if not self.told:
            fine = psi1[-1] * np.arange(1, FINE + 1) / FINE
            psi1, psi2 = fine, np.interp(fine, [0.0, *psi1], [0.0, *psi2])
        return slope(psi1, psi2, 2.0 * (1.0 + restitution) * self.chi)[0]


@attrs.frozen(kw_only=True, eq=False)
class SlopeFile:
    """The content of a file of slopes: its words, and a row for each pair of bodies."""

    title: str
    citation: str
    licence: str
    how: str
    notes: str
    rows: tuple[Row, ...]


def read_slopes(path: str | Path) -> SlopeFile:
    """Return the measured slopes of a TOML file, with ``[[pairs]]`` or a table ``[collisions]``.

    A pair tells its slope ``beta0`` = -psi2/psi1 and ``beta0_error``; collisions tell speeds in
    m/s, from which the slope follows. Bodies without a target are a pair of equals; lengths are in
    m and moduli in Pa.

    Raises
    ------
    ValueError
        If the file cannot be read, has an unknown key, or a number that is not physical.
    """
    file = Path(path)
    text = content(file, kind="a measured set", remedy="give the path of a TOML file")
    try:
        document = tomllib.loads(text.decode("utf-8"))
        root = Table(document, "", known=("about", "pairs", "collisions"))
        about = root.table("about", known=ABOUT_KEYS)
        if root.has("pairs") == root.has("collisions"):
            raise ValueError("give either [[pairs]] or one table [collisions]")
        rows = [
            _pair(Table(item, f"pairs[{number}]", known=PAIR_KEYS))
            for number, item in enumerate(document.get("pairs", ()))
        ] or [_collisions(root.table("collisions", known=(*BODY_KEYS, *SPEED_KEYS)))]
        words = {key: about.text(key, remedy=f"write {key} = ...").strip() for key in ABOUT_KEYS}
    except ValueError as error:  # errors of TOML and of UTF-8 too
        raise ValueError(f"{file}: {error}") from error
    return SlopeFile(**words, rows=tuple(rows))


def slope(psi1: Array, psi2: Array, crossing: float) -> tuple[float, float]:
    """Return beta0 and its standard error by least squares, as experimenters take it.

    Parameters
    ----------
    psi1, psi2 : array, shape (n,)
        Impacts by increasing psi1.
    crossing : float
        Change of slip throughout, 2 (1 + e) chi: the line psi2 = -beta0 psi1 crosses the line of
        slip throughout at crossing/(1 + beta0), and impacts beyond do not count.

    References
    ----------
    Foerster, Louge, Chang & Allia, Phys. Fluids 6 (1994) 1108, doi:10.1063/1.868282.
    """
    slopes = -np.cumsum(psi1 * psi2) / np.cumsum(psi1**2)
    below = np.flatnonzero(psi1 * (1.0 + slopes) <= crossing)
    count = int(below[-1]) + 1 if below.size else 1
    beta0, psi1, rest = float(slopes[count - 1]), psi1[:count], psi2[:count]
    rest = rest + beta0 * psi1
    variance = rest @ rest / max(count - 1, 1) / (psi1 @ psi1)
    return beta0, float(np.sqrt(variance))


def _pair(table: Table) -> Row:
    chi = _chi(table)
    return Row(
        name=_name(table),
        restitution=_number(table, "restitution"),
        chi=chi,
        beta0=_number(table, "beta0", rule=SLOPE),
        error=_number(table, "beta0_error", rule=POSITIVE),
        psi1=4.0 * chi * np.arange(1, POINTS + 1) / POINTS,
    )


def _collisions(table: Table) -> Row:
    chi, e = _chi(table), _number(table, "restitution")
    approach, slip, _, rebound = (table.numbers(key, remedy=SPEEDS) for key in SPEED_KEYS)
    if not len(approach) == len(slip) == len(rebound) > 1:
        raise ValueError(f"{table.path}: speeds must be lists of one length; {SPEEDS}")
    real(table.at("normal_speed"), approach, rule=POSITIVE)
    scale = 2.0 * chi / _reach(table) / _number(table, "friction_coefficient", rule=POSITIVE)
    psi1, psi2 = scale * slip / approach, scale * rebound / approach
    order = np.argsort(psi1)
    beta0, error = slope(psi1[order], psi2[order], 2.0 * (1.0 + e) * chi)
    return Row(
        name=_name(table),
        restitution=e,
        chi=chi,
        beta0=beta0,
        error=error,
        psi1=psi1[order],
        told=True,
    )


def _chi(table: Table) -> float:
    """Return chi of two spheres, or of a sphere and a plate; equal bodies without a target."""
    poisson = _number(table, "poisson_ratio", rule=POISSON)
    modulus = _number(table, "shear_modulus", rule=POSITIVE, default=1.0)
    other = _number(table, "target_poisson_ratio", rule=POISSON, default=poisson)
    target = _number(table, "target_shear_modulus", rule=POSITIVE, default=modulus)
    along = (1.0 - poisson / 2.0) / modulus + (1.0 - other / 2.0) / target
    kappa = ((1.0 - poisson) / modulus + (1.0 - other) / target) / along
    return 0.5 * kappa * _reach(table)


def _reach(table: Table) -> float:
    """Return W_tt/W_nn, which is 1 + 1/K^2 with the gyration ratio K."""
    return 1.0 + _number(table, "gyration_ratio", rule=GYRATION, default=SOLID) ** -2


def _name(table: Table) -> str:
    """Return body and target; numbers that only describe them must be numbers too."""
    for key in DESCRIBED:
        _number(table, key, default=0.0)
    body = table.text("body", remedy="name the body")
    target = table.text("target", default=body)
    return body if target == body else f"{body} on {target}"


def _number(
    table: Table, key: str, *, rule: Rule = NON_NEGATIVE, default: float | None = None
) -> float:
    value = default if default is not None and not table.has(key) else table.require(key, TELL)
    return float(real(table.at(key), value, rule=rule))
