"""Sweeps on a cluster of dask, two processes of this machine; and with other BLAS threads."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from contactlab import Scene, Simulation, SweepFolder, rebound
from tests.laws.ending_laws import Ending, Raising
from tests.runs.test_sweep import CHI, assert_same, blocks_of, scene


@pytest.fixture(scope="module")
def client():
    pytest.importorskip("dask.distributed", reason="needs the extra dask")
    from dask.distributed import Client, LocalCluster

    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        Client(cluster) as client,
    ):
        yield client


@pytest.fixture(scope="module")
def executor(client):
    return client.get_executor()


@pytest.mark.slow
def test_rebounds_of_dask_and_xarray_on_a_cluster(client):
    """Blocks are computed by the workers, each way of the guide."""
    dask_array, xarray = pytest.importorskip("dask.array"), pytest.importorskip("xarray")
    psi1 = dask_array.linspace(-6.0, 6.0, 100_000, chunks=25_000)
    expected = rebound(psi1.compute(scheduler="synchronous"), CHI)
    by_name = xarray.apply_ufunc(
        rebound, xarray.DataArray(psi1, dims="impact"), CHI,
        dask="parallelized", output_dtypes=[float],
    )  # fmt: skip
    for lazy in (
        rebound(psi1, CHI),
        dask_array.map_blocks(rebound, psi1, CHI, dtype=float),
        by_name.data,
        rebound(xarray.DataArray(psi1, dims="impact"), CHI).data,
    ):
        future = client.compute(lazy)
        assert np.array_equal(future.result(), expected)


@pytest.mark.slow
def test_a_folder_is_filled_by_a_cluster(executor, tmp_path):
    scenes = Scene.nondimensional(psi1=np.linspace(0.0, 6.0, 9000), chi=CHI)
    there = Simulation().sweep(scenes, executor=executor, into=tmp_path / "there", chunk=1).check()
    here = Simulation().sweep(scenes)
    assert there["psi2"].tobytes() == here.psi2.tobytes()


@pytest.mark.slow
def test_a_cluster_answers_as_one_process(executor):
    """Exactly, although dask gives its processes one BLAS thread each."""
    scenes = Scene.nondimensional(psi1=np.linspace(0.0, 6.0, 9000), chi=CHI)
    seen = []
    there = Simulation().sweep(scenes, executor=executor, progress=lambda *n: seen.append(n))
    assert seen[-1] == (9000, 9000)
    assert_same(there, Simulation().sweep(scenes))


@pytest.mark.slow
def test_failures_on_a_cluster(executor, monkeypatch, tmp_path):
    blocks_of(monkeypatch, 50)
    raising = Simulation(tangential=Raising(), integrator="symplectic")
    assert_same(raising.sweep(scene(), executor=executor), raising.sweep(scene()))
    ending = Simulation(tangential=Ending(folder=str(tmp_path), above=6.2), integrator="symplectic")
    result = ending.sweep(scene(), executor=executor)
    assert [status.name for status in result.status] == ["SUCCESS"] * 100 + ["WORKER_DIED"] * 50
    assert "KilledWorker" in result.failures[100]


PSI2 = """
import sys, numpy, contactlab
scene = contactlab.Scene.nondimensional(psi1=numpy.linspace(0.0, 6.0, 9000), chi=1.4411764706)
sys.stdout.buffer.write(contactlab.Simulation().sweep(scene).psi2.tobytes())
"""


@pytest.mark.slow
def test_the_exact_solution_does_not_depend_on_the_number_of_threads():
    found = []
    for threads in "12":
        environment = os.environ | {"OMP_NUM_THREADS": threads, "OPENBLAS_NUM_THREADS": threads}
        command = [sys.executable, "-c", PSI2]
        found.append(subprocess.run(command, env=environment, capture_output=True, check=True))
    assert len(found[0].stdout) == 9000 * 8
    assert found[0].stdout == found[1].stdout


BY_MPI = """
import sys
from mpi4py.futures import MPIPoolExecutor
from contactlab import Simulation
from tests.runs.test_sweep import scene
if __name__ == "__main__":
    with MPIPoolExecutor() as executor:
        by_springs = Simulation(tangential="springs")
        by_springs.sweep(scene(), executor=executor, into=sys.argv[1]).check()
"""


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("mpiexec") is None, reason="mpiexec is not installed")
def test_a_folder_is_filled_by_mpi(tmp_path):
    pytest.importorskip("mpi4py", reason="mpi4py is not installed")
    (tmp_path / "by_mpi.py").write_text(BY_MPI)
    roots = {f"{a}_ALLOW_RUN_AS_ROOT{b}": "1" for a in ("OMPI", "PRTE") for b in ("", "_CONFIRM")}
    more = {
        "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
        "PYTHONPATH": str(Path(__file__).parents[2]),
    }
    words = ["mpiexec", "-n", "2", sys.executable, "-m", "mpi4py.futures", tmp_path / "by_mpi.py"]
    subprocess.run([*words, tmp_path / "swept"], env=os.environ | roots | more, check=True)
    here = Simulation(tangential="springs").sweep(scene())
    assert SweepFolder(tmp_path / "swept")["psi2"].tobytes() == here.psi2.tobytes()
