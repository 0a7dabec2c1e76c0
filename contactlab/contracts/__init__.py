"""The three contracts: what a normal law, a tangential law and an integrator promise."""

from contactlab.contracts.integrator import Integrator, Observer, Sample, TangentialMotion
from contactlab.contracts.law import API_VERSION, Law
from contactlab.contracts.motion import (
    ClosedFormMotion,
    NormalMotion,
    NormalSample,
    ScaledContact,
)
from contactlab.contracts.normal import (
    ClosedFormNormalLaw,
    NormalContact,
    NormalLaw,
    without_tension,
)
from contactlab.contracts.phases import (
    ClosedPhase,
    DenseOutput,
    ManyImpacts,
    ManyPhasedTangentialLaw,
    Phase,
    PhasedTangentialLaw,
    PhaseResponse,
    PhaseSample,
    PhaseState,
)
from contactlab.contracts.tangential import (
    AllStepsResponse,
    AllStepsTangentialLaw,
    Increment,
    SteppedTangentialLaw,
    Steps,
    TangentialLaw,
    TangentialResponse,
    WholeImpactTangentialLaw,
)
from contactlab.contracts.whole_impact import WholeImpact, no_force, sliding

__all__ = [
    "API_VERSION",
    "AllStepsResponse",
    "AllStepsTangentialLaw",
    "ClosedFormMotion",
    "ClosedFormNormalLaw",
    "ClosedPhase",
    "DenseOutput",
    "Increment",
    "Integrator",
    "Law",
    "ManyImpacts",
    "ManyPhasedTangentialLaw",
    "NormalContact",
    "NormalLaw",
    "NormalMotion",
    "NormalSample",
    "Observer",
    "Phase",
    "PhaseResponse",
    "PhaseSample",
    "PhaseState",
    "PhasedTangentialLaw",
    "Sample",
    "ScaledContact",
    "SteppedTangentialLaw",
    "Steps",
    "TangentialLaw",
    "TangentialMotion",
    "TangentialResponse",
    "WholeImpact",
    "WholeImpactTangentialLaw",
    "no_force",
    "sliding",
    "without_tension",
]
