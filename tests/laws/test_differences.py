"""The cautions with measured sizes: whole sentences from a small table written here."""

from types import SimpleNamespace

import numpy as np
import pytest

from contactlab import Scene
from contactlab_laws.differences import table
from contactlab_laws.differences.table import Row, choice, springs


class Tsuji:
    """The name of the law with which others are compared."""


class Soft:
    """Measured down to e = 0.1."""


class Hard:
    """Measured down to e = 0.1; further from Tsuji's law."""


class Sticky:
    """Measured from e = 0.5 on: it takes no restitution."""


class Unknown:
    """Not measured."""


NAMES = {each: f"{__name__}.{each.__name__}" for each in (Tsuji, Soft, Hard, Sticky)}
ROWS = {
    NAMES[Tsuji]: (Row(0.1, 0.4, 0.0), Row(1.0, 0.0002, 0.0)),
    NAMES[Soft]: (Row(0.1, 0.2, 0.03), Row(0.5, 0.1, 0.01), Row(1.0, 0.0005, 0.0)),
    NAMES[Hard]: (Row(0.1, 0.3, 0.9), Row(1.0, 0.01, 0.5)),
    NAMES[Sticky]: (Row(0.5, 0.9, 3.0), Row(1.0, 0.9, 3.0)),
}
SCENE = Scene.nondimensional(psi1=1.0, chi=1.2)


@pytest.fixture(autouse=True)
def _small_table(monkeypatch):
    monkeypatch.setattr(table, "rows", lambda: ROWS)


def motion(law, e, scene=SCENE, offers=()):
    """Return as much of a normal motion as a caution looks at."""
    rate = -np.asarray(e) * scene.normal_speed
    return SimpleNamespace(law=law(), final_rate=rate, scene=scene, offers=frozenset(offers))


SPRINGS = (
    "each spring is limited separately, which is not Coulomb's law at every point under this "
    "normal law: psi2 is off by up to {} (measured for chi 0.8 to 1.8{}; model, not numerical "
    "error); tangential.annulus has the right limit"
)
OTHERS = ", of other normal laws of this restitution"


@pytest.mark.parametrize(
    ("law", "e", "size", "scope"),
    [
        (Soft, 0.5, "0.2", ""),  # 0.11 to one digit, upward
        (Soft, 0.3, "0.2", ""),  # 0.165
        (Soft, 0.1, "0.3", ""),
        (Soft, 0.05, "0.3", ""),  # below the least measured: that
        (Soft, 1.0, None, ""),  # 0.0005 is not worth a sentence
        (Soft, np.array([1.0, 0.5, np.nan]), "0.2", ""),  # the worst of a batch
        (Soft, np.nan, None, ""),
        (Tsuji, 0.1, "0.5", ""),
        (Unknown, 1.0, "1", OTHERS),  # 0.99 of Sticky's
    ],
)
def test_the_caution_of_springs(law, e, size, scope):
    expected = () if size is None else (SPRINGS.format(size, scope),)
    assert springs(SCENE, motion(law, e)) == expected
    assert springs(SCENE, motion(law, e, offers={"elastic_hertz"})) == ()


def test_a_size_of_a_thousandth_is_worth_a_sentence(monkeypatch):
    for size, told in ((1e-3, 1), (0.999e-3, 0)):
        row = (Row(1.0, size, size),)
        monkeypatch.setattr(table, "rows", lambda row=row: {NAMES[Soft]: row, NAMES[Tsuji]: row})
        assert len(springs(SCENE, motion(Soft, 1.0))) == told
        assert len(choice(SCENE, motion(Soft, 1.0))) == told


CHOICE = (
    "the restitution alone does not decide psi2: under partial slip other normal laws of the same "
    "restitution move psi2 by up to {} (measured for chi 0.8 to 1.8; model, not numerical error)"
)


@pytest.mark.parametrize(
    ("law", "e", "text"),
    [
        (Soft, 0.1, "0.04 (Tsuji)"),
        (Soft, 0.5, "0.02 (Tsuji)"),
        (Soft, 1.0, None),
        (Hard, 0.1, "1 (Tsuji)"),
        (Sticky, 0.7, "4 (Tsuji)"),
        (Tsuji, 0.1, "0.04 (Soft) to 1 (Hard)"),  # not Sticky, which takes no restitution
        (Tsuji, 1.0, None),
        (Tsuji, np.array([1.0, 0.1]), "0.04 (Soft) to 1 (Hard)"),
        (Unknown, 0.5, None),
    ],
)
def test_the_caution_of_the_choice_of_normal_law(law, e, text):
    expected = () if text is None else (CHOICE.format(text),)
    assert choice(SCENE, motion(law, e)) == expected
    assert choice(SCENE, motion(law, e, offers={"elastic_hertz"})) == ()


@pytest.mark.parametrize(
    ("numbers", "rubs"),
    [
        ({"psi1": 1.0}, True),
        ({"psi1": -1.0}, True),
        ({"psi1": 0.0}, False),
        ({"psi1": [0.0, 0.0]}, False),
        ({"psi1": [0.0, 2.0]}, True),
    ],
)
def test_only_an_impact_that_rubs_is_cautioned_of(numbers, rubs):
    scene = Scene.nondimensional(chi=1.2, **numbers)
    assert bool(springs(scene, motion(Soft, 0.1, scene))) is rubs
    assert bool(choice(scene, motion(Soft, 0.1, scene))) is rubs


def test_without_friction_nothing_rubs():
    scene = SimpleNamespace(slip_velocity=1.0, friction_coefficient=0.0)
    assert not table._rubs(scene)
    scene.friction_coefficient = np.array([0.0, 0.1])
    assert table._rubs(scene)
    scene.slip_velocity = np.array([1.0, 0.0])
    assert not table._rubs(scene)


@pytest.mark.parametrize(
    ("size", "above"),
    [(1.0, "2"), (0.9, "1"), (0.91, "2"), (0.018, "0.02"), (0.02, "0.03"), (8.5e-4, "0.001")],
)
def test_a_size_is_rounded_up_with_a_tenth_more(size, above):
    assert table._above(size) == above


def test_the_file_is_read_whole(monkeypatch, tmp_path):
    """The first line is the head; rows come in ascending restitution."""
    monkeypatch.undo()
    file = tmp_path / "differences.csv"
    file.write_text("law,restitution,springs,choice\nx.A,1,2e-2,3\nx.B,0.5,4,5\nx.A,0.9,6,7\n")
    monkeypatch.setattr(table, "FILE", file)
    assert table.rows.__wrapped__() == {
        "x.A": (Row(0.9, 6.0, 7.0), Row(1.0, 0.02, 3.0)),
        "x.B": (Row(0.5, 4.0, 5.0),),
    }
