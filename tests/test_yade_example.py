"""YADE with the kernel rebounds as contactlab does; run where YADE is installed."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[1] / "examples" / "yade"
PAGE = (FOLDER / "README.md").read_text("utf-8")


def test_the_page_lists_every_file():
    files = {path.name for path in FOLDER.iterdir() if path.is_file()} - {"README.md"}
    assert files == set(re.findall(r"^\| `(\w+\.py)` \|", PAGE, re.MULTILINE))


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("yade") is None, reason="YADE is not installed")
def test_impacts_in_yade():
    words = [sys.executable, FOLDER / "rebounds.py", "--angles", "4", "--springs", "0", "4", "8"]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    own, *kernel = [line.split() for line in done.stdout.splitlines()[1:]]
    assert own[:2] == ["none:", "YADE"]
    assert float(own[2]) > 0.3
    for row, bounds in zip(kernel, ((4, 0.1, 0.03), (8, 0.025, 0.007)), strict=True):
        springs, worst, rms, work = map(float, row)
        assert (springs, worst <= bounds[1], rms <= bounds[2]) == (bounds[0], True, True)
        assert work == pytest.approx(1.0, abs=0.005)


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("yade") is None, reason="YADE is not installed")
def test_damped_impacts_in_yade():
    words = [sys.executable, FOLDER / "rebounds.py", "--damped", "--steps", "200"]
    done = subprocess.run(
        [*words, "--springs", "8", "50"], capture_output=True, text=True, check=True
    )
    rows = [[float(cell) for cell in line.split()] for line in done.stdout.splitlines()[1:]]
    for (springs, worst, _, work), expected, bound in zip(
        rows, (8, 50), (0.015, 2e-3), strict=True
    ):
        assert (springs, worst <= bound) == (expected, True)
        assert work == pytest.approx(1.0, abs=0.005)
