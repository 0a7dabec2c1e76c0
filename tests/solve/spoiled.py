"""Real laws with one of their answers spoiled: every law, under every contract."""

from __future__ import annotations

import copy

import attrs
import numpy as np

from contactlab.contracts import (
    ClosedFormMotion,
    ClosedFormNormalLaw,
    NormalLaw,
    PathTangentialLaw,
    SteppedTangentialLaw,
)


class Spoiler:
    """Counts the calls of a run and spoils one, or all from then on; 0 spoils none."""

    def __init__(self, at: int, value: float, *, lasting: bool = False) -> None:
        self.at, self.value, self.lasting, self.calls = at, value, lasting, 0

    def __call__(self, entry):
        """Return ``entry``, or the bad value if its turn has come."""
        self.calls += 1
        if self.calls != self.at and not (self.lasting and self.calls > self.at > 0):
            return entry
        return entry * 0.0 + self.value if isinstance(entry, np.ndarray) else self.value

    @property
    def struck(self) -> bool:
        return self.calls >= self.at > 0


def inert_copy(law, base):
    """Return class attributes of a law for its wrapper."""
    names = ("needs", "offers", "resolution")
    found = {name: getattr(law, name) for name in names if hasattr(law, name)}
    return found | {"api_version": 2}


def spoiled_tangential(law, spoil, entry):
    """Wrap a stepped law; ``entry`` names what of its response is spoiled."""

    def advance(self, state, increment, before, after):
        response, state = law.advance(state, increment, before, after)
        return response._replace(**{entry: spoil(getattr(response, entry))}), state

    body = inert_copy(law, SteppedTangentialLaw) | {
        "start": lambda _, scene, normal: law.start(scene, normal),
        "advance": advance,
        "stiffness": lambda _, scene, normal: law.stiffness(scene, normal),
    }
    return attrs.frozen(type("Spoiled", (SteppedTangentialLaw,), body))()


def spoiled_path(law, spoil, entry):
    """Wrap a law of a path: ``entry`` names what of one of its stretches is spoiled."""

    def path(self, *arguments):
        for stretch in law.path(*arguments):
            made = copy.copy(stretch)
            object.__setattr__(made, entry, spoil(getattr(stretch, entry)))
            yield made

    body = inert_copy(law, PathTangentialLaw) | {"path": path}
    return attrs.frozen(type("Spoiled", (PathTangentialLaw,), body))()


class SpoiledMotion(ClosedFormMotion):
    """Wraps a motion in closed form; ``name`` says which of its answers is spoiled."""

    def __init__(self, motion, spoil, name):
        self.motion, self.spoil, self.name = motion, spoil, name

    def _told(self, name, value):
        return self.spoil(value) if name == self.name else value

    def _scaled(self, contact):
        what, _, entry = self.name.partition(".")
        if what != "scaled":
            return contact
        return contact._replace(**{entry: self.spoil(getattr(contact, entry))})

    law = property(lambda self: self.motion.law)
    scene = property(lambda self: self.motion.scene)
    duration = property(lambda self: self._told("duration", self.motion.duration))
    maximum_radius = property(lambda self: self.motion.maximum_radius)
    maximum_approach = property(lambda self: self.motion.maximum_approach)
    maximum_force = property(lambda self: self._told("maximum_force", self.motion.maximum_force))
    final_rate = property(lambda self: self.motion.final_rate)
    total_load_impulse = property(lambda self: self.motion.total_load_impulse)
    scaled_mass = property(lambda self: self.motion.scaled_mass)

    def scaled(self, phase):
        return self._scaled(self.motion.scaled(phase))

    def scaled_at(self, phase):
        return self._scaled(self.motion.scaled_at(phase))

    def phase_at_rate(self, rate):
        return self.motion.phase_at_rate(rate)

    def at(self, phase):
        sample = self.motion.at(phase)
        what, _, entry = self.name.partition(".")
        if what != "at":
            return sample
        if hasattr(sample.contact, entry):
            spoiled = self._one(getattr(sample.contact, entry))
            return sample._replace(contact=sample.contact._replace(**{entry: spoiled}))
        return sample._replace(**{entry: self._one(getattr(sample, entry))})

    def _one(self, rows):
        """Spoil one instant, whether they come one by one or all at once."""
        rows = np.array(rows, dtype=float)
        flat = rows.reshape(-1)
        for place in range(flat.size):
            flat[place] = self.spoil(float(flat[place]))
        return rows

    def phase(self, fraction):
        return self.motion.phase(fraction)

    def take(self, part):
        return SpoiledMotion(self.motion.take(part), self.spoil, self.name)


def spoiled_closed_form(law, spoil, name):
    """Wrap a normal law with a motion in closed form."""
    body = inert_copy(law, ClosedFormNormalLaw) | {
        "start": lambda _, scene: law.start(scene),
        "respond": lambda _, *arguments: law.respond(*arguments),
        "motion": lambda _, scene: SpoiledMotion(law.motion(scene), spoil, name),
    }
    return attrs.frozen(type("SpoiledHertz", (ClosedFormNormalLaw,), body))()


def spoiled_normal(law, spoil, entry):
    """Wrap a normal law; without closed form, so that its motion has to be solved."""

    def respond(self, state, approach, rate):
        contact, state = law.respond(state, approach, rate)
        return contact._replace(**{entry: spoil(getattr(contact, entry))}), state

    body = inert_copy(law, NormalLaw) | {
        "offers": law.offers - {"elastic_hertz"},
        "start": lambda _, scene: law.start(scene),
        "respond": respond,
    }
    return attrs.frozen(type("SpoiledHertz", (NormalLaw,), body))()
