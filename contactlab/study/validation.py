"""Checks of an installation: laws against reference values and measurements, with bounds.

``validate`` compares laws with closed forms and reference values; ``gather`` runs every law on
experiments, finite elements and the curves of other codes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from importlib import resources
from typing import Any, NamedTuple

import attrs
import numpy as np

from contactlab.compose.composition import DEFAULT_NORMAL
from contactlab.compose.names import full_name, short_name
from contactlab.compose.registry import REGISTRY, PluginError
from contactlab.compose.simulation import Simulation
from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.eccentric import EccentricScene
from contactlab.impact.hertz import hertz_scales, rigid_body_rebound
from contactlab.impact.material import Material
from contactlab.impact.scene import Scene
from contactlab.scene_file import SceneFile, read_scene
from contactlab.study.comparison import Agreement, Comparison, LawRun
from contactlab.study.interrupts import uninterrupted
from contactlab.study.scores import DEFAULT_SCENE
from contactlab.study.stability_eccentric import RIGID_DISTANCE, STIFF, distance, rod

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
#: Relative bounds of force, and of approach or duration, as read off figures. Two readers of one
#: approach differ by 0.0054; the end of contact is read off a curve that meets its axis at a
#: small angle.
FORCE_READING, OTHER_READING = 0.003, 0.01
#: Compositions and the bound of psi2 over the reference values: laws, each with options, bound.
COMPOSITIONS: tuple[tuple[str, dict[str, Any], str, dict[str, Any], float], ...] = (
    ("fronts", {}, "events", {}, 1e-9),
    ("springs", {"springs": 50}, "symplectic", {"steps": 200}, 2e-3),
    ("sharp_annulus", {"annuli": 50}, "symplectic", {"steps": 200}, 2e-3),
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


def validate(progress: Callable[[int, int], object] | None = None) -> Iterator[Finding]:
    """Iterate over all comparisons as they are done; ``progress(done, total)`` follows each."""
    checks = list(_checks())
    for done, check in enumerate(checks, start=1):
        yield check()
        if progress is not None:
            progress(done, len(checks))


def _checks() -> Iterator[Callable[[], Finding]]:
    installed = REGISTRY.names()
    yield _hertz
    yield _rigid
    for composition in COMPOSITIONS:
        if {f"tangential.{composition[0]}", f"integrator.{composition[2]}"} <= set(installed):
            yield partial(_reference, *composition)
    for case in hertz_scalars():
        yield partial(_scalars, case, ("force",), FORCE_READING)
        if case.approach is not None:
            yield partial(_scalars, case, ("approach", "duration"), OTHER_READING)
    if {"tangential.fronts", "tangential.coulomb", "integrator.events"} <= set(installed):
        yield from (_no_friction, _slip_throughout, _first_slip, _stiff)
    if "tangential.mindlin_cap" in installed:
        for number, form in enumerate(CODE_FORMS):
            yield partial(_codes, number, form)


def _hertz() -> Finding:
    scene = Scene.nondimensional(psi1=0.0, chi=1.0)
    result = Simulation(tangential="coulomb", integrator="symplectic").run(scene)
    duration = float(np.asarray(result.motion.duration / hertz_scales(scene).duration)) - 1.0
    worst = max(abs(duration), abs(float(np.asarray(result.normal_restitution)) - 1.0))
    return Finding(
        what="hertz: duration and restitution",
        against="eq. (7), e = 1",
        difference=worst,
        bound=1e-9,
    )


def _rigid() -> Finding:
    chi = 49 / 34
    psi1 = np.linspace(-8.0, 8.0, 65)
    sim = Simulation(tangential="coulomb", integrator="symplectic")
    psi2 = uninterrupted(sim.sweep(Scene.nondimensional(psi1=psi1, chi=chi))).psi2
    worst = float(np.max(np.abs(psi2 - rigid_body_rebound(psi1, chi))))
    return Finding(
        what="coulomb: psi2", against="slip, then rolling", difference=worst, bound=1e-12
    )


def _eccentric() -> Simulation:
    return Simulation(tangential="fronts", integrator="events")


def _eccentric_finding(what: str, against: str, difference: Any, bound: float) -> Finding:
    worst = float(np.max(np.abs(difference)))
    return Finding(
        what=f"fronts, two bodies: {what}", against=against, difference=worst, bound=bound
    )


def _no_friction() -> Finding:
    scene = EccentricScene.stack([rod(angle, 0.0, 0.5, kappa=0.8) for angle in (-50, 15, 30, 75)])
    result = _eccentric().run(scene).check()
    W = scene.inverse_mass
    slip = scene.slip_velocity[:, 0] - 2.0 * W[:, 0, 1] / W[:, 0, 0]
    off = np.hypot(result.normal_velocity + 1.0, result.slip_velocity[:, 0] - slip)
    return _eccentric_finding("no friction", "V2 = -1, psi2 = psi1 - 2 eta", off, 1e-12)


def _sliding() -> tuple[EccentricScene, Any, Any]:
    """Return scenes that slip in gross slip at first, s psi1 and k of theory §14."""
    chi, lam, eta = (np.array(each) for each in zip(*SLIDING, strict=True))
    k = (2.0 * chi + eta) / (1.0 + lam)
    slip = np.maximum(1.0, 2.0 * k - 1.0) * 1.2
    return EccentricScene.nondimensional(psi1=slip, chi=chi, lam=lam, eta=eta), slip, k


def _slip_throughout() -> Finding:
    scene, slip, k = _sliding()
    result = _eccentric().run(scene).check()
    off = np.hypot(result.normal_velocity + 1.0, result.psi2 - (slip - 2.0 * k))
    return _eccentric_finding("slip throughout", "V2 = -1, psi2 = psi1 - 2k", off, 1e-10)


def _first_slip() -> Finding:
    scene, _, k = _sliding()
    off = []
    for place, each in enumerate(k):
        psi1 = 1.0 + 0.2 * (1 + place) * (each - 1.0)  # slips at first touch, stops before V = 0
        start = attrs.evolve(
            scene.take(place), slip_velocity=scene.slip_velocity[place] * psi1 / scene.psi1[place]
        )
        history: Any = _eccentric().run(start, history=True).check().history
        limit = float(start.friction_coefficient) * history.normal_force
        full = np.abs(history.tangential_force[:, 0]) >= limit * (1.0 - 1e-9)
        stopped = int(np.argmin(full)) - 1
        off.append(history.normal_velocity[stopped] - (each - psi1) / (each - 1.0))
    return _eccentric_finding("end of first slip", "V = (k - psi1)/(k - 1)", off, 1e-9)


def _stiff() -> Finding:
    off = []
    for angle, friction, slip in STIFF_RODS:
        scene = rod(angle, friction, slip, kappa=STIFF)
        soft, rigid = (
            simulation.run(scene).check()
            for simulation in (_eccentric(), Simulation(tangential="coulomb"))
        )
        off.append(distance(soft, rigid))
    bound = RIGID_DISTANCE * STIFF**-0.5
    return _eccentric_finding("rods, kappa = 1e4", "Routh's construction", off, bound)


def _reference(
    tangential: str,
    options: dict[str, Any],
    integrator: str,
    settings: dict[str, Any],
    bound: float,
) -> Finding:
    """Return the finding of one composition against ``REFERENCE_PSI2``."""
    sim = Simulation(
        tangential=REGISTRY.create(f"tangential.{tangential}", **options),
        integrator=REGISTRY.create(f"integrator.{integrator}", **settings),
    )
    worst = 0.0
    for chi, expected in REFERENCE_PSI2.items():
        batch = Scene.nondimensional(psi1=np.array(REFERENCE_PSI1), chi=chi)
        psi2 = uninterrupted(sim.sweep(batch)).psi2
        worst = float(np.max(np.append(np.abs(psi2 - np.array(expected)), worst)))
    numbers = ", ".join(f"{key}={value}" for key, value in (options | settings).items())
    return Finding(
        what=f"{tangential} / {integrator}" + (f", {numbers}" if numbers else ""),
        against="21 reference values of psi2",
        difference=worst,
        bound=bound,
    )


def _codes(number: int, form: str) -> Finding:
    file = read_scene(DEFAULT_SCENE)
    series = file.measured[number]
    sim = Simulation(
        tangential=REGISTRY.create("tangential.mindlin_cap", form=form), integrator="symplectic"
    )
    psi2 = uninterrupted(sim.sweep(file.scene_at(psi1=series.x))).psi2
    return Finding(
        what=f"mindlin_cap, form={form}: psi2",
        against=series.label,
        difference=float(np.max(np.abs(psi2 - series.values))),
        bound=CODE_BOUND,
    )


def _scalars(case: Scalars, names: tuple[str, ...], bound: float) -> Finding:
    """Return the finding of Hertz's law against the named scalars of a normal impact."""
    sim = Simulation(tangential="frictionless", integrator="symplectic")
    motion: Any = sim.run(case.scene).check().motion
    computed = {
        "force": motion.maximum_force,
        "approach": motion.maximum_approach,
        "duration": motion.duration,
    }
    published = {name: getattr(case, name) for name in names if getattr(case, name) is not None}
    return Finding(
        what=f"hertz: {case.name}, {' and '.join(published)}",
        against="Chung & Ooi (2011), relative",
        difference=max(
            abs(float(computed[name]) / value - 1.0) for name, value in published.items()
        ),
        bound=bound,
    )


class Scalars(NamedTuple):
    """A normal impact and its published scalars; None for a scalar that is not published.

    Attributes
    ----------
    name : str
    scene : Scene
    force : float, optional
        Largest normal force, in N.
    approach : float, optional
        Largest approach, in m.
    duration : float, optional
        In s.
    """

    name: str
    scene: Scene
    force: float | None = None
    approach: float | None = None
    duration: float | None = None


def hertz_scalars() -> tuple[Scalars, ...]:
    """Return the normal impacts of tests 1 and 2 of Chung & Ooi.

    The scalars are Hertz's theory, read off their figures by the authors of the benchmarks of
    Kratos and Cabana; the mean where both read the same scalar.

    References
    ----------
    Chung & Ooi, Granular Matter 13 (2011) 643-656, doi:10.1007/s10035-011-0277-0.
    """
    return (
        Scalars("test 1, glass", _spheres(48e9, 0.20, 2800.0), 10.7055e3, 274.96e-6, 40.48e-6),
        Scalars("test 1, limestone", _spheres(20e9, 0.25, 2500.0), 7108.0),
        Scalars("test 2, aluminium", _on_plane(70e9, 0.30, 2699.0), 11.357e3, 49.855e-6, 727.5e-6),
        Scalars("test 2, magnesium", _on_plane(40e9, 0.35, 1800.0), 7233.0),
    )


def _spheres(young: float, poisson: float, density: float) -> Scene:
    """Return test 1: two like spheres of 10 mm radius that close at 20 m/s."""
    material = Material(young_modulus=young, poisson_ratio=poisson, density=density)
    return Scene(Sphere(0.01, material), Sphere(0.01, material), 0.0, 20.0)


def _on_plane(young: float, poisson: float, density: float) -> Scene:
    """Return test 2: a sphere of 0.1 m radius that meets a rigid plane at 0.2 m/s."""
    material = Material(young_modulus=young, poisson_ratio=poisson, density=density)
    plane = HalfSpace(Material(young_modulus=RIGID, poisson_ratio=0.3))
    return Scene(Sphere(0.1, material), plane, 0.0, 0.2)


@attrs.frozen(kw_only=True)
class Source:
    """A file of measured or computed rebounds, the normal laws to run, and bounds.

    Attributes
    ----------
    name : str
        Name of the file in ``contactlab/study/measured``, without its suffix.
    kind : str
        Where the numbers are from: "experiment", "finite elements" or "other codes".
    normals : mapping of str to mapping
        Options of the normal laws, by name.
    bounds : mapping
        Bound of the rms difference by quantity and law: ``{("psi2", "fronts"): 0.06}``.
    """

    name: str
    kind: str
    normals: Mapping[str, Mapping[str, Any]] = attrs.field(factory=lambda: {DEFAULT_NORMAL: {}})
    bounds: Mapping[tuple[str, str], float] = attrs.field(factory=dict)

    def read(self) -> SceneFile:
        """Return the contents of the file."""
        place = resources.files("contactlab").joinpath("study", "measured", f"{self.name}.toml")
        with resources.as_file(place) as path:
            return read_scene(path)


#: Normal laws for the impacts of Kharaz et al.: elastic, and damped to the loss that they measured.
DAMPED = {DEFAULT_NORMAL: {}, "tsuji": {"restitution": 0.98}}
E_T = "tangential_restitution"
SOURCES = (
    Source(
        name="kharaz2001",
        kind="experiment",
        normals=DAMPED,
        bounds={
            (E_T, "fronts"): 0.015,
            (E_T, "springs, tsuji restitution=0.98"): 0.015,
            (E_T, "sharp_annulus, tsuji restitution=0.98"): 0.015,
        },
    ),
    Source(name="finite-elements", kind="finite elements", bounds={("psi2", "fronts"): 0.06}),
    Source(name="codes-test4-oxide", kind="other codes", bounds={(E_T, "mindlin_cap"): 0.006}),
    Source(name="codes-test4-alloy", kind="other codes", bounds={(E_T, "mindlin_cap"): 0.006}),
    Source(name="codes-mfix", kind="other codes", bounds={(E_T, "mindlin_cap"): 0.006}),
)


@attrs.frozen(kw_only=True, eq=False)
class Evidence:
    """A source, and the results of every law that fits.

    Attributes
    ----------
    source : Source
    file : SceneFile
    comparison : Comparison
        Agreements with all series; with ``curves``, the laws over the file's sweep too.
    left_out : mapping of str to str
        Reasons by law, for laws that could not be composed.
    """

    source: Source
    file: SceneFile
    comparison: Comparison
    left_out: Mapping[str, str]

    @property
    def laws(self) -> list[str]:
        """Names of the laws by rms difference from the first series; failed laws come last."""
        first = self.comparison.agreements[0]
        rms = {name: first.rms(name) for name in first.results}
        return sorted(rms, key=lambda name: (np.isnan(rms[name]), rms[name]))

    def scatter(self, agreement: Agreement) -> float:
        """Return the rms measurement error of a series, in its unit; NaN if none is stated."""
        errors = agreement.measured.error[agreement.measured.error > 0.0]
        return float(np.sqrt(np.mean(errors**2))) if errors.size else float("nan")

    def bound(self, quantity: str, law: str) -> float | None:
        """Return the bound of the rms difference; None if there is none."""
        return self.source.bounds.get((quantity, law))


def gather(
    *, curves: bool = False, progress: Callable[[int, int], object] | None = None
) -> Iterator[Evidence]:
    """Iterate over the sources, each with every law that fits under its preferred integrator.

    Parameters
    ----------
    curves : bool
        Run each law over the sweep of each file too, for figures.
    progress : callable, optional
        Called as ``progress(done, total)`` after each source.
    """
    for done, source in enumerate(SOURCES, start=1):
        yield _evidence(source, curves=curves)
        if progress is not None:
            progress(done, len(SOURCES))


def _evidence(source: Source, *, curves: bool) -> Evidence:
    file = source.read()
    simulations, left_out = simulations_over(source.normals)
    agreements = []
    for measured in file.measured:
        scene = file.scene_at(**{measured.against: measured.x})
        results = {
            name: uninterrupted(simulation.sweep(scene)) for name, simulation in simulations.items()
        }
        agreements.append(Agreement(measured=measured, results=results))
    runs = [
        LawRun(
            name=name,
            result=uninterrupted(simulation.sweep(file.scene)),
            run_time_per_impact=float("nan"),
        )
        for name, simulation in simulations.items()
        if curves
    ]
    comparison = Comparison(
        scene=file.scene, varied=file.varied, runs=tuple(runs), agreements=tuple(agreements)
    )
    return Evidence(source=source, file=file, comparison=comparison, left_out=left_out)


def simulations_over(
    normals: Mapping[str, Mapping[str, Any]],
) -> tuple[dict[str, Simulation], dict[str, str]]:
    """Return simulations of every tangential law under the normal laws, and reasons for misfits.

    Both are keyed by the tangential law's name, followed by normal law and options if the normal
    law is not the default.
    """
    simulations: dict[str, Simulation] = {}
    left_out: dict[str, str] = {}
    for normal, options in normals.items():
        for full in REGISTRY.names("tangential"):
            name = short_name(full)
            if normal != DEFAULT_NORMAL:
                words = ", ".join(f"{key}={value}" for key, value in options.items())
                name += f", {normal} {words}".rstrip()
            try:
                normal_law = REGISTRY.create(full_name("normal", normal), **options)
                simulations[name] = Simulation(normal=normal_law, tangential=full)
            except (ValueError, PluginError) as error:
                left_out[name] = str(error)
    return simulations, left_out


def judged(evidence: Evidence) -> Iterator[Finding]:
    """Iterate over the findings of a source: the bounds of the laws that are installed."""
    for agreement in evidence.comparison.agreements:
        quantity = agreement.measured.quantity
        for law in agreement.results:
            bound = evidence.bound(quantity, law)
            if bound is not None:
                yield Finding(
                    what=f"{law}: {quantity}, rms",
                    against=f"{evidence.source.kind}: {evidence.source.name}",
                    difference=agreement.rms(law),
                    bound=bound,
                )
