"""The kernels in C and JavaScript answer as the law in Python does, along the same motions."""

import functools
import itertools
import json
import shutil
import subprocess
from importlib import resources
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import contactlab
from tests.kernels.motions import by_the_law, by_vectors, sliding, wandering, write
from tests.longer import longer

HERE = Path(__file__).parent
KERNELS = Path(str(resources.files("contactlab").joinpath("kernels")))
STRICT = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-O2"]
SANITIZERS = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-g"]
COMPILER = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
NODE = shutil.which("node")
needs_c = pytest.mark.skipif(COMPILER is None, reason="no C compiler (cc, gcc, clang) is there")
needs_node = pytest.mark.skipif(NODE is None, reason="node is not there")


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """Return a function that compiles the driver with flags, once for each set of flags."""
    folder, made = tmp_path_factory.mktemp("kernel"), {}

    def build(*flags):
        if flags not in made:
            made[flags] = folder / f"drive{len(made)}"
            words = [COMPILER, *STRICT, *flags, f"-I{KERNELS}", str(HERE / "drive.c")]
            subprocess.run([*words, "-o", str(made[flags]), "-lm"], check=True, timeout=120)
        return made[flags]

    return build


def program(name, language, folder):
    """Return the program of a C file beside the tests, sanitized as C99, or built as C++."""
    strict = [*STRICT, "-O0", *SANITIZERS] if language == "c99" else ["-x", "c++"]
    source = [f"-I{KERNELS}", HERE / f"{name}.c", "-o", folder / name, "-lm"]
    subprocess.run([COMPILER, *strict, *source], check=True, timeout=120)
    return folder / name


def driven(words, folder, springs, rows, **lengths):
    """Return forces and works, shape (K, 4), that a driver writes."""
    write(folder / "in", springs, rows, **lengths)
    subprocess.run([*words, folder / "in", folder / "out"], check=True, timeout=120)
    return np.fromfile(folder / "out").reshape(-1, 4)


def driven_each(words, folder, springs, motions):
    """Return the answers along several motions, which a row without contact parts, in one call."""
    apart = np.zeros((1, motions[0].shape[1]))
    apart[0, 5] = 1.0
    found = driven(
        words, folder, springs, np.vstack([x for each in motions for x in (each, apart)])
    )
    ends = itertools.accumulate(len(each) + 1 for each in motions)
    return [found[end - 1 - len(each) : end - 1] for each, end in zip(motions, ends, strict=True)]


@pytest.fixture(params=[pytest.param("c", marks=needs_c), pytest.param("js", marks=needs_node)])
def words(request, built):
    """Return the command of each driver."""
    if request.param == "c":
        return [built()]
    return [NODE, HERE / "drive.mjs", KERNELS / "contactlab_springs.mjs"]


@functools.cache
def along_lines(springs):
    """Return four motions along a line, their directions, and what the law in Python answers."""
    motions, directions, sizes = zip(*map(sliding, range(4)), strict=True)
    laws = [by_the_law(springs, *each) for each in zip(motions, sizes, strict=True)]
    return motions, directions, laws


@functools.cache
def in_space(springs):
    """Return four motions with turning normals, and the forces by the rules for vectors."""
    motions = [wandering(seed) for seed in range(4)]
    return motions, [by_vectors(springs, rows) for rows in motions]


@pytest.mark.parametrize(
    "springs", [pytest.param(n, marks=[pytest.mark.slow] * (n < 16)) for n in (2, 4, 8, 16)]
)
def test_along_a_line_it_is_the_law_in_python(words, springs, tmp_path):
    """Through doublings, zero normal force, separation and contact again: 1e-12."""
    motions, directions, laws = along_lines(springs)
    answers = driven_each(words, tmp_path, springs, motions)
    for rows, along, law, found in zip(motions, directions, laws, answers, strict=True):
        largest = np.abs(law).max(axis=0)
        assert (law[rows[:, 6] > 0.0, 0] != 0.0).mean() > 0.9
        assert np.abs(found[:, :3] @ along + law[:, 0]).max() <= 1e-12 * largest[0]
        assert np.abs(found[:, 3] - law[:, 1]).max() <= 1e-12 * largest[1]
        for part in (slice(0, 100), slice(200, 220)):
            assert found[part, :3] @ along == pytest.approx(-law[part, 0], rel=1e-9, abs=1e-300)


def held_by_the_rules(rows, expected, found):
    """Hold that forces are those of the rules, within the limit, and work; return their lengths."""
    assert np.abs(found[:, :3] - expected).max() <= 1e-12 * np.abs(expected).max()
    length = np.linalg.norm(found[:, :3], axis=1)
    assert (length <= rows[:, 7] * (1.0 + 1e-12)).all()
    assert (found[:, 3] >= 0.0).all()
    return length


@pytest.mark.parametrize("springs", [*longer(4), 8])
def test_with_turning_normals_it_is_the_rules_for_vectors(words, springs, tmp_path):
    motions, forces = in_space(springs)
    answers = driven_each(words, tmp_path, springs, motions)
    for rows, expected, found in zip(motions, forces, answers, strict=True):
        length = held_by_the_rules(rows, expected, found)
        across = np.abs(np.einsum("ki,ki->k", found[:, :3], rows[:, 3:6]))
        assert (across <= 1e-12 * length.max()).all()


def test_a_turned_frame_turns_the_force(words, tmp_path):
    rows = wandering(7)
    turn, _ = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))
    turned = rows.copy()
    turned[:, :3], turned[:, 3:6] = rows[:, :3] @ turn, -rows[:, 3:6] @ turn  # either sense
    first, second = (each[:, :3] for each in driven_each(words, tmp_path, 8, [rows, turned]))
    assert np.abs(first @ turn - second).max() <= 1e-12 * np.abs(first).max()


def test_what_is_not_finite_is_nan_until_the_contact_ends(words, tmp_path):
    """A displacement, a normal, a radius or a limit; each in a motion of its own."""
    rows, _, _ = sliding(1)
    rows[90:100, 6] = rows[89, 6]  # in contact; it ends at 100
    motions = [rows]
    for spoilt, value in itertools.product((0, 2, 4, 6, 7), (np.nan, np.inf)):
        motions.append(rows.copy())
        motions[-1][95, spoilt] = value
    clean, *answers = driven_each(words, tmp_path, 8, motions)
    assert np.isfinite(clean).all()
    for found in answers:
        assert (found[:95] == clean[:95]).all()
        assert np.isnan(found[95:100]).all()
        assert (found[101:] == clean[101:]).all()
        assert (found[100, :3] == 0.0).all()


@pytest.mark.parametrize("across", [0.0, np.pi / 2.0])
def test_a_turn_of_the_normal_keeps_the_force(words, across, tmp_path):
    """A held contact turned by 90 degrees in nine steps, along the force and across."""
    angle = np.linspace(0.0, np.pi / 2.0, 10)
    rows = np.zeros((11, 8))
    rows[:, 6:] = 0.1, 1.0
    rows[0, :3] = 0.0, 1e-6 * np.sin(across), 1e-6 * np.cos(across)
    rows[:, 3:6] = [(np.cos(each), 0.0, np.sin(each)) for each in (0.0, *angle)]
    rows[:, 3:6] *= 1.0 if across else -1.0  # either sense
    force = driven(words, tmp_path, 8, rows)[:, :3]
    turned = [(-np.sin(each), 0.0, np.cos(each)) for each in angle]
    expected = np.outer(np.ones(10), force[0]) if across else force[0, 2] * np.array(turned)
    assert np.abs(force[0]).max() > 1e-3
    assert np.abs(force[1:] - expected).max() <= 1e-12 * np.abs(force[0]).max()


@pytest.mark.parametrize(
    ("column", "value"), [("unit", 0.0), ("unit", -0.7), ("unit", np.inf), ("unit", 5e-324),
                          ("modulus", 0.0), ("modulus", -1.0), ("limit", -1e-3), ("springs", 7),
                          *longer(("unit", np.nan), ("modulus", np.nan))]
)  # fmt: skip
def test_what_is_no_contact_is_nan_or_refused(words, column, value, tmp_path):
    rows, _, _ = sliding(1, 101)
    springs, lengths = 8, {}
    if column == "limit":
        rows[:, 7] = value
    elif column == "springs":
        springs = value
    else:
        lengths = {column: value}
    if column == "springs" and words[0] == NODE:
        with pytest.raises(subprocess.CalledProcessError):
            driven(words, tmp_path, springs, rows)
    else:
        assert np.isnan(driven(words, tmp_path, springs, rows, **lengths)[:100]).all()


POOL = """
import {{stateLength, step}} from {kernel};
const length = stateLength(4), normal = [0, 0, 1], force = [0, 0, 0];
const pool = new Float64Array(3 * length).fill(7), list = Array(length).fill(0), forces = [];
const take = (state, radius) => {{
  step(state, 4, [1e-6, 2e-6, 0], normal, radius, 1, 0.7, 3e4, force);
  forces.push([...force]);
}};
pool.fill(0, length, 2 * length);
for (const radius of [0.1, 0.11, 0]) {{
  take(pool.subarray(length), radius);  // the view holds the neighbour too
  take(list, radius);
}}
const told = [];
const wrong = [[[], 4], [new Float64Array(13), 4], [list, 3], [list, 0], [list, undefined]];
for (const [state, n] of wrong) {{
  try {{ step(state, n, [0, 0, 0], normal, 0.1, 1, 0.7, 3e4, force); }}
  catch (error) {{ told.push(error.message); }}
}}
console.log(JSON.stringify({{pool: [...pool], forces, told}}));
"""


def answered(script, folder):
    """Return what a script for node prints, read as JSON."""
    (folder / "script.mjs").write_text(script, "utf-8")
    words = [NODE, folder / "script.mjs"]
    run = subprocess.run(words, check=True, timeout=60, capture_output=True, text=True)
    return json.loads(run.stdout)


@needs_node
def test_a_state_in_a_pool_leaves_its_neighbours_alone(tmp_path):
    kernel = json.dumps((KERNELS / "contactlab_springs.mjs").as_uri())
    answer = answered(POOL.format(kernel=kernel), tmp_path)
    assert answer["pool"] == [7] * 14 + [0] * 14 + [7] * 14
    assert answer["forces"][::2] == answer["forces"][1::2]  # a plain Array serves as well
    assert answer["forces"][0] != [0, 0, 0]
    assert len(answer["told"]) == 5
    assert all("must be even" in each and "state hold" in each for each in answer["told"])


SPINNING = """
import {{stateLength, step}} from {kernel};
const n = 4, state = new Float64Array(stateLength(n)), force = [0, 0, 0], normal = [0.6, 0, 0.8];
const spin = [3, 9, 1], otherSpin = [1, -4, 5], time = 0.1;
step(state, n, [1e-6 * 0.8, 2e-6, -1e-6 * 0.6], normal, 0.1, 1, 0.7, 3e4, force);
const first = [...force];
{lines}
step(state, n, [0, 0, 0], normal, 0.1, 1, 0.7, 3e4, force);
console.log(JSON.stringify([first, force]));
"""


@needs_node
def test_what_the_notes_say_of_spin_about_the_normal(tmp_path):
    """Two bodies that spin about the normal together take the force along."""
    notes = (KERNELS / "README.md").read_text("utf-8")
    lines = notes[notes.index("    const about") : notes.index("### Where the")]
    kernel = json.dumps((KERNELS / "contactlab_springs.mjs").as_uri())
    first, second = answered(SPINNING.format(kernel=kernel, lines=lines), tmp_path)
    normal = np.array([0.6, 0.0, 0.8])
    turn = Rotation.from_rotvec(0.1 * 0.5 * (np.array([4.0, 5.0, 6.0]) @ normal) * normal)
    assert turn.apply(first) == pytest.approx(second, abs=1e-12 * np.abs(first).max())
    assert np.linalg.norm(np.subtract(first, second)) > 0.2 * np.linalg.norm(first)


@pytest.mark.slow
@needs_c
def test_no_undefined_behaviour(built, tmp_path):
    """The sanitizers stop the program at the first read or write out of the state, or overflow."""
    rows = wandering(3)
    rows[300, 6:] = 5e-324, 1.0  # the least radius there is, and the largest
    rows[301, 6:] = 1e300, 1.0
    rows[302, 6:] = 1e-300, 0.0
    rows[310:320, 7] = np.nan
    rows[330, 6] = np.inf
    rows[340, 6] = -1.0
    words = [built(*SANITIZERS)]
    plain = driven([built()], tmp_path, 8, rows)
    assert np.array_equal(driven(words, tmp_path, 8, rows), plain, equal_nan=True)
    assert np.isfinite(plain[360:]).all()


@needs_c
def test_single_precision(built, tmp_path):
    rows = wandering(2)
    double = driven([built()], tmp_path, 8, rows)
    single = driven([built("-DCONTACTLAB_REAL=float")], tmp_path, 8, rows)
    gap = np.linalg.norm(single[:, :3] - double[:, :3], axis=1)
    assert gap.max() <= 1e-4 * np.linalg.norm(double[:, :3], axis=1).max()
    assert gap.max() > 0.0


@needs_c
def test_it_is_c_plus_plus_too(tmp_path):
    compiler = shutil.which("c++") or shutil.which("g++")
    if compiler is None:
        pytest.skip("no C++ compiler (c++, g++) is there")
    source = tmp_path / "use.cpp"
    include = "".join(
        f'#include "contactlab_{name}.h"\n' for name in ("springs", "bounce", "impact")
    )
    source.write_text(include + "int main() { return 0; }\n")
    words = [compiler, "-std=c++11", "-Wall", "-Wextra", "-pedantic", "-Werror", f"-I{KERNELS}"]
    subprocess.run([*words, "-Wno-unused-function", "-c", source, "-o", tmp_path / "use.o"],
                   check=True, timeout=120)  # fmt: skip


@needs_node
@pytest.mark.parametrize(
    ("psi1", "chi"), [(0.5, 1.18), *longer((1.2, 49.0 / 34.0), (3.0, 1.75)), (8.0, 1.44)]
)  # fmt: skip
def test_one_impact_in_javascript(psi1, chi):
    words = [NODE, HERE / "drive.mjs", KERNELS / "contactlab_bounce.mjs", "impact"]
    numbers = [str(number) for number in (psi1, chi, 120, 600)]
    run = subprocess.run([*words, *numbers], check=True, timeout=60, capture_output=True, text=True)
    motion = json.loads(run.stdout)
    assert motion["psi2"] == pytest.approx(contactlab.rebound(psi1, chi), abs=2e-3)
    assert len(motion["time"]) == len(motion["force"]) == len(motion["limit"]) == 601
    force, limit = np.array(motion["force"]), np.array(motion["limit"])
    assert (np.abs(force) <= limit * (1.0 + 1e-12)).all()
    assert (motion["time"][0], motion["time"][-1]) == (0.0, 1.0)
    states = np.array(motion["states"])
    assert states.shape == (600, 120)
    assert set(np.unique(states)) <= {0, 1, 2, 3}
    if psi1 >= 4.0 * chi - 1.0:  # it slips throughout
        assert not (states == 1).any()
