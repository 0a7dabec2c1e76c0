"""Laws of partial slip under normal laws that dissipate, against Coulomb's law at every point."""

import csv
import re
from pathlib import Path

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation
from contactlab_laws.differences.table import LEAST, key, rows
from tests.laws.coulomb_at_a_point import NORMAL, TANGENTIAL, limit, reference
from tests.laws.normal_laws import in_si

RECORDED = Path(__file__).with_name("coulomb_at_a_point.csv")
#: Half of what the half-space and extrapolated laws may be off by themselves, and what annuli are.
NUMERICAL, ANNULI = 5e-4, 2.5e-3
#: Springs with elastic shear: those that share a loss are Coulomb's law at every point.
ELASTIC = contactlab.create("tangential.springs", shear_loss=0.0)
#: The scene of most tests below.
OBLIQUE = in_si(Scene.nondimensional(psi1=2.0, chi=49 / 34))


def figures():
    """Iterate over (normal, options, tangential, largest difference) as recorded."""
    with RECORDED.open(newline="") as file:
        for row in csv.DictReader(file):
            options = {row["option"]: float(row["value"])} if row["option"] else {}
            yield row["normal"], options, row["tangential"], float(row["after"])


#: Options of normal laws between the first and the last that were recorded.
BETWEEN = [
    options
    for law in {name: None for name, _ in NORMAL}
    for options in [given for name, given in NORMAL if name == law][1:-1]
]


def caution(normal, tangential, scene=OBLIQUE):
    """The caution of springs that are not Coulomb's law, with its size; None if there is none."""
    law = ELASTIC if tangential == "springs" else tangential
    plan = Simulation(normal=normal, tangential=law).plan(scene)
    for sentence in map(str, plan.cautions):
        if found := re.search(r"Coulomb's law locally; .* off by up to ([\d.e-]*\d)", sentence):
            assert sentence.startswith("model: ")
            return float(found[1])
    return None


def test_every_pair_that_fits_is_recorded():
    pairs = {(name, tuple(options.items()), each) for name, options, each, _ in figures()}
    expected = {
        (name, tuple(options.items()), each) for name, options in NORMAL for each in TANGENTIAL
    }
    assert pairs == expected


@pytest.mark.parametrize(
    ("name", "options", "tangential", "size"),
    [pytest.param(*row, marks=[pytest.mark.slow] * (row[1] in BETWEEN)) for row in figures()],
)
def test_a_plan_says_what_was_recorded(name, options, tangential, size):
    """Annuli are Coulomb's law; of springs the caution is no smaller than what they are off by."""
    told = caution(contactlab.create(f"normal.{name}", **options), tangential)
    if tangential == "annulus":
        assert size < ANNULI
        assert told is None
    elif name == "hertz":
        assert told is None
    else:
        assert (told or LEAST) >= size - NUMERICAL


@pytest.mark.slow
@pytest.mark.parametrize(("name", "options"), NORMAL)
def test_the_figures_are_found_again(name, options):
    """``python -m tests.laws.coulomb_at_a_point`` prints them all."""
    law = contactlab.create(f"normal.{name}", **options)
    known = reference(law)
    for other, given, tangential, size in figures():
        if (other, given) == (name, options):
            found = np.abs(limit(law, tangential) - known).max()
            assert found == pytest.approx(size, abs=NUMERICAL, rel=0.05)


def test_annuli_are_coulombs_law_where_elastic_springs_are_off():
    """psi2 against the reference of theory §11; springs that share the loss have no caution."""
    law = contactlab.create("normal.tsuji", restitution=0.5)
    scene = Scene.nondimensional(psi1=1.6, chi=1.8)
    annuli, springs = (
        Simulation(normal=law, tangential=each).run(scene).check().psi2
        for each in ("annulus", ELASTIC)
    )
    assert abs(annuli + 0.72925) < 0.015 < abs(springs + 0.72925)
    assert caution(law, "annulus", scene) is None
    assert caution(law, None, scene) is None


def test_no_springs_are_cautioned_of_where_nothing_slips():
    law = contactlab.create("normal.tsuji", restitution=0.5)
    for scene in (
        Scene.nondimensional(psi1=0.0, chi=1.44),
        Scene.nondimensional(psi1=[0.0, 0.0], chi=1.44),
    ):
        assert caution(law, "springs", scene) is None
    assert caution(law, "springs", Scene.nondimensional(psi1=[0.0, 2.0], chi=1.44)) == 0.05


SAME = "psi2 depends on the damping law"


@pytest.mark.parametrize(
    ("name", "e", "size"),
    [("linear", 0.9, 0.7), ("linear", 1.0, 0.8), ("walton_braun", 0.9, 0.6),
     ("hunt_crossley", 0.8, 0.3), ("hunt_crossley", 0.95, 0.06), ("kuwabara_kono", 0.9, 0.03)],
)  # fmt: skip
def test_the_choice_of_normal_law_has_a_size(name, e, size):
    """That of differences.csv, a tenth more, rounded up: no less than that of theory §11."""
    law = contactlab.create(f"normal.{name}", restitution=e)
    plan = Simulation(normal=law, tangential="annulus").plan(OBLIQUE)
    own = {row.restitution: row.choice for row in rows()[key(law)]}
    assert own[e] < chosen(plan) == size < 1.1 * own[e] + 10.0 ** np.floor(np.log10(1.1 * own[e]))


def chosen(plan):
    """The size in the caution of the choice of normal law."""
    (sentence,) = (text for text in map(str, plan.cautions) if SAME in text)
    return float(re.search(r"up to ([\d.e-]+) \(tsuji\)", sentence)[1])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "e"),
    [("tsuji", 0.412), ("tsuji", 0.896), ("hunt_crossley", 0.732), ("kuwabara_kono", 0.57),
     ("kuwabara_kono", 0.956), ("linear", 0.519), ("linear", 0.895), ("walton_braun", 0.475)],
)  # fmt: skip
def test_sizes_hold_between_what_was_measured(name, e):
    """Springs were off by 1.5 times what a plan said, and normal laws differed by 1.2 times."""
    draw = np.random.default_rng(round(1e4 * e))
    chi = draw.uniform(0.8, 1.8, 80)
    psi1 = draw.uniform(0.6, 2.0 * chi * (1.0 + e) + 0.2)
    law = contactlab.create(f"normal.{name}", restitution=e)
    pytest.importorskip("table_builders", reason="table_builders is not in the wheel")
    from table_builders.differences import build as differences

    known = differences.pointwise(law, psi1, chi)
    found = np.abs(differences.springs(law, psi1, chi, shear_loss=0.0) - known).max()
    assert found < caution(law, "springs")
    if name != "tsuji":
        others = differences.pointwise(contactlab.create("normal.tsuji", restitution=e), psi1, chi)
        annuli = Simulation(normal=law, tangential="annulus")
        assert np.abs(others - known).max() < chosen(annuli.plan(OBLIQUE))


def test_tsujis_law_names_the_law_that_is_furthest():
    law = contactlab.create("normal.tsuji", restitution=0.9)
    plan = str(Simulation(normal=law, tangential="annulus").plan(OBLIQUE))
    assert SAME in plan
    assert "0.03 (kuwabara_kono) to 0.7 (linear)" in plan
    assert "0.04 (kuwabara_kono) to 0.6 (linear)" in str(Simulation(normal=law).plan(OBLIQUE))
    elastic = contactlab.create("normal.tsuji", restitution=1.0)
    assert SAME not in str(Simulation(normal=elastic).plan(OBLIQUE))
    assert SAME not in str(Simulation().plan(OBLIQUE))


@pytest.mark.parametrize("name", ["tsuji", "hunt_crossley", "linear", "kuwabara_kono", "jkr"])
@pytest.mark.parametrize(
    "tangential", [ELASTIC, "annulus", "mindlin_deresiewicz", "thornton_yin"], ids=str
)
def test_an_assumed_hemisphere_is_a_caution(name, tangential):
    law = contactlab.create(f"normal.{name}")
    assert "pressure profile" in str(Simulation(normal=law, tangential=tangential).plan(OBLIQUE))


@pytest.mark.parametrize("name", ["hertz", "dmt"])
def test_a_pressure_that_is_hertzs_is_none(name):
    plan = Simulation(normal=name, tangential="springs").plan(OBLIQUE)
    assert "pressure profile" not in str(plan)
