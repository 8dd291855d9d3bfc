"""Are the points of a grid equal to the command's, in whatever parts they are computed, and is its store the same bytes?"""

import pickle
import resource
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Command
from numpy.typing import NDArray
from test_runs import table

from corner_impact import Chart, Model, blocks_done, chart_variables

LENGTHS = {"transient": 5, "record": 2}
WORDS = ("--transient", "5", "--record", "2")


def spaced(low: float, high: float, count: int) -> NDArray[np.float64]:
    """Return values spaced as by the command. Those of numpy's linspace differ in the last digit."""
    return low + (high - low) * (np.arange(count) / (count - 1))


@pytest.fixture(scope="module")
def grid(paper: Model) -> Chart:
    axes = {"restitution": spaced(0, 0.9, 11), "rpm": spaced(90, 190, 12)}
    return Chart(paper, axes, **LENGTHS)


AXES = ("--x", "rpm=90:190:12", "--y", "restitution=0:0.9:11", *WORDS)


def same(one: dict[str, NDArray[Any]], other: dict[str, NDArray[Any]]) -> bool:
    return list(one) == list(other) and all(
        one[name].dtype == other[name].dtype and np.array_equal(one[name], other[name], equal_nan=True) for name in one
    )


def test_points_are_those_of_the_command(grid: Chart, command: Command) -> None:
    found, expected = grid.compute(), table(command("chart", *AXES, "--out", "-"))
    names = {
        "revolutions": "revolutions",
        "impacts": "impacts",
        "growth_rate": "growth_rate",
        "growth_error": "growth_error",
        "impact_speed": "impact_speed_m_s",
        "impacts_per_revolution": "impacts_per_revolution",
        "followed": "followed",
    }
    for name, column in names.items():
        values = np.array(expected[column], dtype=np.float64)
        assert np.array_equal(found[name].ravel().astype(np.float64), values, equal_nan=True), name
    meanings = next(it for it in chart_variables() if it["name"] == "class")["attributes"]["flag_meanings"].split()
    assert [meanings[code] for code in found["class"].ravel()] == expected["class"]
    assert len(set(expected["class"])) > 1
    described = {it["name"]: np.dtype(it["dtype"]) for it in chart_variables()}
    assert described == {name: values.dtype for name, values in found.items()}
    assert np.array_equal(np.array(expected["x"], dtype=float), np.tile(grid.axes["rpm"], 11))


def test_parts_are_parts_of_the_whole(paper: Model, grid: Chart) -> None:
    whole = grid.compute(threads=1)
    assert same(whole, grid.compute(threads=2)) and whole["class"].shape == grid.shape == (11, 12)
    part = grid.compute((3, 8), (0, 5))
    assert same(part, {name: values[3:8, :5] for name, values in whole.items()})
    assert grid.compute((2, 2))["class"].shape == (0, 12)
    names = list(reversed(grid.axes))
    turned = Chart(paper, {name: grid.axes[name] for name in names}, **LENGTHS).compute()
    assert same(turned, {name: values.T for name, values in whole.items()})
    # Values in any order, some of them repeated.
    some = np.array([7, 1, 1, 10])
    mixed = Chart(paper, {"follower.restitution": grid.axes["follower.restitution"], "rpm": grid.axes["rpm"][some]}, **LENGTHS)
    assert same(mixed.compute(), {name: values[:, some] for name, values in whole.items()})


def test_a_grid_is_pickled_whole(paper: Model) -> None:
    grid = Chart(paper, {"mass": [1.2, 1.3], "stiffness": [1400, 1500]}, rpm=700, position=9, velocity=0, **LENGTHS)
    again = pickle.loads(pickle.dumps(grid))
    assert same(again.compute(), grid.compute()) and repr(again) == repr(grid)
    assert (again.rpm, again.transient, again.record, again.model) == (700, 5, 2, paper)
    assert list(again.axes) == ["follower.mass", "follower.stiffness"]


def test_what_cannot_be_is_a_class(paper: Model) -> None:
    axes = {"restitution": [0.8, np.nan, 1.7], "rpm": [-5.0, np.nan, np.inf, 700.0]}
    found = Chart(paper, axes, **LENGTHS).compute()
    meanings = next(it for it in chart_variables() if it["name"] == "class")["attributes"]["flag_meanings"].split()
    failed = found["class"] == meanings.index("failed")
    assert failed.sum() == 11 and not failed[0, 3]
    assert np.isnan(found["growth_rate"][failed]).all() and (found["impacts"][failed] == -1).all()
    below = Chart(paper, {"restitution": [0.8], "rpm": [700.0]}, position=-1.0, velocity=0.0, **LENGTHS).compute()
    assert below["class"][0, 0] == meanings.index("failed")


@pytest.mark.parametrize(
    ("axes", "asked", "words"),
    [
        ({"rpm": [700.0]}, {}, "axes are two"),
        ({"rpm": [700.0], "restitutoin": [0.8]}, {}, "did you mean restitution"),
        ({"rpm": [700.0], "mass": []}, {}, "0 points"),
        ({"rpm": [700.0], "mass": [1.0]}, {"rpm": 700}, "leave it out where rpm is an axis"),
        ({"stiffness": [700.0], "mass": [1.0]}, {}, "neither axis is rpm"),
        ({"follower.mass": [2.0], "mass": [1.0]}, {"rpm": 700}, "two different numbers"),
    ],
)
def test_what_is_no_grid_is_refused(paper: Model, axes: dict[str, Any], asked: dict[str, Any], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        Chart(paper, axes, **asked)


def files(store: Path) -> dict[str, bytes]:
    return {str(path.relative_to(store)): path.read_bytes() for path in store.rglob("*") if path.is_file()}


def test_a_store_is_that_of_the_command(grid: Chart, command: Command, tmp_path: Path) -> None:
    theirs, ours = tmp_path / "theirs.zarr", tmp_path / "ours.zarr"
    command("chart", *AXES, "--out", str(theirs))
    assert grid.begin(ours) == (1, 1) and not blocks_done(ours).any()
    assert grid.fill(ours, 0) and not grid.fill(ours, 0) and blocks_done(ours).all()
    assert files(ours) == files(theirs)
    assert "2 of 2" not in command("chart", "--status", str(ours))


def test_processes_fill_a_store_together(paper: Model, grid: Chart, tmp_path: Path) -> None:
    store, alone, chunks = tmp_path / "chart.zarr", tmp_path / "alone.zarr", (4, 5)
    assert grid.begin(store, chunks) == grid.begin(alone, chunks) == (3, 3)
    with ProcessPoolExecutor(2, get_context("spawn")) as executor:
        assert all(executor.map(grid.fill, [store] * 9, reversed(range(9)), [chunks] * 9))
    assert all(grid.fill(alone, block, chunks, threads=2) for block in range(9))
    assert files(store) == files(alone)
    # A block that was cut off or lost is computed again, with the same bytes.
    whole = files(store)
    (store / "class/c/1/2").write_bytes(b"cut")
    (store / "growth_rate/c/0/0").unlink()
    assert [int(block) for block in np.flatnonzero(~blocks_done(store))] == [0, 5]
    assert [grid.fill(store, block, chunks) for block in (0, 4, 5)] == [True, False, True]
    assert files(store) == whole
    # The arrays hold the computed values, with a checksum at the end of a block.
    block = np.frombuffer(whole["class/c/1/2"][:-4], dtype=np.int8).reshape(4, 5)
    assert np.array_equal(block[:4, :2], grid.compute((4, 8), (10, 12))["class"]) and (block[:, 2:] == -1).all()
    for other, wrong in [
        (Chart(paper, grid.axes, transient=6, record=2), chunks),
        (Chart(paper.with_number("mass", 1.0), grid.axes, **LENGTHS), chunks),
        (Chart(paper, grid.axes | {"rpm": grid.axes["rpm"] + 1.0}, **LENGTHS), chunks),
        (grid, (5, 4)),
    ]:
        with pytest.raises(ValueError, match="holds another chart"):
            other.fill(store, 0, wrong)
    with pytest.raises(ValueError, match="the store has 9"):
        grid.fill(store, 9, chunks)
    with pytest.raises(ValueError, match="have 1 or more"):
        grid.begin(tmp_path / "none.zarr", (0, 5))


def test_a_store_that_cannot_be_written_is_told(grid: Chart, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    with pytest.raises(ValueError, match="cannot be made"):
        grid.begin(tmp_path / "file" / "chart.zarr")
    with pytest.raises(ValueError, match="no store of a chart"):
        blocks_done(tmp_path)
    store = tmp_path / "chart.zarr"
    grid.begin(store)
    # With a limit on the length of files, the block is not done and nothing of it remains. Without the limit it is completed.
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, limits[1]))
    try:
        with pytest.raises(ValueError, match="cannot be written"):
            grid.fill(store, 0)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert not blocks_done(store).any() and not (store / "class/c/0/0").exists()
    assert not [path for path in store.rglob("*") if path.name.endswith(".tmp")]
    assert grid.fill(store, 0) and blocks_done(store).all()

def test_a_machine_in_millimetres_answers_in_them(paper: Model) -> None:
    text = paper.text.replace("rest_position = 0.3", "rest_position = 300.0")
    for radius in ("base_radius = 0.4", "flank_radius = 0.85", "nose_radius = 0.15"):
        name, value = radius.split(" = ")
        text = text.replace(radius, f"{name} = {1000 * float(value)!r}")
    told = Model.parse(text + '\n[units]\nlength = "mm"\nangle = "deg"\n')
    metres, millimetres = (it.simulate(700, 3, transient=10) for it in (paper, told))
    assert list(millimetres)[2:5] == ["cam_angle_deg", "event", "position_mm"]
    np.testing.assert_allclose(millimetres["position_mm"], 1000 * metres["position_m"], rtol=1e-11)
    np.testing.assert_allclose(millimetres["cam_angle_deg"], np.degrees(metres["cam_angle_rad"]), rtol=1e-11)
    impact = told.orbits(680)["orbits"][1]["impacts"][0]
    assert 152.2 < impact["cam_angle_deg"] < 152.3 and impact["velocity_before_mm_s"] < -100_000
    grid = Chart(told, {"rpm": [690, 700], "restitution": [0.7, 0.8]})
    variables = {it["name"]: it["attributes"]["units"] for it in chart_variables(grid)}
    assert variables["impact_speed"] == "mm s-1"
