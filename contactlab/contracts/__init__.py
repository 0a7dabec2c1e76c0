"""The contracts of normal laws, tangential laws and integrators.

Authors of laws need no other module. It also has the fields by which a law declares checked
options (``quantity``, ``count``, ``choice``, ``flag``, ``restitution``), statuses and faults.
"""

from contactlab.contracts import faults, judges
from contactlab.contracts.contact import NormalContact, without_tension
from contactlab.contracts.integrator import CoupledIntegrator, Integrator, accuracy_of
from contactlab.contracts.law import API_VERSION, Law, claims, resolution_of
from contactlab.contracts.motion import (
    ClosedFormMotion,
    NormalMotion,
    NormalSample,
    ScaledContact,
    Units,
)
from contactlab.contracts.normal import (
    ClosedFormNormalLaw,
    NormalLaw,
    UnfollowedNormalLaw,
    unfollowed_rate,
)
from contactlab.contracts.parameters import (
    BY_COMPLIANCE,
    GEOMETRIC_MEAN,
    MEAN,
    Combined,
    number_in,
)
from contactlab.contracts.path import Cost, LostPathError, PathTangentialLaw, Stretch
from contactlab.contracts.restitution import restitution
from contactlab.contracts.sampled_motion import Ends, SampledMotion
from contactlab.contracts.status import Status
from contactlab.contracts.tangential import (
    AllStepsResponse,
    AllStepsTangentialLaw,
    CausalTangentialLaw,
    CoupledTangentialLaw,
    Errors,
    Increment,
    Resolutions,
    ResolvingTangentialLaw,
    Sampled,
    SteppedTangentialLaw,
    Steps,
    TangentialLaw,
    TangentialResponse,
    WholeImpactTangentialLaw,
    shares_loss,
)
from contactlab.contracts.tangential_motion import Observer, Sample, TangentialMotion
from contactlab.contracts.whole_impact import (
    Tabulated,
    WholeImpact,
    from_change,
    no_force,
    sliding,
)
from contactlab.impact.bodies import Pair
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import NON_NEGATIVE, POSITIVE, Rule, choice, count, flag, quantity
from contactlab.numeric.taken import Taken
from contactlab.numeric.types import Mask, Real

__all__ = [
    "API_VERSION",
    "BY_COMPLIANCE",
    "GEOMETRIC_MEAN",
    "MEAN",
    "NON_NEGATIVE",
    "POSITIVE",
    "AllStepsResponse",
    "AllStepsTangentialLaw",
    "CausalTangentialLaw",
    "ClosedFormMotion",
    "ClosedFormNormalLaw",
    "Combined",
    "Cost",
    "CoupledIntegrator",
    "CoupledTangentialLaw",
    "Ends",
    "Errors",
    "Increment",
    "Integrator",
    "Law",
    "LostPathError",
    "Mask",
    "NormalContact",
    "NormalLaw",
    "NormalMotion",
    "NormalSample",
    "Observer",
    "Pair",
    "PathTangentialLaw",
    "Real",
    "Resolutions",
    "ResolvingTangentialLaw",
    "Rule",
    "Sample",
    "Sampled",
    "SampledMotion",
    "ScaledContact",
    "Scene",
    "Status",
    "SteppedTangentialLaw",
    "Steps",
    "Stretch",
    "Tabulated",
    "Taken",
    "TangentialLaw",
    "TangentialMotion",
    "TangentialResponse",
    "UnfollowedNormalLaw",
    "Units",
    "WholeImpact",
    "WholeImpactTangentialLaw",
    "accuracy_of",
    "choice",
    "claims",
    "count",
    "faults",
    "flag",
    "from_change",
    "judges",
    "no_force",
    "number_in",
    "quantity",
    "resolution_of",
    "restitution",
    "shares_loss",
    "sliding",
    "unfollowed_rate",
    "without_tension",
]
