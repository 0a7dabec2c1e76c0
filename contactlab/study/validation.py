"""Checks of an installation: laws against closed forms and reference values, with bounds."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import attrs
import numpy as np
from numpy.typing import ArrayLike

from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.elliptic import ellipse
from contactlab.impact.hertz import hertz_scales, rigid_body_rebound
from contactlab.impact.material import Material
from contactlab.impact.scene import Scene
from contactlab.numeric.names import quote
from contactlab.numeric.progress import Count
from contactlab.numeric.types import Array
from contactlab.registration.bring import sound
from contactlab.registration.hooks import PluginError, guard, hookimpl
from contactlab.registration.manager import Told
from contactlab.registration.names import PROJECT
from contactlab.registry import composition
from contactlab.registry.registry import REGISTRY
from contactlab.runs.simulation import Simulation
from contactlab.scene_file import read_scene
from contactlab.study.scores import DEFAULT_SCENE
from contactlab.study.stability_coupled import RIGID_DISTANCE, STIFF, distance, rod

#: psi2 of the continuum limit for seven psi1 and three chi, to ten digits. Two independent methods
#: agree on them: front tracking, and springs with Richardson extrapolation.
REFERENCE_PSI1 = (0.1, 0.5, 1.0, 1.2, 2.0, 3.0, 4.0)
REFERENCE_PSI2 = {
    49 / 34: (
        0.0205907061, 0.0478310787, -0.0596967039, -0.1805194095,
        -0.8372100068, -1.3796832924, -1.4365122247,
    ),
    1.0: (
        -0.0410991914, -0.2650325763, -0.6328520783, -0.8138674261,
        -1.2952883031, -1.0, 0.0,
    ),
    3.0: (
        -0.0474078686, -0.1287928816, 0.0633660877, 0.2353785026,
        0.8494911084, 1.1585220552, 0.6554364732,
    ),
}  # fmt: skip
#: psi2 with one loss for pressure and shear at the same psi1, by restitution and chi, to 3e-6:
#: springs of two numbers, extrapolated (theory §15).
LOSS_PSI2 = {
    (0.912242, 49 / 34):
        (0.008928, 0.009160, -0.085073, -0.174580, -0.724878, -1.219935, -1.256848),
    (0.912242, 7 / 6):
        (-0.017317, -0.137768, -0.383082, -0.522071, -1.054454, -1.215194, -0.461897),
    (0.836405, 49 / 34):
        (0.001063, -0.018386, -0.107094, -0.176153, -0.637783, -1.089706, -1.105620),
    (0.836405, 7 / 6):
        (-0.019273, -0.134426, -0.351641, -0.468823, -0.942747, -1.084370, -0.284944),
    (0.712382, 49 / 34):
        (-0.007853, -0.050955, -0.136844, -0.184068, -0.513880, -0.891083, -0.859514),
    (0.712382, 1.0):
        (-0.033383, -0.190251, -0.425932, -0.531852, -0.867797, -0.424765, 0.575235),
    (0.538747, 49 / 34):
        (-0.013432, -0.071125, -0.153547, -0.186051, -0.373254, -0.639568, -0.435211),
    (0.538747, 1.75):
        (-0.010535, -0.052723, -0.105150, -0.120047, -0.208623, -0.450809, -0.672458),
}  # fmt: skip
#: Elliptic contact at an angle to its axes: groups, and psi2 by two programs (theory §16).
ASIDE: dict[str, Any] = {
    "psi1": (0.8252397, 0.9558827),
    "chi": ((0.4612217, 0.0), (0.0, 1.5682450)),
    "rho": 0.09 / 0.7736623,
    "cross_stiffness_ratio": 0.8961400 / 0.7736623,
}
ASIDE_PSI2, ASIDE_BOUND = (-0.643320, -0.062657), 2e-4
#: Curvatures B/A of a gap, b/a and R (A + B), of a direct solution of the contact (theory §16).
ELLIPSES = (
    (2.0, 0.630595701, 1.081965077), (4.0, 0.399887015, 1.351490525),
    (25.0, 0.125881950, 3.819343736), (400.0, 0.024714785, 30.7241028),
)  # fmt: skip
#: Springs and steps against these values, and the bound.
LOSS_SPRINGS, LOSS_STEPS, LOSS_BOUND = 50, 200, 1.2e-3
#: Relative bounds of force, and of approach or duration, as read off figures. Two readers of one
#: approach differ by 0.0054; the end of contact is read off a curve that meets its axis at a
#: small angle.
FORCE_READING, OTHER_READING = 0.003, 0.01
#: Compositions and the bound of psi2 over the reference values: laws, each with options, bound.
COMPOSITIONS: tuple[tuple[str, dict[str, Any], str, dict[str, Any], float], ...] = (
    ("fronts", {}, "events", {}, 1e-9),
    ("springs", {"springs": 50}, "symplectic", {"steps": 200}, 2e-3),
    ("annulus", {"annuli": 50}, "symplectic", {"steps": 200}, 0.03),
    ("annulus", {"annuli": 50}, "paper", {"steps": 500}, 0.03),
)
#: chi, lam and eta of eccentric impacts that begin in gross slip, with k > 1.
SLIDING = ((1.3, 0.19, 1.71), (0.8, -0.2, -0.4), (3.0, 1.5, 2.0), (1.1, 0.0, 0.0))
#: Rods by angle, friction and slip over approach; they tend to rigid bodies as the root of 1/kappa.
STIFF_RODS = (
    (15.0, 0.3, 0.0), (30.0, 0.3, 0.0), (-30.0, 0.3, 0.5), (30.0, 0.3, 0.5), (60.0, 0.2, 0.3),
    (-75.0, 0.1, 0.2),
)  # fmt: skip
#: Form of ``mindlin_cap`` of each series of ``compiled_codes.toml``; implementations of one law
#: agree to about 1e-3.
CODE_FORMS = ("displacement", "increment", "increment_rescaled")
CODE_BOUND = 2e-3
#: Young's modulus of a rigid plane, in Pa.
RIGID = 1e25


@attrs.frozen(kw_only=True)
class Finding:
    """One comparison: what is compared, against what, the largest difference, and its bound."""

    what: str
    against: str
    difference: float
    bound: float

    @property
    def ok(self) -> bool:
        """Return True if the bound is met; NaN does not meet it."""
        return self.difference <= self.bound


def validate(progress: Count | None = None) -> Iterator[Finding]:
    """Iterate over all comparisons as they are done; ``progress(done, total)`` follows each."""
    checks = sound("checks", object, lambda item: "" if callable(item) else "which is no function")
    for done, told in enumerate(checks, start=1):
        own = told.info.distribution == PROJECT
        yield told.item() if own else _run_check(told)
        if progress is not None:
            progress(done, len(checks))


def _run_check(told: Told) -> Finding:
    """Return the finding of a plug-in's check, a failed one with the reason if it raises."""
    name = getattr(told.item, "__name__", str(told.item))
    try:
        with guard(f"{name} of {told.info.distribution}", "raised"):
            found = told.item()
        rule = f"returned {quote(found)}, no Finding"
    except PluginError as error:
        found, rule = None, str(error)
    if isinstance(found, Finding):
        return found
    return Finding(what=rule, against="a Finding", difference=math.nan, bound=0.0)


@hookimpl
def contactlab_checks() -> Iterator[Callable[[], Finding]]:
    """Return contactlab's own comparisons."""
    installed = REGISTRY.names()
    yield _hertz
    yield _rigid
    yield _ellipses
    for named in COMPOSITIONS:
        if {f"tangential.{named[0]}", f"integrator.{named[2]}"} <= set(installed):
            yield partial(_reference, *named)
    if {"normal.viscoelastic", "tangential.springs", "integrator.symplectic"} <= set(installed):
        yield _loss
    if {"tangential.springs", "integrator.symplectic"} <= set(installed):
        yield _aside
    for name, (scene, published) in hertz_scalars().items():
        for entries, bound in (
            (("force",), FORCE_READING),
            (("approach", "duration"), OTHER_READING),
        ):
            told = {entry: published[entry] for entry in entries if entry in published}
            if told:
                yield partial(_scalars, name, scene, told, bound)
    if {"tangential.fronts", "tangential.coulomb", "integrator.events"} <= set(installed):
        yield from (_no_friction, _slip_throughout, _first_slip, _stiff)
    if "tangential.mindlin_cap" in installed:
        for number, form in enumerate(CODE_FORMS):
            yield partial(_codes, number, form)


def finding(what: str, against: str, off: ArrayLike, bound: float) -> Finding:
    """Return the finding of differences, of which the largest counts."""
    worst = float(np.max(np.abs(off)))
    return Finding(what=what, against=against, difference=worst, bound=bound)


def _hertz() -> Finding:
    scene = Scene.nondimensional(psi1=0.0, chi=1.0)
    result = Simulation(tangential="coulomb", integrator="symplectic").run(scene)
    duration = np.asarray(result.motion.duration / hertz_scales(scene).duration) - 1.0
    off = np.append(duration, np.asarray(result.normal_restitution) - 1.0)
    return finding("hertz: duration and restitution", "eq. (7), e = 1", off, 1e-9)


def _rigid() -> Finding:
    chi = 49 / 34
    psi1 = np.linspace(-8.0, 8.0, 65)
    sim = Simulation(tangential="coulomb", integrator="symplectic")
    psi2 = sim.sweep(Scene.nondimensional(psi1=psi1, chi=chi)).psi2
    off = psi2 - rigid_body_rebound(psi1, chi)
    return finding("coulomb: psi2", "slip, then rolling", off, 1e-12)


def _exact_laws() -> Simulation:
    return Simulation(tangential="fronts", integrator="events")


def _no_friction() -> Finding:
    scene = Scene.stack([rod(angle, 0.0, 0.5, kappa=0.8) for angle in (-50, 15, 30, 75)])
    result = _exact_laws().run(scene).check()
    W = np.asarray(scene.inverse_mass)
    slip = scene.slip_velocity - 2.0 * W[:, 0, 1] / W[:, 0, 0]
    off = np.hypot(result.normal_restitution - 1.0, result.rebound_slip_velocity - slip)
    return finding("fronts, two bodies: no friction", "V2 = -1, psi2 = psi1 - 2 eta", off, 1e-12)


def _sliding() -> tuple[Scene, Array, Array]:
    """Return scenes that slip in gross slip at first, s psi1 and k of theory §14."""
    chi, lam, eta = (np.array(each) for each in zip(*SLIDING, strict=True))
    k = (2.0 * chi + eta) / (1.0 + lam)
    slip = np.maximum(1.0, 2.0 * k - 1.0) * 1.2
    return Scene.nondimensional(psi1=slip, chi=chi, lam=lam, eta=eta), slip, k


def _slip_throughout() -> Finding:
    scene, slip, k = _sliding()
    result = _exact_laws().run(scene).check()
    off = np.hypot(result.normal_restitution - 1.0, result.psi2 - (slip - 2.0 * k))
    return finding("fronts, two bodies: slip throughout", "V2 = -1, psi2 = psi1 - 2k", off, 1e-10)


def _first_slip() -> Finding:
    scene, _, k = _sliding()
    psi, slips = np.asarray(scene.psi1), np.asarray(scene.slip_velocity)
    off = []
    for place, each in enumerate(k):
        psi1 = 1.0 + 0.2 * (1 + place) * (each - 1.0)  # slips at first touch, stops before V = 0
        slip = slips[place] * psi1 / psi[place]
        start = attrs.evolve(scene.take(place), tangential_velocity=slip)
        history = _exact_laws().run(start, history=True).check().history
        limit = float(start.friction_coefficient) * history.normal_force
        full = np.abs(history.tangential_force) >= limit * (1.0 - 1e-9)
        stopped = int(np.argmin(full)) - 1
        off.append(history.normal_velocity[stopped] - (each - psi1) / (each - 1.0))
    return finding("fronts, two bodies: end of first slip", "V = (k - psi1)/(k - 1)", off, 1e-9)


def _stiff() -> Finding:
    off = []
    for angle, friction, slip in STIFF_RODS:
        scene = rod(angle, friction, slip, kappa=STIFF)
        rigid = Simulation(tangential="coulomb").run(scene).check()
        off.append(float(distance(_exact_laws().run(scene).check(), rigid)))
    bound = RIGID_DISTANCE * STIFF**-0.5
    return finding("fronts, two bodies: rods, kappa = 1e4", "Routh's construction", off, bound)


def _reference(
    tangential: str,
    options: dict[str, object],
    integrator: str,
    settings: dict[str, object],
    bound: float,
) -> Finding:
    """Return the finding of one composition against ``REFERENCE_PSI2``."""
    sim = Simulation(
        tangential=composition.law("tangential", tangential, **options),
        integrator=composition.law("integrator", integrator, **settings),
    )
    off = [
        sim.sweep(Scene.nondimensional(psi1=np.array(REFERENCE_PSI1), chi=chi)).psi2
        - np.array(expected)
        for chi, expected in REFERENCE_PSI2.items()
    ]
    numbers = ", ".join(f"{key}={value}" for key, value in (options | settings).items())
    what = f"{tangential} / {integrator}" + (f", {numbers}" if numbers else "")
    return finding(what, "21 reference values of psi2", off, bound)


def _loss() -> Finding:
    law = partial(REGISTRY.create, "normal.viscoelastic")
    springs = REGISTRY.create("tangential.springs", springs=LOSS_SPRINGS)
    march = REGISTRY.create("integrator.symplectic", steps=LOSS_STEPS)
    off = [
        Simulation(normal=law(restitution=e), tangential=springs, integrator=march)
        .sweep(Scene.nondimensional(psi1=np.array(REFERENCE_PSI1), chi=chi))
        .psi2
        - np.array(expected)
        for (e, chi), expected in LOSS_PSI2.items()
    ]
    what = f"viscoelastic / springs, springs={LOSS_SPRINGS}, steps={LOSS_STEPS}"
    count = sum(map(len, LOSS_PSI2.values()))
    return finding(what, f"{count} reference values of psi2", off, LOSS_BOUND)


def _ellipses() -> Finding:
    off = []
    for ratio, aspect, radius in ELLIPSES:
        found = ellipse(1.0 / ratio)
        off += [found.axis_ratio / aspect - 1.0, found.radius / radius - 1.0]
    return finding("ellipses: b/a and R(A + B)", "a direct solution of the contact", off, 3e-8)


def _aside() -> Finding:
    law = REGISTRY.create("tangential.springs", springs=LOSS_SPRINGS)
    march = REGISTRY.create("integrator.symplectic", steps=LOSS_STEPS)
    scene = Scene.nondimensional(**ASIDE)
    off = Simulation(tangential=law, integrator=march).run(scene).check().psi2 - ASIDE_PSI2
    what = f"springs, an ellipse aside, springs={LOSS_SPRINGS}, steps={LOSS_STEPS}"
    return finding(what, "psi2 by two programs", off, ASIDE_BOUND)


def _codes(number: int, form: str) -> Finding:
    file = read_scene(DEFAULT_SCENE)
    series = file.measured[number]
    law = REGISTRY.create("tangential.mindlin_cap", form=form)
    sim = Simulation(tangential=law, integrator="symplectic")
    psi2 = sim.sweep(file.scene_at(psi1=series.x)).psi2
    what = f"mindlin_cap, form={form}: psi2"
    return finding(what, series.label, psi2 - series.values, CODE_BOUND)


def _scalars(name: str, scene: Scene, published: dict[str, float], bound: float) -> Finding:
    """Return the finding of Hertz's law against published scalars of a normal impact."""
    sim = Simulation(tangential="frictionless", integrator="symplectic")
    motion = sim.run(scene).check().motion
    computed = {
        "force": motion.maximum_force,
        "approach": motion.maximum_approach,
        "duration": motion.duration,
    }
    off = [float(computed[entry]) / value - 1.0 for entry, value in published.items()]
    what = f"hertz: {name}, {' and '.join(published)}"
    return finding(what, "Chung & Ooi (2011), relative", off, bound)


def hertz_scalars() -> dict[str, tuple[Scene, dict[str, float]]]:
    """Return the normal impacts of tests 1 and 2 of Chung & Ooi, and their published scalars.

    Scalars are the largest force (N), the largest approach (m) and the duration (s): Hertz's
    theory, read off their figures by the authors of the benchmarks of Kratos and Cabana; the mean
    where both read the same scalar.

    References
    ----------
    Chung & Ooi, Granular Matter 13 (2011) 643-656, doi:10.1007/s10035-011-0277-0.
    """
    glass = {"force": 10.7055e3, "approach": 274.96e-6, "duration": 40.48e-6}
    aluminium = {"force": 11.357e3, "approach": 49.855e-6, "duration": 727.5e-6}
    return {
        "test 1, glass": (_spheres(48e9, 0.20, 2800.0), glass),
        "test 1, limestone": (_spheres(20e9, 0.25, 2500.0), {"force": 7108.0}),
        "test 2, aluminium": (_on_plane(70e9, 0.30, 2699.0), aluminium),
        "test 2, magnesium": (_on_plane(40e9, 0.35, 1800.0), {"force": 7233.0}),
    }


def _spheres(young: float, poisson: float, density: float) -> Scene:
    """Return test 1: two like spheres of 10 mm radius that close at 20 m/s."""
    material = Material(young_modulus=young, poisson_ratio=poisson, density=density)
    return Scene(Sphere(0.01, material), Sphere(0.01, material), 0.0, 20.0)


def _on_plane(young: float, poisson: float, density: float) -> Scene:
    """Return test 2: a sphere of 0.1 m radius that meets a rigid plane at 0.2 m/s."""
    material = Material(young_modulus=young, poisson_ratio=poisson, density=density)
    plane = HalfSpace(Material(young_modulus=RIGID, poisson_ratio=0.3))
    return Scene(Sphere(0.1, material), plane, 0.0, 0.2)
