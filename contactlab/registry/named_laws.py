"""Names of the laws that come with contactlab, by kind, for type checkers alone."""

from __future__ import annotations

from typing import Literal, TypeAlias

NormalName: TypeAlias = Literal[
    "normal.dmt",
    "normal.hertz",
    "normal.hunt_crossley",
    "normal.jkr",
    "normal.kuwabara_kono",
    "normal.linear",
    "normal.thornton",
    "normal.tsuji",
    "normal.viscoelastic",
    "normal.walton_braun",
]
TangentialName: TypeAlias = Literal[
    "tangential.annulus",
    "tangential.coulomb",
    "tangential.frictionless",
    "tangential.fronts",
    "tangential.halfspace",
    "tangential.linear_spring",
    "tangential.mindlin_cap",
    "tangential.mindlin_deresiewicz",
    "tangential.springs",
    "tangential.stronge",
    "tangential.thornton_yin",
    "tangential.walton",
]
IntegratorName: TypeAlias = Literal[
    "integrator.adaptive",
    "integrator.events",
    "integrator.paper",
    "integrator.symplectic",
]
