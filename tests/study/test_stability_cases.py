"""The cases of the stability report, each against its own label; how many there are of each."""

import re
from collections import Counter

import numpy as np
import pytest

from contactlab.impact.bodies import HalfSpace
from contactlab.study.bench_methods import Method
from contactlab.study.stability_cases import Case, cases, extreme_scenes, normal_scenes

CHI = 49 / 34
#: A name and its number; of psi1 beside a change of regime, the first part.
NUMBER = r"([\w/]+)=(-?[\d.]+(?:e[-+]\d+)?)"
SPRINGS = Method(tangential="springs", integrator="symplectic")


def told(label):
    """The numbers in a label by their names."""
    return {name: float(value) for name, value in re.findall(NUMBER, label)}


def psi1_of(label, chi):
    """The psi1 that a label names, beside a change of regime too."""
    edge = re.search(r"psi1=(1|4chi-1)([-+][\d.e-]+) ", label)
    if edge is None:
        return told(label).get("psi1")
    return (1.0 if edge[1] == "1" else 4.0 * chi - 1.0) + float(edge[2])


def is_steel_ball(scene, **changed):
    """A ball of 1 cm at 1 m/s and 0.3 m/s along the surface, mu = 0.2, unless told otherwise."""
    plain = {"R": 0.01, "v1": 1.0, "mu": 0.2, "nu": 0.3} | changed
    sphere, target = scene.sphere, scene.target
    slip = changed.get("slip", 0.3)
    assert sphere.radius == plain["R"]
    assert scene.normal_speed == plain["v1"]
    assert scene.friction_coefficient == plain["mu"]
    assert scene.tangential_velocity == pytest.approx(slip * plain["v1"], rel=1e-15)
    assert scene.spin == 0.0
    assert sphere.material.poisson_ratio == target.material.poisson_ratio == plain["nu"]
    assert sphere.material.shear_modulus == 80e9
    assert sphere.material.density == 7850.0
    if "m2/m1" in plain:
        assert target.radius == plain["R"]
        assert target.mass / sphere.mass == pytest.approx(plain["m2/m1"], rel=1e-12)
    else:
        assert isinstance(target, HalfSpace)


@pytest.mark.parametrize("listed", [extreme_scenes, normal_scenes])
@pytest.mark.parametrize("quick", [True, False])
def test_every_scene_is_what_its_label_says(listed, quick):
    for extreme in listed(quick=quick):
        if extreme.label.partition(",")[0] in ("float32", "int", "int64"):
            continue
        numbers = told(extreme.label)
        if numbers.get("v1") == 1e-165:  # its energy loses digits
            with pytest.raises(ValueError, match="normal_speed = 1e-165"):
                extreme.make()
            continue
        scene = extreme.make()
        if "psi1" in extreme.label or "chi=" in extreme.label:
            chi = numbers.get("chi", CHI)
            assert scene.chi == pytest.approx(chi, rel=5e-4)
            plain = 0.3 if "psi1" not in extreme.label else psi1_of(extreme.label, scene.chi)
            assert scene.psi1 == pytest.approx(plain, rel=1e-12, abs=1e-320)
        else:
            is_steel_ball(scene, **numbers)


def test_numbers_of_other_types_make_the_same_scenes():
    made = {one.label: one.make() for one in extreme_scenes() if one.family == "types"}
    assert list(made) == ["float32", "int", "int64", "float32, SI", "int, SI"]
    assert made["float32"].psi1 == np.float32(1.2)
    assert made["float32"].chi == pytest.approx(CHI, rel=1e-7)
    assert (made["int"].psi1, made["int"].chi) == (1.0, 3.0)
    assert (made["int64"].psi1, made["int64"].chi) == (2.0, 3.0)
    single = np.float32
    is_steel_ball(made["float32, SI"], mu=single(0.2), slip=single(0.3), nu=single(0.3))
    is_steel_ball(made["int, SI"], mu=1, slip=1, nu=0)


@pytest.mark.parametrize(
    ("listed", "quick", "counts"),
    [
        # psi1: every other of nine. regimes: 3 sides of 2 changes at each of 2 chi. chi: 4 of 2.
        # radius: 2 radii at the usual, the least and the greatest speed.
        (extreme_scenes, True, {
            "psi1": 5, "regimes": 12, "chi": 8, "friction": 6, "poisson": 3, "speed": 2,
            "radius": 6, "mass": 2, "types": 5,
        }),
        # 5 sides of 2 changes at each of 5 chi; 14 chi of 4 psi1; 6 radii at 3 speeds.
        (extreme_scenes, False, {
            "psi1": 9, "regimes": 50, "chi": 56, "friction": 6, "poisson": 3, "speed": 6,
            "radius": 18, "mass": 7, "types": 5,
        }),
        (normal_scenes, True, {"normal": 3}),
        # 3, 6 psi1, 4 chi, 6 frictions, 2 + 6 + 2 sizes, 5 types.
        (normal_scenes, False, {"normal": 3 + 6 + 4 + 6 + 10 + 5}),
    ],
)  # fmt: skip
def test_so_many_scenes_of_each_family(listed, quick, counts):
    found = listed(quick=quick)
    assert Counter(one.family for one in found) == counts
    assert len({one.label for one in found}) == len(found)


def test_scenes_stand_on_both_sides_of_each_change_of_regime():
    """At psi1 = 1 and at 4 chi - 1, by 1e-3 and by 1e-9; at chi = 0.3 the latter is 0.2."""
    found = {one.label: one.make() for one in extreme_scenes() if one.family == "regimes"}
    assert {label.partition(" ")[2] for label in found} == {
        "chi=0.3", "chi=0.5", "chi=0.51", "chi=1.441", "chi=3"
    }  # fmt: skip
    for name in ("1", "4chi-1"):
        sides = [label.partition(" ")[0] for label in found if label.endswith("chi=3")]
        assert [side for side in sides if side.startswith(f"psi1={name}")][-5:] == [
            f"psi1={name}{side}" for side in ("-0.001", "-1e-09", "+0", "+1e-09", "+0.001")
        ]
    assert found["psi1=4chi-1+0.001 chi=0.3"].psi1 == pytest.approx(0.201, rel=1e-12)


def test_the_cases_of_a_stepped_law_are_counted():
    """Every scene; psi1, friction and regimes marched too; chi also at 8 times the limit."""
    found = list(cases(SPRINGS, quick=True))
    counts = Counter((case.family, case.planned) for case in found)
    assert counts == {
        ("psi1", True): 5, ("psi1", False): 5, ("regimes", True): 12, ("regimes", False): 12,
        ("friction", True): 6, ("friction", False): 6, ("chi", True): 16, ("poisson", True): 3,
        ("speed", True): 2, ("radius", True): 6, ("mass", True): 2, ("types", True): 5,
        ("eccentric", True): 12,  # three lam by three psi1, and three rods
        ("normal", True): 24,  # three scenes under eight other normal laws
        ("steps", True): 26,  # 7 numbers on 2 scenes, and 6 of them without refining
        ("parts", True): 8,  # 2 numbers on 2 scenes, at the default steps and above the limit
    }  # fmt: skip
    assert {case.method for case in found} == {SPRINGS}
    assert {case.normal for case in found if case.family != "normal"} == {"hertz"}
    for case in found:
        if case.normal != "hertz":
            assert case.label.startswith(f"{case.normal}: ")
        assert case.label.endswith(", marched") is not case.planned


def test_other_methods_have_the_cases_that_they_can_have():
    def families(tangential, integrator, **kind):
        method = Method(tangential=tangential, integrator=integrator, **kind)
        return Counter(case.family for case in cases(method, quick=True))

    whole = families("walton", "symplectic")
    assert (whole["psi1"], whole["chi"], whole["steps"], whole["parts"]) == (5, 8, 0, 0)
    assert whole["normal"] > 0
    # Under a tolerance, every third of the seven on two scenes, also where the law has parts.
    ruled = families("springs", "adaptive")
    assert (ruled["steps"], ruled["tolerance"], ruled["parts"], ruled["chi"]) == (0, 6, 4, 8)
    exact = families("fronts", "events")
    assert (exact["tolerance"], exact["parts"]) == (6, 0)
    assert families("springs", "symplectic", normal="jkr") == {"normal": 3}
    full = Method(tangential="springs", integrator="symplectic", normal="jkr")
    assert {case.normal for case in cases(full)} == {"jkr"}
    assert len(list(cases(full))) == 34


def test_resolutions_are_named_in_the_label_and_large_chi_has_steps_enough():
    for case in cases(SPRINGS, quick=True):
        options = case.options["tangential"] | case.options["integrator"]
        assert set(case.options) == {"tangential", "integrator"}
        named = {key: value for key, value in told(case.label).items() if key in options}
        assert named == {key: pytest.approx(value, rel=1e-5) for key, value in options.items()
                         if key != "refine"} | (
            {"refine": 0.0} if "refine" in options else {}
        )  # fmt: skip
        if case.family in ("chi", "parts") and "steps" in options:
            # A whole number, from 8 times 2.85 sqrt(chi) on and eight more.
            chi = case.scene.make().chi
            assert options["steps"] - 8 <= 22.8 * chi**0.5 < options["steps"] - 7
        if case.family in ("steps", "parts"):
            assert case.scene.family == case.family


def test_a_case_is_planned_under_the_default_normal_law():
    scene = extreme_scenes(quick=True)[0]
    plain = Case(family="", label="", method=SPRINGS, options={}, scene=scene)
    assert (plain.planned, plain.normal) == (True, "hertz")


def test_a_broken_normal_law_is_left_out(monkeypatch):
    from contactlab.compose.registry import REGISTRY, PluginError

    create = type(REGISTRY).create

    def broken(self, name, **options):
        if name == "normal.jkr":
            raise PluginError("normal.jkr: broken")
        return create(self, name, **options)

    monkeypatch.setattr(type(REGISTRY), "create", broken)
    normals = {case.normal for case in cases(SPRINGS, quick=True)}
    assert "jkr" not in normals
    assert {"tsuji", "dmt", "walton_braun"} < normals


def test_these_resolutions_and_extremes_are_tried():
    """One label of each, of the full set."""

    def tried(method, family, name):
        labels = [case.label for case in cases(method) if case.family == family]
        return list(dict.fromkeys(told(label)[name] for label in labels if name in told(label)))

    steps = [1, 2, 3, 4, 5, 7, 10, 20, 50, 100, 1000, 1e4, 1e5, 1e6]
    assert tried(SPRINGS, "steps", "steps") == steps
    assert tried(SPRINGS, "parts", "springs") == [1, 2, 3, 5, 10, 100, 1000]
    exact = Method(tangential="fronts", integrator="events")
    tolerances = [1.0, 0.1, 1e-2, 1e-3, 1e-5, 1e-8, 1e-12]
    assert tried(exact, "tolerance", "tolerance") == tolerances
    chis = [0.05, 0.1, 0.25, 0.499, 0.5, 0.501, 0.75, 1.0, 3.0, 8.0, 30.0, 100.0, 1e3, 1e4]
    assert tried(exact, "chi", "chi") == chis
    assert tried(exact, "chi", "psi1") == [0.3, 0.98, 1.2, 2.5]
    assert tried(exact, "psi1", "psi1") == [0.0, 1e-300, 1e-12, 1e-3, 0.5, -1.2, 1e6, 1e15, 1e16]
    assert tried(exact, "friction", "mu") == [0.0, 1e-300, 1e-12, 1e3, 1e12, 1e300]
    assert tried(exact, "poisson", "nu") == [-1.0, 0.0, 0.5]
    assert tried(exact, "speed", "v1") == [1e-165, 1e-12, 1e-6, 1e-2, 1e2, 1e4]
    assert tried(exact, "radius", "R") == [1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e9]
    assert tried(exact, "radius", "v1") == [1e-165, 1e4]
    assert tried(exact, "mass", "m2/m1") == [1e-12, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e12]
    ladder = [(0.3, 0.3), (0.5, 1.441), (1.2, 1.441), (3.0, 1.441), (1.2, 30.0), (0.3, 1e3)]
    labels = [case.label for case in cases(exact) if case.family == "tolerance"]
    assert list(dict.fromkeys((told(one)["psi1"], told(one)["chi"]) for one in labels)) == ladder
    plain = [scene.label for scene in normal_scenes()]
    assert plain[:13] == [
        "psi1=3", "psi1=1.2 chi=3", "steel ball", "psi1=0", "psi1=1e-12", "psi1=0.5", "psi1=1.2",
        "psi1=20", "psi1=1e+15", "chi=0.05", "chi=0.5", "chi=30", "chi=1000",
    ]  # fmt: skip
    quick = {case.label for case in cases(SPRINGS, quick=True) if case.family == "chi"}
    assert list(dict.fromkeys(told(label)["chi"] for label in sorted(quick))) == [
        0.05, 0.5, 100.0, 3.0
    ]  # fmt: skip
    sizes = [one.label for one in extreme_scenes(quick=True) if one.family in ("speed", "mass")]
    assert sizes == ["v1=1e-12 m/s", "v1=10000 m/s", "m2/m1=1e-12", "m2/m1=1e+12"]


def test_a_quick_set_tries_some_of_them():
    def tried(method, family, *names):
        listed = [told(case.label) for case in cases(method, quick=True) if case.family == family]
        return list(dict.fromkeys(tuple(one.get(name) for name in names) for one in listed))

    exact = Method(tangential="fronts", integrator="events")
    assert tried(SPRINGS, "steps", "steps") == [(1,), (2,), (3,), (4,), (5,), (10,), (50,)]
    assert tried(SPRINGS, "parts", "springs") == [(1,), (2,)]
    assert tried(exact, "tolerance", "tolerance") == [(1.0,), (1e-3,), (1e-12,)]
    assert tried(exact, "tolerance", "psi1", "chi") == [(1.2, 1.441), (1.2, 30.0)]
    assert tried(exact, "chi", "psi1") == [(0.3,), (1.2,)]
    assert tried(exact, "psi1", "psi1") == [(0.0,), (1e-12,), (0.5,), (1e6,), (1e16,)]
    labels = [one.label for one in extreme_scenes(quick=True) if one.family == "regimes"]
    assert labels[:6] == [
        f"psi1={edge}{side} chi=0.5"
        for edge in ("1", "4chi-1")
        for side in ("-1e-09", "+0", "+1e-09")
    ]  # fmt: skip
    assert [label.partition(" ")[2] for label in labels[6:]] == ["chi=1.441"] * 6
