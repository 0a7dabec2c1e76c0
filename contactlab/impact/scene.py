"""Scenes: two bodies, the friction between them, and their motion before the impact."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from operator import attrgetter
from typing import TYPE_CHECKING, Any, Generic, Self, overload

import attrs
import numpy as np

from contactlab.impact import batches, groups, inverse_mass, kinetics
from contactlab.impact.batches import Batches
from contactlab.impact.bodies import ROUND, HalfSpace, Pair, Sphere
from contactlab.impact.material import Material
from contactlab.impact.of_speed import LawOfSlip, OfSlip, friction, is_law_of_slip, law_of_slip
from contactlab.numeric import arrays as batch
from contactlab.numeric.checks import (
    POSITIVE,
    Rule,
    instance,
    key,
    quantity,
    real,
    refuse,
    whole,
)
from contactlab.numeric.named import NOTHING
from contactlab.numeric.names import state_arguments
from contactlab.numeric.types import Array, Each, Index, Number, Numbers, Places, Real
from contactlab.numeric.vectors import entry, over

if TYPE_CHECKING:
    from contactlab.impact.grid import GridParts
    from contactlab.impact.links import Links

#: Least kinetic energy of the normal motion, in J, and least tangential velocity, in m/s. Numbers
#: computed from smaller values would have fewer than sixteen digits.
LEAST_ENERGY = LEAST_VELOCITY = 1e-290
#: Least mu times momentum of the normal motion, in N s.
LEAST_IMPULSE = 1e-285
#: Impacts of a scene of a grid in parts: whole blocks of a sweep, some 20 MB of columns.
IMPACTS_AT_A_TIME = 1 << 17
OBLIQUE = Rule(
    lambda degrees: np.abs(degrees) < 90.0, "must lie between -90 and 90, measured from the normal"
)


def _tensors(value: Numbers | None) -> Array | None:
    """Return a read-only copy as float64; None as it is."""
    if value is None:
        return None
    if type(value) is not np.ndarray or value.dtype != np.float64:
        value = real("inverse_mass", value, remedy="in 1/kg, shape (..., 3, 3)", empty=True)
    return np.asarray(batch.lock_arrays(np.array(value, dtype=np.float64)))


class _SceneArguments:
    """Arguments of a scene, without overloads, as types for ``attrs.evolve``."""

    __slots__ = ()

    def __init__(
        self,
        sphere: Sphere | None,
        target: Sphere | HalfSpace | None,
        friction_coefficient: Numbers | LawOfSlip,
        normal_speed: Numbers,
        tangential_velocity: Numbers = 0.0,
        spin: Numbers = 0.0,
        *,
        normal_spin: Numbers = 0.0,
        pair: Pair | None = None,
        unit_friction: bool = False,
        has_units: bool = True,
        encounter: object = None,
        frame: Array | None = None,
        along: tuple[float, float, float] | None = None,
        inverse_mass: Numbers | None = None,
        planar: bool = True,
        options: Mapping[str, object] = NOTHING,
        of_slip: OfSlip | None = None,
        links: Links | None = None,
    ) -> None: ...


@state_arguments
@attrs.frozen(init=False)
class Scene(_SceneArguments, Batches, Generic[Each]):
    """One oblique impact, or a batch of them, in SI units.

    The sphere moves towards the target, which is at rest and does not spin. Every
    number may be an array; the scene is then a batch of the broadcast ``shape``.

    To type checkers a scene of numbers is a ``Scene[float]`` and one with an array a
    ``Scene[Array]``, and so are the results of ``run``. Write ``Scene`` where a program does not
    know, and where ``attrs.evolve`` puts arrays in the place of numbers, which no checker sees:
    ``many: Scene = attrs.evolve(scene, spin=spins)``.

    Bodies of any shape have an inverse mass W in the frame (n, t1, t2) of their contact: the normal
    from the first body into the target, and two tangents. Where W couples, friction changes the
    approach. ``Encounter.scene`` makes such a scene from bodies, ``nondimensional`` from the groups
    of theory §14. Spheres leave W out: it is diagonal.

    Parameters
    ----------
    sphere : Sphere
        The body that moves.
    target : HalfSpace or Sphere
        The body at rest.
    friction_coefficient : float, array, callable or mapping
        Coulomb's mu, at least 0. As a function of the slip speed before the impact in m/s it takes
        a float, or an array of the scene's shape, and returns mu; a table ``{0.1: 0.3, 2.0: 0.2}``
        is linear between its slip speeds. Each impact then has the one number that follows.
    normal_speed : float or array
        v1, the speed of approach along the normal, in m/s, positive.
    tangential_velocity : float or array
        v, the tangential velocity of the sphere's centre, in m/s. With an inverse mass: the slip
        velocity along t1; along t1 and t2, shape (..., 2), where ``planar`` is False.
    spin : float or array
        omega, in rad/s, positive where it adds to the tangential velocity at the
        contact: v_x = v + omega R, eq. (20).
    normal_spin : float or array
        omega_n, spin about the normal of the first body relative to the target, in rad/s, by the
        right-hand rule about the normal from the first body into the target. Friction of it needs a
        law with the word ``normal_spin``, such as ``halfspace``; the plan of other laws tells what
        they leave out. 0 for bodies off centre, whose slip moves that spin too.
    pair : Pair
        The numbers of the two bodies that laws need. They are computed from the bodies; a pair
        is given only for a scene without bodies, as in ``nondimensional``.
    unit_friction : bool
        True if the friction coefficient is 1 by choice of units, as in ``nondimensional`` without a
        friction coefficient. A law that needs mu itself refuses such a scene.
    has_units : bool
        False if lengths, masses and speeds are 1 by choice, as in ``nondimensional``. A law with an
        option in m, s or kg is refused in such a scene.
    encounter : Encounter, optional
        The encounter in space, which cautions and velocities in space look at.
    frame : array, shape (..., 3, 3), optional
        n, t1 and t2 as rows, in the frame of an encounter of bodies that are no spheres.
    along : tuple of three floats, optional
        Unit tangent of an encounter along which tangential velocities of the first body, and its
        spin about the normal cross this tangent, are numbers in results, as those of a sphere are.
    inverse_mass : array, shape (..., 3, 3), optional
        W in 1/kg, of a scene without sphere and target: the acceleration of the relative motion at
        the contact for unit forces along n, t1 and t2.
    planar : bool
        True if the motion stays in the plane of n and t1, so that slip is a number.
    options : mapping of str to array
        Options of laws of which each impact has its own number, by ``kind.option (unit)``. A run
        fills them in from its laws, so that parts of a batch keep theirs.
    of_slip : OfSlip, optional
        The function or table of the friction coefficient. A scene with other velocities has the
        numbers that follow; one with another friction coefficient has that.
    links : Links, optional
        How the contacts of a ``Gathering`` move one another; contacts are then the last axis.
        ``collide`` answers such a scene, and nothing else does.

    Raises
    ------
    ValueError
        If a number is not finite or out of range, or W is not positive definite. The message names
        the argument.
    """

    sphere: Sphere[Each] | None = instance(
        Sphere,
        remedy="make one: Sphere(...); of other bodies take Encounter(...).scene",
        optional=True,
    )
    target: Sphere[Each] | HalfSpace[Each] | None = instance(
        HalfSpace, Sphere, remedy="make one: HalfSpace(material)", optional=True
    )
    friction_coefficient: Each | float = friction()
    normal_speed: Each | float = quantity("m/s", rule=POSITIVE)
    tangential_velocity: Each | float = quantity("m/s", default=0.0)
    spin: Each | float = quantity("rad/s", default=0.0)
    normal_spin: Each | float = quantity("rad/s", default=0.0, kw_only=True)
    # None only until __attrs_post_init__ computes the pair from the bodies.
    pair: Pair = instance(
        Pair, remedy="or leave it out", optional=True, default=None, kw_only=True, repr=False
    )
    unit_friction: bool = instance(bool, default=False, kw_only=True, repr=False)
    has_units: bool = instance(bool, default=True, kw_only=True, repr=False)
    encounter: Any = attrs.field(default=None, eq=False, repr=False, kw_only=True)
    frame: Array | None = attrs.field(default=None, eq=False, repr=False, kw_only=True)
    along: tuple[float, float, float] | None = attrs.field(
        default=None, eq=False, repr=False, kw_only=True
    )
    inverse_mass: Array | None = attrs.field(
        default=None, converter=_tensors, eq=key, repr=False, kw_only=True
    )
    planar: bool = instance(bool, default=True, kw_only=True, repr=False)
    _options: Mapping[str, Any] = attrs.field(default=NOTHING, kw_only=True, repr=False)
    #: Friction as a function of slip; None where friction is given by numbers.
    _of_slip: OfSlip | None = attrs.field(default=None, eq=False, kw_only=True, repr=False)
    links: Links | None = attrs.field(default=None, eq=False, repr=False, kw_only=True)
    #: Batch shape: () for one impact.
    shape: tuple[int, ...] = attrs.field(init=False, eq=False, repr=False)
    _index: int | Places | None = attrs.field(init=False, eq=False, repr=False)
    _axes: tuple[tuple[str, Array], ...] = attrs.field(init=False, eq=False, repr=False, default=())
    _varied: tuple[tuple[str, Array], ...] = attrs.field(
        init=False, eq=False, repr=False, default=()
    )

    if TYPE_CHECKING:  # what checkers know of the numbers of one impact, and of a batch

        @overload
        def __new__(
            cls,
            sphere: Sphere[float],
            target: Sphere[float] | HalfSpace[float],
            friction_coefficient: Number | LawOfSlip,
            normal_speed: Number,
            tangential_velocity: Number = ...,
            spin: Number = ...,
            *,
            normal_spin: Number = ...,
        ) -> Scene[float]: ...
        @overload
        def __new__(
            cls,
            sphere: Sphere,
            target: Sphere | HalfSpace,
            friction_coefficient: Numbers | LawOfSlip,
            normal_speed: Numbers,
            tangential_velocity: Numbers = ...,
            spin: Numbers = ...,
            *,
            normal_spin: Numbers = ...,
        ) -> Scene[Array]: ...
        @overload
        def __new__(
            cls,
            sphere: Sphere | None,
            target: Sphere | HalfSpace | None,
            friction_coefficient: Numbers | LawOfSlip,
            normal_speed: Numbers,
            tangential_velocity: Numbers = ...,
            spin: Numbers = ...,
            *,
            normal_spin: Numbers = ...,
            pair: Pair | None = ...,
            unit_friction: bool = ...,
            has_units: bool = ...,
            encounter: object = ...,
            frame: Array | None = ...,
            along: tuple[float, float, float] | None = ...,
            inverse_mass: Numbers | None = ...,
            planar: bool = ...,
            options: Mapping[str, object] = ...,
            of_slip: OfSlip | None = ...,
            links: Links | None = ...,
        ) -> Scene: ...
        def __new__(cls, *_: object, **__: object) -> Scene: ...  # noqa: D102
        @overload
        def take(self, part: int | tuple[int, ...]) -> Scene: ...
        @overload
        def take(self, part: Index) -> Self: ...
        def take(self, part: Index) -> Scene: ...  # noqa: D102
        @property
        def slip_velocity(self) -> Each | float: ...  # noqa: D102
        @property
        def psi_scale(self) -> Each | float: ...  # noqa: D102
        def psi(self, velocity: Real) -> Each | float: ...  # noqa: D102
        @property
        def psi1(self) -> Each | float: ...  # noqa: D102
        @property
        def w1(self) -> Each | float: ...  # noqa: D102
        @property
        def chi_w(self) -> Each | float: ...  # noqa: D102
        @property
        def chi(self) -> Each | float: ...  # noqa: D102
        @property
        def lam(self) -> Each | float: ...  # noqa: D102
        @property
        def eta(self) -> Each | float: ...  # noqa: D102
        @property
        def rho(self) -> Each | float: ...  # noqa: D102

    def __attrs_post_init__(self) -> None:
        if self.sphere is not None and self.target is not None:
            # A given pair is ignored: attrs.evolve passes the pair of the former bodies.
            pair = Pair.of(self.sphere, self.target, turning=kinetics.turns(self))
            object.__setattr__(self, "pair", pair)
        elif self.pair is None:
            raise refuse(
                "sphere, target",
                (self.sphere, self.target),
                "both bodies must be given",
                "or use Scene.nondimensional(psi1=, chi=)",
            )
        shape = batch.common_shape(
            self._shapes(),
            what="Scene: the shapes",
            remedy="give numbers, or arrays of equal length",
        )
        if 0 in shape:
            raise refuse("shape", shape, "a scene must hold at least one impact")
        mu = self.friction_coefficient
        if self._of_slip is not None or (type(mu) is not float and is_law_of_slip(mu)):
            self._set_friction(shape)
        object.__setattr__(self, "shape", shape)
        index = batch.lock_arrays(np.arange(math.prod(shape)).reshape(shape)) if shape else 0
        object.__setattr__(self, "_index", index)
        if self.inverse_mass is not None:
            self._check_inverse_mass()
        self._check_scales()

    def _set_friction(self, shape: tuple[int, ...]) -> None:
        """Set the friction that follows from the slip, unless numbers took its place."""
        slip = kinetics.slip_speed(self)
        if is_law_of_slip(self.friction_coefficient):
            if not self.has_units:
                rule = "follows from a slip speed in m/s, and psi1 and chi have no units"
                raise refuse("friction_coefficient", self.friction_coefficient, rule, "give bodies")
            found: OfSlip | None = OfSlip.of(law_of_slip(self.friction_coefficient), slip, shape)
        else:
            before = self._of_slip
            assert before is not None
            found = before.at(self.friction_coefficient, slip, shape)
        object.__setattr__(self, "_of_slip", found)
        if found is not None:
            object.__setattr__(self, "friction_coefficient", found.numbers)

    def _shapes(self) -> dict[str, tuple[int, ...]]:
        """Return the batch shape of every number that varies."""
        shapes = {}
        if np.ndarray in map(type, (*self._columns(), *self._of_materials().values())):
            shapes = {
                name: number.shape
                for name, number in self.numbers().items()
                if isinstance(number, np.ndarray)
            }
        if self._options is not NOTHING:
            shapes |= {name: np.shape(each.numbers) for name, each in self._options.items()}
        if self.inverse_mass is not None:
            shapes["inverse_mass"] = self.inverse_mass.shape[:-2]
            if not self.planar:
                shapes["tangential_velocity"] = np.shape(self.tangential_velocity)[:-1]
        return shapes

    def _check_inverse_mass(self) -> None:
        """Refuse a W that no bodies have; spread vectors and tensors over the batch."""
        if self.sphere is not None:
            rule = "follows from sphere and target"
            raise refuse("inverse_mass", self.inverse_mass, rule, "leave one of them out")
        vectors: dict[str, tuple[int, ...]] = {"inverse_mass": (3, 3)}
        if not self.planar:
            vectors["tangential_velocity"] = (2,)
        for name, trailing in vectors.items():
            given = np.asarray(getattr(self, name))
            if given.shape[-len(trailing) :] != trailing:
                raise refuse(f"{name}.shape", given.shape, f"must end with {trailing}")
            object.__setattr__(self, name, batch.lock_arrays(over(given, (*self.shape, *trailing))))
        W = self.inverse_mass
        assert W is not None
        inverse_mass.check(W)
        normal, along, across = (entry(W, k, k) for k in range(3))
        tangential = along if self.planar else 0.5 * (along + across)
        masses = {"normal_mass": 1.0 / normal, "tangential_mass": 1.0 / tangential}
        if not self.shape and [getattr(self.pair, name) for name in masses] == [*masses.values()]:
            return  # as of any two bodies
        masses = {name: batch.lock_arrays(mass) for name, mass in masses.items()}
        object.__setattr__(self, "pair", batch.change_entries(self.pair, **masses))

    def numbers(self) -> dict[str, Real]:
        """Return every number of the scene and of its pair, by name."""
        columns = zip((*OF_PAIR, *OF_SCENE), self._columns(), strict=True)
        return dict(columns) | self._of_materials()

    def _columns(self) -> tuple[Real, ...]:
        """Return the numbers of the pair and of the scene, in the order of their names."""
        return (*_of_pair(self.pair), *_of_scene(self))

    def _of_materials(self) -> dict[str, Real]:
        """Return the yield stresses that are known, and the properties, by name."""
        numbers: dict[str, Real] = {}
        for name, body in (("sphere", self.sphere), ("target", self.target)):
            if body is not None and body.material.yield_stress is not None:
                numbers[f"{name}.material.yield_stress"] = body.material.yield_stress
            if body is not None and body.material.properties is not NOTHING:
                for heading, number in body.material.properties.items():
                    numbers[f"{name}.material.properties[{heading!r}]"] = number
        return numbers

    def _check_scales(self) -> None:
        """Refuse scenes whose numbers overflow, or lose digits by underflow."""
        if not self.shape:  # plain numbers warn of nothing
            self._judge_scales()
            return
        with np.errstate(all="ignore"):
            self._judge_scales()

    def _judge_scales(self) -> None:
        """Do what ``_check_scales`` says, whatever NumPy does about numbers out of range."""
        friction: Real = self.friction_coefficient
        speed: Real = self.normal_speed
        energy = 0.5 * self.pair.normal_mass * (speed * speed)
        unit = friction * speed / self.pair.stiffness_ratio
        slip: Real = kinetics.slip_speed(self)
        slip_energy = 0.5 * self.pair.tangential_mass * (slip * slip)
        momentum = friction * self.pair.normal_mass * speed
        tiny = (unit < LEAST_VELOCITY) & (slip < LEAST_VELOCITY)
        tiny = tiny | (momentum < LEAST_IMPULSE) & (slip < 1e9 * unit)
        vast = slip / (unit + (unit == 0.0)) == math.inf
        unheld = (unit > 0.0) & (slip > 0.0) & (tiny | vast)
        lost = (friction > 0.0) & (unit == 0.0)
        if kinetics.turns(self):
            self._check_normal_spin()
        if not batch.every(slip_energy < math.inf):
            si = self.sphere is not None
            turning = " + spin * radius" if np.any(self.spin) else ""
            raise refuse(
                f"tangential_velocity{turning}" if si else "psi1, chi",
                self.slip_velocity if si else (self.psi1, self.chi),
                "the kinetic energy of slip must be finite",
                "give less; from 4 chi - 1 on psi1 falls by 4 chi",
            )
        if not batch.every((energy >= LEAST_ENERGY) & (energy < math.inf)):
            raise refuse(
                "normal_speed",
                self.normal_speed,
                f"the kinetic energy of the impact must be at least {LEAST_ENERGY:g} J and finite, "
                "or digits are lost",
                f"give {'larger' if np.all(energy < 1.0) else 'smaller'} speeds or masses",
            )
        if batch.some(unheld | lost):
            raise refuse(
                "friction_coefficient",
                self.friction_coefficient,
                "with these velocities psi1 of eq. (29) cannot be held in floating point",
                "give 0 for no friction, or larger velocities",
            )

    def _check_normal_spin(self) -> None:
        """Refuse spin about the normal without its inertia, or with an energy that overflows."""
        inverse = self.pair.inverse_spin_mass
        if np.any((np.asarray(self.normal_spin) != 0.0) & (np.asarray(inverse) == 0.0)):
            rule = "must be positive where the bodies spin about the normal"
            remedy = "give spheres, or R²/J in 1/kg with J about the normal"
            raise refuse("pair.inverse_spin_mass", inverse, rule, remedy)
        with np.errstate(all="ignore"):
            finite = np.isfinite(kinetics.spin_energies(self, 0.0)[0])
        if not np.all(finite):
            rule = "the kinetic energy of the spin about the normal must be finite"
            raise refuse("normal_spin", self.normal_spin, rule, "give it in rad/s")

    @overload
    @classmethod
    def at_angle(
        cls,
        sphere: Sphere[float],
        target: Sphere[float] | HalfSpace[float],
        friction_coefficient: Number | LawOfSlip,
        *,
        speed: Number,
        angle_deg: Number,
        spin: Number = ...,
        normal_spin: Number = ...,
    ) -> Scene[float]: ...
    @overload
    @classmethod
    def at_angle(
        cls,
        sphere: Sphere,
        target: Sphere | HalfSpace,
        friction_coefficient: Numbers | LawOfSlip,
        *,
        speed: Numbers,
        angle_deg: Numbers,
        spin: Numbers = ...,
        normal_spin: Numbers = ...,
    ) -> Scene[Array]: ...
    @classmethod
    def at_angle(
        cls,
        sphere: Sphere,
        target: Sphere | HalfSpace,
        friction_coefficient: Numbers | LawOfSlip,
        *,
        speed: Numbers,
        angle_deg: Numbers,
        spin: Numbers = 0.0,
        normal_spin: Numbers = 0.0,
    ) -> Scene:
        """Return the scene of a sphere whose centre moves at an angle from the normal.

        Parameters
        ----------
        sphere, target, friction_coefficient, spin, normal_spin
            As in the class.
        speed : float or array
            Speed of the sphere's centre in m/s, positive.
        angle_deg : float or array
            Angle from the normal in degrees, between -90 and 90.

        Raises
        ------
        ValueError
            If a number is out of range. The message names the argument.
        """
        remedy = "give speed in m/s and angle_deg in degrees from the normal"
        fast = real("speed", speed, rule=POSITIVE, remedy=remedy)
        angle = np.radians(real("angle_deg", angle_deg, rule=OBLIQUE, remedy=remedy))
        batch.common_shape(
            {"speed": np.shape(fast), "angle_deg": np.shape(angle)},
            what="Scene.at_angle: the shapes",
            remedy="give arrays of equal length, or every combination by "
            "Scene.grid(ball, plate, friction_coefficient=0.2, speed=[1, 2], angle_deg=[10, 20])",
        )
        ahead, aside = np.cos(angle), np.sin(angle)
        along = fast * ahead, fast * aside
        return cls(sphere, target, friction_coefficient, *along, spin, normal_spin=normal_spin)

    @overload
    @classmethod
    def nondimensional(  # type: ignore[overload-overlap]  # a number is the first of both
        cls,
        *,
        psi1: Number,
        chi: Number,
        lam: Number = ...,
        eta: Number | None = ...,
        rho: Number | None = ...,
        poisson_ratio: Number | None = ...,
        coupling_number: Number | None = ...,
        friction_coefficient: Number | None = ...,
        cross_stiffness_ratio: Number = ...,
        spin: Number = ...,
        spin_inertia: Number = ...,
    ) -> Scene[float]: ...
    @overload
    @classmethod
    def nondimensional(
        cls,
        *,
        psi1: Numbers,
        chi: Numbers,
        lam: Numbers = ...,
        eta: Numbers | None = ...,
        rho: Numbers | None = ...,
        poisson_ratio: Numbers | None = ...,
        coupling_number: Numbers | None = ...,
        friction_coefficient: Numbers | None = ...,
        cross_stiffness_ratio: Numbers = ...,
        spin: Numbers = ...,
        spin_inertia: Numbers = ...,
    ) -> Scene[Array]: ...
    @classmethod
    def nondimensional(
        cls,
        *,
        psi1: Numbers,
        chi: Numbers,
        lam: Numbers = 0.0,
        eta: Numbers | None = None,
        rho: Numbers | None = None,
        poisson_ratio: Numbers | None = None,
        coupling_number: Numbers | None = None,
        friction_coefficient: Numbers | None = None,
        cross_stiffness_ratio: Numbers = 1.0,
        spin: Numbers = 0.0,
        spin_inertia: Numbers = 0.0,
    ) -> Scene:
        """Return the scene of the paper's two parameters, eqs (29) and (38), and of theory §14.

        The units are chosen so that v1 = R = C = M = 1, and mu = kappa = 1 unless they are given;
        laws with an option in other units are refused.
        Velocities of the results are then the paper's V and psi; with mu and kappa the slip
        velocity is mu/kappa times psi. The scene has no sphere, hence no spin and no velocity of a
        centre.

        Axisymmetric laws need psi1 and chi only. A law of the three-dimensional half-space needs
        the Poisson ratio too, and between unlike bodies the coupling number. Where tangential
        traction changes the pressure it needs the friction coefficient as well.

        With ``lam`` friction changes the approach, as between bodies of any shape; then eta or rho
        is needed, unless both the Poisson ratio and the friction coefficient are given. Where chi
        ends with (2, 2) and rho is given, psi1 and ``lam`` are vectors of the tangent plane.

        Parameters
        ----------
        psi1 : float or array; in space an array of shape (..., 2)
            Local angle of incidence of the paper's eq. (29), without unit: kappa v_x/(mu v1).
        chi : float or array; in space an array of shape (..., 2, 2)
            Inertia ratio (38), (kappa/2) W_tt/W_nn, positive, without unit; 1.4412 for a solid
            sphere of nu = 0.3.
        lam : float or array; in space an array of shape (..., 2)
            mu W_nt/W_nn, what friction adds to the approach; 0 for spheres.
        eta : float or array, optional
            kappa W_nt/(mu W_nn), what pressure adds to the slip; in the plane only. It has the
            sign of ``lam``, and is zero where ``lam`` is.
        rho : float or array, optional
            mu²/kappa = lam/eta, in place of ``eta``.
        poisson_ratio : float or array, optional
            Effective Poisson ratio, the mean of both bodies' with weights 1/G. It makes
            kappa = 2 (1 - nu)/(2 - nu).
        coupling_number : float or array, optional
            Lambda = kappa beta/mu, with Dundurs' beta of the two bodies; 0 for like bodies.
        friction_coefficient : float or array, optional
            Coulomb's mu, positive. Axisymmetric answers in psi do not depend on mu.
        cross_stiffness_ratio : float or array
            G* along t2 over that along t1, of an elliptic contact (theory §16), from 1/2 to 2; 1
            for a circle.
            kappa and rho are those of t1; psi1, chi and eta have kappa of each direction, so
            that chi_21 = ``cross_stiffness_ratio`` chi_12.
        spin : float or array
            w1 = kappa omega_n a/(mu v1) of theory §17, the rim speed of the relative spin about the
            normal in the unit of psi; a is the largest contact radius.
        spin_inertia : float or array
            chi_w = (kappa/2) M_n a²/J about the normal, the inertia ratio of spin; positive where
            ``spin`` is not 0; 5/7 chi (a/R)² for a solid sphere on a half-space.

        Raises
        ------
        ValueError
            If a number is not finite or out of range, lam eta >= 2 chi, rho or lam/eta contradicts
            the friction coefficient and the Poisson ratio, or ``spin`` has no ``spin_inertia`` or
            stands beside ``lam``.
        """
        entries = groups.entries(
            psi1=psi1,
            chi=chi,
            lam=lam,
            eta=eta,
            rho=rho,
            poisson_ratio=poisson_ratio,
            coupling_number=coupling_number,
            friction_coefficient=friction_coefficient,
            cross_stiffness_ratio=cross_stiffness_ratio,
            spin=spin,
            spin_inertia=spin_inertia,
        )
        return cls(None, None, **entries)

    @classmethod
    def grid(cls, *bodies: Sphere | HalfSpace, **entries: Numbers) -> Scene[Array]:
        """Return the batch of all combinations of some entries, the last varying fastest.

        An example is ``Scene.grid(chi=[1.2, 1.4412], psi1=np.linspace(0, 6, 25))``. A list gives
        the values of an entry that varies, a number an entry that does not. The scene keeps its
        ``axes``, so tables and ``ImpactResult.to_xarray`` have named dimensions.

        Parameters
        ----------
        *bodies : Sphere, HalfSpace, optional
            Sphere and target; no bodies with psi1 and chi.
        **entries : float or list
            Entries of ``Scene``; or of ``Scene.at_angle``, with speed and angle_deg; or psi1, chi,
            lam, eta and rho.

        Raises
        ------
        ValueError
            If no entry varies, a list has more than one dimension, or the scene is refused.
        """
        from contactlab.impact.grid import axes_of, product  # needed for grids only

        axes = axes_of(entries)
        return batches.over(cls._maker(bodies, entries)(*bodies, **(entries | product(axes))), axes)

    @classmethod
    def grid_in_parts(
        cls, *bodies: Sphere | HalfSpace, at_a_time: int = IMPACTS_AT_A_TIME, **entries: Numbers
    ) -> GridParts:
        """Return the scenes of a grid one after another, for more impacts than memory holds.

        ``simulation.sweep(Scene.grid_in_parts(...), into=folder)`` sweeps them into a folder.

        Parameters
        ----------
        *bodies, **entries
            As in ``grid``; of any number of impacts.
        at_a_time : int
            Impacts of a scene.

        Raises
        ------
        ValueError
            As ``grid``.
        """
        size = whole("at_a_time", at_a_time)
        make = cls._maker(bodies, entries)

        def part(values: Mapping[str, Array]) -> Scene:
            return batches.varying(make(*bodies, **(entries | dict(values))), values)

        from contactlab.impact.grid import GridParts, axes_of  # needed for grids only

        return GridParts(axes_of(entries), size, part)

    @classmethod
    def _maker(
        cls, bodies: Sequence[object], entries: Mapping[str, object]
    ) -> Callable[..., Scene]:
        """Return a function that makes a scene from bodies and entries."""
        if not bodies and {"psi1", "chi", "lam"} & set(entries):
            return cls.nondimensional
        return cls.at_angle if {"speed", "angle_deg"} & set(entries) else cls


@cache
def _unit_scene() -> Scene:
    """Return an impact whose numbers are 1, without bodies."""
    pair = Pair.of_numbers(dict.fromkeys(ROUND, 1.0))
    return Scene(None, None, 1.0, 1.0, pair=pair)


def of_bodies(entries: Mapping[str, object]) -> Scene:
    """Return a scene by entries that follow from bodies, checked with them but for the scales."""
    scene = batch.change_entries(_unit_scene(), **entries)
    scene._check_scales()
    return scene


#: Numbers of a pair and of a scene.
OF_PAIR = tuple(field.name for field in attrs.fields(Pair))
OF_SCENE = tuple(field.name for field in attrs.fields(Scene) if "unit" in field.metadata)
_of_pair, _of_scene = attrgetter(*OF_PAIR), attrgetter(*OF_SCENE)
#: Units of the entries from which scenes are made.
UNITS: dict[str, str] = {
    field.name: field.metadata["unit"]
    for kind in (Scene, Sphere, Material)
    for field in attrs.fields(kind)
    if "unit" in field.metadata
} | {
    "speed": "m/s",
    "angle_deg": "deg",
    "psi1": "1",
    "chi": "1",
    "coupling_number": "1",
    "lam": "1",
    "eta": "1",
    "rho": "1",
    "cross_stiffness_ratio": "1",
    "spin_inertia": "1",
    "w1": "1",
    "chi_w": "1",
    "tilt_deg": "deg",
    "target_normal_velocity": "m/s",
    "target_tangential_velocity": "m/s",
    "target_spin": "rad/s",
    "curvature_radius": "m",
    "cross_radius": "m",
    "young_modulus": "Pa",
}


def entry_unit(name: str) -> str:
    """Return the unit of an entry; the name may be dotted: ``"sphere.radius"`` has the unit m.

    The unit of a material's property, or of a law's option, is not known here: ``SI``.
    """
    return UNITS.get(name.rpartition(".")[2], "SI") if "." in name else UNITS[name]
