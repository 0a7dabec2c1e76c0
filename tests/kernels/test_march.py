"""The march of springs in C under sanitizers; its answers are tested with the laws."""

import subprocess

import pytest

from tests.kernels.test_kernels import COMPILER, HERE, KERNELS, SANITIZERS, STRICT, needs_c

pytestmark = needs_c
LANGUAGES = {"c99": [*STRICT, "-O3", *SANITIZERS], "c++": [*STRICT[1:], "-x", "c++", "-std=c++11"]}


def marched(folder, language, count, seed):
    """Return statuses of random scenes, done ones without numbers, gain of energy, and books."""
    words = [COMPILER, *LANGUAGES[language], f"-I{KERNELS}", HERE / "march.c", "-o"]
    subprocess.run([*words, folder / "march", "-lm"], check=True, timeout=120)
    done = subprocess.run(
        [folder / "march", str(count), str(seed)],
        check=True, timeout=3000, capture_output=True, text=True,
    )  # fmt: skip
    *ended, wrong, gain, books = done.stdout.split()
    return [int(each) for each in ended], int(wrong), float(gain), float(books)


@pytest.mark.slow
@pytest.mark.parametrize(("language", "count"), [("c99", 20_000), ("c++", 5_000)])
def test_extreme_scenes_end_with_a_status(tmp_path, language, count):
    """Half of them have numbers that no bodies have: none is undefined, or done without numbers."""
    (done, late, lost, deep, refused), wrong, gain, books = marched(tmp_path, language, count, 7)
    assert done + late + lost + deep + refused == count
    assert min(done, late, lost, refused) > 0.01 * count
    assert wrong == 0
    assert gain < 1e-3  # by steps, 60 to an approach
    assert books < 0.1  # by as few as 2 springs
