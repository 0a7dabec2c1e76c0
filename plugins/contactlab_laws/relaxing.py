"""Shared parts of normal laws with a relaxation time: options, and the time from a restitution."""

from __future__ import annotations

from abc import abstractmethod
from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.contracts import BY_COMPLIANCE, NormalLaw, number_in
from contactlab.contracts.restitution import TAKEN_RESTITUTION, restitution
from contactlab.impact.hertz import hertz_scales, hertz_stiffness
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import NON_NEGATIVE, quantity
from contactlab.numeric.types import Real
from contactlab_laws.calibrated import OF_LOSS, one_of_two, waives_of_loss


class Parts(NamedTuple):
    """Stiffness k in N/m^1.5, relaxation time A in s, and the pair's radius in m."""

    stiffness: Real
    time: Real
    radius: Real


@attrs.frozen(kw_only=True)
class Relaxing(NormalLaw):
    """Base of laws of a relaxation time A, which a restitution gives at each speed."""

    offers: ClassVar[frozenset[str]] = OF_LOSS | {"radius", "elliptic"}

    restitution: Real | None = restitution(default=None)
    relaxation_time: Real | None = quantity(
        "s", rule=NON_NEGATIVE, default=None, per_impact=True, material=BY_COMPLIANCE
    )

    def __attrs_post_init__(self) -> None:
        one_of_two(self, "restitution", "relaxation_time", default=TAKEN_RESTITUTION)

    @staticmethod
    @abstractmethod
    def number_of(restitution: Any, /) -> Any:
        """Return A v1/z_max at a restitution, z_max that of Hertz's impact."""

    @property
    def loses(self) -> bool:
        """True if there is any loss."""
        e, time = self.restitution, self.relaxation_time
        if isinstance(e, float):
            return e != 1.0
        loses = e is not None and bool(np.any(e != 1.0))
        return loses or (time is not None and bool(np.any(time)))

    def waives(self) -> frozenset[str]:
        """Return the words of a loss that does not hold."""
        return waives_of_loss(self.restitution, self.loses)

    def restitution_in(self, scene: Scene) -> Real | None:
        """Return e of each impact, unless the user gave a relaxation time."""
        found: Real | None = number_in(self, "restitution", scene)
        return found

    def start(self, scene: Scene) -> Parts:
        """Return stiffness and relaxation time of the pair; the law has no memory."""
        time: Real = number_in(self, "relaxation_time", scene)
        if time is None:
            unit = hertz_scales(scene).approach / scene.normal_speed
            time = self.number_of(self.restitution_in(scene)) * unit
        return Parts(hertz_stiffness(scene), time, scene.pair.radius)
