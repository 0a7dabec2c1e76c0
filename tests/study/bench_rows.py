"""Rows, answers and a clock that are written out, for tests of the benchmark."""

import itertools
from types import SimpleNamespace

from contactlab import Scene
from contactlab.contracts.status import Status
from contactlab.study.bench_methods import Method
from contactlab.study.benchmark import Row

SPRINGS = Method(tangential="springs", integrator="symplectic")
ONE = Scene.nondimensional(psi1=1.2, chi=1.4)


def row(error=1.0, time=1.0, options="steps=10", failed=0, method="a", **entries):
    names = {
        "error_worst": error, "force_error_rms": error, "books_worst": 0.0, "sweep_time_s": time,
        "status": "SUCCESS",
    }  # fmt: skip
    return Row(method=method, options=options, error_rms=error, time_s=time, failed=failed,
               **(names | entries))  # fmt: skip


class Clock:
    """A clock that goes on by a step at each look."""

    def __init__(self, step):
        self.looks, self.step = itertools.count(), step

    def perf_counter(self):
        return self.step * next(self.looks)


def answer(change=0.0, *, status=Status.SUCCESS, imbalance=0.0, checked=True):
    energy = SimpleNamespace(relative_imbalance=imbalance, checked=checked)
    return SimpleNamespace(psi_change=change, status=status, energy=energy)
