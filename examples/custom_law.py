"""A tangential law of one's own in one file, passed to a simulation as an object.

The spring of discrete-element codes: Mindlin's stiffness of a contact that sticks all over,
cut off at Coulomb's limit. It is compared with the paper's contact, which slips from its
edge inwards. Writes ``custom_law.png`` in the current folder.
"""

from pathlib import Path
from typing import ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab import Scene, Simulation
from contactlab.contracts import SteppedTangentialLaw, TangentialResponse
from contactlab.figures import law_style, name_curves, save


class Spring(NamedTuple):
    """The state: two constants of the scene, and the force, which is all the memory."""

    stiffness_per_radius: float
    friction_coefficient: float
    force: float


@attrs.frozen(kw_only=True)
class MindlinCap(SteppedTangentialLaw):
    """F grows by 2 G* b dD, within mu P; the force of area that leaves contact is let go.

    References
    ----------
    Mindlin, J. Appl. Mech. 16 (1949) 259-268: the stiffness 2 G* b, all stuck.
    """

    api_version: ClassVar[int] = 2
    needs: ClassVar[frozenset[str]] = frozenset({"radius"})
    # Checks of `contactlab.testing` that the model fails by its nature, and why.
    expected_failures: ClassVar[dict[str, str]] = {
        "books": "the books leave out what the spring loses as the contact shrinks",
        "impact_books": "the books leave out what the spring loses as the contact shrinks",
    }

    def start(self, scene, normal):
        """Return the spring unloaded."""
        return Spring(scene.pair.tangential_stiffness(1.0), scene.friction_coefficient, 0.0)

    def advance(self, state, increment, before, after):
        """Return the force after the step, and the work of friction in it."""
        stiffness = state.stiffness_per_radius * after.radius
        softness = 1.0 / (stiffness + (stiffness == 0.0))
        # As the contact shrinks the force shrinks with it: otherwise a softer spring would
        # hold the same force, and store energy that nobody gave it.
        kept = np.minimum(after.radius / (before.radius + (before.radius == 0.0)), 1.0)
        kept = np.where(before.radius > 0.0, kept, 1.0)
        held = kept * state.force
        trial = held + stiffness * increment.displacement
        limit = state.friction_coefficient * increment.friction_load
        force = np.clip(trial, -limit, limit)
        slip = (trial - force) * softness
        # The mean of the force before and after: as contact ends a spring lets go of all it holds.
        work = np.maximum(0.5 * (held + force) * slip, 0.0)
        return TangentialResponse(force, work), state._replace(force=force)

    def stiffness(self, scene, normal):
        """Return the stiffness of the largest contact."""
        return scene.pair.tangential_stiffness(normal.maximum_radius)


if __name__ == "__main__":
    psi1 = np.array([0.5, 1.0, 1.2, 2.0, 3.0, 4.0])
    scene = Scene.nondimensional(psi1=psi1, chi=1.4412)
    mine = Simulation(tangential=MindlinCap(), integrator="symplectic").run(scene).check()
    paper = Simulation(tangential="annulus", integrator="symplectic").run(scene).check()
    print("psi1   mindlin cap   annulus")
    for row in zip(psi1, mine.psi2, paper.psi2, strict=True):
        print("{:4.1f}   {:11.4f}   {:7.4f}".format(*row))
    # One spring for a whole contact forgets energy when its stiffness changes under load;
    # the books show how much. The annulus method keeps them to its discretisation error.
    for name, result in (("mindlin cap", mine), ("annulus", paper)):
        share = np.max(np.abs(result.energy.relative_imbalance))
        print(f"energy unaccounted for, {name}: {share:.2%}")

    def draw(axes):
        """Draw the rebounds under both laws."""
        both = {"mindlin cap": mine, "annulus": paper}
        lines = []
        for number, result in enumerate(both.values()):
            lines += axes.plot(psi1, result.psi2, marker="o", **law_style(number))
        axes.set(
            xlabel=r"local angle of incidence $\psi_1$", ylabel=r"local angle of reflexion $\psi_2$"
        )
        axes.axhline(0.0, color="grey", lw=0.8, zorder=0)
        name_curves(axes, lines, list(both))

    save(Path("custom_law.png"), draw)
