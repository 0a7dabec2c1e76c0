"""Ways of a benchmark to answer a question: calls, each with the reading of its answer."""

from __future__ import annotations

import ctypes
import functools
import math
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from importlib import resources
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import attrs
import numpy as np

from contactlab.collisions.collide import collide
from contactlab.collisions.rebound import rebound
from contactlab.contracts.normal import NormalLaw
from contactlab.impact.encounter import Encounter
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Array, Real
from contactlab.outcome.result import ImpactResult
from contactlab.registry import composition
from contactlab.runs.simulation import Simulation
from contactlab.study.bench_methods import Method, Options
from contactlab.study.posed import pose
from contactlab.study.stability_references import converges

#: Function that is timed, after everything was prepared.
Call: TypeAlias = Callable[[], object]
#: Calls of C on one impact per timed call, so that the cost of entering C does not count.
IN_C = 1000
#: Impacts in C by numbers: of spheres with e, and of bodies in a plane.
SOURCE = """
#include "contactlab_bounce.h"
#include "contactlab_impact.h"
void spheres(long n, long times, double e, const double *psi1, const double *chi, double *out)
{
  for (long k = 0; k < times; ++k)
    for (long i = 0; i < n; ++i) out[i] = psi1[i] + contactlab_bounce_change(psi1[i], chi[i], e);
}
void bodies(long n, long times, const double *psi1, const double *chi, const double *lam,
            const double *eta, double *out)
{
  for (long k = 0; k < times; ++k)
    for (long i = 0; i < n; ++i) {
      contactlab_impact one;
      int bad = contactlab_impact_follow(psi1[i], chi[i], lam[i], eta[i],
                                         CONTACTLAB_IMPACT_EXACT, 20000, &one);
      out[i] = bad ? NAN : psi1[i] + one.change;
    }
}
"""


class Answer(NamedTuple):
    """Numbers to hold against the truth; status; energy books over the energy at the start."""

    numbers: Array
    status: str = "SUCCESS"
    books: float = math.nan


def read_number(psi2: Real) -> Answer:
    """Return the answer of a function that returns psi2."""
    return Answer(np.ravel(psi2))


def read_result(result: ImpactResult) -> Answer:
    """Return psi2 of a run."""
    status = "SUCCESS" if np.all(result.status) else result.status.name
    energy, books = result.energy, math.nan
    if status == "SUCCESS" and np.all(energy.checked):
        books = float(np.max(np.abs(energy.relative_imbalance)))
    return Answer(np.ravel(result.psi2), status, books)


@attrs.frozen(kw_only=True)
class Door:
    """One way to answer a question.

    Attributes
    ----------
    name, options : str
        Its resolution in words is ``options``; coarser ones of one name stand before finer ones.
    bind : callable
        ``bind(impact)`` prepares one impact, or a batch, and returns the call that is timed.
    read : callable or None
        ``read(answer)`` of such a call for one impact; None for a limit without an answer.
    calls : int
        Impacts that one call answers, for one impact.
    limit : bool
        True for what no door can beat, as a copy of the numbers.
    converges : bool
        Whether its error is numerical; that of another model falls with no step.
    together : bool
        Whether it takes batches.
    peer : bool
        Whether it is of another engine, and its error the difference of another model.
    """

    name: str
    options: str = ""
    bind: Callable[[Any], Call]
    read: Callable[[Any], Answer] | None = read_result
    calls: int = 1
    limit: bool = False
    converges: bool = True
    together: bool = True
    peer: bool = False


def of_scene(impact: Encounter | Scene) -> Scene:
    """Return the scene of an encounter, or a scene as it is."""
    return impact.scene if isinstance(impact, Encounter) else impact


def by_rebound(restitution: float = 1.0) -> Door:
    """Return ``contactlab.rebound``."""

    def bind(impact: Encounter | Scene) -> Call:
        psi1, chi = _numbers(of_scene(impact), "psi1", "chi")
        if restitution == 1.0:
            return lambda: rebound(psi1, chi)
        return lambda: rebound(psi1, chi, restitution=restitution)

    return Door(name="rebound()", bind=bind, read=read_number)


def by_collide(restitution: float = 1.0) -> Door:
    """Return ``contactlab.collide``, of encounters that are made before."""
    return Door(
        name="collide()",
        bind=lambda met: lambda: collide(met, restitution=restitution),
        read=lambda collision: read_result(collision.result),
    )


def by_run(name: str, options: str, simulation: Simulation) -> Door:
    """Return ``run`` of a simulation for one impact, and its ``sweep`` for a batch."""

    def bind(impact: Encounter | Scene) -> Call:
        scene = pose(of_scene(impact), simulation.laws)
        go = simulation.sweep if scene.shape else simulation.run
        return lambda: go(scene)

    return Door(name=name, options=options, bind=bind, converges=converges(simulation.tangential))


def by_springs(*counts: int, restitution: float = 1.0) -> list[Door]:
    """Return runs of springs and four times as many steps."""
    return [
        by_run("run, springs", f"springs={each}, steps={4 * each}", springs_of(each, restitution))
        for each in counts
    ]


def springs_of(springs: int, restitution: float = 1.0) -> Simulation:
    """Return springs and four times as many steps, none from a table."""
    normal: str | NormalLaw = composition.DEFAULT_NORMAL
    if restitution < 1.0:
        normal = composition.viscous(restitution)
    tangential = composition.law("tangential", composition.ON_A_PATH, springs=springs)
    return Simulation(
        normal=normal, tangential=tangential, integrator=composition.fixed_steps(4 * springs)
    )


def by_method(method: Method, options: Options) -> Door:
    """Return ``run`` and ``sweep`` of laws at one resolution."""
    values = {key: value for part in options.values() for key, value in part.items()}
    words = ", ".join(f"{key}={value:g}" for key, value in values.items())
    return by_run(method.name, words, method.simulation(options))


def in_c(restitution: float = 1.0, *, spheres: bool) -> list[Door]:
    """Return a C kernel, or nothing where no C compiler is; a batch is a loop in C."""
    library = _kernels()
    if library is None:
        return []

    def bind(impact: Encounter | Scene) -> Call:
        names = ("psi1", "chi") if spheres else ("psi1", "chi", "lam", "eta")
        scene = of_scene(impact)
        rows = [np.array(each, ndmin=1) for each in _numbers(scene, *names)]
        out, times = np.empty(rows[0].shape), 1 if scene.shape else IN_C
        head: tuple[Any, ...] = (ctypes.c_long(out.size), ctypes.c_long(times))
        call = library.bodies
        if spheres:
            call, head = library.spheres, (*head, ctypes.c_double(restitution))
        places = [ctypes.c_void_p(each.ctypes.data) for each in (*rows, out)]

        def follow() -> Array:
            assert rows  # C reads them
            call(*head, *places)
            return out

        return follow

    name = "C, contactlab_bounce.h" if spheres else "C, contactlab_impact.h"
    return [Door(name=name, bind=bind, read=read_number, calls=IN_C)]


def limits(*, formula: bool) -> list[Door]:
    """Return a copy of the numbers and, of spheres, one line of NumPy: rigid Coulomb friction."""

    def bind_copy(impact: Encounter | Scene) -> Call:
        rows = np.array(_numbers(of_scene(impact), "psi1", "chi"))
        return rows.copy

    def bind_formula(impact: Encounter | Scene) -> Call:
        psi1, chi = _numbers(of_scene(impact), "psi1", "chi")
        if isinstance(psi1, float):
            return lambda: math.copysign(max(abs(psi1) - 4.0 * chi, 0.0), psi1)
        return lambda: np.copysign(np.maximum(np.abs(psi1) - 4.0 * chi, 0.0), psi1)

    found = [Door(name="limit: a copy", bind=bind_copy, read=None, limit=True)]
    if formula:
        line = Door(
            name="limit: a formula in NumPy", bind=bind_formula, read=read_number, limit=True,
            converges=False,
        )  # fmt: skip
        found.append(line)
    return found


def _numbers(scene: Scene, *names: str) -> tuple[Any, ...]:
    """Return numbers of a scene as floats, or as arrays of its shape."""
    if not scene.shape:
        return tuple(float(getattr(scene, name)) for name in names)
    return tuple(
        np.array(np.broadcast_to(getattr(scene, name), scene.shape), dtype=float) for name in names
    )


@functools.cache
def _kernels() -> ctypes.CDLL | None:
    """Return the kernels in C, compiled for this process, or None."""
    compiler = next(filter(None, map(shutil.which, ("cc", "gcc", "clang"))), None)
    if compiler is None:
        return None
    with (
        tempfile.TemporaryDirectory() as folder,
        resources.as_file(resources.files("contactlab").joinpath("kernels")) as headers,
    ):
        source, built = Path(folder, "doors.c"), Path(folder, "doors.so")
        source.write_text(SOURCE, "utf-8")
        words = ["-std=c99", "-O3", "-ffp-contract=off", "-shared", "-fPIC", f"-I{headers}"]
        try:
            subprocess.run(
                [compiler, *words, source, "-o", built, "-lm"], check=True, capture_output=True
            )
            return ctypes.CDLL(str(built))
        except (OSError, subprocess.CalledProcessError):
            return None
