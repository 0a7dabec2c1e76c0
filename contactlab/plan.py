"""What a scene needs, and what is left out and why, said before anything runs."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.integrator import Integrator
from contactlab.contracts.normal import NormalLaw
from contactlab.contracts.tangential import TangentialLaw
from contactlab.scene import Scene

#: Above this C the contact is so large that Hertz's half-space picture is doubtful (theory §8).
HERTZ_DOUBTFUL_SIZE_RATIO = 0.1


@attrs.frozen(kw_only=True, eq=False)
class Plan:
    """What will be computed, what is left out, and what to be wary of.

    Attributes
    ----------
    computed, left_out, cautions : tuple of str
        One sentence each.
    marched : bool or array of bool
        Impacts whose tangential force is followed step by step.
    slipping : bool or array of bool
        Impacts done by the closed form of gross slip throughout, eq. (45).
    """

    computed: tuple[str, ...]
    left_out: tuple[str, ...]
    cautions: tuple[str, ...] = ()
    marched: NDArray[np.bool_]
    slipping: NDArray[np.bool_]

    def __str__(self) -> str:
        """Return the plan in words, a line a sentence."""
        lines = [f"computed: {sentence}" for sentence in self.computed]
        lines += [f"left out: {sentence}" for sentence in self.left_out]
        lines += [f"caution:  {sentence}" for sentence in self.cautions]
        return "\n".join(lines)

    def to_dict(self) -> dict[str, Any]:
        """Return the sentences as plain lists."""
        return {
            "computed": list(self.computed),
            "left_out": list(self.left_out),
            "cautions": list(self.cautions),
        }


def make_plan(
    scene: Scene,
    normal: NormalLaw,
    tangential: TangentialLaw,
    integrator: Integrator,
    *,
    history: bool | str = False,
) -> Plan:
    """Decide what ``scene`` needs from the three laws.

    Shortcuts are taken only where the normal motion is Hertz's closed form, and only on the
    tangential law's own word (``inert``, ``slips_throughout``) or by symmetry.
    """
    shape = scene.shape
    closed_form = "elastic_hertz" in normal.offers
    nothing = np.zeros(shape, dtype=bool)
    central = np.broadcast_to(np.asarray(scene.slip_velocity) == 0.0, shape)
    without_friction = np.broadcast_to(np.asarray(scene.friction_coefficient) == 0.0, shape)
    still = central | without_friction | tangential.inert if closed_form else nothing
    slipping = nothing
    if closed_form and history != "fields":
        slipping = np.asarray(tangential.slips_throughout(scene.psi1, scene.chi)) & ~still
    marched = ~(still | slipping)

    computed, left_out = [], []
    kind = type(normal).__name__
    if closed_form:
        computed.append(f"normal motion: {kind}, elastic, duration (7) in closed form")
    else:
        computed.append(f"normal motion: {kind}, integrated by {type(integrator).__name__}")
    if marched.any():
        computed.append(f"tangential motion: {integrator!r} over {tangential!r}{_share(marched)}")
        if closed_form and tangential.exact and integrator.accuracy is not None:
            computed.append(
                f"exact to {integrator.accuracy:.0e}: closed-form normal motion, a friction law "
                "without discretisation, errors under control (in psi2 over max(1, |psi1|))"
            )
        if closed_form and "closed_form_motion" not in integrator.uses:
            computed.append(f"normal motion again, by the steps of {type(integrator).__name__}")
    if slipping.any():
        computed.append(f"tangential velocity: eq. (45), slip throughout{_share(slipping)}")
        left_out.append(f"tangential march{_share(slipping)}: the impact slips from start to end")
    if tangential.inert:
        left_out.append("tangential march: the law makes no force")
    elif closed_form and central.any():
        left_out.append(f"tangential march{_share(central)}: central impact, no slip velocity")
    elif closed_form and without_friction.any():
        left_out.append(f"tangential march{_share(without_friction)}: friction coefficient 0")
    if not history:
        left_out.append("history: not asked for")
    elif history != "fields":
        left_out.append("traction and stick/slip fields: not asked for (history='fields')")
    cautions = []
    if np.any(np.asarray(scene.size_ratio) > HERTZ_DOUBTFUL_SIZE_RATIO) and scene.sphere:
        cautions.append(
            f"C = {np.max(scene.size_ratio):.2g}: the contact is not small against the radius, "
            "Hertz's theory is doubtful above 0.1"
        )
    return Plan(
        computed=tuple(computed),
        left_out=tuple(left_out),
        cautions=tuple(cautions),
        marched=marched,
        slipping=slipping,
    )


def _share(mask: NDArray[np.bool_]) -> str:
    """Say of how many impacts of a batch something holds."""
    return f" ({int(mask.sum())} of {mask.size} impacts)" if mask.ndim else ""
