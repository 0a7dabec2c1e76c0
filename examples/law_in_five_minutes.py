"""How wrong is a law that one writes in five minutes: its error over all angles, in one call.

The law is F = mu P tanh(v/v0), friction smoothed so that it has no jump at rest. It is one
class, and ``compare`` puts it beside the exact law. The picture shows where the law holds, in
gross slip, and where it does not, wherever the contact sticks. A smaller v0 comes nearer to
rigid friction, not to elastic bodies: no value helps.

Writes ``law_in_five_minutes.png`` in the current folder.
"""

from pathlib import Path
from typing import ClassVar

import attrs
import numpy as np

from contactlab import Scene, Simulation
from contactlab.contracts import POSITIVE, SteppedTangentialLaw, TangentialResponse, quantity
from contactlab.figures import name_curves, ordered_colours, save
from contactlab.study import compare


@attrs.frozen(kw_only=True)
class Smoothed(SteppedTangentialLaw):
    """F = mu P tanh(v/v0) with v0 a share of the normal speed: no memory, no elasticity."""

    api_version: ClassVar[int] = 2

    share: float = quantity("1", rule=POSITIVE, default=0.1)

    def start(self, scene, normal):
        """Return friction, v0 and the force so far."""
        return scene.friction_coefficient, self.share * scene.normal_speed, 0.0

    def advance(self, state, increment, before, after):
        """Return the force after the step, and the work of friction in it."""
        friction, scale, held = state
        force = friction * increment.friction_load * np.tanh(increment.velocity / scale)
        work = np.maximum(0.5 * (held + force) * increment.displacement, 0.0)
        return TangentialResponse(force, work), (friction, scale, force)


scene = Scene.nondimensional(psi1=np.linspace(0.05, 7.0, 140), chi=1.4412)
laws = {"exact": Simulation()}
laws |= {
    f"$v_0$ = {share:g} of the normal speed": Simulation(tangential=Smoothed(share=share))
    for share in (3, 1, 0.1)
}
compared = compare(scene, laws)
print("law                            psi2: rms error   largest")
for name in compared.names[1:]:
    error = compared.difference("psi2", name)
    print(f"{name:30s} {np.sqrt(np.mean(error**2)):15.2f} {np.abs(error).max():9.2f}")


def draw(axes):
    """Draw the error of psi2 over the angle, each curve with its name."""
    axes.axhline(0.0, color="grey", lw=0.8, zorder=0)
    lines = []
    for name, colour in zip(compared.names[1:], ordered_colours(3), strict=True):
        lines += axes.plot(scene.psi1, compared.difference("psi2", name), color=colour)
    axes.set(xlabel=r"local angle of incidence $\psi_1$", ylabel=r"$\psi_2$: law $-$ exact")
    axes.set_xlim(0.0, 7.0)
    axes.set_ylim(top=2.6)
    name_curves(axes, lines, compared.names[1:])


save(Path("law_in_five_minutes.png"), draw)
