"""The contracts of normal laws, tangential laws and integrators.

Authors of laws need no other module. It also has the fields by which a law declares checked
options (``quantity``, ``count``, ``choice``, ``flag``, ``restitution``), statuses and faults.
"""

from contactlab.contracts import faults
from contactlab.contracts.contact import NormalContact, without_tension
from contactlab.contracts.integrator import Integrator, Observer, Sample, TangentialMotion
from contactlab.contracts.law import API_VERSION, Law
from contactlab.contracts.motion import (
    ClosedFormMotion,
    NormalMotion,
    NormalSample,
    ScaledContact,
)
from contactlab.contracts.normal import ClosedFormNormalLaw, NormalLaw
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
from contactlab.contracts.restitution import restitution
from contactlab.contracts.status import Status
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
from contactlab.impact.bodies import Pair
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import (
    NON_NEGATIVE,
    POSITIVE,
    Mask,
    Real,
    Rule,
    choice,
    count,
    flag,
    quantity,
)

__all__ = [
    "API_VERSION",
    "NON_NEGATIVE",
    "POSITIVE",
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
    "Mask",
    "NormalContact",
    "NormalLaw",
    "NormalMotion",
    "NormalSample",
    "Observer",
    "Pair",
    "Phase",
    "PhaseResponse",
    "PhaseSample",
    "PhaseState",
    "PhasedTangentialLaw",
    "Real",
    "Rule",
    "Sample",
    "ScaledContact",
    "Scene",
    "Status",
    "SteppedTangentialLaw",
    "Steps",
    "TangentialLaw",
    "TangentialMotion",
    "TangentialResponse",
    "WholeImpact",
    "WholeImpactTangentialLaw",
    "choice",
    "count",
    "faults",
    "flag",
    "no_force",
    "quantity",
    "restitution",
    "sliding",
    "without_tension",
]
