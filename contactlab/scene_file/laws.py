"""The laws of a scene, by name, and their options."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Mapping
from inspect import signature
from pathlib import Path
from typing import Any, Literal, overload

import attrs

from contactlab.contracts import Integrator, NormalLaw, TangentialLaw
from contactlab.contracts.law import Law
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import refuse
from contactlab.numeric.names import nearest
from contactlab.registration.names import (
    KINDS,
    full_name,
    is_place,
    kind_of,
    name_from,
    short_name,
    split_name,
)
from contactlab.registry import composition
from contactlab.registry.registry import REGISTRY, PluginError
from contactlab.runs.owners import options as options_of_laws
from contactlab.runs.owners import takes_restitution
from contactlab.runs.simulation import Simulation
from contactlab.scene_file.table import Table, flatten, nearest_of
from contactlab.solve.solve import ways

#: e = 1 - c v^(1/5) in words without blanks.
FIFTH_ROOT = re.compile(r"1-(\d*\.?\d+(?:e[+-]?\d+)?)v\^\(?(?:1/5|0?\.2)\)?")
OF_SPEED_IN_TOML = "[[0.5, 0.95], [2, 0.9]], e over the speed in m/s"
OPTION_REMEDY = "write tangential.annuli = 50, or tangential.annulus.annuli = 50 for one law only"


@attrs.frozen(kw_only=True)
class LawChoice:
    """Names of the three laws, and options for them.

    Attributes
    ----------
    normal, tangential, integrator : str or None
        Names without their kind, such as ``"springs"`` or ``"my-laws:springs"``. None chooses the
        best law that fits the others: the exact solution if all three are None.
    options : mapping of str to mapping
        Options by kind, for the law of that kind (``{"tangential": {"annuli": 50}}``), or by
        full name, used only if that law is chosen (``{"tangential.annulus": ...}``).
    """

    normal: str | None = None
    tangential: str | None = None
    integrator: str | None = None
    options: Mapping[str, Mapping[str, Any]] = attrs.field(factory=dict)

    def choose(self, **names: str | None) -> LawChoice:
        """Return the choice with other laws; None keeps a name.

        A kind whose law changes loses the options of that kind.
        """
        chosen = {
            kind: short_name(full_name(kind, name))
            for kind, name in names.items()
            if name is not None
        }
        changed = [kind for kind, name in chosen.items() if getattr(self, kind) not in (None, name)]
        kept = {key: value for key, value in self.options.items() if key not in changed}
        return attrs.evolve(self, **chosen, options=kept)

    def set(self, settings: Mapping[str, object]) -> LawChoice:
        """Return the choice with more options, by dotted path: ``"tangential.annuli"``."""
        options = {key: dict(value) for key, value in self.options.items()}
        for path, value in settings.items():
            owner, _, option = path.rpartition(".")
            if complaint := _complaint(path):
                near = "" if owner else nearest(path, self._list_options())
                if not (owner or near) and (found := _laws_with(path)):
                    raise ValueError(f"{path}: {found}")
                raise ValueError(f"{complaint}; {near}".rstrip("; "))
            options.setdefault(owner, {})[option] = value
        return attrs.evolve(self, options=options)

    def without(self, kind: str) -> LawChoice:
        """Return the choice without the law of a kind and its options."""
        kept = {key: value for key, value in self.options.items() if key != kind}
        return attrs.evolve(self, **{kind: None}, options=kept)

    def with_restitution(self, restitution: object) -> LawChoice:
        """Return the choice with the law of a restitution, one loss for pressure and shear.

        Parameters
        ----------
        restitution : float, str or list
            e; or in words as a function of the speed of approach, ``"1 - 0.02 v^(1/5)"``; or a
            table ``[[speed, e], ...]``, speeds in m/s.

        Raises
        ------
        ValueError
            If another normal law is named, or the restitution is out of range.
        """
        law = composition.RESTITUTION["normal"]
        if self.normal not in (None, law):
            raise ValueError(beside(self.normal, restitution))
        if (other := self.options.get("normal", {}).get("restitution")) is not None:
            rule = f"normal.restitution = {other} is given too"
            raise refuse("restitution", restitution, rule, "leave out one of the two")
        option, value = _of_speed(restitution)
        composition.law("normal", law, **{option: value})  # refuses what is out of range
        if restitution == 1.0:
            return self
        return self.choose(normal=law).set({f"normal.{option}": value})

    def simulation(self) -> Simulation:
        """Return the simulation of the three laws with their options.

        Raises
        ------
        ValueError
            If a law is not installed, the laws do not fit, or an option is unknown or out of
            range; options of laws that are not chosen are checked too. If a scene that was read
            without ``allow_code`` names a law in a file or in a module.
        """
        choice = self.resolve()
        for name, options in self.options.items():
            if name not in KINDS:  # check options of laws that are not chosen too
                REGISTRY.create(name, **options)
        named = frozenset(kind for kind in KINDS if getattr(self, kind) or kind in self.options)
        made = choice.make("normal"), choice.make("tangential"), choice.make("integrator")
        laws = composition.Laws(*made).change(named=named)
        composition.check(laws)
        return Simulation.of(laws)

    def resolve(self) -> LawChoice:
        """Return the choice with every law named."""
        choice = attrs.evolve(self, normal=self.normal or composition.DEFAULT_NORMAL)
        made: list[Law] = [choice.make("normal")]
        named = () if self.integrator is None else (choice.make("integrator"),)
        for kind in ("tangential", "integrator"):
            if getattr(choice, kind) is None:
                name = composition.prefer_law(kind, *made, after=named)
                choice = choice.choose(**{kind: name})
            made.append(choice.make(kind))
        return choice

    def suit_to(self, scene: Scene) -> LawChoice:
        """Return the choice with every law named, by the laws that answer a scene."""
        choice = self.resolve()
        laws = self.simulation().laws
        for kind, used in ways(laws, scene)[-1].laws.by_kind().items():
            if used is not getattr(laws, kind):
                choice = choice.choose(**{kind: REGISTRY.short_name(used)})
        return choice

    def suit(self) -> LawChoice:
        """Return the choice, without its integrator if that does not run the tangential law."""
        if self.integrator is None:
            return self
        default = attrs.evolve(
            self,
            integrator=None,
            options={key: value for key, value in self.options.items() if key != "integrator"},
        ).resolve()
        own = attrs.evolve(default, integrator=self.integrator, options=self.options)
        laws = (own.make("normal"), own.make("tangential"), own.make("integrator"))
        return default if composition.misfit(*laws) else own

    def _list_options(self) -> list[str]:
        """Return the options of the three laws: ``"tangential.annuli"``."""
        choice = self.resolve()
        laws = {kind: type(choice.make(kind)) for kind in KINDS}
        return [f"{kind}.{name}" for kind in KINDS for name in signature(laws[kind]).parameters]

    @overload
    def make(self, kind: Literal["normal"]) -> NormalLaw: ...
    @overload
    def make(self, kind: Literal["tangential"]) -> TangentialLaw: ...
    @overload
    def make(self, kind: Literal["integrator"]) -> Integrator: ...
    @overload
    def make(self, kind: str) -> Law: ...
    def make(self, kind: str) -> Law:
        """Return the law of one kind with its options."""
        name = full_name(kind, getattr(self, kind))
        options = dict(self.options.get(kind, {}))
        for owner, values in self.options.items():
            if owner not in KINDS and same_law(owner, name):
                options |= values
        try:
            return composition.law(kind, name, **options)
        except ValueError as error:
            if other := _owner(kind, name, options):
                raise ValueError(f"{error}; {other}") from None
            raise


def _of_speed(restitution: object) -> tuple[str, Any]:
    """Return the option of the law of a restitution, and its value."""
    if isinstance(restitution, list):
        return "restitutions", restitution
    if not isinstance(restitution, str):
        return "restitution", restitution
    words = restitution.replace(" ", "").replace("*", "")
    if found := FIFTH_ROOT.fullmatch(words.lower()):
        return "speed_loss", float(found[1])
    if ":" in words:  # as on the command line
        with contextlib.suppress(ValueError):
            return "restitutions", [
                [float(n) for n in pair.split(":")] for pair in words.split(",")
            ]
    rule = "is neither a number, nor a function or a table of the speed"
    remedy = "write 0.9, 1 - 0.02 v^(1/5), or 0.5:0.95,2:0.9 (speed in m/s and e)"
    raise refuse("restitution", restitution, rule, f"{remedy}; in TOML {OF_SPEED_IN_TOML}")


def _owner(kind: str, name: str, given: Mapping[str, object]) -> str:
    """Return the law of a kind that has an option which the default lacks; empty if none."""
    known = options_of_laws(at_hand=True)
    for option in given:
        having = [law for law in known.get(option, ()) if kind_of(law) == kind]
        if having and name not in having:
            return (
                f"{short_name(having[0])} has this option: choose {kind} = {short_name(having[0])}"
            )
    return ""


def beside(
    normal: str,
    restitution: object,
    *,
    given: str = "restitution = ",
    law: str = "normal = ",
    option: str = "normal.restitution = ",
) -> str:
    """Return why a restitution cannot stand beside a named normal law, and what to write.

    ``given``, ``law`` and ``option`` are written before a restitution, a law and an option.
    """
    remedy = f"leave out {law}{normal}"
    name = full_name("normal", normal)
    with contextlib.suppress(PluginError, ValueError):  # a law that is not installed
        if not is_place(name) and takes_restitution(REGISTRY.law_class(name)):
            remedy += f", or {given.rstrip(' =')}, and give {option}{restitution}"
    chosen = composition.RESTITUTION["normal"]
    return f"{given}{restitution}: chooses the normal law ({chosen}); {remedy}"


def _laws_with(option: str) -> str:
    """Return which installed laws have an option that was named without them; empty if none."""
    having = options_of_laws(at_hand=False).get(option, [])
    if not having:
        return ""
    kind, name = kind_of(having[0]), short_name(having[0])
    others = f" (and of {', '.join(having[1:])})" if having[1:] else ""
    return f"belongs to {having[0]}{others}: write --{kind} {name} --set {kind}.{option}=..."


def same_law(one: str, other: str) -> bool:
    """Return whether two full names, with or without a distribution, mean the same law."""
    if one == other or split_name(one)[1] != split_name(other)[1]:
        return one == other
    return REGISTRY.info(one) == REGISTRY.info(other)


def _complaint(path: str) -> str | None:
    """Return why a dotted path is no option of a law, or None; nothing is imported."""
    owner, _, option = path.rpartition(".")
    kind = kind_of(owner)
    # A law in a file has no full name: its options are those of its kind.
    if kind in KINDS and option and not is_place(owner):
        return None
    told = f"{path}: is not an option of a law; {OPTION_REMEDY}"
    return f"{told}; {nearest_of(kind, KINDS)}" if owner else told


def read_laws(content: object, folder: Path, *, allow_code: bool) -> LawChoice:
    """Return the laws of the ``[simulation]`` table of a file in ``folder``; none is imported."""
    known = (*KINDS, "restitution", "options")
    for key, value in content.items() if isinstance(content, Mapping) else ():
        if key not in known and (having := options_of_laws(at_hand=True).get(key)):
            kind, name = kind_of(having[0]), short_name(having[0])
            remedy = f"write {kind} = '{name}' and options.{kind}.{key} = {value!r}"
            raise ValueError(f"simulation.{key}: belongs to {having[0]}; {remedy}")
    table = Table(content, "simulation", known=known)
    names = {
        kind: name_from(folder, table.text(kind), trusted=allow_code)
        for kind in KINDS
        if table.has(kind)
    }
    choice = LawChoice().choose(**names)
    if table.has("restitution"):
        value = table.content["restitution"]
        if isinstance(value, str | list):
            choice = table.make(choice.with_restitution, restitution=value)
        else:
            remedy = f"or {OF_SPEED_IN_TOML}; leave it out for 1"
            number = table.number("restitution", remedy=remedy)
            choice = choice.with_restitution(number)
    if not table.has("options"):
        return choice
    raw = table.content["options"]
    if not isinstance(raw, Mapping):
        raise ValueError(f"simulation.options: must be a table; {OPTION_REMEDY}")
    options = flatten(raw)
    for path in options:
        if complaint := _complaint(path):
            raise ValueError(f"simulation.options.{complaint}")
    return choice.set(options)
