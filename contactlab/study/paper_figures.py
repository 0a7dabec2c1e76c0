"""The numbers behind Figs 1-4 of the paper.

A new figure needs one function here, ``figure_5``, which returns the numbers. The command finds
the function by its name, writes the table and draws the curves. A figure that needs more than
curves and a legend also has a function of that name in ``contactlab.figures.paper``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import attrs
import numpy as np

from contactlab.collisions.rebound import rebound
from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.hertz import rigid_body_rebound
from contactlab.impact.material import Material
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Array, Real
from contactlab.outcome.history import scale_forces
from contactlab.runs.simulation import Simulation

#: chi of a solid homogeneous sphere of Poisson's ratio 0.3, eq. (38): the paper's 1.4412.
SOLID_CHI = 0.7 / 1.7 * 3.5
#: The paper does not list the angles of its Fig. 1; these span sticking to nearly full slip.
FIGURE_1_PSI1 = (0.4, 0.8, 1.2, 2.0, 3.0, 4.0)
#: Radii of gyration over radius in Fig. 3: all mass at the surface, solid, and denser cores.
FIGURE_3_GYRATION = (1.0, 0.4**0.5, 0.4, 0.25)
#: psi1 of Figs 3 and 4.
FIXED_PSI1 = 1.2
#: Ranges of Figs 2 and 4, which show the change of regime and every sign of psi2. Points are so
#: close that straight lines between them show no kinks. psi2 oscillates in the root of chi, and
#: Fig. 4 has a logarithmic axis: points are evenly spaced in a power of chi between the two, with
#: more where psi2 turns sharply, and one at the corner of the rigid-body theory.
FIGURE_2_PSI1 = np.linspace(0.0, 7.0, 141)
#: psi1 over chi at the end of Fig. 2 of other spheres, which slip throughout from 4 chi - 1.
FIGURE_2_END = 4.8
FIGURE_4_POWER = 0.35
FIGURE_4_TURNS = (0.565, 4.33, 11.17)
FIGURE_4_CHI = np.unique(
    np.concatenate(
        [
            np.linspace(0.25**FIGURE_4_POWER, 16.0**FIGURE_4_POWER, 141) ** (1.0 / FIGURE_4_POWER),
            *(turn * np.linspace(0.94, 1.06, 9) for turn in FIGURE_4_TURNS),
            [FIXED_PSI1 / 4.0],
        ]
    )
)


#: Captions of the figures, for a page or a lecture.
CAPTIONS = {
    1: "Tangential force over the contact of a sphere (chi = {0:.5g}) for six local angles of "
    "incidence psi1, and the limits of friction. The force changes its sign before the end, as the "
    "surfaces spring back.",
    2: "Local angle of reflexion psi2 over that of incidence psi1 of a sphere, chi = {0:.5g}. "
    "Below 0 the contact point leaves backwards, which rigid bodies never do.",
    3: "Tangential force over the contact at psi1 = 1.2 for four radii of gyration. The nearer the "
    "mass is to the centre, the more often the force oscillates.",
    4: "Local angle of reflexion psi2 at psi1 = 1.2 over the inertia ratio chi. The rebound goes "
    "forwards or backwards with the number of oscillations in one contact.",
}


class Ball(NamedTuple):
    """The sphere of the figures: Poisson's ratio, also of the half-space, and K over the radius."""

    poisson_ratio: float = 0.3
    gyration_ratio: float = 0.4**0.5

    @property
    def chi(self) -> float:
        """Inertia ratio of eq. (38)."""
        return chi_of_gyration(self.gyration_ratio, self.poisson_ratio)


#: The paper's sphere.
SOLID = Ball()


class Curve(NamedTuple):
    """A named curve; ``parameter`` distinguishes curves of one name, NaN if there is only one."""

    name: str
    parameter: float
    x: Array
    y: Array


@attrs.frozen(kw_only=True, eq=False)
class FigureData:
    """The curves of one figure.

    Attributes
    ----------
    number : int
        Number of the figure in the paper.
    x, y, parameter : str
        Column headings for tables.
    curves : tuple of Curve
    ball : Ball
        The sphere.
    """

    number: int
    x: str
    y: str
    parameter: str
    curves: tuple[Curve, ...]
    ball: Ball = SOLID

    def rows(self) -> list[tuple[str, float, float, float]]:
        """Return (curve, parameter, x, y) for every point."""
        return [
            (curve.name, curve.parameter, x, y)
            for curve in self.curves
            for x, y in zip(curve.x.tolist(), curve.y.tolist(), strict=True)
        ]


def figure_1(simulation: Simulation, ball: Ball = SOLID) -> FigureData:
    """Return the forces over the contact for several psi1."""
    scenes = {psi1: Scene.nondimensional(psi1=psi1, chi=ball.chi) for psi1 in FIGURE_1_PSI1}
    return _forces(1, simulation, scenes, "psi1", ball)


def figure_2(simulation: Simulation, ball: Ball = SOLID) -> FigureData:
    """Return psi2(psi1), elastic and rigid-body."""
    wider = max(1.0, FIGURE_2_END * ball.chi / FIGURE_2_PSI1[-1])
    return _reflexion(2, simulation, ball, psi1=wider * FIGURE_2_PSI1, chi=ball.chi)


def figure_3(simulation: Simulation, ball: Ball = SOLID) -> FigureData:
    """Return the forces over the contact at psi1 = 1.2 for several radii of gyration."""
    scenes = {
        ratio: Scene.nondimensional(psi1=FIXED_PSI1, chi=chi_of_gyration(ratio, ball.poisson_ratio))
        for ratio in FIGURE_3_GYRATION
    }
    return _forces(3, simulation, scenes, "gyration_ratio", ball)


def figure_4(simulation: Simulation, ball: Ball = SOLID) -> FigureData:
    """Return psi2(chi) at psi1 = 1.2, elastic and rigid-body."""
    return _reflexion(4, simulation, ball, psi1=FIXED_PSI1, chi=FIGURE_4_CHI)


def paper_data() -> dict[int, Callable[..., FigureData]]:
    """Return the functions ``figure_1``, ``figure_2``, ... of this module by figure number."""
    prefix = "figure_"
    by_number = {
        int(name.removeprefix(prefix)): function
        for name, function in globals().items()
        if name.startswith(prefix)
    }
    return dict(sorted(by_number.items()))


def chi_of_gyration(gyration_ratio: float, poisson_ratio: float = 0.3) -> float:
    """Return chi, eq. (38), of a sphere on a half-space of its own material.

    Parameters
    ----------
    gyration_ratio : float
        Radius of gyration over radius.
    poisson_ratio : float

    Raises
    ------
    ValueError
        If there is no such sphere.
    """
    material = Material(young_modulus=1.0, poisson_ratio=poisson_ratio, density=1.0)
    ball = Sphere(1.0, material, gyration_ratio=gyration_ratio)
    chi: float = Scene(ball, HalfSpace(material), 0.1, 1.0).chi
    return chi


def _forces(
    number: int, simulation: Simulation, scenes: Mapping[float, Scene], parameter: str, ball: Ball
) -> FigureData:
    """Return the tangential force of each impact over time, and the normal force of the first."""
    curves: list[Curve] = []
    for value, scene in scenes.items():
        result = simulation.run(scene, history=True).check()
        time, tangential, normal = scale_forces(result)
        if not curves:  # the normal force is the same for all
            curves.append(Curve("P/P_max", np.nan, time, normal))
        curves.append(Curve("F/(mu P_max)", value, time, tangential))
    return FigureData(
        number=number,
        x="t/duration",
        y="force",
        parameter=parameter,
        curves=tuple(curves),
        ball=ball,
    )


def _reflexion(
    number: int, simulation: Simulation, ball: Ball, *, psi1: Real, chi: Real
) -> FigureData:
    """Return psi2 of a law, of rigid bodies, and exact, over psi1 or chi: the one in an array."""
    varied = {"psi1": psi1, "chi": chi}
    name = next(name for name, value in varied.items() if np.ndim(value))
    x = np.asarray(varied[name])
    result = simulation.sweep(Scene.nondimensional(psi1=psi1, chi=chi)).check()
    law = result.laws["tangential"].partition(" ")[0]
    curves = (
        Curve(law, np.nan, x, np.asarray(result.psi2)),
        Curve("rigid-body theory", np.nan, x, np.asarray(rigid_body_rebound(psi1, chi))),
        Curve("exact solution", np.nan, x, np.asarray(rebound(psi1, chi))),
    )
    return FigureData(number=number, x=name, y="psi2", parameter="", curves=curves, ball=ball)
