"""Rings by parts: edges at touch and separation, searches, and divisions that are not found."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from contactlab_laws.rings import courses, rings
from contactlab_laws.rings.courses import by_rings, tsuji


@pytest.mark.parametrize(
    ("count", "marks", "numbers", "at"),
    [
        (4, [0.0, 0.0], [0, 0], [0.0, 0.25, 0.5, 0.75, 1.0]),
        # sin 27° is at 0.3 of the way: the edge next to it is the first, moved there
        (
            4,
            [0.0, math.sin(0.15 * math.pi)],
            [0, 1],
            [0.0, 0.3, 0.3 + 0.7 / 3, 1.6 / 3 + 0.7 / 3, 1.0],
        ),
        (4, [math.sin(0.01 * math.pi), 0.0], [1, 0], None),  # no nearer to the centre than one
        (4, [0.0, math.sin(0.49 * math.pi)], [0, 3], None),  # nor to the largest radius
    ],
)
def test_edges_include_the_radii_of_touch_and_separation(count, marks, numbers, at):
    edges, found = courses._edges(count, marks)
    assert found == numbers
    assert edges[0] == 0.0
    assert edges[-1] == pytest.approx(1.0)
    assert (np.diff(edges) > 0.0).all()
    assert edges[[number for number in found if number][-1:]] == pytest.approx(
        [mark for mark in marks if mark][-1:]
    )
    if at is not None:
        assert edges == pytest.approx(np.sin(0.5 * np.pi * np.array(at)))


class Bump:
    """A radius of 0.2 at first touch, 1 at the phase 1.3, and 0.4 at separation."""

    @staticmethod
    def at(phase):
        phase = np.asarray(phase, dtype=float)
        rising = 0.2 + 0.8 * phase / 1.3
        falling = 1.0 - 0.6 * (phase - 1.3) / (math.pi - 1.3)
        radius = np.where(phase <= 1.3, rising, falling)
        return SimpleNamespace(contact=SimpleNamespace(radius=radius))


def test_instants_of_radii_are_found_by_halving():
    phases = np.linspace(0.0, math.pi, 41)
    assert courses._largest(Bump, phases, courses._radii(Bump, phases)) == pytest.approx(1.3)
    wanted = np.array([0.2, 0.6, 1.0])
    up = courses._instants(Bump, wanted, 0.0, 1.3, rising=True)
    assert up == pytest.approx([0.0, 0.65, 1.3])
    down = courses._instants(Bump, np.array([1.0, 0.7, 0.4]), 1.3, math.pi, rising=False)
    assert down == pytest.approx([1.3, 0.5 * (1.3 + math.pi), math.pi])


def test_a_largest_radius_at_an_end_is_found_there():
    ends = SimpleNamespace(
        at=lambda x: SimpleNamespace(contact=SimpleNamespace(radius=1.0 - np.asarray(x)))
    )
    phases = np.linspace(0.0, math.pi, 41)
    assert courses._largest(ends, phases, 1.0 - phases) == pytest.approx(0.0, abs=1e-9)


def test_a_course_in_units_of_hertz():
    """e = 1: half the time and the impulse at the top, where the load is Hertz's."""
    ours = courses.course(tsuji(1.0), 8)
    assert ours.edges == pytest.approx(np.sin(0.5 * np.pi * np.arange(9) / 8))
    assert ours.inside.tolist() == [*range(9), *range(7, -1, -1)]
    assert ours.time[8] == pytest.approx(0.5 * ours.time[-1])
    assert ours.time[-1] == pytest.approx(2.9432, abs=1e-4)
    assert ours.load == pytest.approx(ours.edges[ours.inside] ** 3, abs=1e-6)
    assert ours.impulse[[0, 8, 16]] == pytest.approx([0.0, 1.0, 2.0], abs=1e-7)


def test_the_limit_of_many_rings_by_least_squares(monkeypatch):
    """Of answers a + b/n² exactly a; a wrong answer of few rings weighs little."""
    monkeypatch.setattr(courses, "course", lambda *of: of[1])
    wrong = {10: 0.0}

    def rebound(psi1, chi, count):
        return psi1 - 3.0 * chi + 50.0 / count**2 + wrong.get(count, 0.0)

    monkeypatch.setattr(courses, "rebound", rebound)
    psi1, chi = np.array([5.0, 7.0]), np.array([1.0, 2.0])
    assert courses.solve(psi1, chi, None, counts=(10, 20, 40)) == pytest.approx([2.0, 1.0])
    wrong[10] = 0.1
    weights = (np.array([10, 20, 40]) / 40.0) ** 2
    terms = np.stack([np.ones(3), 1.0 / np.array([10, 20, 40]) ** 2], axis=1)
    values = 2.0 + 50.0 / np.array([10, 20, 40]) ** 2 + np.array([0.1, 0, 0])
    weighed = terms.T @ (weights[:, None] ** 2 * terms)
    expected = np.linalg.solve(weighed, terms.T @ (weights**2 * values))[0]
    assert courses.solve(psi1, chi, None, counts=(10, 20, 40))[0] == pytest.approx(expected)


@pytest.mark.parametrize(
    ("change", "expected"), [(-1.0, [0.2, 4.0, 2e5 - 1.0]), (-3.0, [-1.2, 2.0, 2e5 - 3.0])]
)
def test_beyond_the_largest_psi1_the_change_is_its_limit(change, expected, monkeypatch):
    """And no impact gains energy."""
    asked = []

    def solve(psi1, chi, motion, *, counts):
        asked.append((psi1.tolist(), counts))
        return psi1 + change

    monkeypatch.setattr(courses, "solve", solve)
    found = by_rings(np.array([1.2, 5.0, 2e5]), np.ones(3), 0.9, counts=(4, 8))
    assert asked == [([1.2, 5.0, 1e4], (4, 8))]
    assert found == pytest.approx(expected)


def impacts():
    psi1, chi = np.array([0.3, 1.2, 2.0, 3.0]), np.full(4, 1.44)
    return rings.rebound(psi1, chi, courses.course(tsuji(0.7), 20))


def test_one_ring_at_a_time_comes_to_the_same_division(monkeypatch):
    known = impacts()
    monkeypatch.setattr(rings, "GENTLE", 0)
    assert impacts() == pytest.approx(known, abs=1e-10)


def test_divisions_that_are_not_found_are_an_error(monkeypatch):
    monkeypatch.setattr(rings, "MOST_TRIES", 1)
    with pytest.raises(RuntimeError, match=r"^\d impacts: no division into stick and slip was fou"):
        impacts()


def test_divisions_that_are_no_discs_are_solved_by_themselves():
    """The equations hold: displaced by the aim where stuck, at the limit elsewhere."""
    table = rings.rings(np.linspace(0.0, 1.0, 7))
    limit = np.sqrt(1.0 - table.points**2)
    stuck = np.array(
        [[1, 1, 1, 0, 0, 0], [0, 1, 1, 0, 0, 0], [0, 1, 1, 0, 0, 0], [1, 0, 0, 1, 0, 0]], dtype=bool
    )
    sense = np.array([[1.0] * 6, [1.0] * 6, [-1.0] * 6, [1, 1, -1, 1, -1, 1]])
    aim = np.array([[0.3], [0.2], [0.1], [0.4]]) + 0.01 * np.arange(6)
    found = rings._divided(table, aim, limit, stuck, sense)
    assert found[~stuck] == pytest.approx((sense * limit)[~stuck])
    assert (found @ table.compliance.T)[stuck] == pytest.approx(aim[stuck])
    assert rings._divided(table, aim[:1], limit, stuck[:1], sense[:1]) == pytest.approx(found[:1])
