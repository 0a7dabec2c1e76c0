"""The three contracts: what a normal law, a tangential law and an integrator promise."""

from contactlab.contracts.integrator import Integrator, Motion, Observer, Problem, Sample
from contactlab.contracts.law import API_VERSION, Law
from contactlab.contracts.normal import (
    ClosedFormMotion,
    ClosedFormNormalLaw,
    Course,
    NormalContact,
    NormalLaw,
)
from contactlab.contracts.phases import (
    ClosedPhase,
    Path,
    Phase,
    PhasedTangentialLaw,
    PhaseResponse,
    PhaseState,
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
    "ClosedPhase",
    "Course",
    "Increment",
    "Integrator",
    "Law",
    "Motion",
    "NormalContact",
    "NormalLaw",
    "Observer",
    "Path",
    "Phase",
    "PhaseResponse",
    "PhaseState",
    "PhasedTangentialLaw",
    "Problem",
    "Run",
    "RunResponse",
    "RunningTangentialLaw",
    "Sample",
    "SteppedTangentialLaw",
    "TangentialLaw",
    "TangentialResponse",
]
