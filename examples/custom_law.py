"""A tangential law of one's own in one file, passed to a simulation as an object.

The spring of discrete-element codes: Mindlin's stiffness of a contact that sticks all over,
cut off at Coulomb's limit. It is compared with the paper's contact, which slips from its
edge inwards: on the left the force of both as a pressed contact is moved and moved back, on the
right the rebounds. Writes ``custom_law.png`` in the current folder.
"""

from pathlib import Path
from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab import Material, Scene, Simulation, Sphere, load_path
from contactlab.contracts import (
    Increment,
    NormalContact,
    NormalMotion,
    Real,
    SteppedTangentialLaw,
    TangentialResponse,
)
from contactlab.figures import law_style, name_curves, save


class Spring(NamedTuple):
    """The state: two constants of the scene, and the force."""

    stiffness_per_radius: Real
    friction_coefficient: Real
    force: Real


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

    def start(self, scene: Scene, normal: NormalMotion) -> Spring:
        """Return the spring unloaded."""
        return Spring(scene.pair.tangential_stiffness(1.0), scene.friction_coefficient, 0.0)

    def advance(
        self, state: Any, increment: Increment, before: NormalContact, after: NormalContact
    ) -> tuple[TangentialResponse, Any]:
        """Return the force after the step, and the work of friction in it."""
        stiffness = state.stiffness_per_radius * after.radius
        softness = 1.0 / (stiffness + (stiffness == 0.0))
        # As the contact shrinks the force shrinks with it: otherwise a softer spring would
        # hold the same force, and store energy from nothing.
        kept = np.minimum(after.radius / (before.radius + (before.radius == 0.0)), 1.0)
        kept = np.where(before.radius > 0.0, kept, 1.0)
        held = kept * state.force
        trial = held + stiffness * increment.displacement
        limit = state.friction_coefficient * increment.friction_load
        force = np.clip(trial, -limit, limit)
        slip = (trial - force) * softness
        # The mean of both forces: as contact ends a spring loses all that it holds.
        work = np.maximum(0.5 * (held + force) * slip, 0.0)
        return TangentialResponse(force, work), state._replace(force=force)

    def stiffness(self, scene: Scene, normal: NormalMotion) -> Real:
        """Return the stiffness of the largest contact."""
        return scene.pair.tangential_stiffness(normal.maximum_radius)


if __name__ == "__main__":
    psi1 = np.array([0.5, 1.0, 1.2, 2.0, 3.0, 4.0])
    laws = {
        "mindlin cap, mine": Simulation(tangential=MindlinCap(), integrator="symplectic"),
        "annulus": Simulation(tangential="annulus", integrator="symplectic"),
    }
    scene = Scene.nondimensional(psi1=psi1, chi=1.4412)
    mine, paper = (law.run(scene).check() for law in laws.values())
    print("psi1   mindlin cap   annulus")
    for row in zip(psi1, mine.psi2, paper.psi2, strict=True):
        print("{:4.1f}   {:11.4f}   {:7.4f}".format(*row))
    # One spring for a whole contact forgets energy when its stiffness changes under load;
    # the books show how much. The annulus method keeps them to its discretisation error.
    for name, result in (("mindlin cap", mine), ("annulus", paper)):
        share = np.max(np.abs(result.energy.relative_imbalance))
        print(f"energy unaccounted for, {name}: {share:.2%}")

    def draw(axes: Any) -> None:
        """Draw the law, force over displacement at a constant load, and the rebounds."""
        ball = Sphere(0.01, Material.named("steel"))
        pressed = Scene(ball, ball, 0.3, normal_speed=1.0)
        rise = np.linspace(0.0, 3.0e-6, 200)
        depth = np.concatenate((np.linspace(0.0, 1e-5, 100), np.full(400, 1e-5)))
        moved = np.concatenate((np.zeros(100), rise, rise[::-1]))
        over = np.linspace(0.0, 5.0, 200)
        many = Scene.nondimensional(psi1=over, chi=1.4412)
        lines = []
        for number, (name, law) in enumerate(laws.items()):
            path = load_path(pressed, depth, moved, tangential=law.tangential)
            force = path.friction_force / (0.3 * path.normal_force[-1])
            axes[0, 0].plot(1e6 * moved[100:], force[100:], label=name, **law_style(number))
            lines += axes[0, 1].plot(over, law.run(many).psi2, **law_style(number))
        axes[0, 0].set(xlabel="displacement (µm)", ylabel=r"force over $\mu P$")
        axes[0, 0].legend(loc="lower right")
        axes[0, 1].set(
            xlabel=r"local angle of incidence $\psi_1$", ylabel=r"local angle of reflexion $\psi_2$"
        )
        axes[0, 1].axhline(0.0, color="grey", lw=0.8, zorder=0)
        name_curves(axes[0, 1], lines, list(laws))

    save(Path("custom_law.png"), draw, columns=2)
