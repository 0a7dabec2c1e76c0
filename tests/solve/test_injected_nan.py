"""A NaN or an infinity at any step, of any law under any integrator, is reported: never an answer.

The laws of ``spoiled`` wrap a real one and spoil one of its answers. Whatever is done with it,
the run must not end in success.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, ImpactError, Material, Scene, Simulation, Sphere
from contactlab.registry.registry import REGISTRY
from tests.every_method import every_method
from tests.solve.spoiled import (
    Spoiler,
    spoiled_closed_form,
    spoiled_normal,
    spoiled_path,
    spoiled_tangential,
)

pytestmark = pytest.mark.slow

STEPS = 9
#: No call beyond this one is spoiled.
MOST = 400
#: Bad values that were met by a run, and those of them that it reported.
TRIED = {"bad values met": 0, "of them reported": 0}
NAN, INFINITY = math.nan, math.inf
STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
#: Two impacts: one that sticks at first, in the paper's units, and one that slips, in SI.
SCENES = [
    Scene.nondimensional(psi1=0.6, chi=0.4),
    Scene(Sphere(6.35e-3, STEEL), HalfSpace(STEEL), 0.15, 1.93, 0.9, -40.0),
]
COARSE = {"annulus": 4, "springs": 6}


def options_of(method):
    law = REGISTRY.law_class(f"tangential.{method.tangential}").resolution
    tangential = {law: COARSE.get(method.tangential, 4)} if law else {}
    if method.tangential == "fronts":
        tangential = {"table": False}
    name = f"integrator.{method.integrator}"
    step = REGISTRY.law_class(name).resolution
    integrator = {"steps": STEPS} if step == "steps" else {}
    if step == "tolerance":
        integrator = {"tolerance": 1e-3 if method.integrator == "events" else 0.1}
    return (
        contactlab.create(f"tangential.{method.tangential}", **tangential),
        contactlab.create(name, **integrator),
    )


def ladder(integrator):
    """Return the calls to spoil, as far as a run comes.

    All of the 9 steps of fixed length, or of the first panels, and then ever fewer. Where steps
    are chosen on the way, with three calls each, a bad value is treated alike in all of them:
    the first four, and then ever fewer.
    """
    every, further = (41, 12)
    return [*range(1, every), *np.geomspace(every, MOST, further).astype(int).tolist()]


def every_step(make, scene, value, *, close=None, calls=None):
    """Spoil call 1, 2, 3, ... until a run ends before its turn; return how many were told of.

    A bad value that nobody used (a trial step that was rejected, an instant of no interest)
    may end in an answer, if that is the clean one.
    """
    first = make(Spoiler(0, value))
    clean = answer(first, scene)
    assert clean is not None
    # Where steps are tried and thrown away, another step is as good, to the tolerance.
    if close is None:
        close = 1e-9 if first.integrator.resolution == "steps" else 0.05
    reported = 0
    for lasting in (False, True):
        for at in calls or ladder(first.integrator):
            spoil = Spoiler(at, value, lasting=lasting)
            found = answer(make(spoil), scene)
            if not spoil.struck:
                break
            TRIED["bad values met"] += 1
            if found is None:
                TRIED["of them reported"] += 1
                reported += 1
                continue
            assert found == pytest.approx(clean, rel=close), (
                f"{value} at call {at}{' and on' if lasting else ''}: {found}, not {clean}"
            )
    return reported


def answer(simulation, scene):
    """Return the numbers of a successful run, None of one that reports a failure."""
    with np.errstate(all="ignore"):
        result = simulation.run(scene)
    try:
        motion = result.check().motion
    except ImpactError:
        return None
    numbers = (motion.slip_velocity_change, motion.normal_velocity, motion.duration)
    work = motion.friction_work / result.energy.start
    return [*map(float, numbers), 1.0 + float(work)]


METHODS = [method for method in every_method() if not method.whole]
#: Adaptive steps are those of symplectic, and more of them: tried in the slow tests.
STEPPED = [
    pytest.param(
        method,
        id=method.name,
        marks=[pytest.mark.slow] if method.integrator == "adaptive" else [],
    )
    for method in METHODS
    if method.integrator != "events"
]
PATHS = [method for method in METHODS if method.integrator == "events"]


@pytest.mark.parametrize("value", [NAN, INFINITY])
@pytest.mark.parametrize("method", STEPPED)
def test_tangential_laws_by_steps(method, value):
    law, integrator = options_of(method)
    for entry in ("force", "friction_work"):
        for scene in SCENES:
            assert every_step(
                lambda spoil, entry=entry: Simulation(
                    tangential=spoiled_tangential(law, spoil, entry), integrator=integrator
                ),
                scene,
                value,
            )


@pytest.mark.parametrize(
    ("entry", "value"),
    [
        *itertools.product(["force", "radius", "friction_load"], [NAN, INFINITY]),
        ("overlap", NAN),  # infinity is positive, and no more is asked of an overlap
    ],
)
@pytest.mark.parametrize("law", ["coulomb", "springs"])
def test_normal_laws(law, entry, value):
    """Whatever follows along the motion, it is solved alike, before.

    A step whose stages were bad is tried again, and then the answer is the clean one.
    """
    normal = contactlab.create("normal.hertz")
    for scene in SCENES:
        assert every_step(
            lambda spoil: Simulation(
                normal=spoiled_normal(normal, spoil, entry),
                tangential=law,
                integrator=contactlab.create("integrator.symplectic", steps=STEPS),
            ),
            scene,
            value,
            close=1e-7,
            calls=np.geomspace(1, 3 * MOST, 14).astype(int).tolist(),
        )


@pytest.mark.parametrize("value", [NAN, INFINITY])
@pytest.mark.parametrize(
    "entry", ["at.force", "at.radius", "at.friction_load", "at.time", "at.load_impulse"]
)
@pytest.mark.parametrize("method", STEPPED)
def test_motions_in_closed_form_by_steps(method, entry, value):
    law, integrator = options_of(method)
    normal = contactlab.create("normal.hertz")
    assert every_step(
        lambda spoil: Simulation(
            normal=spoiled_closed_form(normal, spoil, entry), tangential=law, integrator=integrator
        ),
        SCENES[0],
        value,
    )


@pytest.mark.parametrize("value", [NAN, INFINITY])
@pytest.mark.parametrize("entry", ["change", "work", "stop"])
@pytest.mark.parametrize("method", PATHS, ids=lambda method: method.name)
def test_tangential_laws_by_paths(method, entry, value):
    law, integrator = options_of(method)
    for scene in SCENES:
        assert every_step(
            lambda spoil: Simulation(
                tangential=spoiled_path(law, spoil, entry), integrator=integrator
            ),
            scene,
            value,
        )


@pytest.mark.parametrize("value", [NAN, INFINITY])
@pytest.mark.parametrize("entry", ["force", "radius", "rate", "time_rate"])
@pytest.mark.parametrize("method", PATHS, ids=lambda method: method.name)
def test_motions_in_closed_form_by_events(method, entry, value):
    """A law that follows the approach by series of its own, as fronts, answers as without."""
    law, integrator = options_of(method)
    normal = contactlab.create("normal.hertz")
    for scene in SCENES:
        every_step(
            lambda spoil: Simulation(
                normal=spoiled_closed_form(normal, spoil, f"scaled.{entry}"),
                tangential=law,
                integrator=integrator,
            ),
            scene,
            value,
        )
