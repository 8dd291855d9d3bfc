"""A chart by Dask on Slurm. Workers are jobs, which start and end as the scheduler has room for them.

    python dask_slurm.py machine.toml c.zarr

Needs `pip install 'corner-impact[charts]' distributed dask-jobqueue`. If it was stopped, run it again and it continues.
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
    # One process per core. A job that reaches its time limit is replaced by a new one.
    cluster = SLURMCluster(cores=1, processes=1, memory="1GB", walltime="01:00:00", interface=None)
    with cluster, Client(cluster) as client:
        # `adapt`, not `scale`, so that lost jobs are replaced.
        cluster.adapt(maximum_jobs=workers)
        for done, total in fill(chart, store, client.get_executor(retries=10)):
            print(f"{done} of {total} blocks", flush=True)


if __name__ == "__main__":
    file, store, *numbers = sys.argv[1:]
    main(file, store, *map(int, numbers))
