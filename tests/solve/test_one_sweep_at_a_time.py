"""A folder is of one sweep at a time, and what a killed one left there goes."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from contactlab import Simulation
from tests.full_disk import full_disk
from tests.runs.test_into import stopped
from tests.runs.test_sweep import RIGID, blocks_of, scene

both = pytest.mark.parametrize("argument", ["keep", "into"])


@pytest.fixture(autouse=True)
def blocks(monkeypatch):
    blocks_of(monkeypatch, 40)


def sweep(argument, folder, **options):
    return Simulation(**RIGID).sweep(scene(), **{argument: folder}, chunk=40, **options)


@both
def test_what_a_killed_sweep_left_goes_and_other_files_stay(tmp_path, argument):
    folder = tmp_path / "swept"
    sweep(argument, folder, progress=stopped(80), return_partial=True)
    for name in (".contactlab-0123456789ab.part", ".mine"):
        (folder / name).write_bytes(b"half of a chunk")
    sweep(argument, folder).check()
    assert not [*folder.glob("*.part")]
    assert (folder / ".mine").read_bytes() == b"half of a chunk"


@both
def test_a_second_sweep_in_a_folder_is_told(tmp_path, argument):
    folder, told = tmp_path / "swept", []

    def again(done, total):
        with pytest.raises(ValueError, match=rf"{argument} = .*: is in use .*; wait") as error:
            sweep(argument, folder)
        told.append(str(error.value))

    sweep(argument, folder, progress=again).check()
    assert len(told) == 4
    sweep(argument, folder).check()  # it is free again


@both
def test_a_disk_that_is_full_before_the_first_chunk_leaves_a_folder_to_begin_in(
    tmp_path, monkeypatch, argument
):
    folder = tmp_path / "swept"
    with monkeypatch.context() as patched:
        full_disk(patched)
        with pytest.raises(OSError, match="No space left on device"):
            sweep(argument, folder)
    sweep(argument, folder).check()


HOLDING = """
import sys, time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from contactlab import Simulation
from tests.runs.test_sweep import RIGID, scene
from tests.laws.ending_laws import Waiting

def wait(done, total):
    print(done, flush=True)
    time.sleep(600.0)

argument, folder, method, pids = sys.argv[1:]
if method == "none":
    Simulation(**RIGID).sweep(scene(), **{argument: folder}, progress=wait)
else:  # forked processes outlive a parent that is killed
    law = Waiting(folder=pids)
    with ProcessPoolExecutor(1, mp_context=get_context(method)) as pool:
        Simulation(tangential=law).sweep(scene(), **{argument: folder}, executor=pool)
"""


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
@pytest.mark.parametrize("method", ["none", "fork"])
@both
def test_a_killed_process_leaves_no_lock(tmp_path, monkeypatch, argument, method):
    monkeypatch.undo()  # the program has blocks of the usual size
    folder, pids = tmp_path / "swept", tmp_path / "pids"
    pids.mkdir()
    program = tmp_path / "holding.py"
    program.write_text(HOLDING)
    running = subprocess.Popen(
        [sys.executable, program, argument, folder, method, pids],
        stdout=subprocess.PIPE,
        env=os.environ | {"PYTHONPATH": str(Path(__file__).parents[2])},
        start_new_session=True,
    )
    try:
        assert running.stdout.readline()  # of the progress, or printed by the law
        options = RIGID if method == "none" else {"tangential": "coulomb"}
        with pytest.raises(ValueError, match="is in use by another sweep"):
            Simulation(**options).sweep(scene(), **{argument: folder})
        running.kill()
        running.wait(timeout=60)
        if method == "none":
            Simulation(**RIGID).sweep(scene(), **{argument: folder}).check()
        else:  # of another law, and free
            with pytest.raises(ValueError, match="holds another sweep: tangential was"):
                sweep(argument, folder)
    finally:
        running.kill()
        for pid in pids.iterdir():  # it has outlived its parent
            os.kill(int(pid.name), signal.SIGKILL)
        running.communicate()
