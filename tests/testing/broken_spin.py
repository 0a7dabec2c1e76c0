"""A sound law that answers spin about the normal, and laws that break one clause of it each."""

from __future__ import annotations

from typing import ClassVar

import attrs
import numpy as np

from contactlab.impact import kinetics
from tests.testing.broken_impacts import Whole
from tests.testing.broken_laws import Sound


class Torsion(Whole):
    """Slip until it stops; friction takes a tenth of the spin about the normal."""

    offers: ClassVar[frozenset[str]] = frozenset({"normal_spin"})

    def spin_change(self, scene):
        return -0.1 * np.asarray(scene.normal_spin)

    def shift(self, scene):
        """Factor of the change of slip."""
        return 1.0

    def told(self, known, scene):
        change = self.spin_change(scene)
        slip = known.slip_velocity_change * self.shift(scene)
        _, lost = kinetics.spin_energies(scene, change)
        work = -scene.pair.tangential_mass * slip * (scene.slip_velocity + 0.5 * slip)
        spins = {"course": None} if kinetics.turns(scene) else {}
        return attrs.evolve(
            known, slip_velocity_change=slip, friction_work=np.maximum(work + lost, 0.0),
            normal_spin_change=change[()], **spins,
        )  # fmt: skip


class FeelsTheSense(Torsion):
    """Slip that one sense of spin slows more than the other."""

    def shift(self, scene):
        return 1.0 - 0.01 * np.sign(scene.normal_spin)


class KnowsOneSense(Torsion):
    """Takes from one sense of spin, and nearly nothing from the other."""

    def spin_change(self, scene):
        spin = np.asarray(scene.normal_spin)
        return np.where(spin > 0.0, -0.1, -0.05) * spin


class SpeedsUp(Torsion):
    """Friction along the spin."""

    def spin_change(self, scene):
        return -super().spin_change(scene)


class SaysAndLeaves(Torsion):
    """Has the word, and leaves the spin as it is."""

    def spin_change(self, scene):
        return 0.0 * np.asarray(scene.normal_spin)


class JumpsWithoutSpin(Torsion):
    """Other friction as soon as anything spins."""

    def shift(self, scene):
        return np.where(np.asarray(scene.normal_spin) == 0.0, 1.0, 0.98)[()]


class TakesInSilence(Torsion):
    """Changes the spin without the word."""

    offers: ClassVar[frozenset[str]] = frozenset()


class MarchesItsSpin(Sound):
    """Has the word, and nothing but steps."""

    offers: ClassVar[frozenset[str]] = frozenset({"normal_spin"})


#: Each with the check meant for it, and words of what the check says of it.
BROKEN = [
    (FeelsTheSense, "spin_is_odd", "of both senses psi2 differs"),
    (KnowsOneSense, "spin_is_odd", "of both senses w2 differs"),
    (SpeedsUp, "spin_slows", "gain 0.064 of their energy"),
    (SaysAndLeaves, "spin_slows", "It must fall"),
    (JumpsWithoutSpin, "spin_vanishes", "from that of w = 0"),
    (TakesInSilence, "spin_is_left", "the law has not the word normal_spin"),
    (MarchesItsSpin, "contract", "does not define whole_impacts"),
]
