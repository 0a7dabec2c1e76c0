"""A sweep on a cluster of dask: here two processes, elsewhere the machines of a computing centre.

    pip install "contactlab[dask,xarray]"

Writes ``sweep_on_a_cluster.png`` in the current folder. The scene is a grid, so that the answer
is an array with named axes, which xarray can draw. Of `LocalCluster` only the
name changes elsewhere: `dask_jobqueue.SLURMCluster`, say.
"""

import numpy as np
from dask.distributed import Client, LocalCluster

import contactlab


def main() -> None:
    grid = contactlab.Scene.grid(chi=[0.8, 1.0, 1.2, 1.4, 1.6], psi1=np.linspace(0.0, 6.0, 400))
    simulation = contactlab.Simulation(tangential="springs")
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        Client(cluster) as client,
    ):
        result = simulation.sweep(grid, executor=client.get_executor()).check()
    psi2 = result.to_xarray().psi2
    print(f"{len(result)} impacts by two processes")
    for chi in psi2.chi.values:
        least = psi2.sel(chi=chi).min()
        print(f"chi = {chi:.1f}: least psi2 = {float(least):.3f}")
    here = simulation.sweep(grid)
    psi2.plot.line(x="psi1")[0].figure.savefig("sweep_on_a_cluster.png")
    print(f"the same to the last bit as here: {np.array_equal(here.psi2, result.psi2)}")


if __name__ == "__main__":  # processes of the cluster import this file
    main()
