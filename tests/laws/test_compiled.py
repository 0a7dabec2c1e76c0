"""The compiled exact law behind the doors of contactlab: answers as Python's, and words."""

import ctypes
import re

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation, Status, rebound
from contactlab.cli.main import main
from contactlab_laws import compiled as library
from contactlab_laws.fronts import compiled
from contactlab_laws.fronts.law import SOLVED
from tests.longer import longer

needs_library = pytest.mark.skipif(library.library() is None, reason=compiled.tell())


@pytest.fixture
def both(monkeypatch):
    """Return a function that gives what another returns, compiled and by Python."""

    def run(function):
        with monkeypatch.context() as patch:
            patch.setenv(library.VARIABLE, "1")
            first = function()
            patch.setenv(library.VARIABLE, "0")
            return first, function()

    return run


def bodies(count, seed):
    draw = np.random.default_rng(seed)
    chi = 10.0 ** draw.uniform(-0.5, 0.9, count)
    lam = draw.uniform(-2.0, 2.0, count)
    eta = np.sign(lam) * draw.uniform(0.05, 1.0, count) * np.minimum(1.8 * chi / np.abs(lam), 3.0)
    return Scene.nondimensional(psi1=draw.uniform(-5.0, 5.0, count), chi=chi, lam=lam, eta=eta)


@needs_library
def test_bodies_are_those_of_python(both):
    scene = bodies(40, 1)
    one, other = both(lambda: Simulation().run(scene))
    scale = np.maximum(1.0, np.abs(scene.psi1))
    assert (np.abs(one.psi2 - other.psi2) / scale).max() < 1e-12
    assert np.abs(one.normal_velocity - other.normal_velocity).max() < 1e-12
    for name in ("duration", "maximum_radius", "maximum_force", "friction_work", "compressions"):
        first, second = getattr(one.motion, name), getattr(other.motion, name)
        assert first == pytest.approx(second, rel=1e-10, abs=1e-12)
    assert one.energy.relative_imbalance == pytest.approx(np.zeros(40), abs=1e-9)


@needs_library
def test_spheres_beyond_the_table_are_those_of_python(both):
    draw = np.random.default_rng(2)
    chi = draw.uniform(2.6, 10.0, 12)
    psi1 = draw.uniform(-4.0, 4.0, 12) * chi
    for function in (
        lambda: rebound(psi1, chi),
        lambda: Simulation().sweep(Scene.nondimensional(psi1=psi1, chi=chi)).psi2,
        lambda: np.array(
            [rebound(*each) for each in zip(psi1.tolist(), chi.tolist(), strict=True)]
        ),
    ):
        one, other = both(function)
        assert (np.abs(one - other) / np.maximum(1.0, np.abs(psi1))).max() < 2e-11


@needs_library
@pytest.mark.parametrize("chi", [3.0, 1e3, *longer(1e5, 1e6)])
def test_heavy_impacts_are_within_the_error_that_is_declared(chi):
    """Against steps of a 25th of the error; thousands of oscillations add up."""
    draw = np.random.default_rng(8)
    psi1 = np.append(draw.uniform(0.01, 1.0, 12), draw.uniform(0.0, 4.0 * chi - 1.0, 12))
    plan = Simulation().plan(Scene.nondimensional(psi1=psi1, chi=chi))
    numbers = np.array([psi1, np.full(24, chi), np.zeros(24), np.zeros(24)])
    (usual, ended), (fine, settled) = (compiled.follow(numbers, at) for at in (5e-13, 2e-14))
    sound = (ended == 0) & (settled == 0)
    assert sound.sum() >= 12
    assert (np.abs(usual[1] - fine[1]) <= plan.psi2_error)[sound].all()


@needs_library
@pytest.mark.parametrize("at_a_time", [7, 8192])
def test_one_impact_and_many_have_the_same_bits(monkeypatch, at_a_time):
    monkeypatch.setattr(compiled, "AT_A_TIME", at_a_time)
    scene = bodies(30, 3)
    many = Simulation().run(scene)
    for place in (0, 7, 29):
        one = Simulation().run(scene.take(place))
        assert (one.psi2, one.normal_velocity) == (many.psi2[place], many.normal_velocity[place])
    psi1, chi = np.linspace(0.1, 9.0, 20), np.linspace(2.6, 9.0, 20)
    assert rebound(psi1, chi).tolist() == [rebound(a, b) for a, b in zip(psi1, chi, strict=True)]


@needs_library
def test_the_books_of_a_solved_sphere_are_checked():
    """The work is the solver's own, not the energy that the velocities lose."""
    result = Simulation().run(Scene.nondimensional(psi1=[1.2, 0.4, 1e-9, 30.0], chi=3.0))
    assert result.energy.checked.tolist() == [True] * 4
    assert np.abs(result.energy.relative_imbalance).max() < 1e-12
    assert result.counters["solved"] == 3
    assert SOLVED in str(result.plan)
    assert not result.plan.marched.any()


#: psi1, chi, lam and what friction leaves of W, of impacts that jam hundreds of times.
JAMS = [
    (-0.01857175502130575, 0.969553265605366, -2.1667788333025677, 1.468863941850762e-05),
    (1.12968e-07, 1.20233, 740.409, 7.58e-08),
    (3.64852, 0.236367, -236.291, 2.61e-07),
]


def jams(rows):
    psi1, chi, lam, free = np.transpose(rows)
    return np.array([psi1, chi, lam, (1.0 - free) * 2.0 * chi / lam])


@needs_library
def test_the_longest_jams_stay_in_the_library():
    """Python's solver took seconds to give them up after as many steps."""
    found, status = compiled.follow(jams(JAMS), 5e-13)
    assert status.tolist() == [0, compiled.UNSETTLED, compiled.UNSETTLED]
    assert found[6, 1:].tolist() == [compiled.MOST_STEPS] * 2
    out, ended, rows = compiled.follow_one(jams(JAMS)[:, 0].tolist(), 5e-13)
    assert (ended, len(rows)) == (0, found[6, 0])
    assert out.tolist() == found[:, 0].tolist()


@needs_library
@pytest.mark.slow
def test_a_long_jam_is_that_of_python(both):
    psi1, chi, lam, eta = jams(JAMS[:1])[:, 0].tolist()
    scene = Scene.nondimensional(psi1=psi1, chi=chi, lam=lam, eta=eta)
    one, other = both(lambda: Simulation().run(scene).check())
    for name in ("duration", "normal_velocity", "slip_velocity_change", "maximum_radius"):
        assert getattr(one.motion, name) == pytest.approx(getattr(other.motion, name), rel=1e-6)


@needs_library
def test_an_impact_that_it_gives_up_is_followed_by_python(monkeypatch):
    """A memory that finds no room, and a sphere that the library does not settle."""
    follow = compiled.follow

    def forgetful(numbers, *rest):
        out, status = follow(numbers, *rest)
        status[0] = compiled.MEMORY
        out[:, 0] = np.nan
        return out, status

    scene = bodies(3, 4)
    expected = Simulation().run(scene).psi2
    monkeypatch.setattr(compiled, "follow", forgetful)
    found = Simulation().run(scene)
    assert found.status.tolist() == [Status.SUCCESS] * 3
    assert found.psi2 == pytest.approx(expected, abs=1e-11)
    sphere = Simulation().run(Scene.nondimensional(psi1=[1.2, 2.2], chi=3.0))
    assert sphere.plan.marched.tolist() == [True, False]
    assert sphere.psi2[0] == pytest.approx(rebound(1.2, 3.0), abs=1e-9)


@needs_library
def test_a_jam_that_is_not_settled_has_a_status_and_a_sentence(monkeypatch):
    scene = bodies(3, 5)
    follow = compiled.follow
    monkeypatch.setattr(compiled, "follow", lambda numbers, *_: follow(numbers, 5e-13, 2))
    result = Simulation().run(scene)
    assert result.status.tolist() == [Status.UNRESOLVED] * 3
    assert "neither ends nor settles" in result.motion.detail[0]
    assert np.isnan(result.psi2).all()
    alone = Simulation().run(scene.take(0))
    assert alone.status is Status.UNRESOLVED
    assert "neither ends nor settles" in alone.motion.detail


#: psi1, chi and eta of impacts that slip throughout at some time, where friction of one sign takes
#: all force off: lam is 1.
LIFTED = [
    (2.0, 1.0, 1.99), (0.3, 0.8, 1.0), (-5.0, 0.8, 1.0), (-5.0, 0.3, 0.1), (-0.1, 0.3, 0.1),
    (-1.0, 0.3, 0.1), (-2.0, 1.0, 1.5), (-3.0, 2.0, 0.01),
]  # fmt: skip


@pytest.mark.parametrize("sense", [-1.0, 1.0])
@pytest.mark.parametrize("compiled_law", ["0", "1"])
def test_friction_that_takes_all_force_off_is_no_corner(monkeypatch, compiled_law, sense):
    """At lam = 1, and a last bit beside it, answers are the mean of their neighbours'."""
    monkeypatch.setenv(library.VARIABLE, compiled_law)
    psi1, chi, eta = np.transpose(LIFTED)

    def run(lam, **options):
        scene = Scene.nondimensional(
            psi1=sense * psi1, chi=chi, lam=sense * lam + 0.0 * psi1, eta=sense * eta
        )
        return Simulation().run(scene, **options).check()

    names = ("duration", "normal_velocity", "slip_velocity_change", "friction_work")
    low, high = (run(1.0 + step) for step in (-1e-6, 1e-6))
    for lam in (np.nextafter(1.0, 0.0), 1.0, np.nextafter(1.0, 2.0)):
        result = run(lam)
        for name in names:
            mean = 0.5 * (getattr(low.motion, name) + getattr(high.motion, name))
            assert getattr(result.motion, name) == pytest.approx(mean, rel=1e-8, abs=1e-8)
    for place in (0, 1):
        history = Simulation().run(result.scene.take(place), history=True).check().history
        assert history.time[-1] == pytest.approx(result.motion.duration[place], rel=1e-9)


def test_a_history_is_followed_and_agrees():
    result = Simulation().run(Scene.nondimensional(psi1=1.2, chi=3.0), history=True)
    assert result.plan.marched
    assert result.psi2 == pytest.approx(rebound(1.2, 3.0), abs=1e-9)


@needs_library
@pytest.mark.parametrize("psi1", [0.0, -0.4, 1.2, 3.0, 1e9])
def test_histories_of_spheres_are_those_of_python(both, psi1):
    scene = Scene.nondimensional(psi1=psi1, chi=3.0)
    one, other = both(lambda: Simulation().run(scene, history="fields").check())
    assert one.psi2 == pytest.approx(other.psi2, abs=1e-11 * max(1.0, abs(psi1)))
    assert one.energy.friction_work == pytest.approx(other.energy.friction_work, abs=1e-11)
    for name in ("time", "normal_force", "slip_velocity", "tangential_force"):
        first, second = getattr(one.history, name), getattr(other.history, name)
        assert first == pytest.approx(second, rel=1e-11, abs=1e-11 * np.abs(second).max())
    if psi1:
        first, second = one.history.fields, other.history.fields
        assert first["front"] == pytest.approx(second["front"], abs=1e-7)
        assert (first["slipping"] != second["slipping"]).mean() < 1e-4


@needs_library
def test_histories_of_bodies_are_those_of_python(both):
    """Their instants are those of the steps; what is drawn through them is the same."""
    scene = bodies(3, 7).take(1)
    one, other = both(lambda: Simulation().run(scene, history=True).check().history)
    for name in ("normal_force", "slip_velocity", "tangential_force", "normal_velocity"):
        column, size = getattr(one, name), np.abs(getattr(other, name)).max()
        drawn = np.interp(one.time, other.time, getattr(other, name))
        assert np.abs(column - drawn).max() < 0.02 * size
        assert column[-1] == pytest.approx(getattr(other, name)[-1], abs=1e-10 * size)


@pytest.mark.parametrize("word", ["0", " Off"])
def test_what_computes_is_told(monkeypatch, capsys, word):
    monkeypatch.setenv(library.VARIABLE, word)
    assert main(["plugins", "show", "tangential.fronts"]) == 0
    assert "CONTACTLAB_COMPILED=0 leaves the compiled solver out" in capsys.readouterr().out
    assert library.library() is None
    plan = Simulation().plan(Scene.nondimensional(psi1=1.2, chi=3.0))
    assert plan.marched
    assert "one by one" not in str(plan)
    for scene in (bodies(3, 6), Scene.nondimensional(psi1=[1.2, 2.0], chi=3.0)):
        told = str(Simulation().plan(scene))
        assert "run time: impacts one by one, by Python, about 2 ms an impact: CONTACTLAB_" in told
    assert "one by one" not in str(
        Simulation().plan(Scene.nondimensional(psi1=[1.2, 2.0], chi=1.0))
    )


@needs_library
def test_a_library_older_than_its_sources_is_left_out(monkeypatch):
    monkeypatch.setattr(library, "digest", lambda: "other")
    library._library.cache_clear()
    try:
        assert library.library() is None
        assert "older than its sources" in compiled.tell()
    finally:
        library._library.cache_clear()


@needs_library
def test_a_library_without_its_sources_or_of_another_kind_is_left_out(monkeypatch):
    process = ctypes.CDLL(None)
    for place, name, value, words in (
        (library, "SOURCES", (("contactlab", "kernels/none.h"),), "sources .* are not there"),
        (library, "LIBRARY", "impacts.c", "does not load"),
        (ctypes, "CDLL", lambda _path: process, "does not load.*contactlab_impact_sources"),
    ):
        with monkeypatch.context() as patch:
            patch.setattr(place, name, value)
            library._library.cache_clear()
            assert library.library() is None
            assert re.search(words, compiled.tell())
            assert rebound(1.2, 3.0) == pytest.approx(0.23537850255, abs=1e-10)
    library._library.cache_clear()


def test_a_followed_law_stays_a_reference():
    law = contactlab.create("tangential.fronts", table=False)
    result = Simulation(tangential=law).run(Scene.nondimensional(psi1=1.2, chi=3.0))
    assert result.plan.marched
