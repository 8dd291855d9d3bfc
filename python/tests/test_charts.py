"""Are charts the same from every engine, and does a block that fails never count as done?"""

import os
import pickle
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from test_grid import LENGTHS, files, spaced

from corner_impact import Chart, Model, blocks_done
from corner_impact.charts import dataset, fill, lazy

CHUNKS = (4, 5)


@pytest.fixture(scope="module")
def chart(paper: Model) -> Chart:
    return Chart(paper, {"restitution": spaced(0, 0.9, 11), "rpm": spaced(90, 190, 12)}, **LENGTHS)


def filled(chart: Chart, store: Path, executor: Executor | None = None) -> dict[str, bytes]:
    told = list(fill(chart, store, executor, chunks=CHUNKS))
    assert told == [(count, 9) for count in range(10)]
    assert list(fill(chart, store, executor, chunks=CHUNKS)) == [(9, 9)]
    return files(store)


def test_every_engine_computes_the_same(chart: Chart, tmp_path: Path) -> None:
    here = dataset(chart)
    assert here.identical(lazy(chart, CHUNKS).compute(scheduler="threads"))
    assert here.identical(dataset(chart, threads=1))
    alone = filled(chart, tmp_path / "alone.zarr")
    with ThreadPoolExecutor(2) as threads:
        assert filled(chart, tmp_path / "threads.zarr", threads) == alone
    with ProcessPoolExecutor(2, get_context("spawn")) as processes:
        assert filled(chart, tmp_path / "processes.zarr", processes) == alone
    # The store has what is computed here: numbers, types, units, meanings and provenance.
    there = xr.open_zarr(tmp_path / "alone.zarr", chunks=None).load()
    assert here.identical(there)
    assert Model.parse(there.attrs["model_toml"]) == chart.model


def test_dask_fills_a_store_and_outlives_a_worker(chart: Chart, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    alone = filled(chart, tmp_path / "alone.zarr")
    with (
        distributed.LocalCluster(2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        executor = client.get_executor(retries=3)
        told = fill(chart, tmp_path / "dask.zarr", executor, chunks=CHUNKS)
        assert next(told) == (0, 9)
        victim = next(iter(cluster.workers.values()))
        os.kill(victim.pid, signal.SIGKILL)
        assert list(told)[-1] == (9, 9)
        assert lazy(chart, CHUNKS).compute().identical(dataset(chart))
    assert files(tmp_path / "dask.zarr") == alone


class Gated(ThreadPoolExecutor):
    """Executor of one thread, which waits for a permit before each piece of work."""

    def __init__(self, permits: int) -> None:
        super().__init__(1)
        self.gate = threading.Semaphore(permits)

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        def work() -> Any:
            self.gate.acquire()
            return fn(*args, **kwargs)

        return super().submit(work)


def test_what_is_stopped_goes_on(chart: Chart, tmp_path: Path) -> None:
    store = tmp_path / "chart.zarr"
    with Gated(2) as executor:
        told = fill(chart, store, executor, chunks=CHUNKS)
        assert [next(told) for _ in range(3)] == [(0, 9), (1, 9), (2, 9)]
        told.close()
        executor.gate.release(9)
    # A block that had begun is finished, and no other one begins.
    so_far = int(blocks_done(store).sum())
    assert so_far in (2, 3)
    assert next(fill(chart, store, chunks=CHUNKS)) == (so_far, 9)
    assert list(fill(chart, store, chunks=CHUNKS))[-1] == (9, 9)


def test_a_full_disk_counts_for_nothing(chart: Chart, tmp_path: Path) -> None:
    """Limit the length of files, as on a full disk: arrays of 8 bytes a point exceed the limit, and arrays of 1 byte a point do not."""
    script = tmp_path / "full.py"
    script.write_text(
        "import pickle, resource, sys\n"
        "from corner_impact.charts import fill\n"
        "chart = pickle.loads(bytes.fromhex(sys.argv[1]))\n"
        "told = fill(chart, sys.argv[2], chunks=(100, 100))\n"
        "next(told)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, resource.RLIM_INFINITY))\n"
        "next(told)\n"
    )
    store = tmp_path / "chart.zarr"
    words = [sys.executable, str(script), pickle.dumps(chart).hex(), str(store)]
    ended = subprocess.run(words, capture_output=True, text=True, timeout=60)
    assert ended.returncode == 1 and "ValueError" in ended.stderr and "too large" in ended.stderr, ended.stderr
    assert not blocks_done(store).any()
    assert not [path for path in store.rglob("*") if path.name.endswith(".tmp")]
    assert list(fill(chart, store))[-1] == (1, 1)


def test_what_cannot_be_is_refused(chart: Chart, tmp_path: Path) -> None:
    store = tmp_path / "chart.zarr"
    assert next(fill(chart, store, chunks=CHUNKS)) == (0, 9)
    with pytest.raises(ValueError, match="another chart"):
        next(fill(chart, store, chunks=(5, 4)))
    with pytest.raises(ValueError, match="must be 1 or more"):
        lazy(chart, (0, 5))
    with ThreadPoolExecutor(1) as executor:
        (store / "impacts").rename(tmp_path / "impacts")
        (store / "impacts").write_text("no folder")
        with pytest.raises(ValueError, match="cannot be made"):
            list(fill(chart, store, executor, chunks=CHUNKS))
    assert not blocks_done(store).any()


def test_a_table_s_rows_go_with_the_model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a worker in another folder, which cannot find the file of lifts, compute the same chart into the same store."""
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path)
    model = Model.load(Path(__file__).parents[2] / "models/laws/table-cubic.toml")
    chart = Chart(model, {"restitution": [0.5, 0.8], "rpm": [100.0, 300.0]}, transient=20, record=10)
    with ProcessPoolExecutor(1, get_context("spawn")) as executor:
        executor.submit(os.chdir, tmp_path / "elsewhere").result()
        assert list(fill(chart, "chart.zarr", executor))[-1] == (1, 1)
    read = xr.open_zarr(tmp_path / "chart.zarr", chunks=None).load()
    assert read.identical(dataset(chart)) and not np.isnan(read.growth_rate).any()
