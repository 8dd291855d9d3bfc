"""A chart by processes of this machine, without Dask.

    python processes.py machine.toml c.zarr

Needs `pip install 'corner-impact[charts]'`.
"""

import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np

from corner_impact import Chart, Model
from corner_impact.charts import fill


def main(file: str, store: str, points: int = 1000, workers: int | None = None) -> None:
    axes = {"restitution": np.linspace(0.5, 0.95, points), "rpm": np.linspace(600, 760, points)}
    chart = Chart(Model.load(file), axes)
    # Workers are spawned, since a fork would copy locks that threads of this process hold.
    with ProcessPoolExecutor(workers, get_context("spawn")) as executor:
        for done, total in fill(chart, store, executor):
            print(f"{done} of {total} blocks", flush=True)


if __name__ == "__main__":
    file, store, *numbers = sys.argv[1:]
    main(file, store, *map(int, numbers))
