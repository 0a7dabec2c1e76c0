"""The rebound with one loss for pressure and shear: against what shares no code with its table."""

import math

import numpy as np
import pytest

from contactlab import Scene, Simulation, create, rebound
from contactlab_laws.tables import restituted
from contactlab_laws.tables.restituted_regions import BEYOND_ERROR, RESTITUTED_ERROR, WIDER_ERROR
from contactlab_laws.viscoelastic.relaxation import restitution_of
from tests.longer import longer

CHI = 49 / 34
PSI1 = (0.1, 0.5, 1.0, 1.2, 2.0, 3.0, 4.0)
#: psi2 at ``PSI1`` by another program, theory §15, by (a, chi): ±3e-6, for a >= 1 ±1e-5.
REFERENCES = {
    (0.05, CHI): (0.008928, 0.00916, -0.085073, -0.17458, -0.724878, -1.219935, -1.256848),
    (0.05, 7 / 6): (-0.017317, -0.137768, -0.383082, -0.522071, -1.054454, -1.215194, -0.461897),
    (0.1, CHI): (0.001063, -0.018386, -0.107094, -0.176153, -0.637783, -1.089706, -1.10562),
    (0.1, 7 / 6): (-0.019273, -0.134426, -0.351641, -0.468823, -0.942747, -1.08437, -0.284944),
    (0.1, 2.5): (-0.007737, -0.012076, 0.05004, 0.10826, 0.338853, 0.241275, -0.25918),
    (0.2, CHI): (-0.007853, -0.050955, -0.136844, -0.184068, -0.51388, -0.891083, -0.859514),
    (0.2, 1.0): (-0.033383, -0.190251, -0.425932, -0.531852, -0.867797, -0.424765, 0.575235),
    (0.4, CHI): (-0.013432, -0.071125, -0.153547, -0.186051, -0.373254, -0.639568, -0.435211),
    (0.4, 1.75): (-0.010535, -0.052723, -0.10515, -0.120047, -0.208623, -0.450809, -0.672458),
    (1.0, CHI): (-0.01115, -0.05644, -0.11454, -0.13466, -0.20683, -0.31989, 0.28975),
    (3.0, CHI): (-0.00396, -0.01989, -0.03995, -0.04683, -0.06807, -0.09356, 0.86458),
}
#: psi1, chi, a and psi2 by two programs, theory §15, ±4e-7.
SINGLES = (
    (0.7, 1.3, 0.15, -0.129268), (2.5, 1.6, 0.6, -0.324075), (2.6, 1.75, 0.15, -0.510490),
    (0.9, 0.7, 0.08, -0.703601),
)  # fmt: skip


def declared(chi):
    return RESTITUTED_ERROR if chi <= 2.0 else WIDER_ERROR


def impacts(count, seed, *, low=0.3, high=3.0):
    """Random psi1, chi and e over all of the table."""
    draw = np.random.default_rng(seed)
    chi, e = draw.uniform(low, high, count), draw.uniform(0.0, 1.0, count)
    end = np.maximum(1.0, 2.0 * chi * (1.0 + e) - e)
    return draw.uniform(-1.1, 1.1, count) * end, chi, e


@pytest.mark.parametrize(("a", "chi"), REFERENCES)
def test_values_of_another_program(a, chi):
    found = rebound(PSI1, chi, restitution=restitution_of(a))
    assert found == pytest.approx(REFERENCES[a, chi], abs=declared(chi))


@pytest.mark.parametrize(("psi1", "chi", "a", "psi2"), SINGLES)
def test_values_of_two_programs(psi1, chi, a, psi2):
    assert rebound(psi1, chi, restitution=restitution_of(a)) == pytest.approx(psi2, abs=5e-5)


@pytest.mark.parametrize(
    ("chi", "psi1", "psi2"),
    [
        (1.44, 0.5, 0.0), (1.44, 2.0, 0.0), (1.44, 2.88, 0.0), (1.44, 4.0, 1.12), (0.5, 0.9, 0.0),
        (0.3, 0.25, 0.4 * 0.25**2.5), (0.4, 1.0, 0.2), (0.3, 1.5, 0.9), *longer((40.0, 70.0, 0.0)),
        (0.1, 0.5, 0.8 * 0.5**1.25),
    ],
)  # fmt: skip
def test_without_rebound_psi2_is_in_closed_form(chi, psi1, psi2):
    """Clay, theory §15; and the table goes there in proportion to e."""
    assert rebound(psi1, chi, restitution=0.0) == pytest.approx(psi2, abs=1e-15)
    assert rebound([psi1], chi, restitution=[0.0])[0] == pytest.approx(psi2, abs=1e-15)
    for e in (1e-9, 1e-3)[: 1 + (chi <= 3.0)]:
        assert rebound(psi1, chi, restitution=e) == pytest.approx(
            psi2, abs=e * max(1.0, 2.0 * chi) + 5e-5
        )


def test_slip_throughout_is_in_closed_form():
    """From psi1 = max(1, 2 chi (1 + e) - e) on, theory §15; at 1,000 random impacts."""
    draw = np.random.default_rng(2)
    chi, e = draw.uniform(0.01, 10.0, 1000), draw.uniform(0.0, 1.0, 1000)
    psi1 = np.maximum(1.0, 2.0 * chi * (1.0 + e) - e) * (1.0 + draw.exponential(1.0, 1000))
    found = rebound(psi1, chi, restitution=e)
    assert found == pytest.approx(psi1 - 2.0 * chi * (1.0 + e), abs=1e-9)
    for k in range(0, 1000, 50):
        one = rebound(float(psi1[k]), float(chi[k]), restitution=float(e[k]))
        assert one == pytest.approx(found[k], abs=1e-12)


def test_nothing_jumps_where_slip_throughout_begins():
    chi, e = np.meshgrid(np.linspace(0.31, 3.0, 40), np.linspace(0.01, 0.99, 40))
    end = np.maximum(1.0, 2.0 * chi * (1.0 + e) - e)
    below = rebound(end * (1.0 - 1e-12), chi, restitution=e)
    off = np.abs(below - (end - 2.0 * chi * (1.0 + e)))
    assert off[chi <= 2.0].max() < RESTITUTED_ERROR
    assert off.max() < WIDER_ERROR


@pytest.mark.parametrize("count", [7, 200, 5000])
def test_odd_and_alike_alone_and_in_arrays(count):
    """By each of the three ways of evaluation."""
    psi1, chi, e = impacts(count, 3)
    found = rebound(psi1, chi, restitution=e)
    assert (rebound(-psi1, chi, restitution=e) == -found).all()
    some = slice(0, 200)
    triples = zip(psi1[some].tolist(), chi[some].tolist(), e[some].tolist(), strict=True)
    alone = [rebound(one, ratio, restitution=own) for one, ratio, own in triples]
    assert all(type(each) is float for each in alone)
    assert found[some] == pytest.approx(alone, abs=1e-12)
    together = rebound(psi1, chi, restitution=0.7)
    each = rebound(psi1, chi, restitution=np.full(count, 0.7))
    assert together == pytest.approx(each, abs=1e-12)
    assert rebound(-psi1[0], chi[0], restitution=0.7) == -rebound(psi1[0], chi[0], restitution=0.7)


def test_derivatives_are_differences():
    """Over the table, and where it goes over to the elastic one."""
    psi1, chi, e = impacts(300, 4, low=0.31, high=2.99)
    e = 0.01 + 0.97 * e
    e[:60] = 0.9905 + 0.009 * np.arange(60) / 60
    psi1 *= 0.9
    psi2, *slopes = rebound(psi1, chi, restitution=e, derivatives=True)
    assert psi2 == pytest.approx(rebound(psi1, chi, restitution=e), abs=1e-15)
    width = 1e-6
    for k, found in enumerate(slopes):
        step = width * np.eye(3)[k]
        ahead = rebound(psi1 + step[0], chi + step[1], restitution=e + step[2])
        behind = rebound(psi1 - step[0], chi - step[1], restitution=e - step[2])
        difference = (ahead - behind) / (2.0 * width)
        assert np.quantile(np.abs(found - difference), 0.97) < 1e-6  # but at borders of patches
    alone = rebound(psi1[0], chi[0], restitution=e[0], derivatives=True)
    assert [type(each) for each in alone] == [float] * 4
    assert alone == pytest.approx([psi2[0], *(each[0] for each in slopes)], rel=1e-9)
    fewer = rebound(psi1[:3], chi[:3], restitution=0.8, derivatives=True)
    assert [each.shape for each in fewer] == [(3,)] * 4
    assert len(rebound([], 1.0, restitution=0.8, derivatives=True)) == 4


def test_derivatives_at_one_are_the_elastic_ones():
    psi1, chi = np.array([0.5, -1.7, 3.0]), np.array([1.0, 1.44, 2.2])
    elastic = rebound(psi1, chi, derivatives=True)
    for e in (1.0, np.array([1.0, 1.0, 0.9999999])):
        *found, by_e = rebound(psi1, chi, restitution=e, derivatives=True)
        for each, expected in zip(found, elastic, strict=True):
            assert each == pytest.approx(expected, abs=1e-5)
        lower = (elastic[0] - rebound(psi1, chi, restitution=0.995)) / 0.005
        assert by_e == pytest.approx(lower, abs=0.06)


@pytest.mark.parametrize(("chi", "e"), [(0.29, 0.9), (3.01, 0.9), (2.6, 1.0), (9.0, [0.5, 1.0])])
def test_derivatives_out_of_the_table_are_refused(chi, e):
    with pytest.raises(ValueError, match=r"chi = .*derivatives are tabulated"):
        rebound(0.6, chi, restitution=e, derivatives=True)


def test_elastic_answers_stay_and_are_met_without_a_jump():
    psi1, chi, _ = impacts(2000, 5, high=2.5)
    elastic = rebound(psi1, chi)
    assert (rebound(psi1, chi, restitution=1.0) == elastic).all()
    assert (rebound(psi1, chi, restitution=np.ones(2000)) == elastic).all()
    below = rebound(psi1, chi, restitution=math.nextafter(1.0, 0.0))
    assert below == pytest.approx(elastic, abs=1e-9)
    mixed = rebound(psi1, chi, restitution=np.where(np.arange(2000) % 2, 1.0, 0.6))
    assert (mixed[1::2] == elastic[1::2]).all()
    assert mixed[::2] == pytest.approx(rebound(psi1[::2], chi[::2], restitution=0.6), abs=1e-12)


def test_the_join_moves_psi2_by_the_error_of_the_table():
    """From e = 0.99 on; it begins without a jump."""
    psi1, chi, _ = impacts(3000, 6, high=2.5)
    here, above = (rebound(psi1, chi, restitution=e) for e in (0.99, 0.99 + 1e-9))
    assert above == pytest.approx(here, abs=2e-8)
    size, error = np.abs(psi1), np.where(chi <= 2.0, RESTITUTED_ERROR, WIDER_ERROR)
    who = size < np.maximum(1.0, 4.0 * chi - 1.0) - 1e-9
    off = np.abs(restituted._step(size[who], chi[who]))
    assert (off <= error[who]).all()


def test_no_impact_gains():
    """Nor more impulse than slip throughout gives, at 100,000 random impacts."""
    psi1, chi, e = impacts(100_000, 7)
    psi1[::10] *= 10.0 ** -np.linspace(0.0, 300.0, 10_000)
    psi2 = rebound(psi1, chi, restitution=e)
    assert (np.abs(psi2) <= np.abs(psi1)).all()
    assert (np.sign(psi1) * psi2 >= np.abs(psi1) - 2.0 * chi * (1.0 + e) - 1e-14).all()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("chi", "bound"), [(0.01, 1e-5), (0.2, 5e-5), (4.0, BEYOND_ERROR * (4 / 3) ** 0.5)]
)
def test_beyond_the_table_springs_answer_to_their_error(chi, bound):
    """Against twice as many springs, extrapolated; and alone as in an array."""
    from contactlab_laws.viscoelastic.batch import extrapolate_steps
    from contactlab_laws.viscoelastic.relaxation import number_of

    e = np.array([0.0005, 0.3, 0.95])
    psi1 = np.array([0.3, 0.6, 0.95]) * np.maximum(1.0, 2.0 * chi * (1.0 + e) - e)
    found = rebound(psi1, chi, restitution=e)
    finer = extrapolate_steps(psi1, np.full(3, chi), number_of(e), springs=140, steps=1000)
    assert found == pytest.approx(finer, abs=bound)
    alone = rebound(float(-psi1[2]), chi, restitution=0.95)
    assert alone == pytest.approx(-found[2], abs=1e-10)


@pytest.mark.slow
def test_the_largest_chi():
    assert abs(rebound(0.9, 1e4, restitution=0.5)) < 0.01


@pytest.mark.slow
@pytest.mark.parametrize("chi", [3.5, 40.0, 500.0])
def test_far_beyond_the_table_the_error_is_declared(chi):
    """Springs of twice as many and of four times the steps, e next to 0 and 1 too."""
    from contactlab_laws.viscoelastic.batch import rebound as springs
    from contactlab_laws.viscoelastic.relaxation import number_of

    draw = np.random.default_rng(9)
    e = np.concatenate((draw.uniform(0.001, 1.0, 9), [0.001, 0.99, 0.9999]))
    psi1 = draw.random(12) ** 2 * (2.0 * chi * (1.0 + e) - e)
    grid = {"springs": round(240 * (chi / 3) ** 0.25), "steps": 4 * round(600 * (chi / 3) ** 0.5)}
    finer = springs(psi1, np.full(12, chi), number_of(e), **grid)
    error = BEYOND_ERROR * (chi / 3.0) ** 0.5
    assert rebound(psi1, chi, restitution=e) == pytest.approx(finer, abs=error)


def test_the_ends_of_the_range_of_chi():
    """The table and springs meet at both ends."""
    for chi, beside in ((0.3, 0.3 - 1e-9), (3.0, 3.0 + 1e-9)):
        inside, outside = (rebound(0.8, each, restitution=0.6) for each in (chi, beside))
        assert inside == pytest.approx(outside, abs=2e-4)


@pytest.mark.parametrize("wrong", [-0.5, 1.1, np.nan, "high"])
def test_bad_restitution_is_refused(wrong):
    with pytest.raises(ValueError, match="restitution = "):
        rebound(1.2, CHI, restitution=wrong)


@pytest.mark.slow
def test_the_table_is_finer_springs():
    """At random over its regions: ``python -m table_builders restituted verify`` draws more."""
    pytest.importorskip("table_builders", reason="table_builders is not in the wheel")
    from table_builders.restituted.checks import verify

    assert verify(200, 11) == 0


@pytest.mark.parametrize(("e", "seed"), [(0.8, 3), *longer((0.4, 4), (0.05, 5), (0.985, 6))])
def test_a_simulation_takes_the_table_with_the_loss_in_shear_of_finer_springs(e, seed):
    """psi2 and both works, beside springs by name, which are marched."""
    psi1, chi, _ = impacts(40, seed)
    scene = Scene.nondimensional(psi1=psi1, chi=chi)
    normal = create("normal.viscoelastic", restitution=e)
    found = Simulation(normal=normal).sweep(scene)
    assert found.counters.get("tabulated", 0) > 20
    assert "table of restitutions" in str(found.plan)
    fine = {
        "tangential": create("tangential.springs", springs=200),
        "integrator": create("integrator.symplectic", steps=800),
    }
    marched = Simulation(normal=normal, **fine).sweep(scene)
    assert "tabulated" not in marched.counters
    assert found.psi2 == pytest.approx(marched.psi2, abs=2.5e-4)
    unit = scene.friction_coefficient * scene.normal_speed / scene.pair.stiffness_ratio
    unit = 0.5 * scene.pair.tangential_mass * unit**2 * np.maximum(1.0, np.abs(psi1)) ** 2
    for name in ("shear_loss", "friction_work"):
        off = getattr(found.energy, name) - getattr(marched.energy, name)
        assert np.abs(off / unit).max() < 2e-3
    assert (found.energy.shear_loss > 0.0).any()


def test_a_course_or_another_loss_in_shear_is_marched():
    scene = Scene.nondimensional(psi1=1.2, chi=1.44)
    normal = create("normal.viscoelastic", restitution=0.8)
    assert Simulation(normal=normal).run(scene).counters == {"tabulated": 1}
    assert "steps" in Simulation(normal=normal).run(scene, history=True).counters
    for options in ({"shear_loss": 2.0}, {"springs": 50}, {"grid": "doubling"}, {"table": False}):
        law = create("tangential.springs", **options)
        assert "steps" in Simulation(normal=normal, tangential=law).run(scene).counters


def test_the_loss_in_shear_alone_is_that_of_arrays_and_vanishes_without_loss():
    psi1, chi, e = impacts(30, 7)
    found = restituted.shear_loss(psi1, chi, e)
    alone = [
        restituted.shear_loss(*(each[k : k + 1] for each in (psi1, chi, e)))[0] for k in range(30)
    ]
    assert found == pytest.approx(alone, abs=1e-12)
    nearly = restituted.shear_loss(psi1, chi, np.full(30, 1.0 - 1e-9))
    assert np.abs(nearly).max() < 1e-6
