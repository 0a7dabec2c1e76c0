"""Slip, inverse mass and dimensionless groups of a scene, for spheres and bodies of any shape."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Self, TypeVar

import numpy as np

from contactlab.impact import inverse_mass
from contactlab.impact.bodies import Pair, Sphere, size_ratio
from contactlab.numeric import arrays as batch
from contactlab.numeric.arrays import choose, magnitude, quotient, some
from contactlab.numeric.types import Array, Index, Places, Real, Tree
from contactlab.numeric.vectors import (
    components,
    dot,
    entry,
    factor,
    hypotenuse,
    join_components,
    rows,
    solve_factored,
)

if TYPE_CHECKING:
    from contactlab.impact.links import Links

#: Groups of theory §14, where friction changes the approach.
COUPLED = ("lam", "eta", "rho")
#: Groups of theory §17, where bodies spin about the normal.
OF_SPIN = ("w1", "chi_w")

AnyScene = TypeVar("AnyScene", bound="Motions")


class Motions:
    """Base of scenes: slip, dimensionless groups, ways of solving, impulses and energies."""

    __slots__ = ()

    if TYPE_CHECKING:
        pair: Pair
        shape: tuple[int, ...]
        planar: bool
        inverse_mass: Array | None
        links: Links | None
        friction_coefficient: Real
        normal_speed: Real
        tangential_velocity: Real
        normal_spin: Real
        sphere: Sphere[Any] | None
        spin: Real

        def take(self, part: Index) -> Self: ...  # noqa: D102
        @property
        def index(self) -> int | Places: ...  # noqa: D102

    @property
    def slip_velocity(self) -> Real:
        """v_x = v + omega R, the slip velocity (20), in m/s; along t1 and t2 in space."""
        if self.sphere is None:
            return self.tangential_velocity
        return self.tangential_velocity + self.spin * self.sphere.radius

    @property
    def psi_scale(self) -> Real:
        """kappa/(mu v1) of eq. (29), psi per m/s of slip velocity; infinite without friction."""
        if not self.shape:  # plain numbers are ten times as fast
            unit = float(self.friction_coefficient * self.normal_speed)
            return float(self.pair.stiffness_ratio) / unit if unit else math.inf
        with np.errstate(divide="ignore", over="ignore"):
            scale = np.divide(
                self.pair.stiffness_ratio, self.friction_coefficient * self.normal_speed
            )
        return batch.plain(scale)

    def psi(self, velocity: Real) -> Real:
        """Return psi of a slip velocity, eq. (29), without unit: (...), or (..., 2) in space.

        Parameters
        ----------
        velocity : float or array
            Slip velocity in m/s, with the sign and shape of ``slip_velocity``.
        """
        if type(velocity) is float and not self.shape:
            return 0.0 if velocity == 0.0 else velocity * self.psi_scale
        scale = self.psi_scale
        if not self.planar:
            scale = np.asarray(scale)[..., None] * self._sides
        with np.errstate(invalid="ignore", over="ignore"):
            value = np.where(np.asarray(velocity) == 0.0, 0.0, velocity * scale)
        return batch.plain(value)

    @property
    def psi1(self) -> Real:
        """Dimensionless angle of incidence, psi of the slip velocity, eqs (20) and (29)."""
        return self.psi(self.slip_velocity)

    @property
    def w1(self) -> Real:
        """W of the spin about the normal before the impact, theory §17."""
        return rim(self, self.normal_spin)

    @property
    def chi_w(self) -> Real:
        """chi_w = (kappa/2) M_n a²/J, inertia ratio of spin about the normal; 0 without spin."""
        pair, size = self.pair, self._size()
        inertia = pair.normal_mass * pair.inverse_spin_mass
        return 0.5 * pair.stiffness_ratio * inertia * size * size

    def _size(self) -> Real:
        """Return C of eq. (9), the largest contact radius of an elastic Hertz impact over R."""
        pair = self.pair
        return size_ratio(pair.normal_mass, pair.effective_modulus, pair.radius, self.normal_speed)

    @property
    def chi(self) -> Real:
        """Inertia ratio, eq. (38); in space (kappa/2) W_tt/W_nn, shape (..., 2, 2).

        On an ellipse each row has kappa of its direction, and the tensor is not symmetric.
        """
        if self.inverse_mass is None:
            return self.pair.inertia_ratio
        W, half = self.inverse_mass, 0.5 * self.pair.stiffness_ratio
        if self.planar:
            return half * entry(W, 1, 1) / entry(W, 0, 0)
        sides = np.asarray(half)[..., None] * self._sides
        return sides[..., None] * W[..., 1:, 1:] / W[..., :1, :1]

    @property
    def lam(self) -> Real:
        """Lam = mu W_nt/W_nn, what friction adds to the approach; (..., 2) in space."""
        return coupling(self, self.friction_coefficient)

    @property
    def eta(self) -> Real:
        """Eta = kappa W_nt/(mu W_nn), what pressure adds to the slip; infinite without friction."""
        eta = coupling(self, quotient(self.pair.stiffness_ratio, self.friction_coefficient))
        return eta if self.planar else eta * self._sides

    @property
    def _sides(self) -> Array:
        """Stiffness along t1 and t2 over that along t1, shape (..., 2); 1 on a circle."""
        sides = np.ones((*self.shape, 2))
        sides[..., 1] = self.pair.cross_stiffness_ratio
        return sides

    @property
    def rho(self) -> Real:
        """Rho = mu²/kappa, on an ellipse that along t1."""
        mu: Real = self.friction_coefficient
        rho: Real = mu * mu / self.pair.stiffness_ratio
        return rho

    @property
    def central(self) -> Self:
        """The impact with the same approach and no coupling: the scene itself for spheres.

        Its slip is the magnitude in space, its tangential mass that along the slip.
        """
        if self.inverse_mass is None:
            return self
        pair, slip = self.pair, self.slip_velocity
        if not self.planar:
            x, y = components(np.asarray(slip))
            slip = hypotenuse(x, y)
            still = slip == 0.0  # the tangential mass is that along t1 then
            unit = slip + still
            mass = 1.0 / inverse_mass.along(rows(self.inverse_mass), (x + still) / unit, y / unit)
            pair = batch.change_entries(pair, tangential_mass=batch.lock_arrays(mass))
        slip = batch.lock_arrays(batch.spread(slip, self.shape))
        alone = {"inverse_mass": None, "planar": True, "links": None}
        return self._with(tangential_velocity=slip, pair=pair, **alone)

    #: Return this scene with other entries, which were checked before; arrays are read-only.
    _with = batch.change_entries

    def _ways(self) -> Real:
        """Return the way in which each impact is solved."""
        W = self.inverse_mass
        assert W is not None
        speed, *slip = self._components(self.normal_speed, self.slip_velocity)
        return inverse_mass.ways(rows(W), speed, slip, self.pair.cross_stiffness_ratio)

    def _going(self, way: Real) -> Self:
        """Return this scene in the form that one way of solving takes."""
        if way == inverse_mass.CENTRAL:
            return self.central
        if way == inverse_mass.SPATIAL or self.planar:
            return self
        W = self.inverse_mass
        assert W is not None
        pair = batch.change_entries(
            self.pair, tangential_mass=batch.lock_arrays(1.0 / entry(W, 1, 1))
        )
        slip = batch.spread(np.asarray(self.slip_velocity)[..., 0], self.shape)
        slip = batch.lock_arrays(slip)
        return self._with(tangential_velocity=slip, pair=pair, planar=True)

    @property
    def velocity(self) -> Array:
        """Approach and slip at first touch along n, t1 and t2, shape (..., 3), in m/s."""
        return join_components(self._components(self.normal_speed, self.slip_velocity), self.shape)

    def _components(self, approach: Real, slip: Real) -> tuple[Real, Real, Real]:
        """Return rates along n and slip velocities as components along n, t1 and t2."""
        if self.planar or isinstance(slip, float):
            return approach, slip, 0.0
        along, across = components(slip)
        return approach, along, across


def slip_speed(scene: Motions) -> Real:
    """Return magnitude of the slip velocity, in m/s, of the batch shape."""
    return size_of(scene, scene.slip_velocity)


def rubs(scene: Motions) -> bool:
    """Return whether any impact has friction and slip at first touch."""
    slip = slip_speed(scene)
    friction = scene.friction_coefficient
    return some((slip != 0.0) & (friction != 0.0))


def turns(scene: Motions) -> bool:
    """Return whether any pair of bodies spins about the normal."""
    spin = scene.normal_spin
    return spin != 0.0 if isinstance(spin, float) else bool(spin.any())


def rim(scene: Motions, spin: Real) -> Real:
    """Return w = kappa omega_n a/(mu v1) of spins about the normal, theory §17, without unit.

    It is the speed of the rim of the largest elastic Hertz contact in the unit of psi.

    Parameters
    ----------
    spin : float or array
        omega_n in rad/s, of the batch shape.
    """
    return scene.central.psi(spin * scene._size() * scene.pair.radius)


def normal_inertia(scene: Motions) -> Real:
    """Return J about the normal in kg m², 1/J the sum of both bodies'; 0 without spin about it."""
    inverse = scene.pair.inverse_spin_mass
    size = scene.pair.radius
    return choose(inverse > 0.0, quotient(size * size, inverse), 0.0)


def spin_energies(scene: Motions, change: Real) -> tuple[Real, Real]:
    """Return the energy ½ J omega_n² at the start, and what it loses, in J.

    Parameters
    ----------
    change : float or array
        Change of the spin about the normal, in rad/s.
    """
    spin, momentum = scene.normal_spin, normal_inertia(scene) * scene.normal_spin
    return 0.5 * momentum * spin, -normal_inertia(scene) * change * (spin + 0.5 * change)


def size_of(scene: Motions, slip: Real) -> Real:
    """Return the magnitude of slip velocities, of the batch shape.

    Parameters
    ----------
    slip : float or array
        As ``slip_velocity``.
    """
    if scene.planar or isinstance(slip, float):
        return magnitude(slip)
    return hypotenuse(*components(slip))


def along_slip(scene: Motions, velocity: Real) -> Real:
    """Return the part of slip velocities along the slip at first touch, of the batch shape.

    Parameters
    ----------
    velocity : float or array
        As ``slip_velocity``.
    """
    if scene.planar:
        return velocity
    part = np.einsum(
        "...i,...i->...", velocity, inverse_mass.unit_slip(np.asarray(scene.slip_velocity))
    )
    return batch.plain(part)


def batch_of(scene: Motions) -> tuple[int, ...]:
    """Return the shape of independent problems: the scene's, less the contacts of a gathering."""
    return scene.shape if scene.links is None else scene.shape[:-1]


def over_contacts(scene: Motions, each: Tree) -> Tree:
    """Return what each gathering has, for each of its contacts; what one contact has as it is."""
    if scene.links is None:
        return each
    return np.broadcast_to(np.asarray(each)[..., None], scene.shape)  # type: ignore[return-value]


def slip_axes(scene: Motions) -> tuple[int, ...]:
    """Return the axes of a slip velocity beside the batch's: (2,) in space, else ()."""
    return () if scene.planar else (2,)


def largest_chi(scene: Motions) -> Real:
    """Return the largest eigenvalue of chi, of the batch shape."""
    if scene.planar:
        return scene.chi
    assert scene.inverse_mass is not None
    W = rows(scene.inverse_mass)
    ratio = 0.5 * scene.pair.stiffness_ratio / W[0][0]
    cross = scene.pair.cross_stiffness_ratio
    # the symmetric tensor with the same eigenvalues
    along, across, both = ratio * W[1][1], ratio * cross * W[2][2], ratio * cross**0.5 * W[1][2]
    largest = 0.5 * (along + across) + hypotenuse(0.5 * (along - across), both)
    return batch.of_each(largest, scene.shape)


def free_share(scene: Motions) -> Real:
    """Return the share of W_nn that an unchanged slip leaves, 1 - W_nt²/(W_nn W_tt) in a plane."""
    if scene.inverse_mass is None:
        return 1.0
    (a, b, c), (_, d, e), (_, _, f) = rows(scene.inverse_mass)
    if scene.planar:
        return (a * d - b * b) / (a * d)
    minor = d * f - e * e
    return (a * minor - b * (b * f - c * e) + c * (b * e - c * d)) / (a * minor)


def sizes(scene: Motions) -> tuple[Real, Real, Real]:
    """Return the magnitudes of lam, eta and psi1, of the batch shape."""
    inverse = scene.inverse_mass
    if scene.shape or inverse is None:
        lam, eta, psi1 = (size_of(scene, each) for each in (scene.lam, scene.eta, scene.psi1))
        return lam, eta, psi1
    # plain numbers are ten times as fast
    W, along, across = inverse[0].tolist()
    _, x, y = scene._components(0.0, scene.slip_velocity)
    if scene.planar:
        across = 0.0
    cross, mu, scale = scene.pair.cross_stiffness_ratio, scene.friction_coefficient, scene.psi_scale
    eta = quotient(scene.pair.stiffness_ratio, mu)
    return (
        hypotenuse(mu * along / W, mu * across / W),
        hypotenuse(eta * along / W, eta * across / W * cross),
        hypotenuse(x and x * scale, y and y * (scale * cross)),
    )


def coupling(scene: Motions, factor: Real) -> Real:
    """Return ``factor`` times W_nt/W_nn, as this scene has its slip; 0 for spheres.

    Parameters
    ----------
    factor : float or array
    """
    if scene.inverse_mass is None:
        return 0.0
    W = scene.inverse_mass
    if scene.planar and not scene.shape:  # plain numbers warn of nothing
        return factor * W.item(0, 1) / W.item(0, 0)
    with np.errstate(all="ignore"):
        if scene.planar:
            return factor * entry(W, 0, 1) / entry(W, 0, 0)
        return np.asarray(factor)[..., None] * W[..., 0, 1:] / W[..., :1, 0]


def tangent(scene: Motions, vectors: Array) -> Real:
    """Return vectors of the tangent plane, (..., 2), as this scene has its slip.

    Parameters
    ----------
    vectors : array, shape (..., 2)
        Along t1 and t2.
    """
    if not scene.planar:
        return vectors
    return vectors[..., 0] if scene.shape else float(vectors[0])


def groups(scene: Motions) -> dict[str, Any]:
    """Return the dimensionless groups that determine the impact, by name."""
    names = ("psi1", "chi") if scene.inverse_mass is None else ("psi1", "chi", *COUPLED)
    if turns(scene):
        names = (*names, *OF_SPIN)
    return {name: getattr(scene, name) for name in names}


def most_slip_change(scene: Motions) -> Real:
    """Return the largest change of slip velocity in m/s, of an elastic impact of gross slip.

    It is infinite where friction changes the approach: no such bound is known there.
    """
    if scene.inverse_mass is not None:
        return math.inf + 0.0 * slip_speed(scene)
    pair = scene.pair
    friction = scene.friction_coefficient * scene.normal_speed
    # This is 4 chi in psi; psi itself would be infinite without friction.
    return 2.0 * (friction * (pair.normal_mass / pair.tangential_mass))


def parts(scene: AnyScene, *, as_one: bool = False) -> list[tuple[Any, AnyScene]]:
    """Return places and scenes of impacts that are solved in the same way, at most three.

    A part has no inverse mass where W does not couple and slip keeps its line, and is planar
    where slip stays along t1.

    Parameters
    ----------
    as_one : bool
        True if impacts that differ stay one part, as a history with one time axis needs.
    """
    if scene.inverse_mass is None:
        return [(..., scene)]
    if not scene.shape and scene.planar and inverse_mass.presses(rows(scene.inverse_mass)):
        return [(..., scene)]  # as it is, whichever way its slip goes
    found = scene._ways()
    if not scene.shape:
        return [(..., scene._going(found))]
    kinds = np.unique(found).tolist()
    if len(kinds) == 1:
        return [(..., scene._going(kinds[0]))]
    if as_one:
        return [(..., scene)]
    masks = [(found == kind, kind) for kind in kinds]
    return [(where, scene.take(where)._going(kind)) for where, kind in masks]


def impulse(scene: Motions, rate: Real, change: Real) -> Array:
    """Return the impulse on the target along n, t1 and t2, shape (..., 3), in N s.

    Parameters
    ----------
    rate, change : float or array
        Rate of approach after, and change of the slip velocity, in m/s.
    """
    if scene.inverse_mass is None:
        push = scene.pair.normal_mass * (scene.normal_speed - rate)
        drag = -scene.pair.tangential_mass * change
        return join_components((push, drag, 0.0), scene.shape)
    moved = scene._components(rate - scene.normal_speed, change)
    ((p, q, r),) = solve_factored(factor(rows(scene.inverse_mass)), moved)
    return join_components((-p, -q, -r), scene.shape)


def energies(scene: Motions, rate: Real, change: Real) -> tuple[Real, Real, Real]:
    """Return the energy at the start, and what approach and slip lose of it, in J.

    Parameters
    ----------
    rate, change : float or array
        Rate of approach after, and change of the slip velocity, in m/s.
    """
    speed = scene.normal_speed
    if scene.inverse_mass is None:
        return scene.pair.energies(speed, scene.slip_velocity, rate, change)
    x, y, z = before = scene._components(speed, scene.slip_velocity)
    u, v, w = moved = scene._components(rate - speed, change)
    held, gained = solve_factored(factor(rows(scene.inverse_mass)), before, moved)
    mean = x + 0.5 * u, y + 0.5 * v, z + 0.5 * w
    lost = 0.5 * scene.pair.normal_mass * (speed - rate) * (speed + rate)
    return 0.5 * dot(held, before), lost, -dot(gained, mean) - lost


def energy_at_start(scene: Motions) -> Real:
    """Return the energy of approach and slip in J, of bodies whose contact couples them."""
    assert scene.inverse_mass is not None
    before = scene._components(scene.normal_speed, scene.slip_velocity)
    (held,) = solve_factored(factor(rows(scene.inverse_mass)), before)
    return 0.5 * dot(held, before)
