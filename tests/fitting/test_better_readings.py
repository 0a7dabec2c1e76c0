"""Which other readings of a table are told: scores, limits and sentences."""

import math

import attrs
import numpy as np
import pytest

from contactlab import Simulation
from contactlab.fitting import slips
from contactlab.fitting.readings import Reading
from contactlab.fitting.slips import Read
from tests.fitting.lines import line, option
from tests.fitting.test_readings import E_T, POLAR, problem_of

X = np.arange(1.0, 9.0)
Y = 2.0 * X + 0.1 * np.array([1.0, -2.0, 0.5, 1.5, -1.0, 0.7, -0.9, 0.3])
A = option("a", starts=(1.0, 2.0, 3.0))


def scores(reading, points, counts=(8,), sizes=(1.0,)):
    return slips._scores(reading, np.array(points), list(counts), list(sizes))


def test_a_score_is_the_likelihood_of_the_numbers_as_they_were_written():
    """n log of the mean square; numbers read by a factor are scaled back."""
    problem = line({"y": Y, "z": np.array([6.0] * 7 + [np.nan])}, A, x=X)
    points = [[2.0], [1.9]]
    found = scores(Reading("", problem, {"y": 100.0}), points, (8, 7), (0.0, 3.0))
    for (a,), score in zip(points, found, strict=True):
        y, z = np.mean((Y - a * X) ** 2) / 1e4, (6.0 - 3.0 * a) ** 2
        assert score == pytest.approx(8.0 * np.log(y) + 7.0 * np.log(z + 9e-12))


def test_the_counts_of_a_score_are_those_of_the_table():
    """A reading that drops a number is judged by as many as the table has."""
    problem = line({"y": np.append(Y[:-1], np.nan)}, A, x=X)
    expected = 8.0 * np.log(np.mean((Y - 2.0 * X)[:-1] ** 2))
    assert scores(Reading("", problem, {}), [[2.0]], sizes=(0.0,)) == pytest.approx([expected])


def test_stated_errors_weight_a_score_by_their_ratios():
    error = np.linspace(1.0, 3.0, 8)
    problem = line({"y": Y}, A, x=X, errors={"y": error})
    weighted = (Y - 2.0 * X) * np.sqrt(np.mean(error**2)) / error
    expected = 8.0 * np.log(np.mean(weighted**2))
    for size in (1.0, 7.0):
        wider = attrs.evolve(problem, errors={"y": size * error})
        assert scores(Reading("", wider, {}), [[2.0]], sizes=(0.0,)) == pytest.approx([expected])


def better(monkeypatch, found, own, *, number=8, rough=None):
    """Return the words of the readings kept, of their scores and that of the table."""
    table = line({"y": np.resize(Y, number)}, A, x=np.resize(X, number))
    read = [Reading(words, attrs.evolve(table), {}) for words in found]

    def scored(reading, points, *_):
        score = own if reading.words == "" else found[reading.words]
        if len(points) > 1 and rough is not None:
            return np.array([9e9, rough, 9e9])
        return np.full(len(points), score)

    monkeypatch.setattr(slips, "_scores", scored)
    monkeypatch.setattr(slips, "solved", lambda _, start: start)
    kept = slips._better(table, np.array([2.0]), read)
    return [(each.reading.words, each.score, each.values.tolist()) for each in kept]


@pytest.mark.parametrize(
    ("number", "limit"), [(8, 20.0), (14, 20.0), (15, 30.0 * math.log(2.0)), (40, 80 * math.log(2))]
)
def test_a_better_reading_halves_the_residuals_and_is_certain(number, limit, monkeypatch):
    """-2 log likelihood lower by 20, and by 2 n log 2."""
    found = {"better": 100.0 - limit - 1e-9, "not": 100.0 - limit + 1e-9}
    kept = better(monkeypatch, found, 100.0, number=number)
    assert kept == [("better", found["better"], [1.0])]


def test_three_readings_as_good_as_the_best_are_kept():
    """Within six of the best score, the best first."""
    found = {"b": 5.0, "e": 11.0, "a": 4.99, "c": 10.98, "d": 10.985}
    with pytest.MonkeyPatch.context() as patch:
        kept = better(patch, found, 100.0)
    assert [words for words, _, _ in kept] == ["a", "b", "c"]
    with pytest.MonkeyPatch.context() as patch:
        kept = better(patch, {"a": 5.0, "e": 11.0}, 100.0)
    assert [words for words, _, _ in kept] == ["a"]


@pytest.mark.parametrize(("over", "kept"), [(-1e-9, 1), (1e-9, 0)])
def test_a_reading_is_fitted_if_the_grid_is_near(over, kept, monkeypatch):
    """Residuals at most three times those of the fit, at the best point of the grid."""
    rough = 100.0 + 16.0 * math.log(3.0) + over
    found = better(monkeypatch, {"a": 0.0}, 100.0, rough=rough)
    assert found == [("a", 0.0, [2.0])] * kept


def read(words, score, *, rest=None, values=(2.0,)):
    return Read(Reading(words, line({"y": Y}, A, x=X), {}, rest), score, np.array(values))


def test_the_sentence_tells_how_much_smaller_residuals_are(monkeypatch):
    monkeypatch.setattr(slips, "_scores", lambda *_: np.array([100.0]))
    told = [read("one", 100.0 - 16.0 * math.log(3.7), values=(1.234567,)), read("other", 90.0)]
    assert slips._sentence(line({"y": Y}, A, x=X), np.array([2.0]), told) == (
        "one; or other: read so, residuals are 3.7 times smaller, and a 1.235"
    )


@pytest.mark.parametrize(
    ("own", "rest", "certain", "possible"),
    [
        ({"kept": 20.01}, False, ["told"], []),
        ({"kept": 20.0}, False, [], ["or, with every number kept, told"]),
        ({"kept": 0.01}, False, [], ["or, with every number kept, told"]),
        ({"kept": 0.0}, False, [], []),
        ({"kept": 50.0, "rest": 19.0}, True, [], ["or, with every number kept, told"]),
        ({"kept": 19.0, "rest": 50.0}, True, [], ["or, with every number kept, told"]),
        ({"kept": 50.0, "rest": 50.0}, True, ["told"], []),
        ({"kept": 50.0, "rest": -1.0}, True, [], []),
    ],
)
def test_a_slip_is_certain_if_the_table_without_outliers_is_far_worse(
    own, rest, certain, possible, monkeypatch
):
    problem, given = problem_of(POLAR | E_T)
    numbers = {"kept": {"y": "kept"}, "rest": {"y": "rest"}}
    best = read("best", 0.0, rest=numbers["rest"] if rest else None)
    monkeypatch.setattr(slips, "_better", lambda *_: [best])
    monkeypatch.setattr(slips, "_sentence", lambda *_: "told")
    monkeypatch.setattr(slips, "_without", lambda _, __, part: own[part["y"]])
    found = slips.slips(problem, given, np.array([0.1]), numbers["kept"])
    assert found == (certain, possible)


@pytest.mark.parametrize(("count", "tried"), [(4, True), (3, False)])
def test_readings_need_three_numbers_more_than_parameters(count, tried, monkeypatch):
    asked = []
    monkeypatch.setattr(slips, "_better", lambda *_: asked.append(1) or [])
    problem, given = problem_of({name: values[:count] for name, values in (POLAR | E_T).items()})
    assert slips.slips(problem, given, np.array([0.1]), {}) == ([], [])
    assert bool(asked) == tried


def test_under_another_law_a_reading_has_to_be_better_twice(monkeypatch):
    """First by the table of the exact law, then by the law of the fit."""
    problem, given = problem_of(POLAR | E_T)
    setup = problem.model.setup._replace(simulation=Simulation(tangential="coulomb"))
    problem = attrs.evolve(problem, model=attrs.evolve(problem.model, setup=setup))
    quick = slips._elastic(problem)
    assert quick.model.setup.simulation is None
    assert [p.name for p in quick.model.parameters] == ["friction_coefficient"]
    scene = attrs.evolve(setup.scene, friction_coefficient=0.7)
    other = attrs.evolve(quick, model=quick.model.at(scene))
    asked = []

    def better(asking, values, candidates):
        asked.append((asking, values.tolist(), list(candidates)))
        return [Read(Reading("r", other, {}), 0.0, values)] if len(asked) == 1 else []

    monkeypatch.setattr(slips, "_better", better)
    monkeypatch.setattr(slips, "solved", lambda _, start: start + 100.0)
    assert slips.slips(problem, given, np.array([0.1]), {}) == ([], [])
    assert asked[0][0].model.setup.simulation is None
    assert asked[0][1][0] > 100.0
    assert (asked[1][0] is problem, asked[1][1]) == (True, [0.1])
    (again,) = asked[1][2]
    assert again.problem.model.setup == (scene, setup.simulation)


def test_the_exact_law_is_its_own_quick_one_and_kappa_is_kept():
    problem, _ = problem_of(POLAR | E_T)
    assert slips._elastic(problem) is problem
    kappa = attrs.evolve(problem.model.parameters[0], name="stiffness_ratio")
    setup = problem.model.setup._replace(simulation=Simulation())
    model = attrs.evolve(problem.model, setup=setup, parameters=(kappa,))
    quick = slips._elastic(attrs.evolve(problem, model=model))
    assert [p.name for p in quick.model.parameters] == ["friction_coefficient", "stiffness_ratio"]


def test_the_best_of_two_searches_is_the_score_without_some_numbers(monkeypatch):
    table = line({"y": Y}, A, x=X)
    ends = {1.5: 2.0, 2.0: 1.0}
    monkeypatch.setattr(slips, "solved", lambda _, start: np.array([ends[start[0]]]))
    fewer = {"y": np.append(Y[:-1], np.nan)}
    found = slips._without(table, np.array([1.5]), fewer)
    expected = 8.0 * np.log(np.mean((Y - 2.0 * X)[:-1] ** 2) + (1e-6 * np.abs(Y).max()) ** 2)
    assert found == pytest.approx(expected)
