"""Bodies, and the reduction of two bodies to the numbers that laws need."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache
from operator import itemgetter
from typing import TYPE_CHECKING, Any, Generic, overload

import attrs
import numpy as np

from contactlab.impact.material import A_MATERIAL, Material
from contactlab.numeric.arrays import change_entries, common_shape, lock_arrays
from contactlab.numeric.checks import (
    GYRATION,
    NON_NEGATIVE,
    POSITIVE,
    Rule,
    derive,
    instance,
    key,
    quantity,
    refuse,
)
from contactlab.numeric.names import state_arguments
from contactlab.numeric.types import Array, Each, Number, Numbers, Real

#: K of a solid homogeneous sphere: K² = 2/5.
SOLID_SPHERE_GYRATION_RATIO = math.sqrt(0.4)
#: Largest radius in m: the approach to larger ones underflows.
MOST_RADIUS = 1e100
#: From this power of ten on a product of numbers may overflow or underflow.
FAR = 70.0
RADIUS = Rule(
    lambda value: (value > 0.0) & (value <= MOST_RADIUS),
    "must be positive and finite, at most 1e100",
)


def _material() -> Any:
    """Return the attrs field for the material of a body."""
    return instance(Material, remedy=A_MATERIAL)


class _SphereArguments:
    """Arguments of a sphere: ``__init__`` as ``attrs.evolve`` is checked by, without overloads."""

    __slots__ = ()

    def __init__(
        self,
        radius: Numbers,
        material: Material,
        *,
        mass: Numbers | None = None,
        gyration_ratio: Numbers = SOLID_SPHERE_GYRATION_RATIO,
    ) -> None: ...


@state_arguments
@attrs.frozen(init=False)
class Sphere(_SphereArguments, Generic[Each]):
    """An elastic sphere.

    Parameters
    ----------
    radius : float
        R, in m.
    material : Material
        Elastic material; its density is needed if no mass is given.
    mass : float, optional
        M, in kg; by default the mass of a solid homogeneous sphere of the material's density.
    gyration_ratio : float, optional
        K = sqrt(I / (M R²)); by default K² = 2/5 of a solid homogeneous sphere.

    Raises
    ------
    ValueError
        If a value is out of range, or neither mass nor density is given.
    """

    radius: Each | float = quantity("m", rule=RADIUS, empty=True)
    material: Material[Each] = _material()
    mass: Each | float = quantity("kg", rule=POSITIVE, default=None, kw_only=True, empty=True)
    gyration_ratio: Each | float = quantity(
        "1", rule=GYRATION, default=SOLID_SPHERE_GYRATION_RATIO, kw_only=True
    )

    if TYPE_CHECKING:

        @overload
        def __new__(
            cls,
            radius: Number,
            material: Material[float],
            *,
            mass: Number | None = ...,
            gyration_ratio: Number = ...,
        ) -> Sphere[float]: ...
        @overload
        def __new__(
            cls,
            radius: Numbers,
            material: Material,
            *,
            mass: Numbers | None = ...,
            gyration_ratio: Numbers = ...,
        ) -> Sphere[Array]: ...
        def __new__(cls, *_: object, **__: object) -> Sphere: ...  # noqa: D102

    # A hash of all numbers takes longer than a collision; equal spheres have equal masses.
    def __hash__(self) -> int:
        mass = self.mass
        return hash(mass if type(mass) is float else key(mass))

    def __attrs_post_init__(self) -> None:
        if self.mass is not None:
            return
        density = self.material.density
        if density is None:
            raise refuse(
                "mass",
                None,
                "is needed where the material has no density",
                "give Sphere(mass=...) in kg or Material(density=...) in kg/m³",
            )
        solid = 4.0 / 3.0 * math.pi * self.radius * self.radius * self.radius * density
        given = {"radius": self.radius, "density": density}
        mass = derive("mass", solid, "check the units, or give mass", **given)
        object.__setattr__(self, "mass", mass)


@state_arguments
@attrs.frozen(init=False)
class HalfSpace(Generic[Each]):
    """An elastic body with a plane surface, so large that no impact changes its motion.

    Parameters
    ----------
    material : Material
        Elastic material; the density is not used.
    """

    material: Material[Each] = _material()

    def __init__(self, material: Material[Each]) -> None: ...

    def __hash__(self) -> int:
        modulus = self.material.shear_modulus
        return hash(modulus if type(modulus) is float else key(modulus))


@attrs.frozen(kw_only=True)
class Pair:
    """The numbers of two bodies in contact that laws need (theory §1).

    For bodies of one material ``stiffness_ratio`` is 2(1-nu)/(2-nu) of eq. (29), and
    ``inertia_ratio`` is chi of eq. (38).

    Parameters
    ----------
    radius : float or array
        R in m, 1/R = 1/R1 + 1/R2.
    effective_modulus : float or array
        E* in Pa.
    effective_shear_modulus : float or array
        G* in Pa, 1/G* = sum of (2-nu)/(4 G). Discrete-element codes define 1/G* = sum of
        (2-nu)/G, a quarter of this G*, and the tangential stiffness 8 G* a. Here the tangential
        stiffness is 2 G* a, see ``tangential_stiffness``.
    normal_mass : float or array
        M_n in kg: normal force over the deceleration of the approach.
    tangential_mass : float or array
        M_t in kg: tangential force over the deceleration of slip.
    dundurs_beta : float or array
        Dundurs' beta, which couples pressure and shear; 0 for bodies of one material.
    cross_stiffness_ratio : float or array
        G* along t2 over that along t1, which is ``effective_shear_modulus``; 1 for a circle.
    axis_ratio : float or array
        Semi-axis of the elliptic contact along t2 over that along t1; 1 for a circle.
    inverse_spin_mass : float or array
        R²/J in 1/kg: 1/J is the sum of 1/J_i, the moments of inertia about the normal. Only scenes
        with spin about the normal have it; 0 in others.

    Notes
    -----
    For an elliptic contact ``radius`` is that of the circular contact which is as stiff (theory
    §16): a contact radius is that of this circle, and force and approach are those of the ellipse.
    """

    radius: Real = quantity("m", rule=POSITIVE, empty=True)
    effective_modulus: Real = quantity("Pa", rule=POSITIVE, empty=True)
    effective_shear_modulus: Real = quantity("Pa", rule=POSITIVE, empty=True)
    normal_mass: Real = quantity("kg", rule=POSITIVE, empty=True)
    tangential_mass: Real = quantity("kg", rule=POSITIVE, empty=True)
    dundurs_beta: Real = quantity("1", default=0.0, empty=True)
    cross_stiffness_ratio: Real = quantity("1", rule=POSITIVE, default=1.0, empty=True)
    axis_ratio: Real = quantity("1", rule=POSITIVE, default=1.0, empty=True)
    inverse_spin_mass: Real = quantity("1/kg", rule=NON_NEGATIVE, default=0.0, empty=True)

    @classmethod
    def of_numbers(cls, numbers: Mapping[str, Real]) -> Pair:
        """Return the pair of new numbers by name; those of round contacts are checked at once.

        Parameters
        ----------
        numbers : mapping of str to float or array
            Arguments of the class.
        """
        kinds = {*map(type, numbers.values())} if numbers.keys() == ROUND else None
        if kinds == {float}:
            if min(_positive(numbers)) > 0.0 and math.isfinite(sum(numbers.values())):
                return change_entries(_unit_pair(), **numbers)
        elif kinds == {np.ndarray} and len({np.shape(each) for each in numbers.values()}) == 1:
            table = np.array([*_positive(numbers), numbers["dundurs_beta"]])
            if table.size and table[:-1].min() > 0.0 and np.isfinite(table).all():
                locked = {name: lock_arrays(each) for name, each in numbers.items()}
                return change_entries(_unit_pair(), **locked)
        return cls(**numbers)

    @property
    def stiffness_ratio(self) -> Real:
        """Kappa = G*/E*: initial tangential over normal contact stiffness."""
        return self.effective_shear_modulus / self.effective_modulus

    @property
    def inertia_ratio(self) -> Real:
        """Chi = (kappa/2) M_n/M_t, eq. (38) generalised to unlike bodies."""
        return 0.5 * self.stiffness_ratio * (self.normal_mass / self.tangential_mass)

    def tangential_stiffness(self, radius: Real) -> Real:
        """Return Mindlin's stiffness without slip, 2 G* a, in N/m; ``radius`` and pair broadcast.

        Parameters
        ----------
        radius : float or array
            Contact radius a in m, of a shape that broadcasts with the pair's numbers.

        References
        ----------
        Mindlin, J. Appl. Mech. 16 (1949) 259-268.
        """
        return 2.0 * self.effective_shear_modulus * radius

    def energies(
        self, speed: Real, slip: Real, rate: Real, change: Real
    ) -> tuple[Real, Real, Real]:
        """Return the energy at the start, and what approach and slip lose of it, in J.

        Parameters
        ----------
        speed, slip : float or array
            Rate of approach and slip velocity before, in m/s.
        rate, change : float or array
            Rate of approach after, and change of the slip velocity, in m/s.
        """
        # Products, not powers: a float raised to a power raises OverflowError. Losses are formed
        # from the changes: with a huge v_x, start - end would cancel.
        start = 0.5 * self.normal_mass * speed * speed
        start = start + 0.5 * self.tangential_mass * slip * slip
        lost = 0.5 * self.normal_mass * (speed - rate) * (speed + rate)
        return start, lost, -self.tangential_mass * change * (slip + 0.5 * change)

    @classmethod
    def of(cls, sphere: Sphere, target: Sphere | HalfSpace, *, turning: bool = False) -> Pair:
        """Return the pair of a sphere and its target (theory §1).

        Parameters
        ----------
        sphere : Sphere
            The sphere.
        target : Sphere or HalfSpace
            The body that the sphere meets.
        turning : bool
            True if the bodies spin about the normal: the pair then has its ``inverse_spin_mass``.
        """
        try:
            return cls._of(sphere, target, turning)
        except (ValueError, ZeroDivisionError):
            if told := _find_loss(sphere, target):
                raise told from None
            raise

    @classmethod
    def _of(cls, sphere: Sphere, target: Sphere | HalfSpace, turning: bool) -> Pair:
        """Return the pair, if floating point holds its numbers."""
        compliance_n = normal_compliance(sphere.material) + normal_compliance(target.material)
        compliance_t = shear_compliance(sphere.material) + shear_compliance(target.material)
        curvature = 1.0 / sphere.radius
        inverse_normal = 1.0 / sphere.mass
        inverse_tangential = _inverse_tangential_mass(sphere)
        if isinstance(target, Sphere):
            curvature = curvature + 1.0 / target.radius
            inverse_normal = inverse_normal + 1.0 / target.mass
            inverse_tangential = inverse_tangential + _inverse_tangential_mass(target)
        spin: Real = 0.0
        if turning:
            spheres = [body for body in (sphere, target) if isinstance(body, Sphere)]
            spin = sum(inverse_turning_mass(body, 1.0 / curvature) for body in spheres)
        return cls(
            radius=1.0 / curvature,
            effective_modulus=1.0 / compliance_n,
            effective_shear_modulus=1.0 / compliance_t,
            normal_mass=1.0 / inverse_normal,
            tangential_mass=1.0 / inverse_tangential,
            dundurs_beta=coupling_compliance(sphere.material, target.material) / compliance_n,
            inverse_spin_mass=spin,
        )


#: Numbers of a round contact of two bodies that do not spin about the normal.
ROUND = {
    "radius", "effective_modulus", "effective_shear_modulus", "normal_mass", "tangential_mass",
    "dundurs_beta",
}  # fmt: skip


#: The positive numbers among them.
_positive = itemgetter(*sorted(ROUND - {"dundurs_beta"}))


@cache
def _unit_pair() -> Pair:
    """Return a pair whose numbers are 1; optional numbers have their defaults."""
    return Pair(**dict.fromkeys(ROUND, 1.0))


def _find_loss(*bodies: Sphere | HalfSpace) -> ValueError | None:
    """Return the ValueError of a number that makes the contact's numbers 0 or infinite, if any."""
    numbers: dict[str, Real] = {}
    for name, body in zip(("sphere", "target"), bodies, strict=True):
        numbers[f"{name}.material.shear_modulus"] = body.material.shear_modulus
        if isinstance(body, Sphere):
            numbers[f"{name}.radius"], numbers[f"{name}.mass"] = body.radius, body.mass
            numbers[f"{name}.gyration_ratio"] = body.gyration_ratio
    shapes = {name: np.shape(number) for name, number in numbers.items()}
    common_shape(shapes, what="the shapes of the bodies", remedy="give arrays of equal length")
    far = {name: float(np.max(np.abs(np.log10(number)))) for name, number in numbers.items()}
    name = max(far, key=lambda each: far[each])
    if far[name] < FAR:
        return None
    rule = "floating point cannot hold what follows from it for the contact"
    return refuse(name, numbers[name], rule, "check its unit")


def normal_compliance(material: Material) -> Real:
    """Return (1-nu)/(2G) = (1-nu²)/E, one body's part of 1/E*, in 1/Pa."""
    return (1.0 - material.poisson_ratio) / (2.0 * material.shear_modulus)


def coupling_compliance(sphere: Material, target: Material) -> Real:
    """Return half the difference of (1-2nu)/(2G), which is Dundurs' beta over E*, in 1/Pa."""
    first = (1.0 - 2.0 * sphere.poisson_ratio) / (2.0 * sphere.shear_modulus)
    second = (1.0 - 2.0 * target.poisson_ratio) / (2.0 * target.shear_modulus)
    return 0.5 * (first - second)


def shear_compliance(material: Material) -> Real:
    """Return (2-nu)/(4G), one body's part of 1/G*, in 1/Pa."""
    return (2.0 - material.poisson_ratio) / (4.0 * material.shear_modulus)


def _inverse_tangential_mass(sphere: Sphere) -> Real:
    """Return (1 + 1/K²)/m, one body's part of 1/M_t, in 1/kg, eq. (21)."""
    return (1.0 + 1.0 / sphere.gyration_ratio**2) / sphere.mass


def inverse_turning_mass(sphere: Sphere, radius: Real) -> Real:
    """Return radius²/J of a sphere, in 1/kg; J of a tiny sphere would underflow."""
    share = radius / (sphere.gyration_ratio * sphere.radius)
    return share * share / sphere.mass


def size_ratio(
    normal_mass: Real, effective_modulus: Real, radius: Real, normal_speed: Real
) -> Real:
    """Return C of eq. (9) for any pair, C⁵ = 15 M v1² / (16 E* R³); arguments M, E*, R, v1."""
    # Factors are raised to their powers one by one: v1² and R³ might underflow or overflow.
    stiffness = 15.0 * normal_mass / (16.0 * effective_modulus)
    ratio: Real = stiffness**0.2 * normal_speed**0.4 / radius**0.6
    return ratio
