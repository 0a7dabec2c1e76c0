"""The pressure of the half-space's contact, prescribed or answering, and slips kept: by hand."""

from types import SimpleNamespace

import numpy as np
import pytest

from contactlab_laws.halfspace.course import Course
from contactlab_laws.halfspace.pressure import Answering, Prescribed
from contactlab_laws.halfspace.rest import Slips, begun, moved

EDGES = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
TABLE = SimpleNamespace(
    basis=SimpleNamespace(edges=EDGES), points=EDGES[:-1], count=4, drags=np.arange(4.0)
)


def column(*values):
    return np.array(values, dtype=float)[:, None]


COURSE = Course(
    inside=np.array([0, 2, 1, 0]),
    share=np.array([1.0, 0.75, 0.4, 1.0]),
    radius=np.array([0.0, 0.5, 0.25, 0.0]),
    time=column(0.0, 1.0, 3.0, 4.0),
    impulse=column(0.0, 0.3, 0.5, 0.6),
    pressure=column(0.0, 2.0, 3.0, 0.0),
    phase=column(0.0, 1.0, 2.0, 3.0),
)


def hemisphere(edge):
    return np.sqrt(np.maximum(edge**2 - EDGES[:-1] ** 2, 0.0))


def test_a_prescribed_pressure_is_of_two_hemispheres():
    """Of 2: three quarters of that of the outer edge, the rest of that of the edge before."""
    made = Prescribed(TABLE, COURSE, 1.25)
    found = made.contact(1)
    assert found.rings == 2
    limit = 1.5 * hemisphere(0.5) + 0.5 * hemisphere(0.25)
    assert found.limit == pytest.approx(limit[:2])
    assert found.load == pytest.approx(1.5 * 0.125 + 0.5 * 0.015625)
    assert found.dragged == pytest.approx(1.5 * 1.0 + 0.5 * 0.0)
    assert (found.depth, found.yielding) == (0.0, 0.0)
    assert made.limit(1) == pytest.approx([*limit[:2], 0.0, 0.0])
    innermost = made.contact(2)  # without an edge before
    assert innermost.limit == pytest.approx(1.2 * hemisphere(0.25)[:1])
    assert innermost.load == pytest.approx(1.2 * 0.015625)
    assert made.contact(0) is made.contact(3) is None
    assert made.limit(3).tolist() == [0.0] * 4
    assert made.duration.tolist() == [1.0, 2.0, 1.0]
    assert [made.impulse(k) for k in (1, 2, 3)] == pytest.approx([0.3, 0.2, 0.1])
    assert made.advance(2, 9.0) == made.impulse(2)
    lost = Prescribed(TABLE, COURSE._replace(pressure=column(0.0, 0.0, -1.0, 0.0)), 1.25)
    assert lost.contact(1) is lost.contact(2) is None


def test_a_pressure_that_answers_moves_the_bodies():
    """Stiffness 2: a force 0.1 above Hertz's at the end of 1, which grew evenly from none."""
    made = Answering(TABLE, COURSE, 2.0)
    found = made.contact(1)
    assert (found.rings, found.limit, found.load) == (4, None, 0.125)
    assert found.yielding == pytest.approx(1.0 / 3.0)
    assert found.depth == pytest.approx(0.25 + 0.125 / 3.0 - 0.5 * EDGES[:-1] ** 2)
    assert made.impulse(1) == pytest.approx(0.3)
    assert made.advance(1, 0.225) == pytest.approx(0.4)
    assert made.excess[1] == pytest.approx(0.1)
    assert made.rate[1] == pytest.approx(-0.1)  # 2 * 0.1/2
    assert made.approach[1] == pytest.approx(-0.1 / 3.0)  # 2 * 0.1/6
    assert made.impulse(2) == pytest.approx(0.2 + 2.0 * 2.0 * 0.1)
    assert made.contact(2) is None  # 0.0625 less 0.0333, 2 * 0.1 and 2 * 0.1 * 2²/2 * 2/3
    assert made.advance(2, 0.0) == pytest.approx(0.2 + 2.0 * (0.1 - 0.015625))
    assert made.rate[2] == pytest.approx(-0.1 - 2.0 * (0.1 - 0.015625))
    assert made.approach[2] == pytest.approx(-0.1 / 3.0 - 0.2 - 4.0 / 3.0 * (0.2 - 0.015625))
    assert made.contact(3) is None  # of no radius
    again = Answering(TABLE, COURSE._replace(radius=np.array([0.0, 0.24, 0.2, 0.0])), 2.0)
    assert again.contact(1).rings == 2  # 0.2472 is within the first ring, and one is spare


@pytest.mark.parametrize(("off", "apart"), [(-0.2499, False), (-0.25, True), (-0.3, True)])
def test_surfaces_part_where_no_approach_is_left(off, apart):
    made = Answering(TABLE, COURSE, 2.0)
    made.approach[0] = off
    assert (made.contact(1) is None) is apart


def test_slips_are_kept_for_three_instants():
    """A ring out of contact forgets how fast it slipped, and how long it was in contact."""
    past = Slips(
        np.array([3.0, 3.0]),
        np.array([2.0, 2.0]),
        np.array([1.0, 1.0]),
        (0.5, 0.25),
        np.array([4, 4]),
    )
    now = moved(past, np.array([5.0, 6.0]), 0.75, np.array([True, False]))
    assert now.last.tolist() == [5.0, 6.0]
    assert now.before.tolist() == [3.0, 6.0]
    assert now.first.tolist() == [2.0, 2.0]
    assert now.steps == (0.75, 0.5)
    assert now.inside.tolist() == [5, 0]
    first = begun(np.zeros((2, 3)))
    assert (first.steps, first.inside.tolist()) == ((0.0, 0.0), [0.0, 0.0, 0.0])
