"""Stronge's contact by parts: zeros, phases that end, and whole sentences."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from contactlab import Scene, Simulation, create
from contactlab_laws.stronge import law, lumped
from contactlab_laws.stronge.lumped import Contact, Half, rebound
from contactlab_laws.stronge.roots import first_zero


@pytest.mark.parametrize(
    ("function", "bend", "start", "stop", "zero"),
    [
        (math.cos, 1.0, 0.0, 3.0, 0.5 * math.pi),
        (math.cos, 1.0, 0.0, 1.5, None),
        (math.sin, 1.0, 1.0, 7.0, math.pi),
        (lambda x: math.cos(1e4 * x), 1e8, 0.0, 1.0, 0.5e-4 * math.pi),
        (lambda x: 1.0 - x, 0.0, 0.0, 3.0, 1.0),
        (lambda x: 1.0 - x, 0.0, 0.0, 1.0, None),  # it comes to zero there, not below
        (lambda x: x * x, 2.0, -1.0, 1.0, None),  # a touch is no fall
        (lambda x: -0.5 - x, 0.0, 0.0, 1.0, 0.0),  # below from the start
        (lambda _: -0.5e-14, 0.0, 0.0, 1e-6, None),  # rounding
        (lambda _: -2e-14, 0.0, 0.0, 1e-6, 0.0),
    ],
)
def test_the_first_fall_below_zero(function, bend, start, stop, zero):
    found = first_zero(function, bend, start, stop)
    assert (found is None) is (zero is None)
    if zero is not None:
        assert found == pytest.approx(zero, abs=1e-13)


def test_the_halves_of_the_contact():
    """p = sin theta, then cos (theta/e) of e = 0.5; the integrals of whole halves are 1 and e."""
    close, part = Half(1.0, True), Half(0.5, False)
    assert close.load(0.3) == pytest.approx(math.sin(0.3))
    assert part.load(0.3) == pytest.approx(math.cos(0.3))
    assert close.impulse(0.2, 0.9) == pytest.approx(math.cos(0.2) - math.cos(0.9))
    assert part.impulse(0.2, 0.9) == pytest.approx(0.5 * (math.sin(0.9) - math.sin(0.2)))
    assert close.impulse(0.0, 0.5 * math.pi) == pytest.approx(1.0)
    assert part.impulse(0.0, 0.5 * math.pi) == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("speed", "half", "square", "x", "end"),
    [
        # 0.5 - 4 (1 - cos x) = cos x at cos x = 3.5/3: not before the end
        (0.5, Half(1.0, True), 4.0, 0.0, 0.5 * math.pi),
        (1.0, Half(1.0, True), 4.0, 0.0, 0.0),
        (2.5, Half(1.0, True), 4.0, 0.0, math.acos(0.5)),
        (4.0, Half(1.0, True), 4.0, 0.0, math.acos(0.0)),
        (4.1, Half(1.0, True), 4.0, 0.0, 0.5 * math.pi),
        (2.5, Half(1.0, True), 1.0, 0.0, 0.5 * math.pi),  # the load falls as fast
        # 0.75 - 4 sin x/2 = -2 sin x: never; with 9 at 0.75 = 2.5 sin x
        (0.75, Half(0.5, False), 4.0, 0.0, 0.5 * math.pi),
        (0.75, Half(0.5, False), 9.0, 0.0, math.asin(0.3)),
        (2.5, Half(0.5, False), 9.0, 0.0, 0.5 * math.pi),
        (3.0, Half(0.5, False), 9.0, 0.0, 0.5 * math.pi),
        (0.75, Half(0.5, False), 9.0, 0.1, math.asin((0.75 + 4.5 * math.sin(0.1)) / 2.5)),
    ],
)
def test_where_slip_of_one_sign_ends(speed, half, square, x, end):
    assert lumped._slip_ends(speed, half, square, x) == pytest.approx(end, abs=1e-12)


def test_changes_without_end_are_an_error(monkeypatch):
    """A change is allowed for each unit of 1 + omega: four at omega = 3."""
    monkeypatch.setattr(lumped, "MOST_CHANGES", 1)

    def again(contact, half, frequency, x):
        return contact, x

    monkeypatch.setattr(lumped, "_stick", again)
    with pytest.raises(ArithmeticError, match=r"^slip and stick change 5 times, omega = 3\.0$"):
        rebound(0.5, 3.0, 1.0)


@pytest.mark.parametrize(("incidence", "follow"), [(0.999, "_stick"), (1.0, "_slip")])
def test_slow_contacts_stick_at_first(incidence, follow, monkeypatch):
    asked = []
    for name in ("_stick", "_slip"):
        monkeypatch.setattr(
            lumped, name, lambda contact, *_, name=name: (asked.append(name), (contact, 9.0))[1]
        )
    rebound(incidence, 2.0, 0.5)
    assert asked[0] == follow


def test_slip_of_the_other_sign_is_its_mirror_image():
    half = Half(0.8, False)
    there = lumped._slip(Contact(1.5, 0.2, 0.9, 0.3, 1), half, 2.0, 0.1)
    back = lumped._slip(Contact(-1.5, -0.2, -0.9, 0.3, -1), half, 2.0, 0.1)
    assert back[1] == there[1]
    for name, sign in (("change", -1), ("force", -1), ("work", 1), ("sense", -1)):
        assert getattr(back[0], name) == pytest.approx(sign * getattr(there[0], name))


LUMPED = (
    "lumped contact: springs independent of the contact's area, without partial slip, which moves "
    "psi2 of solid spheres by up to about 0.4 (model, not numerical error)"
)


@pytest.mark.parametrize(
    ("impulse", "text"),
    [
        (2.0 * 1.00099, None),
        (2.0 * 1.00101, "1"),
        (2.0 * 1.2345, "1.23"),
        ([2.0, 3.0, 1.0], "1.5"),
    ],
)
def test_the_caution_of_a_pull(impulse, text):
    """M_n v1 (1 + e) is 2 where all of these are 1."""
    scene = SimpleNamespace(pair=SimpleNamespace(normal_mass=1.0), normal_speed=1.0)
    normal = SimpleNamespace(total_load_impulse=np.array(impulse), final_rate=-1.0)
    told = create("tangential.stronge").cautions(scene, normal)
    pull = (
        f"lumped contact: its normal spring does not pull; the friction load of the normal law has "
        f"up to {text} times the impulse (1 + e) M_n v1 of that spring (model, not numerical error)"
    )
    assert told == ((LUMPED,) if text is None else (LUMPED, pull))


@pytest.mark.parametrize(("frequency", "refused"), [(1e4, False), (1.0001e4, True), (np.nan, True)])
def test_a_frequency_too_high_is_refused(frequency, refused, monkeypatch):
    monkeypatch.setattr(law, "rebound", lambda *given: given)
    if not refused:
        assert law._of_one(0.5, frequency, 1.0) == (0.5, frequency, 1.0)
        return
    with pytest.raises(ValueError, match="ratio of natural frequencies") as told:
        law._of_one(0.5, frequency, 1.0)
    assert str(told.value) == (
        f"ratio of natural frequencies = {frequency}: must be at most 10000: each oscillation is "
        "followed; take tangential.fronts"
    )


@pytest.mark.parametrize("incidence", [0.0, np.inf, np.nan])
def test_what_does_not_slip_is_not_followed(incidence):
    assert law._of_one(incidence, 1.0, 1.0) == (0.0, 0.0)


@pytest.mark.parametrize("ratio", [None, 0.5])
def test_units_of_an_impact_in_si(ratio):
    """In SI as in scaled numbers: the change in mu v1/ratio, the work in M_t times its square."""
    from contactlab import HalfSpace, Material, Sphere

    steel = Material.named("steel")
    scene = Scene(Sphere(0.01, steel), HalfSpace(steel), 0.3, 0.7, -0.15)
    chosen = create("tangential.stronge", stiffness_ratio=ratio)
    result = Simulation(tangential=chosen).run(scene).check()
    stiff = scene.pair.stiffness_ratio if ratio is None else ratio
    unit = 0.3 * 0.7 / stiff
    omega = math.sqrt(stiff * scene.pair.normal_mass / scene.pair.tangential_mass)
    known = rebound(0.15 / unit, omega, 1.0)
    assert result.motion.slip_velocity_change == pytest.approx(-unit * known.change)
    assert result.motion.friction_work == pytest.approx(
        scene.pair.tangential_mass * unit**2 * known.work
    )
