"""A chart by Dask on Slurm: workers come as jobs and go as the scheduler has room for them.

    python dask_slurm.py machine.toml c.zarr

It needs `pip install 'corner-impact[charts]' distributed dask-jobqueue`. Run it again after it was stopped, and it goes on.
"""

import sys

import numpy as np
from dask_jobqueue import SLURMCluster
from distributed import Client

from corner_impact import Chart, Model
from corner_impact.charts import fill


def main(file: str, store: str, points: int = 1000, workers: int = 16) -> None:
    axes = {"restitution": np.linspace(0.5, 0.95, points), "rpm": np.linspace(600, 760, points)}
    chart = Chart(Model.load(file), axes)
    # A process for each core; a job that ends in time is begun anew.
    cluster = SLURMCluster(cores=1, processes=1, memory="1GB", walltime="01:00:00", interface=None)
    with cluster, Client(cluster) as client:
        # By `adapt`, not by `scale`: jobs that were lost come again.
        cluster.adapt(maximum_jobs=workers)
        for done, total in fill(chart, store, client.get_executor(retries=10)):
            print(f"{done} of {total} blocks", flush=True)


if __name__ == "__main__":
    file, store, *numbers = sys.argv[1:]
    main(file, store, *map(int, numbers))
