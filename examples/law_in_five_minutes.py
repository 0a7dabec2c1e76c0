"""The error of a law of one's own over all angles: a law in five minutes, judged in one call.

The law is F = mu P tanh(v/v0), friction smoothed so that it has no jump at rest. It is one
class, and ``compare`` puts it beside the exact law. On the left the picture shows the law, on the
right its rebound, which is right in gross slip alone: wherever the contact sticks the law misses.
A smaller v0 comes nearer to rigid friction, not to elastic bodies: no value helps.

Writes ``law_in_five_minutes.png`` in the current folder.
"""

from pathlib import Path
from typing import Any, ClassVar

import attrs
import numpy as np

from contactlab import Scene, Simulation
from contactlab.contracts import (
    POSITIVE,
    Increment,
    NormalContact,
    NormalMotion,
    SteppedTangentialLaw,
    TangentialResponse,
    quantity,
)
from contactlab.figures import name_curves, ordered_colours, save
from contactlab.study import compare


@attrs.frozen(kw_only=True)
class Smoothed(SteppedTangentialLaw):
    """F = mu P tanh(v/v0) with v0 a share of the normal speed: no memory, no elasticity."""

    api_version: ClassVar[int] = 2

    share: float = quantity("1", rule=POSITIVE, default=0.1)

    def start(self, scene: Scene, normal: NormalMotion) -> Any:
        """Return friction, v0 and the force so far."""
        return scene.friction_coefficient, self.share * scene.normal_speed, 0.0

    def advance(
        self, state: Any, increment: Increment, before: NormalContact, after: NormalContact
    ) -> tuple[TangentialResponse, Any]:
        """Return the force after the step, and the work of friction in it."""
        friction, scale, held = state
        force = friction * increment.friction_load * np.tanh(increment.velocity / scale)
        work = np.maximum(0.5 * (held + force) * increment.displacement, 0.0)
        return TangentialResponse(force, work), (friction, scale, force)


SHARES = (3, 1, 0.1)
scene = Scene.nondimensional(psi1=np.linspace(0.05, 7.0, 140), chi=1.4412)
laws = {"exact": Simulation()}
laws |= {
    f"$v_0$ = {share:g} of the normal speed": Simulation(tangential=Smoothed(share=share))
    for share in SHARES
}
compared = compare(scene, laws)
print("law                            psi2: rms error   largest")
for name in compared.names[1:]:
    error = compared.difference("psi2", name)
    print(f"{name:30s} {np.sqrt(np.mean(error**2)):15.2f} {np.abs(error).max():9.2f}")


def draw(axes: Any) -> None:
    """Draw the law, and psi2 over the angle, each curve with its name."""
    law, rebound = axes[0]
    speed = np.linspace(-3.0, 3.0, 300)
    colours = ordered_colours(3)
    for share, colour in zip(SHARES, colours, strict=True):
        law.plot(speed, np.tanh(speed / share), color=colour)
    law.set(xlabel="slip velocity over normal speed", ylabel=r"$F/(\mu P)$, the law")
    rebound.axhline(0.0, color="grey", lw=0.8, zorder=0)
    lines = rebound.plot(scene.psi1, compared.values("psi2", "exact"), color="black", lw=2.6)
    for name, colour in zip(compared.names[1:], colours, strict=True):
        lines += rebound.plot(scene.psi1, compared.values("psi2", name), color=colour)
    rebound.set(xlabel=r"local angle of incidence $\psi_1$", ylabel=r"$\psi_2$, the rebound")
    rebound.set_xlim(0.0, 7.0)
    names = [f"$v_0$ = {share:g}" for share in SHARES]
    name_curves(rebound, lines, ["exact", *names])
    name_curves(law, law.get_lines(), names)


save(Path("law_in_five_minutes.png"), draw, columns=2)
