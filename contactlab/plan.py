"""What a scene needs, and what is left out and why, said before anything runs."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.checks import Real
from contactlab.contracts.integrator import Integrator
from contactlab.contracts.normal import NormalLaw
from contactlab.contracts.tangential import TangentialLaw
from contactlab.plain import plain
from contactlab.scene import Scene

#: Above this C the contact is so large that Hertz's half-space picture is doubtful (theory §8).
HERTZ_DOUBTFUL_SIZE_RATIO = 0.1
#: Why an impact of gross slip is not marched.
SLIPS = "the impact slips from start to end"


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
    psi2_error : float or array
        What psi2 may be off by, as the law and the integrator declare it (``contactlab.declared``);
        NaN where none is declared.
    """

    computed: tuple[str, ...]
    left_out: tuple[str, ...]
    cautions: tuple[str, ...] = ()
    marched: NDArray[np.bool_]
    slipping: NDArray[np.bool_]
    psi2_error: Real = math.nan

    def __str__(self) -> str:
        """Return the plan in words, a line a sentence."""
        lines = [f"computed: {sentence}" for sentence in self.computed]
        lines += [f"left out: {sentence}" for sentence in self.left_out]
        lines += [f"caution:  {sentence}" for sentence in self.cautions]
        return "\n".join(lines)

    def to_dict(self) -> dict[str, Any]:
        """Return the sentences as plain lists, and the declared error."""
        return {
            "computed": list(self.computed),
            "left_out": list(self.left_out),
            "cautions": list(self.cautions),
            "psi2_error": plain(self.psi2_error),
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
    closed_form = "elastic_hertz" in normal.offers
    needs = _needs(scene, tangential, closed_form=closed_form, history=history)

    computed, left_out = [], []
    kind = type(normal).__name__
    if closed_form:
        computed.append(f"normal motion: {kind}, elastic, duration (7) in closed form")
    else:
        computed.append(f"normal motion: {kind}, integrated by {type(integrator).__name__}")
    if needs.marched.any():
        share = _share(needs.marched)
        computed.append(f"tangential motion: {integrator!r} over {tangential!r}{share}")
        if closed_form and tangential.exact and integrator.accuracy is not None:
            computed.append(
                f"exact to {integrator.accuracy:.0e}: closed-form normal motion, a friction law "
                "without discretisation, errors under control (in psi2 over max(1, |psi1|))"
            )
        if closed_form and "closed_form_motion" not in integrator.uses:
            computed.append(f"normal motion again, by the steps of {type(integrator).__name__}")
    if needs.slipping.any():
        computed.append(f"tangential velocity: eq. (45), slip throughout{_share(needs.slipping)}")
    for why, mask in needs.left_out.items():
        if mask.any():
            left_out.append(f"tangential march{_share(mask)}: {why}")
    if not history:
        left_out.append("history: not asked for")
    elif history != "fields":
        left_out.append("traction and stick/slip fields: not asked for (history='fields')")
    elif not needs.marched.any():
        left_out.append("traction and stick/slip fields: there is no march to take them from")
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
        marched=needs.marched,
        slipping=needs.slipping,
    )


class _Needs(NamedTuple):
    """Masks of the scene's shape."""

    marched: NDArray[np.bool_]
    slipping: NDArray[np.bool_]
    left_out: dict[str, NDArray[np.bool_]]  # by reason; each impact once


def _needs(
    scene: Scene, tangential: TangentialLaw, *, closed_form: bool, history: bool | str
) -> _Needs:
    """Return which impacts need a march, and why the others do not."""
    shape = scene.shape
    marched = np.ones(shape, dtype=bool)
    if not closed_form:
        return _Needs(marched, ~marched, {})
    slips: Any = False
    if history != "fields":
        slips = tangential.slips_throughout(scene.psi1, scene.chi)
    left_out = {}
    for why, mask in (
        ("the law makes no force", tangential.inert),
        ("central impact, no slip velocity", np.asarray(scene.slip_velocity) == 0.0),
        ("friction coefficient 0", np.asarray(scene.friction_coefficient) == 0.0),
        (SLIPS, slips),
    ):
        left_out[why] = marched & mask
        marched = marched & ~left_out[why]
    if history and shape and marched.any():  # one time axis for the whole batch
        marched = np.ones(shape, dtype=bool)
        left_out = {SLIPS: ~marched}
    return _Needs(marched, left_out[SLIPS], left_out)


def _share(mask: NDArray[np.bool_]) -> str:
    """Say of how many impacts of a batch something holds."""
    return f" ({int(mask.sum())} of {mask.size} impacts)" if mask.ndim else ""
