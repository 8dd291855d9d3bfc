"""Charts as xarray datasets: computed here, lazily by Dask, or in a store that many machines fill together.

What is imported here comes with `pip install 'corner-impact[charts]'`. A store is read by `xarray.open_zarr`.
"""

from collections.abc import Generator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from importlib import import_module
from itertools import islice
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from corner_impact._native import Chart, blocks_done, chart_variables

__all__ = ["dataset", "fill", "lazy"]

AHEAD = 1000
"""Blocks that are handed to an executor before the first of them is done: more than any cluster here has workers."""


def dataset(chart: Chart, *, threads: int | None = None) -> xr.Dataset:
    """What one run comes to at each point of `chart`, computed now, on all cores or so many `threads`.

    Variables are two-dimensional, with the units and the meanings of codes as CF attributes.

    >>> from corner_impact import Chart, Model
    >>> chart = Chart(Model.paper(), {"restitution": [0.7, 0.8], "rpm": [660.0, 700.0]})
    >>> dataset(chart).sizes["rpm"]
    2
    >>> [round(float(rate), 9) for rate in dataset(chart).growth_rate.sel(rpm=700)]    # ln 0.7 and ln 0.8
    [-0.356674944, -0.223143551]
    """
    return _described(chart, dict(chart.compute(threads=threads)))


def lazy(chart: Chart, chunks: tuple[int, int] = (100, 100)) -> xr.Dataset:
    """The same, in Dask arrays of blocks with so many rows and columns, computed when they are asked for.

    Raises ValueError where a block has no rows or columns.
    """
    # Dask is only for those who ask for it, and says nothing of its types.
    array: Any = import_module("dask.array")
    delayed: Any = import_module("dask").delayed

    if min(chunks) < 1:
        raise ValueError(f"chunks = {chunks}: must be 1 or more")
    down, across = (
        [(low, min(low + side, size)) for low in range(0, size, side)] for size, side in zip(chart.shape, chunks)
    )
    # One task computes all variables of a block.
    blocks: Any = [[delayed(chart.compute, pure=True)(rows, columns, threads=1) for columns in across] for rows in down]

    def assembled(name: str, dtype: str) -> Any:
        def part(row: int, column: int) -> Any:
            shape = tuple(high - low for low, high in (down[row], across[column]))
            return array.from_delayed(blocks[row][column][name], shape, dtype=np.dtype(dtype))

        return array.block([[part(row, column) for column in range(len(across))] for row in range(len(down))])

    return _described(chart, {of["name"]: assembled(of["name"], of["dtype"]) for of in chart_variables()})


def _described(chart: Chart, arrays: dict[str, Any]) -> xr.Dataset:
    names, attributes = list(chart.axes), {of["name"]: of["attributes"] for of in chart_variables(chart)}
    coordinates = {name: (name, values, {"units": "rpm"} if name == "rpm" else {}) for name, values in chart.axes.items()}
    variables = {name: (names, values, attributes[name]) for name, values in arrays.items()}
    return xr.Dataset(variables, coordinates, chart.attributes)


def fill(
    chart: Chart,
    store: str | PathLike[str],
    executor: Executor | None = None,
    *,
    chunks: tuple[int, int] = (100, 100),
) -> Generator[tuple[int, int], None, None]:
    """Computes what the zarr store of `chart` lacks, and tells after each block how many are done, and of how many.

    Blocks have so many rows and columns, and should take a second or more each. They go to the workers of `executor`: a
    `ProcessPoolExecutor`, Dask's `client.get_executor()`, or whatever has that interface; every worker has to see the store's
    folder, and has no need of the model's file. Without one, all cores of this machine are used. What is done already is not
    done again, so that after an interruption the same line goes on; the bytes are the same however they came to be.

    Raises ValueError where the store is another chart's or can't be written, and whatever the executor raises for a worker
    that is lost.
    """
    # A worker may be in another folder.
    place = Path(store).absolute()
    chart.begin(place, chunks)
    done = blocks_done(place)
    missing, total, count = (int(block) for block in np.flatnonzero(~done)), done.size, int(done.sum())
    yield count, total
    if executor is None:
        for block in missing:
            chart.fill(place, block, chunks, threads=None)
            count += 1
            yield count, total
        return
    running: set[Future[bool]] = set()
    try:
        while True:
            more = islice(missing, AHEAD - len(running))
            running |= {executor.submit(chart.fill, place, block, chunks) for block in more}
            if not running:
                return
            finished, running = wait(running, return_when=FIRST_COMPLETED)
            for future in finished:
                future.result()
                count += 1
                yield count, total
    finally:
        for future in running:
            future.cancel()


