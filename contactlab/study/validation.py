"""Checks of an installation: laws against reference values, each with a bound."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, NamedTuple

import attrs
import numpy as np

from contactlab.compose.registry import REGISTRY
from contactlab.compose.simulation import Simulation
from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.hertz import hertz_scales, rigid_body_rebound
from contactlab.impact.material import Material
from contactlab.impact.scene import Scene
from contactlab.scene_file import read_scene
from contactlab.study.evidence import Evidence
from contactlab.study.interrupts import uninterrupted
from contactlab.study.scores import DEFAULT_SCENE

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
