"""Model error: distance of a law's own exact answer from that of the elastic continuum.

No resolution reduces the model error. The stability report judges each law by its own exact
answer, so its numerical errors do not contain the model error.
"""

from __future__ import annotations

from collections.abc import Sequence

import attrs
import numpy as np

from contactlab.contracts import TangentialLaw, WholeImpactTangentialLaw
from contactlab.impact.error_model import range_of
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Array
from contactlab.registry import composition
from contactlab.runs.simulation import Simulation
from contactlab.study.posed import pose
from contactlab.study.stability_references import continuum, converges, reference_for

#: Numerical error of any answer, over the range of psi2.
ROUNDING = 1e-12


@attrs.frozen(kw_only=True, eq=False)
class ModelError:
    """Model error of a friction law between elastic spheres under Hertz's normal law.

    Attributes
    ----------
    law : str
        Name without the kind.
    chis : tuple of float
    error : array, shape (chis,)
        Largest difference of psi2 over the incidences, over the range of psi2. Incidences do not
        count where the law has no exact answer, or where the numerical error that it declares, or
        that twice the resolution shows, is larger; NaN where no incidence counts.
    """

    law: str
    chis: tuple[float, ...]
    error: Array


def model_error(law: str, chis: Sequence[float], incidences: Sequence[float]) -> ModelError | None:
    """Return the model error of a law; None for one whose limit is, or may be, the continuum.

    Parameters
    ----------
    law : str
        Name without the kind, of a law with a default for every option.
    chis, incidences : sequence of float
        Values of chi; values of psi1, over which the largest error is taken.
    """
    tangential = composition.law("tangential", law)
    if converges(tangential):
        return None
    errors = [[_error(tangential, psi1, chi) for psi1 in incidences] for chi in chis]
    largest = np.fmax.reduce(errors, axis=1)
    if np.isnan(largest).all():
        return None
    return ModelError(law=law, chis=tuple(chis), error=largest)


def _error(law: TangentialLaw, psi1: float, chi: float) -> float:
    """Return the model error of one impact, over the range of psi2; NaN without exact answer."""
    laws = Simulation(tangential=law).laws
    scene, normal = pose(Scene.nondimensional(psi1=psi1, chi=chi), laws), laws.normal
    exact, own = continuum(scene, law), reference_for(law, normal)(scene, law)
    unit, width, _ = map(float, range_of(scene))
    uncertain = 0.0
    if isinstance(law, WholeImpactTangentialLaw):
        result = Simulation(tangential=law).run(scene)
        answer = float(result.motion.slip_velocity_change) if result.status else None
        if own is None:
            own = answer
        elif law.resolution is not None:  # its own limit lies about as far off
            doubling = abs(own - answer) if answer is not None else np.inf
            declared = float(np.nan_to_num(result.plan.psi2_error)) * unit
            uncertain = max(doubling, declared, ROUNDING * width)
    if own is None or exact is None or abs(own - exact) < uncertain:
        return np.nan
    return abs(own - exact) / float(width)
