"""The impacts and steps that checks of the kit ask for: angles, bodies, friction and spin."""

from typing import Any, ClassVar

import attrs
import numpy as np
import pytest

from contactlab.testing import checks_for, outcome
from contactlab.testing.impacts import CHI, PSI1
from tests.testing.fresh_sound import HardSphere
from tests.testing.test_what_checks_ask import Recording as Stepped
from tests.testing.test_what_checks_ask import asked as courses
from tests.testing.test_what_checks_ask import paths


@attrs.frozen(kw_only=True)
class Recording(HardSphere):
    """Keeps every scene."""

    seen: Any = attrs.field(factory=list, eq=False)

    def whole_impacts(self, scene, normal):
        self.seen.append((scene, normal))
        return super().whole_impacts(scene, normal)


class Claiming(Recording):
    offers: ClassVar[frozenset] = frozenset({"rigid", "no_friction", "partial_slip"})


def asked(name, law=None):
    """Scenes and normal motions of a check of laws that answer for whole impacts."""
    law = law or Recording()
    outcome(law, next(check for check in checks_for(law) if check.name == name))
    return law.seen


def angles(name, law=None):
    """Psi1 and chi of each single impact, rounded."""
    single = [scene for scene, _ in asked(name, law) if not scene.shape]
    return {(round(float(one.psi1), 6), round(float(one.chi), 6)) for one in single}


ALL = {(psi1, round(chi, 6)) for psi1 in PSI1 for chi in CHI}


@pytest.mark.parametrize("name", ["impact_bounds", "impact_books", "impact_units"])
def test_impacts_are_of_all_angles_and_inertias(name):
    assert angles(name) == ALL


def test_mirror_images_are_of_all_angles():
    assert angles("impact_odd") == ALL | {(-psi1, chi) for psi1, chi in ALL}


def test_central_impacts_are_central():
    assert angles("impact_central") == {(0.0, round(chi, 6)) for chi in CHI}


def test_batches_are_of_unlike_bodies_and_of_both_senses():
    batch = next(scene for scene, _ in asked("impact_batch") if scene.shape == (12,))
    assert set(np.round(batch.psi1, 6)) == {-2.0, 0.3, 1.2, 40.0}
    assert set(np.round(batch.chi, 6)) == {round(chi, 6) for chi in CHI}
    for column in (batch.pair.radius, batch.friction_coefficient, batch.pair.normal_mass):
        assert len(set(column)) == 12


def test_grazing_impacts_are_asked_with_four_coefficients_of_friction():
    scenes = [scene for scene, _ in asked("friction_coefficient")]
    assert [float(one.friction_coefficient) for one in scenes] == [0.02, 0.1, 0.3, 0.9]
    for one in scenes:
        assert one.psi1 == pytest.approx(300.0 * 4.0 * CHI[1])


@pytest.mark.parametrize(
    ("name", "laws"),
    [("sliding_impulse", {"Hertz", "DampedHertz"}), ("load_impulse", {"PullingHertz"})],
)
def test_sliding_is_asked_under_other_normal_laws(name, laws):
    seen = asked(name)
    assert {type(normal.law).__name__ for _, normal in seen} == laws
    for scene, _ in seen:
        assert scene.psi1 == pytest.approx(1200.0 * scene.chi)


def test_spin_makes_a_share_of_the_slip_velocity():
    scenes = [scene for scene, _ in asked("spin")]
    assert {round(float(one.psi1), 6) for one in scenes} == {0.5, 9.0, 2.0}
    shares = {round(float(one.tangential_velocity / one.slip_velocity), 6) for one in scenes}
    assert shares == {1.0, 0.0, 0.4, 2.5, -1.0}
    for one in scenes:
        spun = one.tangential_velocity + one.spin * one.sphere.radius
        assert one.slip_velocity == pytest.approx(spun)


def test_scenes_before_are_of_the_same_shape_and_other_bodies():
    scenes = [scene for scene, _ in asked("impact_after_another")]
    assert [one.shape for one in scenes] == [(), (), (1,)]
    first, second, stacked = (float(np.ravel(one.pair.radius)[0]) for one in scenes)
    assert first != second == stacked
    assert [float(np.ravel(one.psi1)[0]) for one in scenes] == pytest.approx([1.2, 2.0, 2.0])
    assert [float(np.ravel(one.friction_coefficient)[0]) for one in scenes] == [0.3, 0.6, 0.6]


@pytest.mark.parametrize("name", ["rigid_body", "no_friction"])
def test_rigid_bodies_are_asked_from_the_centre_on(name):
    assert (0.0, 0.3) in angles(name, Claiming())


def test_declared_errors_are_asked_in_stick_and_in_slip():
    @attrs.frozen(kw_only=True)
    class Declaring(Recording):
        resolution: ClassVar[str] = "pieces"
        pieces: int = 1

        def answer(self, scene, change, work):
            return attrs.evolve(super().answer(scene, change, work), psi2_error=0.5)

    seen = angles("declared_error", Declaring())
    assert seen == {(p, round(c, 6)) for p in (0.3, 0.9, 1.2, 2.0, 3.5) for c in CHI}


def test_turns_are_made_in_stick_and_in_gross_slip():
    runs = paths("turning_points")
    assert len(runs) == 12
    for index, turn in enumerate((0.3, 0.6, 1.5)):
        loading, unloading, looped, direct = (run[0][39::40] for run in runs[4 * index :][:4])
        assert loading == pytest.approx([0.0, turn])
        assert unloading == pytest.approx([0.0, turn, -turn])
        assert looped == pytest.approx([0.0, turn, 0.4 * turn, turn, 1.4 * turn])
        assert direct == pytest.approx([0.0, turn, 1.4 * turn])
    assert all(run[1][39:] == pytest.approx(0.8) for run in runs)


def test_gross_slip_goes_on_and_a_long_slip_turns():
    [(slip, level, _, _)] = paths("gross_slip")
    assert (slip[79], slip[-1]) == pytest.approx((4.0, 8.0))
    assert level[39:] == pytest.approx(0.7)
    ahead, back = paths("odd_in_slip")[-2:]
    assert ahead[0][39::40] == pytest.approx([0.0, 1e4, 9999.0])
    assert back[0] == pytest.approx(-ahead[0])
    assert ahead[1][39::40] == pytest.approx([0.5, 0.9, 0.7])


def test_every_path_is_gone_in_both_senses():
    runs = paths("odd_in_slip")
    assert len(runs) == 8
    for forth, back in zip(runs[::2], runs[1::2], strict=True):
        assert back[0] == pytest.approx(-forth[0])
        assert back[1] == pytest.approx(forth[1])


def test_tension_is_asked_in_both_senses_and_with_some_load():
    runs = courses("tension", Stepped())
    assert len(runs) == 4
    for (slip, level, load, _), share in zip(runs, (0.0, 0.0, 0.2, 0.2), strict=True):
        sense = np.sign(slip[8])
        pulled = [0.1, 0.0, 0.3, -0.2, -0.9, 0.05]
        assert np.cumsum(slip)[15] == pytest.approx(0.4 * sense)
        assert slip[16:] == pytest.approx(sense * np.array(pulled))
        assert level[16:] == pytest.approx(0.5)
        assert load[16:] == pytest.approx(share)
    assert [np.sign(run[0][8]) for run in runs] == [1.0, -1.0, 1.0, -1.0]
