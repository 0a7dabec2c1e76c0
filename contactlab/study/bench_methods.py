"""Methods of the benchmark with their ladders of resolutions, and its set of scenes."""

from __future__ import annotations

import inspect
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import TypeAlias

import attrs

from contactlab.contracts import WholeImpactTangentialLaw
from contactlab.contracts.law import Law, law_kind
from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.material import Material
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import refuse
from contactlab.registration.names import KINDS, full_name, is_place, kind_of, short_name
from contactlab.registry import composition
from contactlab.registry.composition import DEFAULT_NORMAL, RESTITUTION
from contactlab.registry.registry import REGISTRY, PluginError
from contactlab.runs.simulation import Simulation
from contactlab.study.posed import pose
from contactlab.testing.load_paths import scene as ball

#: psi1 and chi of the scenes: every regime of theory §2 but slip throughout, which every law
#: answers in closed form. Solid spheres have chi from 1.17 to 1.75.
NONDIMENSIONAL = (
    (0.1, 1.17), (0.5, 1.17), (1.0, 1.17), (1.2, 1.17), (2.0, 1.17), (3.0, 1.17),
    (0.1, 49 / 34), (0.5, 49 / 34), (1.0, 49 / 34), (1.2, 49 / 34), (2.0, 49 / 34),
    (3.0, 49 / 34), (4.0, 49 / 34),
    (0.1, 1.75), (0.5, 1.75), (1.0, 1.75), (1.2, 1.75), (2.0, 1.75), (3.0, 1.75), (4.0, 1.75),
)  # fmt: skip
#: psi1 and chi of a quick benchmark.
QUICK = ((0.5, 49 / 34), (1.2, 49 / 34), (3.0, 49 / 34))

#: Ladders of resolution: parts (springs, annuli) if a law has them, else steps. The number of steps
#: is then the number of parts times the ratio of the two defaults (ten for the paper's steps and
#: annuli) or times ``STEPS_PER_PART``, but at least ``LEAST_STEPS``.
STEPS = (25, 50, 100, 200, 400)
PARTS = (2, 3, 4, 8, 12, 25, 50, 100)
TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10)
QUICK_RESOLUTIONS, QUICK_PARTS = 3, (8, 25, 50)
STEPS_PER_PART, LEAST_STEPS = 4, 25
#: Least number of parts under a tolerance.
LEAST_PARTS = 10


#: Options of laws, by kind and name: the resolution of a method.
Options: TypeAlias = Mapping[str, Mapping[str, float]]


@attrs.frozen(kw_only=True)
class Method:
    """A tangential law under an integrator and a normal law.

    Attributes
    ----------
    tangential, integrator, normal : str
        Names without the kind.
    restitution : float or None
        Restitution of the normal law; None for its default.
    """

    tangential: str
    integrator: str
    normal: str = DEFAULT_NORMAL
    restitution: float | None = None

    @property
    def whole(self) -> bool:
        """Whether the law answers every impact as a whole, without an integrator."""
        return issubclass(_law("tangential", self.tangential), WholeImpactTangentialLaw)

    @property
    def name(self) -> str:
        """``law / integrator``, or ``law`` without one; a normal law other than the default too."""
        name = self.tangential if self.whole else f"{self.tangential} / {self.integrator}"
        if self.normal == DEFAULT_NORMAL:
            return name
        e = "" if self.restitution is None else f" e={self.restitution:g}"
        return f"{name}, {self.normal}{e}"

    def resolutions(self, *, quick: bool = False) -> list[Options]:
        """Return options of tangential law and integrator by kind, coarse to fine."""
        law = _law("tangential", self.tangential).resolution
        steps = None if self.whole else _law("integrator", self.integrator).resolution
        values: Sequence[float] = (math.nan,)  # no resolution
        if "tolerance" in (law, steps):
            values = TOLERANCES
        elif law:
            values = PARTS
        elif steps:
            values = STEPS
        per_part = self._steps_per_part(law, steps)
        ladder: list[Options] = []
        for value in values:
            options: dict[str, dict[str, float]] = {"tangential": {}, "integrator": {}}
            if steps is not None:
                options["integrator"][steps] = value
            if law is not None and values is PARTS:
                options["tangential"][law] = value
                if steps is not None:
                    options["integrator"][steps] = max(per_part * value, LEAST_STEPS)
            elif law is not None:
                options["tangential"][law] = round(LEAST_PARTS * (TOLERANCES[0] / value) ** 0.5)
            if all(
                accepts(full_name(kind, getattr(self, kind)), options[kind]) for kind in options
            ):
                ladder.append(options)
        if not quick:
            return ladder
        if law is not None and values is PARTS:
            return [each for each in ladder if each["tangential"][law] in QUICK_PARTS]
        # A tolerance of 1e-6 would take minutes, because the annuli grow with it.
        return ladder[:: 1 if values is TOLERANCES else 2][:QUICK_RESOLUTIONS]

    def _steps_per_part(self, part: str | None, steps: str | None) -> int:
        """Return default steps over default parts; ``STEPS_PER_PART`` unless both are integers."""
        if part is None or steps is None:
            return STEPS_PER_PART
        step_default = _default("integrator", self.integrator, steps)
        part_default = _default("tangential", self.tangential, part)
        if isinstance(step_default, int) and isinstance(part_default, int):
            return max(1, round(step_default / part_default))
        return STEPS_PER_PART

    def simulation(self, options: Options, *, normal: str | None = None) -> Simulation:
        """Return the composition at one resolution; ``normal`` replaces the method's normal law."""
        own = normal in (None, self.normal)
        return Simulation(
            normal=normal or self.normal,
            restitution=self.restitution if own else None,
            tangential=composition.law("tangential", self.tangential, **options["tangential"]),
            integrator=composition.law("integrator", self.integrator, **options["integrator"]),
        )


def scenes(*, quick: bool = False, sized: bool = False) -> list[Scene]:
    """Return the scenes: dimensionless ones by psi1 and chi, and a steel ball with spin.

    Parameters
    ----------
    quick : bool
        Fewer scenes.
    sized : bool
        Scenes of a ball in SI instead of dimensionless ones, for laws with options in SI.
    """
    pairs = QUICK if quick else NONDIMENSIONAL
    if sized:
        fixed = [ball(psi1, chi) for psi1, chi in pairs]
    else:
        fixed = [Scene.nondimensional(psi1=psi1, chi=chi) for psi1, chi in pairs]
    steel = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
    return [*fixed, Scene(Sphere(6.35e-3, steel), HalfSpace(steel), 0.15, 1.93, 0.9, -40.0)]


def methods(laws: Iterable[str] | None = None, *, restitution: float | None = None) -> list[Method]:
    """Return every installed composition that fits, or the compositions of the laws named.

    Laws without friction are left out unless named; so are broken plug-ins.

    Parameters
    ----------
    laws : iterable of str, optional
        Names of any kind, as ``"integrator.mine"``; a name without a kind is a tangential law.
        If no tangential law is named, all are taken, and likewise integrators; if no normal law
        is named, the default.
    restitution : float, optional
        Coefficient of restitution, in place of a normal law; 1 for elastic bodies.

    Raises
    ------
    ValueError
        If a law named is not installed, or fits no other; if a normal law is named beside a
        restitution.
    """
    if restitution is not None:
        Simulation(restitution=restitution)  # refuses what is out of range
    named: dict[str, list[str]] = {kind: [] for kind in KINDS}
    for law in laws or ():
        kind = law_kind(REGISTRY.law_class(law)) if is_place(law) else kind_of(law)
        kind = kind if kind in KINDS else "tangential"
        named[kind].append(short_name(full_name(kind, law)))
        _law(kind, named[kind][-1])  # raises if the law is not installed
    if restitution is not None and named["normal"]:
        rule = f"stands in place of a normal law, and {named['normal'][0]} is named"
        raise refuse("restitution", restitution, rule, "leave out one of the two")
    if restitution is not None and restitution != 1.0:
        laws = [*(laws or ())]
        named["normal"] = [RESTITUTION["normal"]]
    fitting: list[Method] = []
    for normal in named["normal"] or [DEFAULT_NORMAL]:
        for tangential in named["tangential"] or _list_names("tangential"):
            of_law = _fitting(normal, tangential, named)
            if not of_law and named["tangential"]:
                integrators = ", ".join(named["integrator"])
                misfit = (
                    f"does not fit {integrators}" if integrators else "fits no installed integrator"
                )
                under = full_name("normal", normal)
                raise ValueError(f"--tangential {tangential}: {misfit} under {under}")
            fitting += of_law
    if laws is not None and not fitting:
        listed = ", ".join(name for names in named.values() for name in names)
        raise ValueError(f"{listed}: no installed tangential law fits")
    if named["normal"] == [RESTITUTION["normal"]]:
        fitting = [attrs.evolve(method, restitution=restitution) for method in fitting]
    return fitting


def _fitting(normal: str, tangential: str, named: dict[str, list[str]]) -> list[Method]:
    """Return the methods of one normal and one tangential law; ``named`` are the laws asked for."""
    try:
        whole = issubclass(_law("tangential", tangential), WholeImpactTangentialLaw)
        if not named["tangential"] and (
            _makes_no_force(tangential) or (whole and named["integrator"])
        ):
            return []
        fitting = [
            Method(tangential=tangential, integrator=integrator, normal=normal)
            for integrator in named["integrator"] or _list_names("integrator")
            if _fits(normal, tangential, integrator)
        ]
        return fitting[:1] if whole else fitting  # all integrators give the same answer
    except PluginError:
        if any(named.values()):
            raise
        return []


def _list_names(kind: str) -> list[str]:
    return [short_name(name) for name in REGISTRY.names(kind)]


def _fits(normal: str, tangential: str, integrator: str) -> bool:
    try:
        Simulation(normal=normal, tangential=tangential, integrator=integrator)
    except (ValueError, TypeError):
        return False
    return True


def _makes_no_force(tangential: str) -> bool:
    """Return whether a whole-impact law changes no velocity."""
    if not issubclass(_law("tangential", tangential), WholeImpactTangentialLaw):
        return False
    try:
        simulation = Simulation(tangential=tangential)
        scene = pose(Scene.nondimensional(psi1=1.0, chi=1.0), simulation.laws)
        result = simulation.run(scene)
    except ValueError:
        return False
    return bool(result.psi_change == 0.0)


def accepts(name: str, options: Mapping[str, object]) -> bool:
    """Return whether a law accepts the options; a resolution may be too coarse."""
    try:
        REGISTRY.create(name, **options)
    except ValueError:
        return False
    return True


def _default(kind: str, name: str, option: str) -> object:
    """Return the default of a law's option."""
    return inspect.signature(_law(kind, name)).parameters[option].default


def _law(kind: str, name: str) -> type[Law]:
    return REGISTRY.law_class(full_name(kind, name))
