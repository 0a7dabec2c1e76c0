"""The three contracts: what a normal law, a tangential law and an integrator promise."""

from contactlab.contracts.integrator import Integrator, Motion, Observer, Problem, Sample
from contactlab.contracts.law import API_VERSION, Law
from contactlab.contracts.normal import (
    ClosedFormMotion,
    ClosedFormNormalLaw,
    NormalContact,
    NormalLaw,
)
from contactlab.contracts.tangential import (
    Increment,
    Run,
    RunningTangentialLaw,
    RunResponse,
    SteppedTangentialLaw,
    TangentialLaw,
    TangentialResponse,
)

__all__ = [
    "API_VERSION",
    "ClosedFormMotion",
    "ClosedFormNormalLaw",
    "Increment",
    "Integrator",
    "Law",
    "Motion",
    "NormalContact",
    "NormalLaw",
    "Observer",
    "Problem",
    "Run",
    "RunResponse",
    "RunningTangentialLaw",
    "Sample",
    "SteppedTangentialLaw",
    "TangentialLaw",
    "TangentialResponse",
]
