"""A chart by Dask on the cores of this machine.

    python dask_here.py machine.toml c.zarr

Needs `pip install 'corner-impact[charts]' distributed`. To use an existing cluster, replace the client by `Client("tcp://…")`.
"""

import sys

import numpy as np
from distributed import Client, LocalCluster

from corner_impact import Chart, Model
from corner_impact.charts import fill


def main(file: str, store: str, points: int = 1000, workers: int | None = None) -> None:
    axes = {"restitution": np.linspace(0.5, 0.95, points), "rpm": np.linspace(600, 760, points)}
    chart = Chart(Model.load(file), axes)
    with LocalCluster(n_workers=workers, threads_per_worker=1) as cluster, Client(cluster) as client:
        for done, total in fill(chart, store, client.get_executor(retries=3)):
            print(f"{done} of {total} blocks", flush=True)


if __name__ == "__main__":
    file, store, *numbers = sys.argv[1:]
    main(file, store, *map(int, numbers))
