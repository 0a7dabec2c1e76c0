"""Bad input by the thousand: a ValueError that names the argument, or an answer; nothing else.

``CONTACTLAB_EXAMPLES=5000 pytest tests`` is the long run; it prints what it tried.
"""

from __future__ import annotations

import inspect
import random
import re
import tempfile
from pathlib import Path

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

import contactlab
from contactlab import HalfSpace, Material, PluginError, Scene, Simulation, Sphere
from contactlab.registry.registry import REGISTRY
from tests.every_method import every_method

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))
#: chi above which the oscillations of one impact are counted in the hundreds.
SLOW = 1e3
FOLDER = Path(tempfile.mkdtemp(prefix="contactlab"))
METHODS = every_method()
CHEAP = {"annuli": 5, "springs": 5, "steps": 20}

TRIED: dict[str, int] = {}

extreme = st.sampled_from(
    [0.0, -0.0, 1.0, -1.0, 0.5, -0.5, 5e-324, 1e-308, 1e-165, 1e-12, 1e12, 1e165, 1e308, np.inf,
     -np.inf, np.nan, True, None, "1", b"1", 1j, [], [1.0], (), {}, object(), np.array([1.0, 2.0]),
     np.array([np.nan]), np.float32(0.3), np.int64(3), np.array("x"), np.array(None), 10**400]
)  # fmt: skip
anything = st.one_of(
    extreme, st.floats(), st.integers(), st.text(max_size=5), st.lists(st.floats(), max_size=3)
)
#: Numbers over the whole range of what may be physical, and a little beyond.
numbers = st.one_of(
    st.floats(allow_nan=False, allow_infinity=False),
    st.builds(lambda m, e: m * 10.0**e, st.floats(1.0, 10.0), st.integers(-300, 300)),
    st.builds(lambda m, e: m * 10.0**e, st.floats(1.0, 10.0), st.integers(-12, 12)),
)


def tried(what: str) -> None:
    """Count one input, for the summary of the run."""
    TRIED[what] = TRIED.get(what, 0) + 1


def named(error: BaseException, names) -> None:
    """Assert that the message names one of the arguments."""
    message = str(error)
    assert any(re.search(rf"\b{re.escape(name)}\b", message) for name in names), message


def answered(result) -> None:
    """Assert that every success is made of numbers."""
    statuses = np.ravel(np.asarray(result.status, dtype=object))
    motion = result.motion
    for name in ("duration", "normal_velocity", "slip_velocity_change", "friction_work"):
        values = np.broadcast_to(np.ravel(np.asarray(getattr(motion, name))), statuses.shape)
        for status, value in zip(statuses, values, strict=True):
            assert not status or np.isfinite(value), f"{status.name} with {name} = {value}"


def refused(make, names):
    """Return what ``make`` makes, or None if it refuses as it should."""
    try:
        with np.errstate(all="ignore"):  # arrays that overflow on the way to a refusal
            return make()
    except (ValueError, PluginError) as error:
        named(error, names)
        return None


MATERIAL = ("shear_modulus", "young_modulus", "poisson_ratio", "density")
SPHERE = ("radius", "material", "mass", "gyration_ratio")
SCENE = ("sphere", "target", "friction_coefficient", "normal_speed", "tangential_velocity", "spin")
PAIR = ("radius", "effective_modulus", "effective_shear_modulus", "normal_mass", "tangential_mass")
KNOWN = Material(shear_modulus=80e9, poisson_ratio=0.3, density=7850.0)


@given(st.data())
def test_materials(data):
    tried("materials")
    values = {name: data.draw(anything) for name in MATERIAL if data.draw(st.booleans())}
    values.setdefault("poisson_ratio", 0.3)
    refused(lambda: Material(**values), MATERIAL)


@given(st.data())
def test_spheres(data):
    tried("spheres")
    values = {name: data.draw(anything) for name in SPHERE if data.draw(st.booleans())}
    values.setdefault("radius", 0.01)
    values.setdefault("material", KNOWN)
    refused(lambda: Sphere(**values), SPHERE)


@given(st.data())
def test_scenes_of_anything(data):
    tried("scenes of anything")
    values = {name: data.draw(anything) for name in SCENE if data.draw(st.booleans())}
    values = {
        "sphere": Sphere(0.01, KNOWN), "target": HalfSpace(KNOWN), "friction_coefficient": 0.2,
        "normal_speed": 1.0, "tangential_velocity": 0.1, **values,
    }  # fmt: skip
    scene = refused(lambda: Scene(**values), (*SCENE, *SPHERE, *PAIR, "Scene"))
    if scene is not None:
        with np.errstate(all="ignore"):
            answered(Simulation().run(scene))


@given(anything, anything)
def test_scenes_of_the_paper_of_anything(psi1, chi):
    tried("psi1 and chi of anything")
    scene = refused(
        lambda: Scene.nondimensional(psi1=psi1, chi=chi), ("psi1", "chi", "Scene", *PAIR)
    )
    # Above, the exact solution takes seconds before it gives up.
    with np.errstate(all="ignore"):
        if scene is not None and np.size(scene.psi1) < 10 and np.max(scene.chi) < SLOW:
            answered(Simulation().run(scene))


@given(numbers, numbers, numbers, numbers, numbers, st.sampled_from(METHODS))
def test_scenes_of_numbers(radius, speed, friction, slip, modulus, method):
    """Any method on scenes over the whole range of floats: an answer, a refusal, a status."""
    tried("scenes of numbers")
    scene = refused(
        lambda: Scene(
            Sphere(abs(radius), Material(shear_modulus=abs(modulus), poisson_ratio=0.3,
                                         density=7850.0)),
            HalfSpace(KNOWN), abs(friction), abs(speed), slip,
        ),
        (*SCENE, *SPHERE, *MATERIAL, *PAIR),
    )  # fmt: skip
    if scene is None or method.integrator == "adaptive":
        return
    simulation = method.simulation(cheap(method))
    with np.errstate(all="ignore"):
        answered(simulation.run(scene))


def cheap(method):
    options = {"tangential": {}, "integrator": {}}
    for kind, name in (("tangential", method.tangential), ("integrator", method.integrator)):
        word = REGISTRY.law_class(f"{kind}.{name}").resolution
        if word in CHEAP:
            options[kind][word] = CHEAP[word]
    return options


@given(st.data())
def test_options_of_laws(data):
    tried("options")
    name = data.draw(st.sampled_from(REGISTRY.names()))
    known = list(inspect.signature(REGISTRY.law_class(name)).parameters)
    option = data.draw(st.sampled_from([*known, "nonsense"]))
    value = data.draw(anything)
    refused(lambda: contactlab.create(name, **{option: value}), [option])


def mutated(text: str, seed: int) -> str:
    """Return a scene file with a few characters, numbers or lines changed."""
    dice = random.Random(seed)
    for _ in range(dice.randint(1, 4)):
        lines = text.split("\n")
        place = dice.randrange(len(lines))
        kind = dice.randrange(7)
        if kind == 0:
            del lines[place]
        elif kind == 1:
            lines.insert(place, lines[dice.randrange(len(lines))])
        elif kind == 2:
            bad = ["nan", "inf", "-1", "0", "1e400", "'x'", "[]", "[1, 2]", "{}", "true", "1e-320"]
            lines[place] = re.sub(r"=.*", f"= {dice.choice(bad)}", lines[place])
        elif kind == 3 and lines[place]:
            spot = dice.randrange(len(lines[place]))
            lines[place] = lines[place][:spot] + chr(dice.randrange(1, 300)) + lines[place][spot:]
        elif kind == 4 and lines[place]:
            spot = dice.randrange(len(lines[place]))
            lines[place] = lines[place][:spot] + lines[place][spot + 1 :]
        elif kind == 5:
            lines[place] = lines[place].replace("=", ".x =", 1)
        else:
            lines[place] = re.sub(r"^\[(\w+)", "[nonsense", lines[place])
        text = "\n".join(lines)
    return text


@given(st.sampled_from(EXAMPLES), st.integers(0, 2**63))
def test_mutated_scene_files(path, seed):
    """The file is named; laws that cannot be made or do not fit are named themselves."""
    tried("scene files")
    text = mutated(path.read_text(encoding="utf-8"), seed)
    file = FOLDER / "mutated.toml"
    file.write_text(text, encoding="utf-8")
    try:
        read = contactlab.read_scene(file)
    except (ValueError, PluginError) as error:
        assert file.name in str(error)  # noqa: PT017
        return
    try:
        read.laws.simulation()
    except (ValueError, PluginError) as error:
        assert re.search(r"\b(normal|tangential|integrator)\b", str(error))  # noqa: PT017
