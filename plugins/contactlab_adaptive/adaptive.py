"""Steps under error control, rejected and tried again where they are too long."""

from __future__ import annotations

from typing import ClassVar

import attrs
import numpy as np

from contactlab.checks import Rule, quantity
from contactlab.contracts import Integrator, Motion, Observer, Problem, SteppedTangentialLaw
from contactlab_adaptive.run import Run

TOLERANCE = Rule(
    lambda value: np.ndim(value) == 0 and 1e-12 <= value <= 1.0,
    "must be one number in [1e-12, 1]",
)


@attrs.frozen(kw_only=True)
class Adaptive(Integrator):
    """Second order, each step done once whole and once in halves; the halves are kept.

    A third of the difference is the error of the halves. Over the share of the impact that the
    step covers it is held below ``tolerance``: so the error of the whole impact is below that,
    for a smooth law. Changes between stick and slip, and the end of contact, are located by the
    steps they force.

    What both ways have in common is not seen. An annulus that comes into contact remembers the
    displacement at the sample before, whenever in the step it came: under such a law the error
    falls as the root of ``tolerance`` only, as its steps do.

    Parameters
    ----------
    tolerance : float
        In psi; from 1e-12 to 1. Cost grows as its inverse square root.
    """

    api_version: ClassVar[int] = 1
    resolution: ClassVar[str | None] = "tolerance"
    offers: ClassVar[frozenset[str]] = frozenset({"steps"})
    needs: ClassVar[frozenset[str]] = frozenset({"advance"})
    uses: ClassVar[frozenset[str]] = frozenset({"closed_form_motion"})
    common_instants: ClassVar[bool] = False
    together: ClassVar[bool] = False

    tolerance: float = quantity("1", rule=TOLERANCE, default=1e-4)

    def integrate(self, problem: Problem, observer: Observer | None = None) -> Motion:
        """Return the motion; impacts of a batch choose their own steps, one by one."""
        if not problem.shape:
            return self._one(problem, observer)
        motions = [self._one(impact, None) for impact in problem.impacts()]
        return Motion.joined(motions, problem.shape)

    def _one(self, problem: Problem, observer: Observer | None) -> Motion:
        law = problem.tangential
        assert isinstance(law, SteppedTangentialLaw)
        return Run(problem, law, float(self.tolerance)).follow(observer)
