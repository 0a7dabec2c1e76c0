"""Eccentric impacts in numbers: bodies for which friction changes the approach (theory §14)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.impact.bodies import Pair
from contactlab.impact.scene import Scene
from contactlab.numeric import arrays as batch
from contactlab.numeric.checks import NON_NEGATIVE, POSITIVE, Real, instance, quantity, real, refuse

Array = NDArray[np.float64]

#: Smallest over largest eigenvalue of an inverse mass, scaled to ones on the diagonal, that is
#: told from zero.
SINGULAR = 1e-14


def _locked(value: Any) -> Array:
    """Return a read-only copy as float64."""
    return np.asarray(batch.locked(np.array(value, dtype=np.float64)))


@attrs.frozen(kw_only=True)
class EccentricScene:
    """One impact of two bodies of any shape at their contact, or a batch, in SI units.

    The frame of the contact is (n, t1, t2): the normal from the first body into the target, and
    two tangents. In a plane scene t2 plays no part. ``Encounter.scene`` makes one from bodies,
    ``nondimensional`` one from the parameters of theory §14.

    Parameters
    ----------
    pair : Pair
        Radius and elastic moduli of the contact; ``normal_mass`` is 1/W_nn.
    friction_coefficient : float or array
        Coulomb's mu, at least 0.
    inverse_mass : array, shape (..., 3, 3)
        W in 1/kg: the acceleration of the relative motion at the contact, for unit forces along
        n, t1 and t2.
    normal_speed : float or array
        Speed of approach of the contact points, in m/s, positive.
    slip_velocity : array, shape (..., 2)
        Velocity of the first body over the target at the contact, along t1 and t2, in m/s.
    planar : bool
        True if the motion stays in the plane of n and t1.
    bodies : tuple
        Bodies of the encounter, which cautions look at; empty without.

    Raises
    ------
    ValueError
        If a number is out of range, or W is not positive definite.
    """

    pair: Pair = instance(Pair)
    friction_coefficient: Real = quantity("1", rule=NON_NEGATIVE)
    inverse_mass: Array = attrs.field(converter=_locked, eq=False, repr=False)
    normal_speed: Real = quantity("m/s", rule=POSITIVE)
    slip_velocity: Array = attrs.field(converter=_locked, eq=False)
    planar: bool = instance(bool, default=True)
    #: Bodies of the encounter, for cautions; empty without.
    bodies: tuple[Any, ...] = attrs.field(default=(), eq=False, repr=False)
    #: Batch shape: () for one impact.
    shape: tuple[int, ...] = attrs.field(init=False, eq=False, repr=False)

    def __attrs_post_init__(self) -> None:
        shapes = {"inverse_mass": self.inverse_mass.shape[:-2]}
        shapes["slip_velocity"] = self.slip_velocity.shape[:-1]
        numbers = attrs.asdict(self.pair) | {
            "friction_coefficient": self.friction_coefficient,
            "normal_speed": self.normal_speed,
        }
        shapes |= {name: np.shape(each) for name, each in numbers.items() if np.ndim(each)}
        what, remedy = "EccentricScene: the shapes", "give numbers, or arrays of equal length"
        shape = batch.common_shape(shapes, what=what, remedy=remedy)
        if 0 in shape:
            raise refuse("shape", shape, "a scene must hold at least one impact")
        object.__setattr__(self, "shape", shape)
        diagonal = np.sqrt(np.einsum("...ii->...i", self.inverse_mass))
        with np.errstate(all="ignore"):
            scaled = self.inverse_mass / (diagonal[..., None] * diagonal[..., None, :])
        if not (np.isfinite(scaled).all() and np.linalg.eigvalsh(scaled).min() > SINGULAR):
            rule = "must be positive definite: lam · chi⁻¹ · eta < 2 in the plane lam eta < 2 chi"
            raise refuse("inverse_mass", self.inverse_mass.tolist(), rule)

    @classmethod
    def nondimensional(
        cls, *, psi1: Any, chi: Any, lam: Any, eta: Any = None, rho: Any = None
    ) -> EccentricScene:
        """Return the scene of the parameters of theory §14.

        The units are chosen so that v1 = R = C = 1/W_nn = kappa = 1.

        Parameters
        ----------
        psi1 : float or array; in space an array of shape (..., 2)
            Slip velocity at first touch, kappa v_x/(mu v1).
        chi : float or array; in space an array of shape (..., 2, 2)
            (kappa/2) W_tt/W_nn.
        lam : float or array; in space an array of shape (..., 2)
            mu W_nt/W_nn, what friction adds to the approach.
        eta : float or array, optional
            kappa W_nt/(mu W_nn), what pressure adds to the slip; in the plane only. It has the
            sign of ``lam``, and is zero where ``lam`` is.
        rho : float or array, optional
            mu²/kappa, in space in place of ``eta``.

        Raises
        ------
        ValueError
            If a number is not finite, or lam eta >= 2 chi.
        """
        if (eta is None) == (rho is None):
            raise refuse("eta, rho", (eta, rho), "give eta in the plane, rho in space")
        if rho is not None:
            return cls._in_space(psi1, chi, lam, rho)
        slip, coupling = real("psi1", psi1), real("lam", lam)
        inertia, pressure = real("chi", chi, rule=POSITIVE), real("eta", eta)
        try:
            values: Any = np.broadcast_arrays(slip, inertia, coupling, pressure)
        except ValueError:
            shapes = [np.shape(each) for each in (slip, inertia, coupling, pressure)]
            raise refuse("psi1, chi, lam, eta", shapes, "must have shapes that fit") from None
        slip, inertia, coupling, pressure = values
        alone = (coupling == 0.0) & (pressure == 0.0)
        rule = "must be positive: both have the sign of W_nt, and both are zero without coupling"
        with np.errstate(all="ignore"):
            squared = np.where(alone, 1.0, coupling / pressure)
        if not np.all((squared > 0.0) & np.isfinite(squared)):
            raise refuse("lam / eta", squared, rule, "rho = lam/eta = mu²/kappa")
        if not np.all(coupling * pressure < 2.0 * inertia):
            worst = np.max(coupling * pressure / (2.0 * inertia))
            raise refuse("lam eta / (2 chi)", float(worst), "must be below 1: W has an inverse")
        slip, coupling = (
            np.stack((each, other), axis=-1)
            for each, other in ((slip, 0.0 * slip), (coupling, np.zeros(slip.shape)))
        )
        tensor = inertia[..., None, None] * np.eye(2)
        return cls._scaled(np.sqrt(squared), slip, tensor, coupling, planar=True)

    @classmethod
    def _in_space(cls, psi1: Any, chi: Any, lam: Any, rho: Any) -> EccentricScene:
        """Return the scene of vectors in the tangent plane."""
        slip, coupling, inertia = (
            np.asarray(real(name, each))
            for name, each in (("psi1", psi1), ("lam", lam), ("chi", chi))
        )
        squared = np.asarray(real("rho", rho, rule=POSITIVE))
        for name, each, ends in (
            ("psi1", slip, (2,)),
            ("lam", coupling, (2,)),
            ("chi", inertia, (2, 2)),
        ):
            if each.shape[-len(ends) :] != ends:
                rule = f"must end with {ends} in space"
                raise refuse(f"{name}.shape", each.shape, rule, "in the plane give eta, not rho")
        shape = np.broadcast_shapes(
            slip.shape[:-1], coupling.shape[:-1], inertia.shape[:-2], squared.shape
        )
        mu = np.broadcast_to(np.sqrt(squared), shape)
        return cls._scaled(mu, slip, inertia, coupling, planar=False)

    @classmethod
    def _scaled(
        cls, mu: Array, slip: Array, inertia: Array, coupling: Array, *, planar: bool
    ) -> EccentricScene:
        """Return a scene of vectors and tensors, in units with v1 = R = C = 1/W_nn = kappa = 1."""
        matrix = np.zeros((*mu.shape, 3, 3))
        matrix[..., 0, 0] = 1.0
        matrix[..., 0, 1:] = matrix[..., 1:, 0] = coupling / mu[..., None]
        matrix[..., 1:, 1:] = 2.0 * inertia
        modulus = 15.0 / 16.0  # makes C = 1 in eq. (9)
        pair = Pair(
            radius=1.0,
            effective_modulus=modulus,
            effective_shear_modulus=modulus,
            normal_mass=1.0,
            tangential_mass=_number(2.0 / (matrix[..., 1, 1] + matrix[..., 2, 2])),
        )
        return cls(
            pair=pair,
            friction_coefficient=_number(mu),
            inverse_mass=matrix,
            normal_speed=1.0,
            slip_velocity=np.broadcast_to(slip * mu[..., None], (*mu.shape, 2)),
            planar=planar,
        )

    @property
    def kappa(self) -> Real:
        """Kappa = G*/E*."""
        return self.pair.stiffness_ratio

    def psi(self, velocity: Any) -> Any:
        """Return slip velocities, shape (..., 2), as psi: (...) in the plane, (..., 2) in space.

        Parameters
        ----------
        velocity : array, shape (..., 2)
            Along t1 and t2, in m/s.
        """
        unit: Any = self.friction_coefficient * self.normal_speed / self.kappa
        with np.errstate(all="ignore"):
            scaled = velocity / np.asarray(unit)[..., None]
        return self._plane(scaled)

    def _plane(self, vectors: Any) -> Any:
        """Return the first component in the plane, the vector in space."""
        return _number(vectors[..., 0]) if self.planar else vectors

    @property
    def psi1(self) -> Any:
        """Scaled slip velocity at first touch, (...) in the plane, (..., 2) in space."""
        return self.psi(self.slip_velocity)

    @property
    def chi(self) -> Any:
        """(kappa/2) W_tt/W_nn: (...) in the plane, (..., 2, 2) in space."""
        W, half = self.inverse_mass, 0.5 * np.asarray(self.kappa)
        scaled = half[..., None, None] * W[..., 1:, 1:] / W[..., :1, :1]
        return _number(scaled[..., 0, 0]) if self.planar else scaled

    @property
    def lam(self) -> Any:
        """Lam = mu W_nt/W_nn: (...) in the plane, (..., 2) in space."""
        W, mu = self.inverse_mass, np.asarray(self.friction_coefficient)
        return self._plane(mu[..., None] * W[..., 0, 1:] / W[..., :1, 0])

    @property
    def eta(self) -> Any:
        """Eta = kappa W_nt/(mu W_nn), as ``lam``; infinite without friction."""
        W, mu = self.inverse_mass, np.asarray(self.friction_coefficient)
        with np.errstate(all="ignore"):
            factor = np.asarray(self.kappa / mu)[..., None]
            return self._plane(factor * W[..., 0, 1:] / W[..., :1, 0])

    @property
    def rho(self) -> Real:
        """Rho = mu²/kappa."""
        mu: Any = self.friction_coefficient
        rho: Real = mu * mu / self.kappa
        return rho

    @property
    def central(self) -> Scene:
        """The central impact with the same approach: what a law starts from, without coupling."""
        slip = _number(np.hypot(self.slip_velocity[..., 0], self.slip_velocity[..., 1]))
        speed = self.normal_speed
        if self.shape and not np.ndim(speed):
            speed = np.full(self.shape, speed)
        numbers = self.friction_coefficient, speed, slip
        return Scene(None, None, *numbers, pair=self.pair, bodies=self.bodies)

    def take(self, part: Any) -> EccentricScene:
        """Return the impacts that ``part`` indexes.

        Parameters
        ----------
        part : slice, array of bool or int, int or tuple of int
            Index of an array of the batch shape.
        """
        spread = {
            "inverse_mass": np.broadcast_to(self.inverse_mass, (*self.shape, 3, 3))[part],
            "slip_velocity": np.broadcast_to(self.slip_velocity, (*self.shape, 2))[part],
        }
        taken = {
            name: batch.taken(getattr(self, name), self.shape, part)
            for name in ("pair", "friction_coefficient", "normal_speed")
        }
        return attrs.evolve(self, **spread, **taken)

    @classmethod
    def stack(cls, scenes: Sequence[EccentricScene]) -> EccentricScene:
        """Return one batch scene of shape (len(scenes),) from scenes of single impacts.

        Parameters
        ----------
        scenes : sequence of EccentricScene
        """
        scenes = list(scenes)
        if not all(isinstance(each, cls) and not each.shape for each in scenes) or not scenes:
            raise refuse("scenes", scenes, "must be EccentricScenes of single impacts")
        pairs = [each.pair for each in scenes]
        names = [field.name for field in attrs.fields(Pair)]
        return cls(
            pair=Pair(**{name: np.array([getattr(p, name) for p in pairs]) for name in names}),
            friction_coefficient=np.array([each.friction_coefficient for each in scenes]),
            inverse_mass=np.array([each.inverse_mass for each in scenes]),
            normal_speed=np.array([each.normal_speed for each in scenes]),
            slip_velocity=np.array([each.slip_velocity for each in scenes]),
            planar=all(each.planar for each in scenes),
            bodies=scenes[0].bodies,
        )

    def kinetic_energy(self, velocity: Any) -> Any:
        """Return ½ v·W⁻¹·v in J of velocities (..., 3) along n, t1, t2, of the batch shape.

        Parameters
        ----------
        velocity : array, shape (..., 3)
            Relative velocity at the contact in m/s.
        """
        impulse = np.linalg.solve(self.inverse_mass, velocity[..., None])[..., 0]
        return _number(0.5 * np.einsum("...i,...i->...", velocity, impulse))

    @property
    def velocity(self) -> Array:
        """Approach and slip at first touch, shape (..., 3), in m/s."""
        speed = np.broadcast_to(self.normal_speed, self.shape)[..., None]
        slip = np.broadcast_to(self.slip_velocity, (*self.shape, 2))
        return np.concatenate((speed, slip), axis=-1)


def _number(value: Any) -> Any:
    """Return a float for a single number, else the array."""
    return float(value) if np.ndim(value) == 0 else value
