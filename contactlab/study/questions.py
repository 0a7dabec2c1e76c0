"""Questions of a benchmark: impacts, their true answers, and the doors that answer them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Final, TypeAlias

import attrs
import numpy as np

from contactlab.collisions.collide import collide
from contactlab.collisions.gathered import GatheringResult
from contactlab.contracts import NormalLaw
from contactlab.contracts.law import claims
from contactlab.impact import shapes
from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.encounter import Encounter
from contactlab.impact.gathering import Body, Gathering, Touch
from contactlab.impact.material import Material
from contactlab.impact.rigid_body import RigidBody
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Array, Real
from contactlab.outcome.result import ImpactResult
from contactlab.registry import composition
from contactlab.registry.registry import REGISTRY
from contactlab.runs.simulation import Simulation
from contactlab.study import doors, peers
from contactlab.study.bench_methods import Method, Options, methods, scenes
from contactlab.study.doors import Answer, Door
from contactlab.study.posed import need_units
from contactlab.study.stability_references import converges, reference_for

#: Tolerance of the exact answers: finer than the default, which is measured too.
EXACT_TOLERANCE = 1e-12
#: Springs of other true answers, extrapolated from half as many; steps are four times as many.
TRUE_SPRINGS, TRUE_SPRINGS_QUICK = 800, 400
TRUE_OF_TWO, TRUE_OF_TWO_QUICK = 400, 200
#: Rings of the true answer with spin about the normal; instants of a course.
TRUE_RINGS, INSTANTS = 24, 60
#: The restitution of impacts with loss, and the normal law that stands for any.
LOSS, ANY = 0.8, "tsuji"
#: Least restitution that springs follow; below it their answer is that of ``rebound``.
LEAST_FOLLOWED = 0.01
#: The law of spin about the normal.
SPINNING: Final = "tangential.halfspace"
#: Integrators, the usual one first.
USUAL = ("symplectic", "events", "adaptive", "paper")
#: Impacts of a batch, and of a batch of bodies.
MANY, MANY_BODIES = 1000, 100
#: Status of a law that answers impacts as a whole and has no force in between.
NO_COURSE = "NO_COURSE"
#: Multiples of this number spread evenly over [0, 1].
GOLDEN = 0.6180339887498949
DOWN = np.array([0.0, 0.0, -1.0])
#: A body, and the vector to its contact.
Made: TypeAlias = tuple[RigidBody, Array]


@attrs.frozen(kw_only=True)
class Posed:
    """The impacts of a question.

    Attributes
    ----------
    impacts : sequence
        Scenes, encounters or gatherings, each alone.
    batch : callable or None
        Returns so many impacts in one scene, encounter or gathering; None where no door takes them.
    most : int
        The largest batch.
    truths : sequence of arrays
        The true answer of each impact.
    doors : sequence of Door
    """

    impacts: Sequence[Any]
    truths: Sequence[Array]
    doors: Sequence[Door]
    batch: Callable[[int], Any] | None = None
    most: int = MANY


@attrs.frozen
class Question:
    """A question: its name, and what poses it, ``quick`` or not.

    ``needs`` is the law of the true answers, which may not be installed. ``peers`` tells whether
    other engines are asked.
    """

    name: str
    pose: Callable[[bool], Posed]
    needs: str | None = None
    peers: bool = False


def questions(
    laws: list[str] | None = None, only: str | None = None, *, restitution: float | None = None
) -> list[Question]:
    """Return the questions; for named laws only those that any law answers.

    Parameters
    ----------
    laws : list of str, optional
        As of ``bench_methods.methods``.
    only : str, optional
        The name of one question.
    restitution : float, optional
        Coefficient of restitution, in place of a normal law. Where no law is named, the questions
        are those of impacts with a restitution; springs can follow it from 0.01 on.
    """
    chosen = methods(laws, restitution=restitution)
    if laws is None and restitution is not None:
        found = _with_loss(restitution)
    elif laws is None:
        damped, usual = _usual(methods([f"normal.{ANY}"])), _usual(chosen)
        found = [
            Question(
                "sphere",
                lambda quick: _sphere(usual if quick else chosen, quick, alone=False),
                peers=True,
            ),
            *(each for each in _QUESTIONS if each.needs in (None, *REGISTRY.names())),
            Question("any normal law", lambda quick: _by_methods(damped, quick)),
            Question("course", lambda quick: _course(usual, quick)),
        ]
    else:
        found = []
        for normal in dict.fromkeys(each.normal for each in chosen):
            own = [each for each in chosen if each.normal == normal]
            found += _of_normal(normal, own)
    if only is None:
        return found
    if named := [each for each in found if each.name == only]:
        return named
    rule = "must be one of " + ", ".join(repr(each.name) for each in found)
    raise refuse("question", only, rule)


def _with_loss(restitution: float) -> list[Question]:
    """Return the questions of impacts with a restitution."""
    if restitution < LEAST_FOLLOWED:
        rule = f"must be at least {LEAST_FOLLOWED:g}: below it no springs give a true answer"
        raise refuse("restitution", restitution, rule)
    return [
        _of_spheres(restitution),
        _of_bodies("plane with e", _rod, restitution),
        _of_bodies("turning slip with e", _rod, restitution, across=0.3),
        _of_bodies("ellipse with e", _egg, restitution, across=0.3),
    ]


def _of_spheres(restitution: float) -> Question:
    """Return the question of spheres with a restitution."""
    return Question(
        "sphere with e", lambda quick: _sphere_with_loss(restitution, quick), peers=True
    )


def _of_bodies(
    name: str, make: Callable[[], Made], restitution: float, *, across: float = 0.0
) -> Question:
    """Return the question of a body that falls; slip keeps its line where ``across`` is 0."""
    return Question(
        name,
        lambda quick: _bodies(make(), restitution, quick, across=across),
        peers=across == 0.0,
    )


def _usual(chosen: Sequence[Method]) -> list[Method]:
    """Return each law under the first of the usual integrators that runs it."""
    of_law: dict[str, Method] = {}
    for method in sorted(chosen, key=lambda each: (*USUAL, each.integrator).index(each.integrator)):
        of_law.setdefault(method.tangential, method)
    return list(of_law.values())


def _of_normal(normal: str, own: list[Method]) -> list[Question]:
    """Return the question for laws under one normal law."""
    if normal != composition.DEFAULT_NORMAL:
        return [Question(f"sphere, {normal}", lambda quick: _by_methods(own, quick))]
    return [
        Question("sphere", lambda quick: _sphere(own, quick, alone=True)),
        Question("course", lambda quick: _course(own, quick)),
    ]


def sweep_scenes(size: int = MANY) -> Scene:
    """Return impacts of solid spheres without slip throughout, one batch."""
    chi = 1.17 + 0.58 * (np.arange(size) * GOLDEN % 1.0)  # all chi beside all psi1
    psi1 = 0.01 + np.linspace(0.0, 1.0, size) * (4.0 * chi - 1.02)
    return Scene.nondimensional(psi1=psi1, chi=chi)


def _resolutions(chosen: Sequence[Method], quick: bool) -> Iterator[tuple[Method, Options]]:
    """Yield the methods at every resolution, coarse to fine; two of another model if ``quick``."""
    for method in chosen:
        ladder = method.resolutions(quick=quick)
        if quick and not converges(method.simulation(ladder[0]).tangential):
            ladder = ladder[:2]
        for options in ladder:
            yield method, options


def _ladders(chosen: Sequence[Method], quick: bool) -> list[Door]:
    """Return the methods at every resolution."""
    return [doors.by_method(*each) for each in _resolutions(chosen, quick)]


def _sphere(chosen: Sequence[Method], quick: bool, *, alone: bool) -> Posed:
    """Return elastic spheres; without the doors that are no laws if laws were named ``alone``."""
    impacts = _scenes_for(chosen, quick)
    others = [] if alone else [
        doors.by_rebound(), *doors.in_c(spheres=True), *doors.limits(formula=True),
        *peers.of_spheres(),
    ]  # fmt: skip
    return Posed(
        impacts=impacts,
        batch=sweep_scenes,
        truths=_exact(impacts),
        doors=[*others, *_ladders(chosen, quick)],
    )


def _scenes_for(chosen: Sequence[Method], quick: bool) -> list[Scene]:
    """Return the scenes of the benchmark, in SI if an option of a law has a unit."""
    plain: Options = {"tangential": {}, "integrator": {}}
    return scenes(
        quick=quick, sized=any(need_units(each.simulation(plain).laws) for each in chosen)
    )


def _psi2(simulation: Simulation, impacts: Sequence[Scene]) -> list[Array]:
    """Return psi2 of each impact, in one axis."""
    return [np.ravel(simulation.run(each).check().psi2) for each in impacts]


def _exact(impacts: Sequence[Scene], normal: NormalLaw | None = None) -> list[Array]:
    """Return psi2 of each impact by the exact laws."""
    return _psi2(Simulation(normal=normal, **composition.exact(EXACT_TOLERANCE)), impacts)


def _extrapolate(answers: Callable[[int], list[Array]], fine: int) -> list[Array]:
    """Return the limits of answers by so many springs, whose error falls with the square."""
    both = zip(answers(fine // 2), answers(fine), strict=True)
    return [whole + (whole - half) / 3.0 for half, whole in both]


def _sphere_with_loss(restitution: float, quick: bool) -> Posed:
    """Return spheres of one restitution."""
    impacts = scenes(quick=quick)[: 3 if quick else None]
    return Posed(
        impacts=impacts,
        batch=sweep_scenes,
        truths=_by_fine_springs(impacts, restitution, quick),
        doors=[
            doors.by_rebound(restitution),
            *doors.in_c(restitution, spheres=True),
            doors.by_run("run()", "", Simulation(restitution=restitution)),
            *doors.by_springs(12, 25, 50, 100, restitution=restitution),
            *doors.limits(formula=False),
            *peers.of_spheres(restitution),
        ],
    )


def _rod() -> Made:
    axis = [math.sin(0.5), 0.0, math.cos(0.5)]
    return shapes.rod(
        length=0.1, radius=0.005, material=Material.named("steel"), axis=axis, normal=DOWN
    )


def _egg() -> Made:
    axis = np.array([0.5, 0.0, math.sqrt(0.75)])
    axes = np.stack((axis, [0.0, 1.0, 0.0], np.cross(axis, [0.0, 1.0, 0.0])), axis=1)
    return shapes.ellipsoid(
        semi_axes=[0.03, 0.022, 0.015], material=Material.named("steel"), axes=axes, normal=DOWN
    )


def _falls(body: Made, velocity: tuple[Real, Real]) -> Encounter:
    """Return a fall on steel at 1 m/s; ``velocity`` are its parts along the floor."""
    along, across = np.broadcast_arrays(*velocity)
    return Encounter(
        body[0], HalfSpace(Material.named("steel")), 0.3, normal=DOWN, contact=body[1],
        velocity=np.stack([along, across, np.full(along.shape, -1.0)], axis=-1),
    )  # fmt: skip


def _bodies(body: Made, restitution: float, quick: bool, *, across: float) -> Posed:
    """Return falls of one body; slip keeps its line where ``across`` is 0, in m/s."""
    alone = (0.1, 0.5) if quick else (-0.6, -0.2, 0.1, 0.3, 0.5, 0.9)
    impacts = [_falls(body, (each, across)) for each in alone]
    plane = across == 0.0
    falls = [each.scene for each in impacts]
    if plane and restitution == 1.0:
        truths, kernel = _exact(falls), doors.in_c(spheres=False)
    else:
        truths, kernel = _by_fine_springs(falls, restitution, quick), []
    return Posed(
        impacts=impacts,
        batch=lambda size: _falls(body, (np.linspace(-1.0, 1.0, size), across)),
        most=MANY_BODIES,
        truths=truths,
        doors=[
            doors.by_collide(restitution),
            doors.by_run("run()", "", Simulation(restitution=restitution)),
            *kernel,
            *doors.by_springs(12, 25, 50, 100, restitution=restitution),
            *(peers.of_rods(restitution) if plane else ()),
        ],
    )


def _by_fine_springs(impacts: Sequence[Scene], restitution: float, quick: bool) -> list[Array]:
    """Return psi2 by many springs, extrapolated as their error falls with the square."""
    fine = TRUE_SPRINGS_QUICK if quick else TRUE_SPRINGS
    return _extrapolate(lambda n: _psi2(doors.springs_of(n, restitution), impacts), fine)


def _normal_spin(quick: bool) -> Posed:
    """Return balls that spin about the normal."""
    steel = Material.named("steel")
    ball = Sphere(0.01, steel)

    def meet(slip: Real, spin: Real) -> Encounter:
        along, turning = np.broadcast_arrays(slip, spin)
        zero = np.zeros(along.shape)
        return Encounter(
            ball, HalfSpace(steel), 0.3, normal=DOWN,
            velocity=np.stack([along, zero, zero - 1.0], axis=-1),
            spin=np.stack([zero, zero, turning], axis=-1),
        )  # fmt: skip

    impacts = (
        [meet(0.4, 600.0)] if quick else [meet(0.2, 300.0), meet(0.4, 600.0), meet(0.8, 300.0)]
    )

    def law(rings: int) -> Simulation:
        return Simulation(tangential=REGISTRY.create(SPINNING, rings=rings))

    finest = law(TRUE_RINGS)
    ladder = [doors.by_run("halfspace", f"rings={rings}", law(rings)) for rings in (4, 8, 16)]
    return Posed(
        impacts=impacts,
        batch=lambda size: meet(np.linspace(0.1, 1.0, size), 300.0),
        most=MANY_BODIES,
        truths=_psi2(finest, [each.scene for each in impacts]),
        doors=[attrs.evolve(doors.by_collide(), name="collide(), without"), *ladder],
    )


def _two_contacts(quick: bool) -> Posed:
    """Return a billiard ball that meets cushion and cloth at once; errors over 1 m/s."""
    ball = Sphere(0.0286, Material(young_modulus=5e9, poisson_ratio=0.34, density=1700.0))
    rubber, cloth = (
        HalfSpace(Material(young_modulus=young, poisson_ratio=poisson))
        for young, poisson in ((5e6, 0.48), (5e7, 0.4))
    )

    def meet(along: Real) -> Gathering:
        first = np.asarray(along, dtype=float)
        one = np.ones(first.shape)
        return Gathering(
            [Body(ball, velocity=np.stack([first, one, 0.0 * one], axis=-1), spin=[-35, 35, 0])],
            [
                Touch(0, rubber, 0.14, normal=[0, 0.9165, 0.4]),
                Touch(0, cloth, 0.2, normal=DOWN),
            ],
        )

    def read(answer: GatheringResult) -> Answer:
        return Answer(np.ravel(answer.velocity))

    def door(name: str, options: str, simulation: Simulation | None) -> Door:
        return Door(
            name=name, options=options, read=read,
            bind=lambda gathering: lambda: collide(gathering, simulation),
        )  # fmt: skip

    def by_springs(count: int) -> list[Array]:
        return [read(collide(each, doors.springs_of(count))).numbers for each in impacts]

    impacts = [meet(each) for each in ((0.3,) if quick else (0.1, 0.3, 0.6, 1.0, 2.0))]
    fine = TRUE_OF_TWO_QUICK if quick else TRUE_OF_TWO
    return Posed(
        impacts=impacts,
        batch=lambda size: meet(np.linspace(0.1, 2.0, size)),
        most=MANY_BODIES,
        truths=_extrapolate(by_springs, fine),
        doors=[
            door("collide()", "", None),
            *(
                door("collide, springs", f"springs={n}, steps={4 * n}", doors.springs_of(n))
                for n in (12, 24, 50, 100)
            ),
        ],
    )


def _by_methods(chosen: Sequence[Method], quick: bool) -> Posed:
    """Return spheres under a normal law of its own, by laws at every resolution.

    The limit of a law is its own if it converges, else that of the law preferred there.
    """
    laws = [each.simulation({"tangential": {}, "integrator": {}}).laws for each in chosen]
    normal = laws[0].normal
    impacts = scenes(quick=quick, sized=True)
    friction = composition.law("tangential", composition.prefer_law("tangential", normal))
    own = [each.tangential for each in laws if converges(each.tangential)]
    if own and type(friction) not in map(type, own):
        friction = own[0]
    elastic = "elastic_hertz" in claims(normal)
    truths = _exact(impacts, normal) if elastic else []
    for scene in impacts[len(truths) :]:
        change = reference_for(friction, normal)(scene, friction)
        psi2 = math.nan if change is None else float(scene.psi1) + float(scene.psi(change))
        truths.append(np.array([psi2]))
    return Posed(
        impacts=impacts,
        batch=sweep_scenes,
        truths=truths,
        doors=_ladders(chosen, quick),
    )


def _course(chosen: Sequence[Method], quick: bool) -> Posed:
    """Return elastic spheres whose force is asked at every instant."""
    impacts = _scenes_for(chosen, quick)
    exact = Simulation(**composition.exact(EXACT_TOLERANCE))

    def read(result: ImpactResult) -> Answer:
        if not result.status:
            return Answer(np.empty(0), result.status.name)
        forces = _forces(result)
        return Answer(forces, "SUCCESS" if np.isfinite(forces).all() else NO_COURSE)

    def follow(door: Door, method: Method, options: Options) -> Door:
        simulation = method.simulation(options)
        return attrs.evolve(
            door, read=read, together=False,
            bind=lambda scene: lambda: simulation.run(scene, history=True),
        )  # fmt: skip

    return Posed(
        impacts=impacts,
        truths=[_forces(exact.run(each, history=True).check()) for each in impacts],
        doors=[
            follow(doors.by_method(method, options), method, options)
            for method, options in _resolutions(chosen, quick)
        ],
    )


def _forces(result: ImpactResult) -> Array:
    """Return the tangential force over mu P_max at even instants of the contact."""
    from scipy.interpolate import PchipInterpolator  # a few 1e-7 of the peak at 200 instants

    history = result.history
    assert history is not None
    instants, first = np.unique(history.time, return_index=True)  # an event may occur twice
    scale = float(np.asarray(result.scene.friction_coefficient * result.motion.maximum_force))
    even = np.linspace(instants[0], instants[-1], INSTANTS)
    if not np.isfinite(history.tangential_force).all():
        return np.full(INSTANTS, math.nan)
    force: Array = PchipInterpolator(instants, history.tangential_force[first])(even)
    return force / scale


_QUESTIONS = (
    _of_spheres(LOSS),
    _of_bodies("plane", _rod, 1.0),
    _of_bodies("plane with e", _rod, LOSS),
    _of_bodies("turning slip", _rod, 1.0, across=0.3),
    _of_bodies("ellipse", _egg, 1.0, across=0.3),
    Question("spin about the normal", _normal_spin, needs=SPINNING),
    Question("two contacts", _two_contacts),
)
