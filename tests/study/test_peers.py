"""Other engines in the benchmark: where each is installed, held against its own model."""

import sys

import numpy as np
import pytest

from contactlab.cli import bench as cli_bench
from contactlab.cli.main import main
from contactlab.study import peers
from contactlab.study.benchmark import Benchmark, Row
from contactlab.study.questions import questions

pytestmark = pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::ImportWarning")

SLIPS = np.array([0.5, 1.2, 3.0])
CHI = 49 / 34


def answers(engine, question):
    """Return psi2 of the impacts of a question by an engine, and the impacts."""
    if peers.engine(engine) is None:
        pytest.skip(f"{engine} is not there: pip install {engine}")
    (asked,) = questions(only=question)
    posed = asked.pose(True)
    (door,) = (each for each in posed.doors if each.name == engine)
    found = [door.read(door.bind(each)()).numbers[0] for each in posed.impacts]
    return np.array(found), posed


def rigid(met, e):
    """Return psi2 of rigid bodies: what stops slip, or the most that friction can do."""
    scene = met.scene
    psi1, chi, lam, eta = (float(getattr(scene, each)) for each in ("psi1", "chi", "lam", "eta"))
    # V2 = -e: (1 + e) = P + lam F and the change of psi = -(eta P + 2 chi F), by the impulses
    stops = np.linalg.solve([[1.0, lam], [eta, 2.0 * chi]], [1.0 + e, psi1])
    if abs(stops[1]) <= stops[0]:
        return 0.0
    sign = np.sign(stops[1])
    return psi1 - (eta + 2.0 * chi * sign) * (1.0 + e) / (1.0 + lam * sign)


def test_pymunk_is_the_rigid_model_of_a_ball():
    found, posed = answers("pymunk", "sphere with e")
    slips = np.array([float(each.psi1) for each in posed.impacts])
    chi = np.array([float(each.chi) for each in posed.impacts])
    expected = np.maximum(slips - 2.0 * chi * 1.8, 0.0)
    assert found == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize(("question", "e"), [("plane", 1.0), ("plane with e", 0.8)])
def test_pymunk_is_the_rigid_model_of_a_rod(question, e):
    found, posed = answers("pymunk", question)
    assert found == pytest.approx([rigid(each, e) for each in posed.impacts], abs=2e-3)


def test_mujoco_damps_slip_and_keeps_what_slides_throughout():
    found, posed = answers("mujoco", "sphere with e")
    slips = np.array([float(each.psi1) for each in posed.impacts])
    assert (found > 0.0).all()
    assert (found < slips).all()
    assert (found >= slips - 2.0 * CHI * 1.83).all()  # its e is .81 to .83 in 50 steps


def test_lammps_reverses_slip_less_than_the_exact_law_says():
    found, posed = answers("lammps", "sphere")
    truth = np.concatenate(posed.truths)
    assert (np.abs(found - truth) > 0.05).any()
    assert np.abs(found - truth).max() < 0.65  # its own mindlin/force: .515 (theory §13)


def test_a_difference_of_models_is_told_beside_errors_and_on_no_front():
    own = Row(method="collide()", error_rms=1e-3, error_worst=1e-3, time_s=1e-3)
    other = Row(
        method="pymunk", options="rigid", error_rms=0.6, error_worst=1.0, time_s=1e-6, peer=True
    )
    made = Benchmark(rows=(own, other), orders={}, complete=True, left_out=("lammps",))
    assert made.front("sphere") == made.short() == [own]
    first, second, last = cli_bench._report(made).split("\n\n")
    assert "pymunk" not in first
    assert "no numerical error" in second
    assert "pymunk" in second
    assert last == "other engines left out, not there: lammps"


def test_engines_that_are_not_there_are_left_out_in_one_line(capsys, monkeypatch):
    for name in peers.ENGINES:
        monkeypatch.setitem(sys.modules, name, None)
    assert main(["bench", "--question", "plane", "--time-limit", "1e-6"]) == 0
    assert not [each for each in peers.of_rods() + peers.of_spheres(0.8) if each.peer]
    said = capsys.readouterr().out
    assert said.count("pymunk") == 1
    assert "left out, not there: pymunk, mujoco, lammps" in said
