"""Which laws a scene is run with, by name, and their options."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import attrs

from contactlab.compose import composition
from contactlab.compose.names import KINDS, full_name, kind_of, parted, short_name
from contactlab.compose.registry import REGISTRY
from contactlab.compose.simulation import Simulation
from contactlab.scene_file.table import Table, flattened, nearest_of

OPTION_REMEDY = "write tangential.annuli = 50, or tangential.annulus.annuli = 50 for one law only"


@attrs.frozen(kw_only=True)
class LawChoice:
    """Names of the three laws, and options for them.

    Attributes
    ----------
    normal, tangential, integrator : str or None
        Names without their kind, such as ``"springs"`` or ``"my-laws:springs"``; None for the best
        that fits the others, the exact solution if nothing else is asked for.
    options : mapping of str to mapping
        Options by kind, for the law chosen here (``{"tangential": {"annuli": 50}}``), or by
        full name, for that law whenever it is chosen (``{"tangential.annulus": ...}``).
    """

    normal: str | None = None
    tangential: str | None = None
    integrator: str | None = None
    options: Mapping[str, Mapping[str, Any]] = attrs.field(factory=dict)

    def choose(self, **names: str | None) -> LawChoice:
        """Return the choice with other laws; None keeps a name.

        Options given for a kind are the old law's: they go where its law goes.
        """
        chosen = {
            kind: short_name(full_name(kind, name))
            for kind, name in names.items()
            if name is not None
        }
        changed = [kind for kind, name in chosen.items() if getattr(self, kind) not in (None, name)]
        kept = {key: value for key, value in self.options.items() if key not in changed}
        return attrs.evolve(self, **chosen, options=kept)

    def set(self, settings: Mapping[str, Any]) -> LawChoice:
        """Return the choice with more options, keyed by dotted path."""
        options = {key: dict(value) for key, value in self.options.items()}
        for path, value in settings.items():
            owner, _, option = path.rpartition(".")
            if kind_of(owner) not in KINDS or not option:
                hint = nearest_of(kind_of(owner), KINDS)
                raise ValueError(f"{path}: is not an option of a law; {OPTION_REMEDY}; {hint}")
            options.setdefault(owner, {})[option] = value
        return attrs.evolve(self, options=options)

    def simulation(self) -> Simulation:
        """Make the three laws with their options and compose them.

        Raises
        ------
        ValueError
            If a law is not installed, an option is unknown or out of range, of a law that is
            not chosen too, or the laws do not fit.
        """
        choice = self.resolved()
        for name, options in self.options.items():
            if name not in KINDS:  # of a law that may not be chosen: misspelt, it would go unseen
                REGISTRY.create(name, **options)
        return Simulation(**{kind: choice.made(kind) for kind in KINDS})

    def resolved(self) -> LawChoice:
        """Return the choice with every law named."""
        choice = attrs.evolve(self, normal=self.normal or composition.DEFAULT_NORMAL)
        made = [choice.made("normal")]
        named = () if self.integrator is None else (choice.made("integrator"),)
        for kind in ("tangential", "integrator"):
            if getattr(choice, kind) is None:
                name = composition.preferred(kind, *made, after=named)
                choice = choice.choose(**{kind: name})
            made.append(choice.made(kind))
        return choice

    def suited(self) -> LawChoice:
        """Return the choice without its integrator, if that does not run the tangential law."""
        if self.integrator is None:
            return self
        free = attrs.evolve(
            self,
            integrator=None,
            options={key: value for key, value in self.options.items() if key != "integrator"},
        ).resolved()
        kept = attrs.evolve(free, integrator=self.integrator, options=self.options)
        laws = (kept.made("normal"), kept.made("tangential"), kept.made("integrator"))
        return free if composition.misfit(*laws) else kept

    def made(self, kind: str) -> Any:
        """Return the law of one kind with its options."""
        name = full_name(kind, getattr(self, kind))
        options = dict(self.options.get(kind, {}))
        for other, values in self.options.items():
            if other not in KINDS and same_law(other, name):
                options |= values
        return REGISTRY.create(name, **options)


def same_law(one: str, other: str) -> bool:
    """Return whether two full names mean one installed law: with and without its distribution."""
    if one == other or parted(one)[1] != parted(other)[1]:
        return one == other
    return REGISTRY.info(one) == REGISTRY.info(other)


def read_laws(content: object) -> LawChoice:
    """Return the laws of a file's ``[simulation]``."""
    table = Table(content, "simulation", known=(*KINDS, "options"))
    names = {kind: table.text(kind) for kind in KINDS if table.has(kind)}
    choice = LawChoice().choose(**names)
    if not table.has("options"):
        return choice
    raw = table.content["options"]
    if not isinstance(raw, Mapping):
        raise ValueError(f"simulation.options: must be a table; {OPTION_REMEDY}")
    try:
        return choice.set(flattened(raw))
    except ValueError as error:
        raise ValueError(f"simulation.options.{error}") from error
