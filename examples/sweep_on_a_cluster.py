"""A sweep on a cluster of dask: here two processes, elsewhere the machines of a computing centre.

    pip install ".[dask,xarray]"

Writes ``sweep_on_a_cluster.png`` in the current folder. The scene is a grid, so that the answer
is an array with named axes. Of `LocalCluster` only the
name changes elsewhere: `dask_jobqueue.SLURMCluster`, say.
"""

from pathlib import Path
from typing import Any

import numpy as np
from dask.distributed import Client, LocalCluster
from matplotlib.axes import Axes

import contactlab
from contactlab.figures import name_curves, ordered_colours, save


def main() -> None:
    grid = contactlab.Scene.grid(chi=[0.8, 1.0, 1.2, 1.4, 1.6], psi1=np.linspace(0.0, 6.0, 400))
    simulation = contactlab.Simulation(tangential="springs")
    here: dict[str, Any] = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with (
        LocalCluster(**here) as cluster,
        Client(cluster) as client,
    ):
        result = simulation.sweep(grid, executor=client.get_executor()).check()
    psi2 = result.to_xarray().psi2
    print(f"{len(result)} impacts by two processes")
    for chi in psi2.chi.values:
        least = psi2.sel(chi=chi).min()
        print(f"chi = {chi:.1f}: least psi2 = {float(least):.3f}")
    alone = simulation.sweep(grid)

    def draw(axes: Axes) -> None:
        """Draw psi2 over psi1, each curve with its chi."""
        lines = []
        for chi, colour in zip(psi2.chi.values, ordered_colours(len(psi2.chi)), strict=True):
            lines += axes.plot(psi2.psi1, psi2.sel(chi=chi), color=colour)
        axes.set(
            xlabel=r"local angle of incidence $\psi_1$",
            ylabel=r"local angle of reflexion $\psi_2$",
            xlim=(0.0, 6.0),
        )
        axes.axhline(0.0, color="grey", lw=0.8, zorder=0)
        name_curves(axes, lines, [f"{chi:.1f}" for chi in psi2.chi.values])
        axes.text(0.03, 0.04, "at each curve: inertia ratio $\\chi$", transform=axes.transAxes)

    save(Path("sweep_on_a_cluster.png"), draw)
    print(f"the same to the last bit as here: {np.array_equal(alone.psi2, result.psi2)}")


if __name__ == "__main__":  # processes of the cluster import this file
    main()
