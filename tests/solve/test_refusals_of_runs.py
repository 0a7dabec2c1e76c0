"""Every refusal of a run, a sweep, a path, a rebound or a law: name, value, rule and remedy."""

import re
from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import (
    HalfSpace,
    Material,
    Scene,
    Simulation,
    Sphere,
    collide,
    compare,
    load_path,
    rebound,
)
from contactlab.contracts import SteppedTangentialLaw, TangentialResponse
from contactlab.registry.composition import law
from contactlab.scene_file import read_scene
from contactlab.study.stability import stability
from contactlab.study.work_precision import bench
from tests.collisions.test_collision import meeting
from tests.laws.normal_laws import LinearSpring
from tests.solve.any_scene import BATCHES, EXACT, WITH_BODIES, one_scene

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
BALL = Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.2, 1.0)
BARE = Scene.nondimensional(psi1=1.0, chi=1.0)
BATCH = Scene.nondimensional(psi1=[[1.0, 2.0]], chi=1.0)
PATH = [1e-6, 2e-6]
E_RULE = "must be from 0 to 1: rebound over approach velocity; leave it out for 1"
OUT = "leave it out for 1e-5"
DIFFERENCES = "take differences of psi2"
KINDS = "normal, tangential, integrator"


@attrs.frozen(kw_only=True)
class Demanding(SteppedTangentialLaw):
    """A law with an option that must be given, and a need that no law meets."""

    api_version: ClassVar[int] = 2
    needs: ClassVar[frozenset] = frozenset({"magic"})
    share: float

    def start(self, scene, normal):
        return None

    def advance(self, state, increment, before, after):
        return TangentialResponse(0.0, 0.0), state


@attrs.frozen(kw_only=True)
class Boasting(LinearSpring):
    """A spring that offers what it is not."""

    offers: ClassVar[frozenset] = frozenset({"elastic_hertz"})


DEMANDING = Demanding(share=1.0)
REFUSED = [
    (
        lambda: rebound("a", 1.0),
        "psi1 = 'a': must be a real number; give the non-dimensional angle of incidence, eq. (29) "
        "of the paper",
    ),
    (
        lambda: rebound(1.0, 1.1e4),
        "chi = 11000.0: must be positive and at most 1e4, the range over which answers were "
        "checked; chi of eq. (38); 1.4412 for a solid steel sphere",
    ),
    (
        lambda: rebound([1.0, 2.0], [1.0, 2.0, 3.0]),
        "shapes of psi1 and chi = ((2,), (3,)): must broadcast to one; one value of chi for "
        "each psi1",
    ),
    (
        lambda: rebound([1.0, 2.0], 1.0, restitution=[0.9, 0.8, 0.7]),
        "shapes of psi1 and restitution = ((2,), (3,)): must broadcast to one; one value of "
        "restitution for each psi1",
    ),
    (
        lambda: rebound(1.0, 1.0, tolerance=1.0),
        f"tolerance = 1.0: must be one number between 1e-9 and 1, of max(1, |psi1|); {OUT}",
    ),
    (
        lambda: rebound(1.0, 1.0, tolerance=9.9e-10),
        f"tolerance = 9.9e-10: must be one number between 1e-9 and 1, of max(1, |psi1|); {OUT}",
    ),
    (
        lambda: rebound(1.0, 1.0, tolerance=[1e-5]),
        f"tolerance = [1e-05]: must be one number between 1e-9 and 1, of max(1, |psi1|); {OUT}",
    ),
    (lambda: rebound(1.0, 1.0, restitution=-0.009), f"restitution = -0.009: {E_RULE}"),
    (lambda: rebound(1.0, 1.0, restitution=1.001), f"restitution = 1.001: {E_RULE}"),
    (
        lambda: rebound([1.0, 1.0], [1.0, 2.51], derivatives=True),
        f"chi = 2.51: derivatives are tabulated up to chi = 2.5; {DIFFERENCES} beyond",
    ),
    (lambda: collide(3), "encounter = 3: must be an Encounter; make one: Encounter(...)"),
    (
        lambda: collide([3]),
        "encounter = [3]: must be an Encounter; make a single Encounter with arrays of vectors, "
        "shape (..., 3); bodies that touch at several contacts at once are a "
        "Gathering(bodies, touches)",
    ),
    (
        lambda: collide(meeting(), "springs"),
        "simulation = 'springs': must be a Simulation; or leave it out",
    ),
    (
        lambda: collide(meeting(), 0.9),
        "simulation = 0.9: must be a Simulation; or leave it out; a restitution is given by name: "
        "restitution=0.9",
    ),
    (
        lambda: collide(meeting(), separating="away"),
        "separating = 'away': must be 'refuse' or 'pass'",
    ),
    (lambda: collide(meeting(), restitution=-0.1), f"restitution = -0.1: {E_RULE}"),
    (
        lambda: collide(meeting(), restitution=[0.9, 0.8]),
        "restitution = array([0.9, 0.8]): must be one number, or of the shape () of the impacts; "
        "give one number for each impact",
    ),
    (
        lambda: collide(meeting(), Simulation(), restitution=0.9),
        "restitution = 0.9: stands in place of a simulation; leave out simulation, or make it "
        "with normal=create('normal.viscoelastic', restitution=0.9)",
    ),
    (lambda: load_path(3, PATH, PATH), "scene = 3: must be a Scene; make one: Scene(...)"),
    (
        lambda: load_path(BALL, 1.0, PATH),
        "approach = 1.0: must be an array, shape (K,) or (K, ...); for one point give [1.0]",
    ),
    (
        lambda: load_path(BALL, PATH, [0.0]),
        "approach (2,), displacement (1,): must have the same number of points along the first "
        "axis",
    ),
    (
        lambda: load_path(BALL, np.ones((2, 2)), np.ones((2, 3))),
        "approach (2, 2), displacement (2, 3), scene (): the axes after the first must broadcast "
        "with the scene's; a batch of N paths has arrays of shape (K, N)",
    ),
    (
        lambda: load_path(BALL, PATH, PATH, time=[1.0, 1.0]),
        "time = [1.0, 1.0]: must grow along its first axis; in s",
    ),
    (
        lambda: load_path(BALL, PATH, PATH, time=1.0),
        "time = 1.0: must grow along its first axis; in s",
    ),
    (
        lambda: load_path(BALL, PATH, PATH, tangential="frictionless"),
        "tangential = Frictionless(): must be a law of steps, a SteppedTangentialLaw; use "
        "springs or annulus",
    ),
    (
        lambda: load_path(BALL, PATH, PATH, tangential=DEMANDING),
        "tangential = Demanding: needs 'magic' of the normal law, which hertz does not offer",
    ),
    (lambda: Simulation().run(3), "scene = 3: must be a Scene; make one: Scene(...)"),
    (
        lambda: Simulation().plan("a.toml"),
        "scene = 'a.toml': must be a Scene; of a file: case = read_scene(path); "
        "case.laws.simulation().run(case.scene)",
    ),
    (
        lambda: Simulation().run(BARE, history="all"),
        "history = 'all': must be True, False or 'fields'",
    ),
    (
        lambda: Simulation().plan(BARE, history=2),
        "history = 2: must be True, False or 'fields'",
    ),
    (
        lambda: Simulation().sweep(BATCH),
        "scenes = (1, 2): must be a sequence, or a one-dimensional batch; for one impact use run",
    ),
    (
        lambda: Simulation().sweep([BARE], progress=5),
        "progress = 5: must be True or a function of done and total; give True, or: "
        "bar = tqdm(); progress=lambda done, total: bar.update(done - bar.n)",
    ),
    (
        lambda: Simulation().sweep([BARE], chunk=0),
        "chunk = 0: must be a whole number from 1 to 10000000",
    ),
    (lambda: Simulation().sweep([BARE], keep=3), "keep = 3: must be the path of a folder"),
    (
        lambda: Simulation(normal=Boasting(), tangential=DEMANDING, integrator="symplectic"),
        "normal = Boasting: offers 'elastic_hertz', but is no ClosedFormNormalLaw; derive "
        "the law from that class, or do not offer the word; no law at hand fits",
    ),
    (
        lambda: contactlab.create(3),
        "name = 3: must be a text such as 'tangential.springs'",
    ),
    (
        lambda: contactlab.create("tangential.frictionless", step=3),
        "step = 3: frictionless has no such option; its options: none",
    ),
    (
        lambda: contactlab.create("integrator.paper", steps=0),
        "integrator.paper: steps = 0: must be a whole number from 1 to 2000000",
    ),
]


@pytest.mark.parametrize(("make", "words"), REFUSED, ids=[words[:40] for _, words in REFUSED])
def test_a_refusal_names_value_rule_and_remedy(make, words):
    with pytest.raises(ValueError, match=" ") as caught:
        make()
    assert str(caught.value) == words


YES_OR_NO = [  # an option, and a call that takes it
    ("history", lambda given: compare(BARE, {"exact": EXACT}, history=given)),
    ("estimate_error", lambda given: compare(BARE, {"exact": EXACT}, estimate_error=given)),
    ("estimate_error", lambda given: EXACT.run(BARE, estimate_error=given)),
    ("return_partial", lambda given: EXACT.sweep([BARE], return_partial=given)),
    ("return_partial", lambda given: EXACT.sweep([BARE], into="no", return_partial=given)),
    ("derivatives", lambda given: rebound(1.0, 1.4, derivatives=given)),
    ("derivatives", lambda given: rebound([1.0, 2.0], 1.4, derivatives=given)),
    ("derivatives", lambda given: rebound(1.0, 1.4, restitution=0.5, derivatives=given)),
    ("cautions", lambda given: EXACT.run(BARE).check(cautions=given)),
    ("allow_code", lambda given: read_scene("none.toml", allow_code=given)),
    ("quick", lambda given: stability([], quick=given)),
    ("quick", lambda given: bench([], quick=given)),
    ("table", lambda given: law("tangential", "fronts", table=given)),
]


@pytest.mark.parametrize("given", ["no", "", 0, 1, None, [True]])
@pytest.mark.parametrize(("name", "call"), YES_OR_NO, ids=[name for name, _ in YES_OR_NO])
def test_an_option_is_on_or_off_and_nothing_is_taken_for_either(name, call, given):
    with pytest.raises(ValueError, match="True or False") as caught:
        call(given)
    assert f"{name} = {given!r}: must be True or False" in str(caught.value)


def test_numpys_true_and_false_are_on_and_off():
    assert len(rebound(1.0, 1.4, derivatives=np.True_)) == 3
    assert rebound(1.0, 1.4, derivatives=np.False_) == rebound(1.0, 1.4)
    assert np.isfinite(EXACT.run(BARE, estimate_error=np.True_).psi2_error_estimate)
    assert law("tangential", "fronts", table=np.False_).table is False


def test_other_things_in_place_of_a_scene_have_a_remedy_of_their_own():
    with pytest.raises(ValueError, match=r"^scene = Encounter\(") as caught:
        Simulation().run(meeting())
    assert str(caught.value).endswith(
        ": must be a Scene; for bodies in space use collide(encounter, simulation), or "
        "encounter.scene"
    )
    result = Simulation().run(BARE)
    with pytest.raises(ValueError, match=r"^result = ImpactResult\(") as caught:
        contactlab.Collision.of(meeting(), result)
    assert str(caught.value).endswith(
        ": must be the result of encounter.scene; run that: simulation.run(encounter.scene)"
    )
    none = collide(meeting(normal=(0, 0, 1)), separating="pass")
    with pytest.raises(ValueError, match=r"^encounter = Encounter\(.*: no bodies met: all sep"):
        _ = none.result


def test_a_class_in_place_of_a_law_and_a_law_of_another_kind():
    springs = type(contactlab.create("tangential.springs"))
    installed = "names: contactlab plugins list"
    rule = "must be a name or a"
    with pytest.raises(ValueError, match=r"^tangential = <class ") as caught:
        law("tangential", springs)
    assert str(caught.value).endswith(
        f": {rule} tangential law; this is the class; make one: Springs()"
    )
    with pytest.raises(ValueError, match=f"tangential law; {installed}$"):
        law("tangential", contactlab.SteppedTangentialLaw)  # which nobody can make
    with pytest.raises(ValueError, match=r"^normal = Springs\(") as caught:
        law("normal", springs())
    assert str(caught.value).endswith(f": {rule} normal law; {installed}")
    with pytest.raises(ValueError, match=r"^normal = 3: ") as caught:
        law("normal", 3)
    assert str(caught.value).endswith(f": {rule} normal law; {installed}")


def test_the_first_default_that_is_not_blocked_is_taken(monkeypatch):
    def usual(**laws):
        made = Simulation(**laws)
        return [type(each).__name__ for each in (made.tangential, made.integrator)]

    def block(*names):
        monkeypatch.setenv("CONTACTLAB_BLOCK_PLUGINS", " ".join(names))

    assert usual() == ["Fronts", "Events"]
    block("tangential.fronts")
    assert usual() == ["Springs", "Symplectic"]
    alike = Simulation(normal="walton_braun")  # springs stand in for its law where W couples
    assert alike.plan(Scene.nondimensional(psi1=1.0, chi=1.0, lam=0.1, eta=0.1)).cautions
    block("tangential.fronts", "tangential.springs")
    assert usual() == ["Coulomb", "Events"]
    assert usual(normal="tsuji") == ["Annulus", "Symplectic"]
    block("integrator.symplectic")
    with pytest.raises(ValueError, match="events: runs laws of events, and springs"):
        usual(tangential="springs")
    block("integrator.symplectic", "integrator.events")
    with pytest.raises(ValueError, match=r"^integrator = None: ") as caught:
        usual()
    assert str(caught.value) == (
        "integrator = None: must be given: none of the defaults is installed; names: contactlab "
        "plugins list"
    )


def test_a_law_without_one_of_its_options_says_how_to_give_it(registry, install, law_source):
    source = law_source.replace("    def start", "    share: float\n    def start")
    install("needy", "needy_law", source, "tangential.mine")
    with pytest.raises(ValueError, match=" ") as caught:
        registry.create("tangential.mine")
    assert str(caught.value) == (
        "tangential.mine: share must be given; in Python create('tangential.mine', share=...), on "
        "the command line --set tangential.share=..."
    )
    assert registry.create("tangential.mine", share=3.0).share == 3.0


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        (
            "normal.springs",
            "no normal law 'springs' is installed; did you mean 'tangential.springs'",
        ),
        ("tangential.sprung", "no friction law 'sprung' is installed; did you mean 'springs'"),
        ("tangential.zzz", "no friction law 'zzz' is installed; all names"),
        ("nobody:tangential.zzz", "no friction law 'nobody:zzz' is installed; all names"),
        ("contactlap:tangential.zzz", "is installed; did you mean 'contactlab'"),
        ("nobody:normal.hertz", "is installed; write 'contactlab:normal.hertz'"),
    ],
)
def test_a_law_that_is_not_installed_has_a_hint(registry, name, hint):
    with pytest.raises(ValueError, match=re.escape(hint)):
        registry.create(name)


WITH_FRICTION = Scene.nondimensional(
    psi1=1.5, chi=1.4, lam=0.2, friction_coefficient=0.3, poisson_ratio=0.3
)


@one_scene
@pytest.mark.parametrize(
    ("other", "words"),
    [
        (3, "scenes.1. = 3: must be a Scene"),
        (None, "must be a Scene"),
        (BATCHES["planar"], "must be a single impact"),
        (BATCHES["mixed"], "must be a single impact"),
        (WITH_BODIES, "must have a sphere if, and only if"),
        (WITH_FRICTION, "must have a friction coefficient if"),
    ],
    ids=["3", "None", "batch", "mixed", "bodies", "friction"],
)
def test_sweeps_that_are_refused(scene, other, words):
    with pytest.raises(ValueError, match=words):
        EXACT.sweep([scene, other])
