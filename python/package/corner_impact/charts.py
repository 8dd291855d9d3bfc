"""Charts as xarray datasets: computed here, lazily by Dask, or in a zarr store that many machines fill together.

`pip install 'corner-impact[charts]'` installs the packages for them. `xarray.open_zarr` reads a store.
"""

from collections.abc import Generator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from itertools import islice
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from corner_impact._extras import need
from corner_impact._native import Chart, blocks_done, chart_variables
from corner_impact.results import described

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["dataset", "fill", "lazy"]

AHEAD = 1000
"""Largest number of blocks that are submitted to an executor at once."""


def dataset(chart: Chart, *, threads: int | None = None) -> "xr.Dataset":
    """Compute `chart` on all cores or on `threads` threads, and return it as a dataset.

    Variables have the shape of the chart, with units and the meanings of codes as CF attributes. Raises ImportError without xarray.

    >>> from corner_impact import Chart, Model
    >>> chart = Chart(Model.paper(), {"restitution": [0.7, 0.8], "rpm": [660.0, 700.0]})
    >>> dataset(chart).sizes["rpm"]
    2
    >>> [round(float(rate), 9) for rate in dataset(chart).growth_rate.sel(rpm=700)]    # ln 0.7 and ln 0.8
    [-0.356674944, -0.223143551]
    """
    return chart.compute(threads=threads).to_xarray()


def lazy(chart: Chart, chunks: tuple[int, int] = (100, 100)) -> "xr.Dataset":
    """Return `chart` as a dataset of Dask arrays in blocks of `chunks` (rows, columns). Each block is computed when it is needed.

    Raises ValueError if a block has no rows or columns, and ImportError without Dask.
    """
    # Dask has no types.
    array, delayed = need("dask.array", "charts"), need("dask", "charts").delayed
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

    return described(chart, chart.axes, {of["name"]: assembled(of["name"], of["dtype"]) for of in chart_variables()})


def fill(
    chart: Chart,
    store: str | PathLike[str],
    executor: Executor | None = None,
    *,
    chunks: tuple[int, int] = (100, 100),
) -> Generator[tuple[int, int], None, None]:
    """Compute the missing blocks of the zarr store of `chart`, and yield after each block (blocks done, all blocks).

    Blocks have `chunks` (rows, columns); each should take a second or more. They go to the workers of `executor`: a
    `ProcessPoolExecutor`, Dask's `client.get_executor()`, or another object with that interface. Every worker must see the folder of the
    store, but not the model's file. Without an executor, all cores of this machine work. After an interruption the same call continues;
    the bytes do not depend on who computed them.

    Raises ValueError if the store holds another chart or cannot be written, and the executor's error if a worker is lost.
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
