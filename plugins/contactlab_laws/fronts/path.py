"""The path of one impact through stick, edge slip and gross slip (theory §5).

In the frame of the sign s in which the edge slips, or would, with c the radius of what sticks,

    k = V - s psi             the edge sticks while k > 0 and slips while k < 0
    k' = 1.25 [(2 chi - 1) P - 3 chi J]      J' = c k      m' = -k          (' = d/dT)

stuck (c is the edge) and slipping (c is the front) alike; J and m as in ``memory``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np

from contactlab.contracts import ClosedFormMotion, LostPathError, ScaledContact, Stretch
from contactlab.numeric.lobatto import Array, first_fall, row, value_at
from contactlab_laws.fronts.memory import Drawn, Locked, Piece
from contactlab_laws.fronts.panel import NODES, GrossStretch, Panel, PanelStretch

#: Longest panels in x, and radians of the fastest oscillation in them: the normal motion's
#: nearest singularity in x lies at 0.22 + 0.86 i (theory §3).
LONGEST, SWING = 1.4, 8.0
#: (dT/dx)² u is at most 1.6.
FASTEST = 1.6
#: A panel is resolved if its highest Legendre terms are below this part of the velocity, or of the
#: tolerance.
TAIL, TAIL_PART = 1e-12, 1e-3
#: Margins below this are no rounding error.
LEVEL = -4e-15
#: With less than this to Coulomb's limit all slips.
AT_LIMIT = 3e-16
#: Along the memory k² must stay above this part of its largest value: k is its root.
LEAST_PART = 1e-3
#: Moves of the front's time: at most, and when they are few enough.
PICARD_CAP, SETTLED = 30, 3e-14
NEWTON_CAP, LAST_UPDATE = 25, 1e-7
TRIES = 60
#: A panel in time begins with this part of the time in which the piece would be spent.
HINT_PART = 0.7
LARGEST, ROUNDING, TINY = 1e100, 5e-16, 1e-300
#: Panels of an impact, about a second; below OFTEN in chi it is not oscillation that takes so many.
PANEL_CAP, OFTEN = 3000, 1e3
SQUARES = NODES.points[1:] ** 2
HALF = 0.5 * math.pi

Phase = Callable[[], "Phase | None"]


class Impact:
    """One impact in progress: its state, its memory, and a method for each phase.

    Parameters
    ----------
    velocity, inertia : float
        psi1 and 2.5 chi.
    motion : ClosedFormMotion
    tolerance : float
        Error of psi2 over max(1, psi1) that is aimed at.
    """

    def __init__(
        self, velocity: float, inertia: float, motion: ClosedFormMotion, tolerance: float
    ) -> None:
        self.velocity, self.motion = velocity, motion
        self.tail = max(TAIL, TAIL_PART * tolerance)
        self.ratio = inertia * motion.scaled_mass  # 2 chi
        self.drive = (self.ratio - 1.0) / motion.scaled_mass  # 1.25 (2 chi - 1)
        self.spring = 1.5 * inertia  # 3.75 chi
        self.longest = min(LONGEST, SWING / math.sqrt(self.spring * FASTEST))
        self.sign, self.x, self.change, self.work = 1, 0.0, 0.0, 0.0
        # k, J and m
        self.margin = 1.0 - velocity
        self.lack = self.gone = 0.0
        # k is zero here, but for rounding
        self.zero = self.margin == 0.0
        # where the front is on its piece, and its radius
        self.place = self.radius = 0.0
        self.memory: list[Piece] = []
        self.stretches: list[Stretch] = []
        self.panels, self.hint = 0, math.inf

    def follow(self) -> Iterator[Stretch]:
        """Yield the stretches to the end of contact."""
        slips = self.margin < 0.0 or (self.zero and self.drive <= 0.0)
        phase: Phase | None = self._slip if slips else self._stuck
        while phase is not None and self.x < math.pi:
            phase = phase()
            yield from self.stretches
            self.stretches.clear()

    # ---------------------------------------------------------------------------- the phases

    def _stuck(self) -> Phase | None:
        """Let all stick, c = u and J' = u k: k at the nodes solves one linear system."""
        left = HALF - self.x
        if left <= 0.0:
            return self._slip_after_loading()
        self._count()
        length = self._length(left)
        x, contact, weights = self._nodes(length)
        u, rate = contact.radius, contact.time_rate
        growth = weights * u
        matrix = weights.dot(growth)
        matrix *= self.spring
        matrix += NODES.identity
        known = self._driven(contact, weights)
        known -= (self.spring * self.lack) * weights.sum(axis=1)
        gathered = growth.dot(np.linalg.solve(matrix, known))
        k = known - self.spring * weights.dot(gathered)
        lack, gone = self.lack + gathered, self.gone - weights.dot(k)
        margins = np.array([k, 2.0 * contact.rate - k])
        tau, event = first_fall(NODES, margins, LEVEL, fresh=self.zero)
        start = self.x
        self._arrive(Panel(x, contact, weights, k, lack, gone, u, 0.0 * u, x), min(tau, 1.0))
        if self.x > start:
            table = gone, lack, -k * rate, u
            span = start, length
            piece = Drawn(self.sign, span, NODES, table, contact.rate * rate)
            piece.cut(self.x)
            self.memory.append(piece)
        if tau > 1.0:
            self.x = HALF if length == left else self.x
            return self._stuck
        if event == 1:
            self._turn()
        self._at_zero()
        return self._slip

    def _edge_slip(self) -> Phase:
        """Let the edge slip as far as the front c: J and c follow from m along the memory."""
        self.hint = math.inf
        return self._along_memory() or self._in_time()

    def _along_memory(self) -> Phase | None:
        """Take the front for the variable, to the inner end of its piece; None where k is lost so.

        dE/dm = -1.25 [(2 chi - 1) P - 3 chi J] for E = k²/2, where J and m are known along the
        piece and only P waits for the time dT = -dm/k, found by iteration.
        """
        piece, zero = self.memory[-1], self.zero
        span = piece.inner - self.place
        if span == 0.0:
            return self._spent()
        tau, integral = NODES.points, NODES.integral
        places = self.place + span * tau
        gone, lack, slope, c = piece.curve(places)
        dm = slope * span
        contact = first = self._now()
        k0 = self._margin(first)
        known = 0.5 * k0 * k0 + self.spring * integral.dot(lack * dm)
        energy = known - (self.drive * first.force) * integral.dot(dm)
        x = None
        for _ in range(PICARD_CAP):
            part = energy[1:] / SQUARES if zero else energy
            least, largest = float(part.min()), float(part.max())
            if not least > 0.0:
                return None
            k = np.sqrt(2.0 * np.maximum(energy, TINY))
            pace = dm / (k * contact.time_rate)
            if zero:  # the front goes in as the edge came out
                pace[0] = -span
            new = self.x + integral.dot(pace)
            end = float(new[-1])
            self.hint = HINT_PART * (end - self.x)
            if not (least > LEAST_PART * largest and end < math.pi):
                return None
            move = math.inf if x is None else float(np.abs(new - x).max())
            x = new
            if move < SETTLED:
                break
            contact = self.motion.scaled(x)
            energy = known - self.drive * integral.dot(contact.force * dm)
        else:
            return None
        if np.abs(NODES.tail.dot(pace)).max() > self.tail:
            return None
        self._count()
        weights = integral * (contact.time_rate * pace)
        k = -k
        if zero:
            k[0] = self.margin
        depth = contact.approach - c * c
        stop, _ = first_fall(NODES, depth[None], LEVEL, fresh=self.place == piece.outer)
        panel = Panel(x, contact, weights, k, lack, gone, c, depth, places)
        self._arrive(panel, min(stop, 1.0))
        return self._caught() if stop <= 1.0 else self._spent()

    def _in_time(self) -> Phase:
        """Newton's method for k at the nodes, with the front found for each m."""
        piece, left = self.memory[-1], math.pi - self.x
        fresh = self.place == piece.outer
        length = self._length(left)
        if self.hint < length:
            length = self.hint
        for _ in range(TRIES):
            panel = self._newton(piece, length, piece.radius if fresh else self.radius)
            if panel is None:
                length *= 0.5
                continue
            contact = panel.contact
            margins = np.array([-panel.margin, panel.depth])
            spent = panel.gone > piece.highest
            size = float(np.abs(panel.margin).max())
            terms = np.abs(NODES.tail.dot(contact.time_rate * panel.lack)).max()
            resolved = terms < max(self.tail * size / (self.spring * length), ROUNDING)
            if spent.any():  # beyond the first node there the front is not where it was put
                node = int(spent.argmax())
                over = (margins[:, 1:node] < LEVEL).any(axis=0)
                cut = (
                    NODES.points[1 + int(over.argmax())] if over.any() else 0.8 * NODES.points[node]
                )
                length *= float(cut)
                continue
            tau, event = first_fall(NODES, margins, LEVEL, fresh=self.zero or fresh)
            # k may be zero just beyond the piece, between nodes
            if tau <= 1.0 and value_at(NODES, tau, panel.gone) > piece.highest:
                length *= 0.8 * tau
                continue
            if resolved:
                break
            length *= max(1.05 * tau, 0.1) if tau < 0.9 else 0.5
        else:
            raise LostPathError("the front is lost: Newton's method fails on short panels")
        self._arrive(panel, min(tau, 1.0))
        self.lack, self.radius, _, self.place = piece.front_at(self._now(), self.gone, self.place)
        if tau > 1.0:
            self.x = math.pi if length == left else self.x
            return self._edge_slip
        return self._caught() if event else self._stopped(self.radius)

    def _newton(self, piece: Piece, length: float, radius: float) -> Panel | None:
        """Return a panel of edge slip, or None."""
        self._count()
        x, contact, weights = self._nodes(length)
        known, spring = self._driven(contact, weights), self.spring
        place = np.full(x.shape, self.place)
        matrix = (spring * radius) * weights.dot(weights)
        matrix += NODES.identity
        k = np.linalg.solve(matrix, known - (spring * self.lack) * weights.sum(axis=1))
        last = False
        for _ in range(NEWTON_CAP):
            gone = self.gone - weights.dot(k)
            front = piece.front(contact, gone, place)
            place, new = front.place, known - spring * weights.dot(front.lack)
            if last:
                if self.place == piece.outer:  # known here, where rounding moves the front most
                    front.place[0], front.radius[0] = piece.outer, radius
                    front.depth[0] = contact.approach[0] - radius * radius
                gone = self.gone - weights.dot(new)
                return Panel(x, contact, weights, new, front.lack, gone, *front[1:])
            matrix = (weights * front.radius).dot(weights)
            matrix *= spring
            matrix += NODES.identity
            move = np.linalg.solve(matrix, k - new)
            k = k - move
            size = float(np.abs(k).max())
            if not size < LARGEST:
                return None
            last = float(np.abs(move).max()) < LAST_UPDATE * size
        return None

    def _gross_slip(self) -> Phase | None:
        """All slips, J = 0: k rises in proportion to the fall of V until it is 0."""
        self.memory.clear()
        first, last = self._now(), -1.0  # contact ends as fast as it begins
        k, V, mass = self._margin(first), first.rate, self.motion.scaled_mass
        excess = self.ratio - 1.0
        rate = min(V + k / excess, V) if excess > 0.0 else -math.inf
        stops = rate > last
        fall = V - rate
        if not stops:  # from the energy 1 - V², as the difference would cancel
            fall = first.approach * first.force / (1.0 - V) if V < 0.0 else V - last
        x = max(float(self.motion.phase_at_rate(rate)), self.x) if stops else math.pi
        self.work += mass * fall * (-k - 0.5 * excess * fall)
        self.change -= self.sign * self.ratio * fall
        known = self.change, self.work, self.panels, max(rate, last), self.ratio
        self.stretches.append(GrossStretch(self.sign, self.x, x, *known))
        self.x = x
        if not stops:
            return None
        self.lack = self.gone = 0.0
        return self._stopped(0.0)

    # --------------------------------------------------------------------- what comes after

    def _slip(self) -> Phase | None:
        """Slip begins, or goes on in the next piece of memory; without any all slips."""
        memory = self.memory
        while memory and memory[-1].locked == self.sign:
            memory.pop()
        if not memory:
            return self._gross_slip()
        piece = memory[-1]
        if isinstance(piece, Drawn) and piece.frame != self.sign:
            piece = memory[-1] = piece.flipped()
        self.place, self.radius = piece.outer, piece.radius
        # what rounding has moved is put back on the curve
        self.gone, self.lack = piece.lowest, piece.lack
        if self.lack < AT_LIMIT:
            return self._gross_slip()
        return self._edge_slip()

    def _slip_after_loading(self) -> Phase | None:
        """At maximum compression V = 0, and the edge slips one way or the other."""
        now = self._now()
        k = self._margin(now)
        if k > 0.0 or (k == 0.0 and self.drive * now.force > self.spring * self.lack):
            self._turn()
        return self._slip()

    def _stopped(self, front: float) -> Phase:
        """K is 0: the slip zone locks; in unloading the edge slips the other way at once."""
        now = self._now()
        if self.memory:
            self.memory[-1].cut(self.place)
        self.memory.append(Locked(self.sign, self.gone, self.lack, front, now.radius))
        self._at_zero()
        if now.rate > 0.0:
            return self._stuck
        self._turn()
        return self._slip

    def _caught(self) -> Phase:
        """Let the edge, which has come to the front as it shrank, slip the other way."""
        self.memory[-1].cut(self.place)
        self._turn()
        return self._slip

    def _spent(self) -> Phase:
        """Leave the piece to whose inner end the front has come."""
        self.memory.pop()
        return self._slip

    # ------------------------------------------------------------------------------ the state

    def _now(self) -> ScaledContact:
        return self.motion.scaled_at(self.x)

    def _margin(self, now: ScaledContact) -> float:
        """Return k."""
        return 0.0 if self.zero else self.margin

    def _at_zero(self) -> None:
        """Let k be zero, which it is but for rounding."""
        self.zero, self.margin = True, 0.0

    def _turn(self) -> None:
        """See all from the other sign."""
        now = self._now()
        self.sign, self.zero = -self.sign, False
        self.margin = 2.0 * now.rate - self.margin
        self.lack = 4.0 / 3.0 * now.force - self.lack
        self.gone = -self.gone - 2.0 * now.approach

    def _length(self, left: float) -> float:
        return left if left < 1.3 * self.longest else self.longest

    def _count(self) -> None:
        """Count a panel; give up at the cap."""
        if self.panels == PANEL_CAP:
            why = f"at chi = {0.5 * self.ratio:.3g} the contact oscillates about sqrt(chi) times"
            if self.ratio < 2.0 * OFTEN:
                why = "slip changes too often, or stick is lost within too short a time"
            raise LostPathError(
                f"More than {PANEL_CAP} panels would be needed: {why}. A law of steps, such as "
                "springs under symplectic, can go on, with the error of its steps."
            )
        self.panels += 1

    def _nodes(self, length: float) -> tuple[Array, ScaledContact, Array]:
        """Return nodes from here on, the contact there, and integration over T to each."""
        x = self.x + length * NODES.points
        contact = self.motion.scaled(x)
        return x, contact, NODES.integral * (length * contact.time_rate)

    def _driven(self, contact: ScaledContact, weights: Array) -> Array:
        """Return what k would be without J."""
        return np.asarray(self.margin + weights.dot(self.drive * contact.force))

    def _arrive(self, panel: Panel, tau: float) -> None:
        """Move to ``tau`` of a solved panel."""
        s, start, contact = self.sign, self.x, panel.contact
        moved = s * (contact.rate - contact.rate[0] - (panel.margin - self.margin))
        # The energy of slip never exceeds that at first touch, rounding of a small psi1 apart.
        change = np.clip(self.change + moved, -2.0 * self.velocity, 0.0)
        force = s * (contact.force - 1.5 * panel.lack)
        gap = panel.depth / (contact.radius + panel.radius + TINY)
        zone = 0.5 * gap * gap * (2.0 * contact.radius + panel.radius)
        work = panel.weights.dot(panel.margin * zone)
        columns = np.array([panel.x, change, force, panel.radius])
        state = np.array([panel.margin, panel.lack, panel.gone, panel.place, panel.radius, work])
        weights = row(NODES, tau)
        x, self.change, *_ = columns.dot(weights).tolist()
        self.margin, self.lack, self.gone, self.place, self.radius, lost = state.dot(
            weights
        ).tolist()
        self.x, self.zero = min(max(x, start), math.pi), False
        self.work -= lost
        known = self.change, self.work, self.panels, columns
        self.stretches.append(PanelStretch(s, start, self.x, *known))
