"""Parts of the annulus laws: one contact and many, divisions without end, and what is refused."""

import numpy as np
import pytest

from contactlab import Scene, Simulation, Status, create
from contactlab_laws.annulus import many, one, tables
from contactlab_laws.annulus.sharp import Circles
from contactlab_laws.annulus.tables import response

SIGNS = np.array([0.0, 0.0, -1.0, 0.0, 0.0, 1.0])
SCENE = Scene.nondimensional(psi1=1.2, chi=1.4)


@pytest.mark.parametrize(
    ("before", "after", "guess"),
    [
        (3, 5, [0.0, 0.0, -1.0, -1.0, -1.0, 1.0]),
        (1, 3, [0.0, 0.0, 0.0, 0.0, 0.0, 1.0]),
        (3, 3, SIGNS),
        (3, 2, SIGNS),
        (0, 4, SIGNS),
    ],
)
def test_new_annuli_begin_as_the_outermost_did(before, after, guess):
    assert one.extended(SIGNS, before, after).tolist() == list(guess)


@pytest.mark.parametrize("mean", [False, True])
@pytest.mark.parametrize(
    "sticks", [[1, 1, 1, 0, 0, 0], [0] * 6, [1] * 6, [0, 1, 1, 0, 1, 0], [1, 0, 0, 1, 0, 1]]
)
def test_a_response_is_the_solution_of_the_equations(mean, sticks):
    """By kept responses, by triangular factors or a solve, and by the equations themselves."""
    table, sticks = tables.tables(6, mean), np.array(sticks, dtype=bool)
    drive = np.array([0.3, -0.2, 0.5, 0.1, -0.4, 0.25])
    kept = one.respond(table, sticks, 0.7, drive)
    solved = one.respond(table._replace(responses=[]), sticks, 0.7, drive)
    assert kept[0] == pytest.approx(solved[0], abs=1e-12)
    assert kept[1] == pytest.approx(solved[1], abs=1e-12)
    traction = np.where(sticks, kept[1], drive)
    lag = np.where(sticks, drive, kept[1])
    assert table.compliance @ traction == pytest.approx(lag + 0.7, abs=1e-12)
    assert kept[0] == pytest.approx(table.weight @ traction, abs=1e-12)
    assert response(6, mean, sticks.tobytes()).shape == (7, 7)


def test_a_division_that_comes_again_is_given_up(monkeypatch):
    """All annuli are over the limit where they stick, and slip backward where they slip."""
    asked = []

    def respond(table, sticks, total, drive):
        asked.append(sticks.sum())
        return 0.0, np.where(sticks, 9.0, 9.0)

    monkeypatch.setattr(one, "respond", respond)
    table, state = tables.tables(4), one.start(4)
    force, work, settled, after = one.advance(table, state, 0.1, 1.0, 1.0)
    assert np.isnan([force, work]).all()
    assert settled is False
    assert after is state
    assert asked == [4, 0, 4]


@pytest.mark.parametrize("wrong", [(np.nan, 0.5, 1.0), (0.1, np.inf, 1.0), (0.1, 0.5, np.inf)])
def test_numbers_without_end_are_answered_with_nan(wrong):
    table = tables.tables(4)
    force, work, settled, after = one.advance(table, one.start(4), *wrong)
    assert np.isnan([force, work]).all()
    assert settled is True
    assert after.touching == 0
    both = (np.array([each, 0.1 + 0.2 * k]) for k, each in enumerate(wrong))
    with np.errstate(invalid="ignore"):  # infinite pressure, nothing outside the contact
        force, work, settled, _ = many.advance(table, many.start(4, (2,)), *both)
    assert np.isnan([force[0], work[0]]).all()
    assert np.isfinite([force[1], work[1]]).all()
    assert settled.tolist() == [True, True]


@pytest.mark.parametrize("mean", [False, True])
def test_many_contacts_are_one_by_one(mean):
    """Along paths to and fro, over contacts that grow, shrink, part and touch again."""
    draw = np.random.default_rng(3)
    table, size, shape, steps = tables.tables(8, mean), 8, (2, 3), 40
    moves = 0.3 * draw.normal(size=(steps, *shape))
    radius = np.abs(np.sin(np.linspace(0.0, 7.0, steps)))[:, None, None] * draw.uniform(
        0.6, 1, shape
    )
    radius[15:18] = 0.0
    pressure = draw.uniform(0.8, 1.2, (steps, *shape))
    states, singles = many.start(size, shape), [one.start(size) for _ in range(6)]
    for k in range(steps):
        force, work, settled, states = many.advance(table, states, moves[k], radius[k], pressure[k])
        assert settled.all()
        stuck, sense = states.division()
        for item, place in enumerate(np.ndindex(shape)):
            given = (float(each[k][place]) for each in (moves, radius, pressure))
            f, w, good, singles[item] = one.advance(table, singles[item], *given)
            assert good
            assert force[place] == pytest.approx(f, abs=1e-10)
            assert work[place] == pytest.approx(w, abs=1e-10)
            inside = singles[item].division()
            assert stuck[place].tolist() == inside[0].tolist()
            assert sense[place].tolist() == inside[1].tolist()
            assert states.traction[place] == pytest.approx(singles[item].traction, abs=1e-10)


@pytest.mark.parametrize("kept", [200, 5], ids=["in blocks", "one by one"])
@pytest.mark.parametrize("displacement", ["midpoint", "mean"])
def test_steps_without_a_division_are_told(kept, displacement, monkeypatch):
    """Blocks give up as soon as their search does."""
    from contactlab_laws.annulus import blocks

    monkeypatch.setattr(tables, "LARGEST_TABLE", kept)
    monkeypatch.setattr(one, "MOST_PASSES", 0)
    monkeypatch.setattr(blocks, "MOST_TRIES", -1)
    tables.tables.cache_clear()
    law = create("tangential.annulus", annuli=9, displacement=displacement)
    found = Simulation(tangential=law, integrator=create("integrator.paper", steps=40)).run(SCENE)
    tables.tables.cache_clear()
    assert found.status is Status.UNSETTLED
    assert "At step 1: no division found" in found.motion.detail
    assert np.isnan(found.psi2)


@pytest.mark.parametrize("annuli", [1, 2, 7])
def test_circles_carry_the_load_and_half_of_it(annuli):
    """w = b² - s² gives b³ in gross slip; the weights of one contact are those of many."""
    made = Circles(annuli)
    assert made.full_weights.shape == (annuli,)
    squares = np.array([0.0, 0.04, 0.3, 0.5, 0.9, 1.0])
    together = made.weights(squares)
    for k, square in enumerate(squares.tolist()):
        touching = int((np.arange(annuli) / annuli < square**0.5).sum())
        alone = made.weights_of_one(square, touching)
        assert alone == pytest.approx(together[:touching, k], abs=1e-15)
        height = square - (np.arange(touching) / annuli) ** 2
        assert alone @ height == pytest.approx(square**1.5, abs=1e-14)


@pytest.mark.parametrize(
    ("name", "options", "bound"),
    [
        ("annulus", {"annuli": 40}, 0.025),
        ("annulus", {"annuli": 40, "displacement": "mean"}, 0.01),
        ("sharp_annulus", {"annuli": 40}, 0.055),
        ("springs", {"springs": 60}, 0.0505),
        ("mindlin_deresiewicz", {}, 0.1),
        ("linear_spring", {}, 0.05),
        ("coulomb", {}, 1e-9),
        ("frictionless", {}, 1e-9),
        ("stronge", {}, 1e-9),
        ("walton", {}, 1e-9),
        ("fronts", {}, 1e-8),
        ("halfspace", {}, 0.02),
    ],
)
def test_how_far_the_books_may_miss(name, options, bound):
    assert create(f"tangential.{name}", **options).books_bound(SCENE) == pytest.approx(bound)
