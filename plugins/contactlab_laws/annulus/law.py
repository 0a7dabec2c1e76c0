"""The annulus law: partial slip in rings, each of them stuck or slipping."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    AllStepsResponse,
    AllStepsTangentialLaw,
    Increment,
    NormalContact,
    NormalMotion,
    Steps,
    TangentialResponse,
)
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import choice, count
from contactlab.numeric.types import Array, Mask, Real
from contactlab_laws.annulus import all_steps, step
from contactlab_laws.annulus.tables import Tables, hertz_pressure, tables
from contactlab_laws.differences import table as differences
from contactlab_laws.jaeger.all_steps import ScaledSteps
from contactlab_laws.jaeger.partial_slip import PartialSlip, Scales, hemisphere


class State(NamedTuple):
    """Scales and memory of a contact, or of a batch; never changed once made."""

    scales: Scales
    hertz: bool  # whether the normal law is Hertz's
    memory: step.ContactStates


@attrs.frozen(kw_only=True)
class Annulus(PartialSlip, AllStepsTangentialLaw):
    """Mindlin's partial slip by the paper's concentric annuli.

    Each step solves (33) where the surfaces stick and (34) where they slip, tests the
    division into stick and slip by (36) and (37), and repeats with all violators flipped
    until the tests pass. Annuli outside the contact are left out (16).

    The pressures in the middles of (34) carry the load P to within about n^-1.5. Under Hertz's
    law they are those of the paper; under any other law they are scaled to carry P, so that gross
    slip is exact. Shear is elastic: under a viscous normal law the loss is in pressure alone, where
    springs share it (theory §15).

    Parameters
    ----------
    annuli : int
        n, the number of annuli across the largest contact radius. The error is about 1/n, for n
        up to half the steps: annuli that come into contact in one step share one displacement.
    displacement : str
        The displacement that (33) prescribes: at the ``"midpoint"`` of each annulus, as in the
        paper, or its ``"mean"``, which is as accurate and closes the energy books at every n.

    References
    ----------
    Maw, Barber & Fawcett, Wear 38 (1976) 101-114, doi:10.1016/0043-1648(76)90201-5,
    eqs (1), (13)-(18), (22), non-dimensional as (33)-(37).
    """

    api_version: ClassVar[int] = 2
    resolution: ClassVar[str | None] = "annuli"

    annuli: int = count(default=50, most=2000)
    displacement: str = choice("midpoint", "mean", default="midpoint")

    def books_bound(self, scene: Scene) -> Real:
        """Return 1/n for midpoints, which are not reciprocal and leave about 0.3/n; else 0.01.

        With means only the error of the steps is left: 0.01 is generous.
        """
        return 1.0 / self.annuli if self.displacement == "midpoint" else 0.01

    def cautions(self, scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
        """Return the cautions of every law, and one on a pressure that may be no hemisphere."""
        own = (*differences.choice(scene, normal), *hemisphere(normal))
        return (*super().cautions(scene, normal), *own)

    def path_cautions(self) -> tuple[str, ...]:
        """Return the cautions of the force at gross slip, and of false spots in the map."""
        most = 0.1 / self.annuli
        return (
            f"numerical error: the force of {self.annuli} annuli may exceed mu N by up to "
            f"{most:.1g} of mu N; more annuli reduce this.",
            "stick and slip of annuli: false while few annuli are in contact, up to a quarter of "
            "the impact (numerical error; psi2 is right). springs and fronts show none.",
        )

    def start(self, scene: Scene, normal: NormalMotion) -> State:
        """Return a contact without traction."""
        memory = step.start(self.annuli, scene.shape)
        return State(Scales.of(scene, normal), "elastic_hertz" in normal.claims, memory)

    def advance(
        self,
        state: State,
        increment: Increment,
        before: NormalContact,
        after: NormalContact,
    ) -> tuple[TangentialResponse, State]:
        """Return the force (22) after the step."""
        scales, hertz, memory = state
        radius: Real = after.radius / scales.radius
        pressure = self._pressure(scales, radius, after.friction_load, hertz=hertz)
        slip: Real = increment.displacement * scales.displacement
        forces, works, passed, memory = step.advance(self._tables(), memory, slip, radius, pressure)
        force: Real = forces
        work: Real = works
        settled: Mask = passed
        if not memory.lag.shape[:-1]:
            force, work, settled = forces.item(), works.item(), passed.item()
        response = TangentialResponse(force * scales.force, work * scales.work, settled)
        return response, State(scales, hertz, memory)

    def advance_all(
        self, scene: Scene, normal: NormalMotion, steps: Steps
    ) -> AllStepsResponse | None:
        """Return the forces (22) of one impact, computed in blocks of steps.

        None for a batch, and for more annuli than have tables of responses.
        """
        if scene.shape or not self._tables().responses:
            return None
        scales = Scales.of(scene, normal)
        radius, load = steps.contact.radius / scales.radius, steps.contact.friction_load
        scaled = ScaledSteps(
            radius=radius,
            pressure=np.asarray(
                self._pressure(scales, radius, load, hertz="elastic_hertz" in normal.claims)
            ),
            drift=steps.drift * scales.displacement,
            kick=steps.kick * scales.force / scene.pair.tangential_mass,
        )
        march = all_steps.BlockMarch(self._tables(), scaled, float(scene.slip_velocity))
        settled = march.march()
        work = march.friction_work() * float(scales.work)
        return AllStepsResponse(march.forces * scales.force, work, settled)

    def _pressure(self, scales: Scales, radius: Real, load: Real, *, hertz: bool) -> Real:
        """Return the ratio of the pressures of (34) to those of a Hertz contact of this radius."""
        if hertz:
            return scales.pressure(radius, load)
        table = self._tables()
        carried: Real = hertz_pressure(table, radius) @ table.weight  # beta³ to within about n^-1.5
        return load / (scales.normal_force * carried + (carried == 0.0))

    def _tables(self) -> Tables:
        return tables(self.annuli, self.displacement == "mean")

    def fields(self, state: State) -> Mapping[str, NDArray[Any]]:
        """Return radius (m), traction (Pa), displacement (m), stuck and slipping of every annulus.

        ``slipping`` is the sign of the traction of a slipping annulus, 0 elsewhere.
        """
        scales, _, memory = state
        table = self._tables()
        stuck, slipping = memory.division()

        def column(value: Real) -> Array:
            return np.asarray(value)[..., None]

        xi = memory.traction @ table.compliance.T
        return {
            "radius": np.broadcast_to(
                column(scales.radius) * np.sqrt(table.radius_squared), memory.traction.shape
            ),
            # the unit is mu times Hertz's greatest pressure, 3 P_max/(2 pi a²), eq. (3)
            "traction": column(1.5 * scales.force / (np.pi * scales.radius**2)) * memory.traction,
            "displacement": column(scales.metres) * xi,
            "stuck": stuck,
            "slipping": slipping,
        }
