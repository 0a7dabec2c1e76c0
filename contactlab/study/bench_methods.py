"""What the benchmark runs: methods with their ladders of resolutions, and a set of scenes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import attrs

from contactlab.compose.names import full_name, short_name
from contactlab.compose.registry import REGISTRY, PluginError
from contactlab.compose.simulation import Simulation
from contactlab.contracts import WholeImpactTangentialLaw
from contactlab.impact.bodies import HalfSpace, Material, Sphere
from contactlab.impact.scene import Scene

#: psi1 and chi of the scenes: every regime of theory §2 short of slip throughout, which the
#: plan answers in closed form whatever the law.
NONDIMENSIONAL = (
    (0.1, 1.0), (0.5, 1.0), (1.0, 1.0), (1.2, 1.0), (2.0, 1.0),
    (0.1, 49 / 34), (0.5, 49 / 34), (1.0, 49 / 34), (1.2, 49 / 34), (2.0, 49 / 34),
    (3.0, 49 / 34), (4.0, 49 / 34),
    (0.1, 3.0), (0.5, 3.0), (1.0, 3.0), (1.2, 3.0), (2.0, 3.0), (3.0, 3.0), (4.0, 3.0),
)  # fmt: skip
#: Those that a quick benchmark takes.
QUICK = ((0.5, 49 / 34), (1.2, 49 / 34), (3.0, 49 / 34), (1.2, 3.0))

#: Ladders. A law's own resolution is the number of steps over ``STEPS_PER_PART``.
STEPS = (25, 50, 100, 200, 400)
TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10)
QUICK_RESOLUTIONS = 3
STEPS_PER_PART = 4
#: Parts under a tolerance, however coarse.
LEAST_PARTS = 10
#: The paper's steps are paired with annuli as in its own proportion, ten to one.
PAPER_STEPS_PER_PART = 10


@attrs.frozen(kw_only=True)
class Method:
    """A tangential law under an integrator, with Hertz's normal law unless another is named.

    Attributes
    ----------
    tangential, integrator : str
        Names without the kind.
    """

    tangential: str
    integrator: str

    @property
    def whole(self) -> bool:
        """Whether the law answers every impact as a whole, and asks no integrator."""
        return issubclass(_law("tangential", self.tangential), WholeImpactTangentialLaw)

    @property
    def name(self) -> str:
        """``law / integrator``, or the law alone if it needs none."""
        if self.whole:
            return self.tangential
        return f"{self.tangential} / {self.integrator}"

    def resolutions(self, *, quick: bool = False) -> list[dict[str, dict[str, Any]]]:
        """Return options of the two laws, coarse to fine."""
        law = _law("tangential", self.tangential).resolution
        steps = None if self.whole else _law("integrator", self.integrator).resolution
        values: Sequence[Any] = (None,)
        if "tolerance" in (law, steps):
            values = TOLERANCES
        elif law or steps:
            values = STEPS
        per_part = PAPER_STEPS_PER_PART if self.integrator == "paper" else STEPS_PER_PART
        found: list[dict[str, dict[str, Any]]] = []
        for value in values:
            options: dict[str, dict[str, Any]] = {"tangential": {}, "integrator": {}}
            if steps is not None:
                options["integrator"][steps] = value
            if law is not None:
                count = value if isinstance(value, int) else round(value**-0.5)
                least = 2 if isinstance(value, int) else LEAST_PARTS
                options["tangential"][law] = max(count // per_part, least)
            if _accepted(full_name("integrator", self.integrator), options["integrator"]):
                found.append(options)
        if not quick:
            return found
        # Of steps every other one; a tolerance of 1e-6 would take minutes with rings to match.
        return found[:: 1 if values is TOLERANCES else 2][:QUICK_RESOLUTIONS]

    def simulation(
        self, options: dict[str, dict[str, Any]], *, normal: str = "hertz"
    ) -> Simulation:
        """Return the composition at one resolution."""
        return Simulation(
            normal=normal,
            tangential=REGISTRY.create(
                full_name("tangential", self.tangential), **options["tangential"]
            ),
            integrator=REGISTRY.create(
                full_name("integrator", self.integrator), **options["integrator"]
            ),
        )


def scenes(*, quick: bool = False) -> list[Scene]:
    """Return the fixed scenes: the paper's two parameters, and one in SI with spin."""
    pairs = QUICK if quick else NONDIMENSIONAL
    found = [Scene.nondimensional(psi1=psi1, chi=chi) for psi1, chi in pairs]
    steel = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
    return [*found, Scene(Sphere(6.35e-3, steel), HalfSpace(steel), 0.15, 1.93, 0.9, -40.0)]


def methods(laws: Iterable[str] | None = None) -> list[Method]:
    """Return every installed composition that fits, or those of the tangential laws named.

    Laws that make no force are left out, broken plug-ins too unless asked for by name.

    Raises
    ------
    ValueError
        If a law named is not installed, or fits no integrator.
    """
    named = None if laws is None else [short_name(law) for law in laws]
    found = []
    for tangential in named or [short_name(name) for name in REGISTRY.names("tangential")]:
        try:
            if named is None and _makes_no_force(tangential):
                continue
            integrators = [short_name(name) for name in REGISTRY.names("integrator")]
            fitting = [
                Method(tangential=tangential, integrator=integrator)
                for integrator in integrators
                if _fits(tangential, integrator)
            ]
            if issubclass(_law("tangential", tangential), WholeImpactTangentialLaw):
                fitting = fitting[:1]  # no integrator is asked
        except PluginError:
            if named is not None:
                raise
            continue
        if named is not None and not fitting:
            raise ValueError(f"--law {tangential}: fits no installed integrator under normal.hertz")
        found += fitting
    return found


def _fits(tangential: str, integrator: str) -> bool:
    try:
        Simulation(normal="hertz", tangential=tangential, integrator=integrator)
    except (ValueError, TypeError):
        return False
    return True


def _makes_no_force(tangential: str) -> bool:
    """Return whether a law that answers whole impacts changes no velocity."""
    if not issubclass(_law("tangential", tangential), WholeImpactTangentialLaw):
        return False
    try:
        result = Simulation(tangential=tangential).run(Scene.nondimensional(psi1=1.0, chi=1.0))
    except ValueError:
        return False
    return bool(result.psi_change == 0.0)


def _accepted(name: str, options: dict[str, Any]) -> bool:
    """Return False for a value beyond what the integrator allows, such as a coarse tolerance."""
    try:
        REGISTRY.create(name, **options)
    except ValueError:
        return False
    return True


def _law(kind: str, name: str) -> Any:
    return REGISTRY.law_class(full_name(kind, name))
