"""Parameters to fit: numbers of a scene, and options of laws."""

from __future__ import annotations

import abc
import inspect
import math
from collections.abc import Callable, Collection, Sequence
from functools import partial
from typing import NamedTuple

import attrs
import numpy as np

from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.material import Material
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import Rule
from contactlab.numeric.names import nearest
from contactlab.numeric.types import Array, Real
from contactlab.registration.names import full_name
from contactlab.registry.registry import KINDS, REGISTRY, PluginError
from contactlab.runs.simulation import Simulation
from contactlab_fit import tabulated

#: Range of the friction coefficient, and starts of the searches.
FRICTION, FRICTION_STARTS = (1e-6, 10.0), tuple(np.geomspace(0.004, 4.0, 25).tolist())
#: kappa = 2(1-nu)/(2-nu) of isotropic solids, from nu = 0.5 to nu = -1.
STIFFNESS = (2.0 / 3.0, 4.0 / 3.0)
#: Trial numbers that bracket the interval in which the rule of an option holds.
TRIED = np.concatenate([-np.geomspace(1e12, 1e-6, 37), [0.0], np.geomspace(1e-6, 1e12, 37)])
#: Starts of a parameter with a finite range; few starts may all lie where it has no effect.
STARTS = 15
#: Options of the loss: of viscous normal laws, and of tangential laws that share it.
RESTITUTION, SHEAR_LOSS = tabulated.RESTITUTION, "shear_loss"


class Setup(NamedTuple):
    """A scene and its laws; None stands for the tabulated exact rebound."""

    scene: Scene
    simulation: Simulation | None


@attrs.frozen(kw_only=True)
class Parameter(abc.ABC):
    """A number to fit, between ``least`` and ``most``.

    Attributes
    ----------
    name, unit : str
    least, most : float
    starts : tuple of float
        Candidate values at which searches begin.
    """

    name: str
    unit: str = "1"
    least: float
    most: float
    starts: tuple[float, ...]

    @property
    def width(self) -> float:
        """Width of the range; infinite if unbounded."""
        return self.most - self.least

    @property
    def batched(self) -> bool:
        """Whether each impact of a batch may have its own value."""
        return True

    @abc.abstractmethod
    def apply(self, setup: Setup, value: Real) -> Setup:
        """Return scene and laws with this value, a number or an array over the impacts."""


class FrictionCoefficient(Parameter):
    """The friction coefficient of all impacts."""

    @property
    def width(self) -> float:
        """Infinite: ``most`` only bounds the search."""
        return math.inf

    def apply(self, setup: Setup, value: Real) -> Setup:
        """Return the scene with this friction."""
        return setup._replace(scene=attrs.evolve(setup.scene, friction_coefficient=value))


class StiffnessRatio(Parameter):
    """Kappa = G*/E*, the ratio of the initial tangential to the normal stiffness of the contact.

    A rebound depends on the shear moduli through kappa alone. Both bodies get the Poisson's ratio
    of kappa = 2(1-nu)/(2-nu), and keep their compliance in normal contact, (1-nu)/(2G).
    """

    def apply(self, setup: Setup, value: Real) -> Setup:
        """Return the scene with bodies of this ratio."""
        scene = setup.scene
        assert scene.sphere is not None
        assert scene.target is not None
        poisson = (2.0 - 2.0 * value) / (2.0 - value)

        def like(old: Material) -> Material:
            shear = old.shear_modulus * (1.0 - poisson) / (1.0 - old.poisson_ratio)
            return attrs.evolve(old, shear_modulus=shear, poisson_ratio=poisson)

        sphere = attrs.evolve(scene.sphere, material=like(scene.sphere.material))
        material = like(scene.target.material)
        target = (
            HalfSpace(material)
            if isinstance(scene.target, HalfSpace)
            else attrs.evolve(scene.target, material=material)
        )
        return setup._replace(scene=attrs.evolve(scene, sphere=sphere, target=target))


@attrs.frozen(kw_only=True)
class LawOption(Parameter):
    """A real-valued option of a law."""

    kind: str
    option: str
    each: bool = False

    @property
    def batched(self) -> bool:
        """Whether the option may be one number an impact; most have one for all impacts."""
        return self.each

    def apply(self, setup: Setup, value: Real) -> Setup:
        """Return the laws with this option."""
        assert setup.simulation is not None
        laws = {kind: getattr(setup.simulation, kind) for kind in KINDS}
        laws[self.kind] = attrs.evolve(laws[self.kind], **{self.option: value})
        return setup._replace(simulation=Simulation(**laws))


def in_words(parameters: Sequence[Parameter], values: Array) -> str:
    """Return the parameters with their values, in words."""
    pairs = zip(parameters, values.tolist(), strict=True)
    return ", ".join(f"{parameter.name} {value:.4g}" for parameter, value in pairs)


def find_parameter(name: str, setup: Setup) -> Parameter:
    """Return a parameter by name: a number of the scene, or ``kind.option`` of a law.

    The kind may be left out if only one law has an option of that name.
    """
    choices = _choices(setup)
    if (full := _full(name, choices)) is not None:
        return choices[full]()
    near = nearest(name, [*choices, *_short(choices)])
    listed = f"known here: {', '.join(choices)}" if choices else "nothing can be fitted here"
    raise ValueError(
        f"parameters = {name!r}: scene and laws have no such number; {near}{listed}{_remedy(name)}"
    )


def those_of(setup: Setup, names: Sequence[str]) -> list[str]:
    """Return the names that scene and laws have."""
    choices = _choices(setup)
    return [name for name in names if _full(name, choices) is not None]


def asks_for(option: str, names: Sequence[str]) -> bool:
    """Return whether an option of a law is among the names of parameters."""
    return any(name.rpartition(".")[2] == option for name in names)


def defaults_of(setup: Setup, fitted: Collection[str]) -> dict[str, tuple[float, str]]:
    """Return the options of laws that are not fitted and keep their default: value and unit."""
    found: dict[str, tuple[float, str]] = {}
    for name in _choices(setup):
        kind, _, option = name.partition(".")
        if not option or name in fitted:
            continue
        law = getattr(setup.simulation, kind)
        try:
            default = getattr(type(law)(), option)
        except TypeError:  # a required option
            continue
        if getattr(law, option) == default:
            found[name] = float(default), attrs.fields_dict(type(law))[option].metadata["unit"]
    return found


def _full(name: str, choices: Collection[str]) -> str | None:
    """Return the full name of a parameter; None if it is none of the choices, or of several."""
    same = [name] if name in choices else _short(choices).get(name, [])
    return same[0] if len(same) == 1 else None


def _short(choices: Collection[str]) -> dict[str, list[str]]:
    """Return the full names by the last word of each."""
    short: dict[str, list[str]] = {}
    for full in choices:
        short.setdefault(full.rpartition(".")[2], []).append(full)
    return short


def _remedy(name: str) -> str:
    """Return which laws have a parameter."""
    option = name.rpartition(".")[2]
    having = laws_with(option)
    if option == SHEAR_LOSS:
        return f"; {', '.join(having)} has this option under normal = {tabulated.LOSSY!r}"
    if not having:
        return "; options of a law are there once it is chosen and they have a number"
    usual = full_name("normal", tabulated.LOSSY)
    if option == RESTITUTION and usual in having:
        others = ", ".join(law for law in having if law != usual)
        return f"; {usual} has this option (equal damping), and so have {others}"
    return f"; choose a law that has this option: {', '.join(having)}"


def laws_with(option: str) -> list[str]:
    """Return the installed normal and tangential laws with an option of that name."""
    kinds = [kind for kind in KINDS if kind != "integrator"]
    names = [name for kind in kinds for name in REGISTRY.names(kind)]
    matching = []
    for name in names:
        try:
            options = inspect.signature(REGISTRY.law_class(name)).parameters
        except (ValueError, PluginError):  # a broken plug-in is no remedy
            continue
        matching += [name] if option in options else []
    return matching


def _choices(setup: Setup) -> dict[str, Callable[[], Parameter]]:
    """Return makers of the parameters that scene and laws have, by name."""
    choices: dict[str, Callable[[], Parameter]] = {}
    if isinstance(setup.scene.sphere, Sphere) or setup.scene.along:
        choices["friction_coefficient"] = lambda: FrictionCoefficient(
            name="friction_coefficient", least=FRICTION[0], most=FRICTION[1], starts=FRICTION_STARTS
        )
    if isinstance(setup.scene.sphere, Sphere):
        choices["stiffness_ratio"] = lambda: StiffnessRatio(
            name="stiffness_ratio",
            least=STIFFNESS[0],
            most=STIFFNESS[1],
            starts=_evenly(*STIFFNESS),
        )
    simulation = setup.simulation
    if simulation is None:
        return choices
    for kind in KINDS:
        law = getattr(simulation, kind)
        for field in attrs.fields(type(law)) if attrs.has(type(law)) else ():
            value = getattr(law, field.name)
            if field.init and isinstance(value, float) and kind != "integrator":
                if (
                    field.name == SHEAR_LOSS
                    and "viscous" not in simulation.laws.capability.normal_claims
                ):
                    continue  # without a loss there is no such option
                choices[f"{kind}.{field.name}"] = partial(_option, kind, field, value)
    return choices


def _option(kind: str, field: attrs.Attribute[object], value: float) -> LawOption:
    least, most = _range(field.metadata.get("rule"), value)
    finite = math.isfinite(least) and math.isfinite(most)
    return LawOption(
        name=f"{kind}.{field.name}",
        unit=field.metadata.get("unit", "1"),
        least=least,
        most=most,
        starts=(value, *(_evenly(least, most) if finite else ())),
        kind=kind,
        option=field.name,
        each="per_impact" in field.metadata,
    )


def _evenly(least: float, most: float) -> tuple[float, ...]:
    """Return numbers evenly between two ends, without the ends."""
    return tuple(np.linspace(least, most, STARTS + 2)[1:-1].tolist())


def _range(rule: Rule | None, value: float) -> tuple[float, float]:
    """Return the ends of the interval around ``value`` in which a rule holds."""
    if rule is None:
        return -math.inf, math.inf
    return _end(rule, value, np.flip(TRIED[value > TRIED])), _end(rule, value, TRIED[value < TRIED])


def _end(rule: Rule, value: float, further: Array) -> float:
    """Return the last number for which the rule holds on the way from ``value`` outwards."""
    inside = value
    for number in further.tolist():
        if rule.holds(number):
            inside = number
            continue
        outside = number
        for _ in range(100):  # halving, to the last bit
            middle = 0.5 * (inside + outside)
            inside, outside = (middle, outside) if rule.holds(middle) else (inside, middle)
        return inside
    return math.copysign(math.inf, inside - value) if len(further) else value
