"""Do results work as dicts, objects, tables, files and pictures?"""

import copy
import json
import pickle
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from corner_impact import Chart, LocalMap, Model, Result

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("agg")
xr = pytest.importorskip("xarray")

ASKED: dict[str, Callable[[Model], Any]] = {
    "simulate": lambda it: it.simulate(670, 20),
    "diagram": lambda it: it.diagram([690, 710], record=5),
    "strobed": lambda it: it.diagram([690, 710], record=5, strobe_deg=90),
    "cam": lambda it: it.cam(angle_deg=np.arange(360)),
    "strobe_map": lambda it: it.strobe_map(700, np.linspace(2, 6, 3)[:, None], [0.0, 1.0], jacobian=True),
    "impact_map": lambda it: it.impact_map(700, np.linspace(2, 3, 5), 70.0),
    "orbits": lambda it: it.orbits(680),
    "locate": lambda it: it.locate((670, 680)),
    "speeds": lambda it: it.speeds((700, 710), speeds=4, starts=6),
    "over": lambda it: it.speeds(700, over=("restitution", 0.65, 0.75), step=0.05, starts=4),
    "design": lambda it: it.design((100, 130), speeds=3, needs=["no separation to 130 rpm"]),
    "verify": lambda it: it.verify(external=False),
    "compare": lambda it: it.compare(it.with_number("restitution", 0.7), external=False),
    "certify": lambda it: it.certify((670, 680)),
    "certified orbits": lambda it: it.certify(690, orbits=True),
    "counts": lambda it: it.certify((690, 700), orbits=True),
    "basins": lambda it: it.basins(678, (12, 10), strobe_deg=330),
    "shares": lambda it: it.basins(700, (5, 5), over=("restitution", 0.7, 0.8, 2)),
    "continue": lambda it: it.continue_(700, ("rpm", 695, 705)),
    "curve": lambda it: it.curve((665, 680), ("restitution", 0.79, 0.81), events=["corner"]),
    "chaos": lambda it: it.chaos(670),
    "figure": lambda it: it.figure("cam"),
    "explain": lambda it: it.explain("B_minus", external=False),
    "chart": lambda it: Chart(it, {"restitution": [0.7, 0.8], "rpm": [660.0, 700.0, 720.0]}).compute(),
}


@pytest.fixture(scope="module")
def found(paper: Model) -> Callable[[str], Result]:
    known: dict[str, Result] = {}

    def find(name: str) -> Result:
        if name not in known:
            known[name] = ASKED[name](paper)
        return known[name]

    return find


@pytest.mark.parametrize("name", ASKED)
def test_every_result_is_a_dict_a_table_a_dataset_a_file_and_a_picture(found: Any, name: str, tmp_path: Path) -> None:
    result: Result = found(name)
    assert issubclass(type(result), dict) and type(result.to_dict()) is dict and result.to_dict().keys() == result.keys()
    for again in (copy.deepcopy(result), pickle.loads(pickle.dumps(result))):
        assert type(again) is type(result) and repr(again) == repr(result)
    table, frame, dataset = result.table(), result.to_pandas(), result.to_xarray()
    assert list(frame.columns) == list(table) and len(frame) > 0 and table
    result.to_netcdf(tmp_path / "result.nc")
    with xr.open_dataset(tmp_path / "result.nc", engine="h5netcdf") as read:
        assert dict(read.sizes) == dict(dataset.sizes)
        for variable in dataset:
            assert np.array_equal(read[variable].values, dataset[variable].values, equal_nan=dataset[variable].dtype.kind == "f")
    axes = result.plot()
    assert axes.get_xlabel() and axes.get_ylabel() and (axes.lines or axes.collections)
    assert result.plot(axes) is axes
    matplotlib.pyplot.close("all")
    assert result._repr_html_().startswith("<table>") and len(repr(result)) < 100
    assert set(result) - {"class", "values"} <= {*dir(result), *(key for key in result if not key.isidentifier())}


def test_entries_are_attributes(found: Any) -> None:
    orbits = found("orbits")
    assert orbits.speed_rpm == orbits["speed_rpm"] == dict(orbits)["speed_rpm"] == 680
    stable = orbits.orbits[1]
    assert stable.multipliers.tolist() == [complex(one["re"], one["im"]) for one in orbits["orbits"][1]["multipliers"]]
    assert stable.state.tolist() == orbits["orbits"][1]["state"] and stable.impacts[0].revolution == 0
    assert stable.impacts[0].cam_angle_deg == np.degrees(stable.impacts[0].cam_angle_rad) and "cam_angle_deg" in dir(stable.impacts[0])
    assert stable.contact == [] and orbits.complete[0].known == "proved"
    verified = found("verify")
    assert verified.routes.closed_form.minus.A.shape == (2, 2) and verified.eigenvalues.plus[0].imag > 0
    assert verified.refusal is None and verified.corner_impact.cam_acceleration_m_s2.minus > 0
    assert found("basins").endings[0].ending == "periodic" and found("shares").values_[0].speed_rpm == 700
    proved = found("certify").corner_impacts[0]
    assert float(proved.D) == pytest.approx(259.744986) and proved.speed_rpm.rad == proved["speed_rpm"]["rad"]
    assert found("speeds").attractors[0].birth is None and found("diagram").impacts.event.tolist() == 10 * [0]
    with pytest.raises(AttributeError, match="Orbits has no 'orbit'; it has: schema, model"):
        orbits.orbit
    with pytest.raises(KeyError):
        orbits["cam_angle_deg"]


def test_angles_turn_either_way(paper: Model) -> None:
    told = Model.parse(paper.text + '\n[units]\nangle = "deg"\n')
    one, other = told.orbits(680).orbits[1].impacts[0], paper.orbits(680).orbits[1].impacts[0]
    assert "cam_angle_deg" in one and one.cam_angle_rad == pytest.approx(other.cam_angle_rad, rel=1e-14)
    axes = told.diagram([690, 710], record=5).plot()
    assert axes.get_ylabel() == "cam angle (deg)" and axes.get_ylim()[1] > 100
    matplotlib.pyplot.close("all")


def test_tables_have_a_column_for_each_number(found: Any) -> None:
    table = found("orbits").table()
    assert table["stable"].tolist() == [False, True, False] and table["impacts"].tolist() == [1, 1, 2]
    assert table["state_2"][1] == found("orbits")["orbits"][1]["state"][1]
    assert table["multipliers_1_im"].dtype == float and table["stability"].tolist() == ["unstable", "stable", "unstable"]
    branches = found("continue").table()
    counts = [len(branch.points) for branch in found("continue").branches]
    assert np.bincount(branches["branches"]).tolist() == counts and set(branches["begins"]) == {"the end of the range"}
    assert found("certify").table()["D"][0] == float(found("certify").corner_impacts[0].D)
    events = found("simulate").table()
    assert set(events["event"]) == {"release", "impact"} and set(found("simulate").impacts.table()["event"]) == {"impact"} and found("simulate").to_xarray().position_m.attrs == {"units": "m"}
    assert found("strobe_map").to_xarray().sizes == {"dim_0": 3, "dim_1": 2}
    assert found("strobe_map").table()["jacobian_1_2"][3] == found("strobe_map").jacobian[1, 1, 0, 1]
    basins = found("basins").to_xarray()
    assert basins.ending.sel(velocity=0, method="nearest").sizes == {"position": 12} and basins.attrs["rpm"] == 678
    missing = found("speeds").table()
    assert np.isnan(missing["birth"]).all() and missing["shares"].tolist() == [6]


def test_plots_show_the_columns_that_are_asked_for(found: Any) -> None:
    axes = found("simulate").plot(x="cam_angle_deg", y="velocity_before_m_s", by="revolution", color="red")
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("cam angle (deg)", "velocity before (m/s)")
    assert len(axes.lines) == len(np.unique(found("simulate").revolution)) and axes.lines[0].get_color() == "red"
    np.testing.assert_array_equal(axes.lines[0].get_xdata(), found("simulate").cam_angle_deg[found("simulate").revolution == 0])
    stable = found("orbits").plot()
    assert [text.get_text() for text in stable.get_legend().get_texts()] == ["unstable", "stable"]
    chart = found("chart").plot(by="growth_rate", x="restitution")
    assert (chart.get_xlabel(), chart.get_ylabel()) == ("follower.restitution", "speed (rpm)")
    np.testing.assert_array_equal(chart.collections[0].get_array(), found("chart").growth_rate.T)
    with pytest.raises(ValueError, match="there is no column 'height'; there are: revolution, time_s"):
        found("simulate").plot(y="height")
    matplotlib.pyplot.close("all")


def test_charts_select_by_the_ends_of_names(paper: Model) -> None:
    chart = Chart(paper, {"restitution": [0.8, 0.7], "rpm": [660.0, 700.0, 720.0]}, start_angle_deg=0)
    points = chart.compute()
    assert chart.sel(restitution=0.7).revolutions.values.tolist() == points.revolutions[1].tolist() == [0, 1, 1]
    assert chart.sel(**{"follower.restitution": 0.69}, rpm=700, method="nearest").revolutions == 1
    assert chart.to_xarray().identical(points.to_xarray()) and points.class_.shape == (2, 3)
    assert chart.compute((1, 2)).sel(restitution=0.7).sizes == {"rpm": 3}
    with pytest.raises(KeyError):
        chart.sel(restitution=0.5)
    with pytest.raises(ValueError, match="there is no axis 'mass'; there are: follower.restitution, rpm"):
        chart.sel(mass=1.0)
    assert chart.plot().get_xlabel() == "speed (rpm)" and chart.plot(x="restitution").get_ylabel() == "speed (rpm)"
    assert points.table()["class"].tolist() == ["chaotic", "periodic", "periodic"] * 2
    matplotlib.pyplot.close("all")


def test_a_chart_is_a_netcdf_file(paper: Model, tmp_path: Path) -> None:
    chart = Chart(paper, {"restitution": [0.8, 0.7], "rpm": [660.0, 700.0]})
    assert chart.to_xarray().attrs["rpm"] is None
    chart.to_netcdf(tmp_path / "chart.nc")
    with xr.open_dataset(tmp_path / "chart.nc", engine="h5netcdf") as read:
        assert read.load().equals(chart.to_xarray()) and "flag_meanings" in read["class"].attrs
        assert json.loads(read.attrs["start"]) == chart.attributes["start"] and Model.parse(read.attrs["model_toml"]) == paper


@pytest.mark.parametrize(
    ("package", "extra", "use"),
    [
        ("pandas", "pandas", lambda it, path: it.to_pandas()),
        ("xarray", "xarray", lambda it, path: it.to_xarray()),
        ("h5netcdf", "netcdf", lambda it, path: it.to_netcdf(path)),
        ("matplotlib.pyplot", "plot", lambda it, path: it.plot()),
    ],
)
def test_a_missing_package_is_named_with_its_extra(
    paper: Model, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, package: str, extra: str, use: Any
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(ImportError, match=rf"{package.partition('.')[0]} is missing: pip install 'corner-impact\[{extra}\]'"):
        use(paper.orbits(680), tmp_path / "file.nc")
    # Everything else works without these packages.
    assert paper.orbits(680).orbits[1].stable and json.dumps(paper.orbits(680))


def test_the_package_imports_numpy_alone() -> None:
    program = "import sys, corner_impact as it; it.Model.paper().orbits(680).table(); print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout.split()
    assert "corner_impact.results" in loaded and not {"pandas", "xarray", "matplotlib", "h5netcdf", "dask"} & set(loaded)


@pytest.mark.parametrize("name", ["beyond-attractor", "slow-impacts", "fast-impacts"])
def test_figures_show_their_clouds(paper: Model, name: str) -> None:
    figure = paper.figure(name)
    series = figure["figure"]["panels"][0]["series"]
    (index, cloud), *_ = [(index, one["data"]["density"]) for index, one in enumerate(series) if "density" in one["data"]]
    table = figure.table()
    here = (table["panel"] == 0) & (table["series"] == index)
    assert here.sum() == len(cloud["counts"]) > 1000
    for column, cells in (("x", "columns"), ("y", "rows")):
        (low, high), side = cloud[column], (cloud[column][1] - cloud[column][0]) / cloud[cells]
        first = cloud["counts"][0][0]
        assert table[column][here][0] == pytest.approx(low + side * ((first % cloud["columns"] if column == "x" else first // cloud["columns"]) + 0.5))
        assert low < table[column][here].min() and table[column][here].max() < high
    drawn = [np.asarray(line.get_xdata()) for line in figure.plot().lines]
    assert sum(map(len, drawn)) == np.count_nonzero(table["panel"] == 0)
    assert figure._repr_html_().endswith("</svg>\n") or figure._repr_html_().endswith("</svg>")
    matplotlib.pyplot.close("all")


def test_figures_keep_their_scale(paper: Model) -> None:
    axes = paper.figure("cam-shape").plot()
    assert axes.get_aspect() == 1 and paper.figure("cam").plot().get_aspect() == "auto"
    matplotlib.pyplot.close("all")


def test_a_plot_refuses_what_it_does_not_know(found: Any, paper: Model) -> None:
    chart = Chart(paper, {"restitution": [0.7, 0.8], "rpm": [660.0, 700.0]})
    for plot, words in (
        (lambda: chart.plot(variable="growth_rate"), "pcolormesh of matplotlib .*'variable'"),
        (lambda: found("basins").plot(variable="growth"), "'variable'"),
        (lambda: found("basins").plot(by="growth"), "no choice of by"),
        (lambda: found("figure").plot(y="lift"), "no choice of y"),
        (lambda: found("orbits").plot(height=3), "'height'"),
    ):
        with pytest.raises(TypeError, match=words):
            plot()
    with pytest.raises(ValueError, match="there is no variable 'growth'; there are: revolutions, impacts"):
        chart.plot(by="growth")
    assert found("basins").plot(alpha=0.5).collections[0].get_alpha() == 0.5
    matplotlib.pyplot.close("all")


def test_a_diagram_at_a_section_has_no_impacts(found: Any) -> None:
    assert not hasattr(found("strobed"), "impacts") and hasattr(found("diagram"), "impacts")


def test_a_result_without_a_list_is_one_row(found: Any) -> None:
    orbit, impact = found("orbits").orbits[1], found("locate").corner_impacts[0]
    assert orbit.to_pandas()["state_1"].tolist() == [orbit.state[0]] and len(impact.to_pandas()) == 1
    branch, curve = found("continue").branches[0], found("curve").curves[0]
    assert len(branch.to_pandas()) == len(branch.points) > 10 and len(curve.to_pandas()) == len(curve.points)
    assert branch.plot().lines and LocalMap(Model.paper()).orbit("R", dT=-1e-4).to_pandas()["word"].tolist() == ["R"]
    matplotlib.pyplot.close("all")


def test_branches_have_the_angle_of_the_first_impact(found: Any) -> None:
    branches = found("continue")
    angles = [point.orbit.impacts[0].cam_angle_rad for branch in branches.branches for point in branch.points]
    assert branches.table()["cam_angle_rad"].tolist() == angles
    axes = branches.plot(y="cam_angle_deg")
    assert axes.get_ylabel() == "cam angle (deg)" and axes.get_xlabel() == "speed (rpm)"
    matplotlib.pyplot.close("all")


def test_axes_say_what_they_show(found: Any) -> None:
    for name, across, up in (
        ("orbits", "position (m)", "velocity (m/s)"),
        ("continue", "speed (rpm)", "position (m)"),
        ("curve", "follower.restitution", "speed (rpm)"),
        ("design", "speed (rpm)", "least contact force (N)"),
        ("chaos", "lowest speed (rpm)", "entropy per revolution"),
        ("over", "follower.restitution", "share"),
    ):
        axes = found(name).plot()
        assert (axes.get_xlabel(), axes.get_ylabel()) == (across, up), name
    told = Model.parse(Model.paper().text + '\n[units]\nlength = "mm"\n').orbits(680).plot()
    assert told.get_xlabel() == "position (mm)"
    separation = found("design").plot().lines[-1]
    assert separation.get_label() == "separation" and separation.get_xdata()[0] == found("design").separation.speed_rpm
    assert {found(name).plot().get_xscale() for name in ("verify", "compare")} == {"log"}
    bars = found("basins").plot().figure.axes[1].get_yticklabels()
    assert [text.get_text() for text in bars] == ["periodic, 1 revolution, 1 impact", "chaotic"]
    legend = found("continue").plot().get_legend()
    assert all(handle.get_markersize() >= 3 for handle in legend.legend_handles)
    assert found("cam").plot().lines[0].get_linestyle() == "-"
    matplotlib.pyplot.close("all")


def test_results_are_equal_by_their_values(paper: Model) -> None:
    for one, same, other in (
        (paper.simulate(670, 20), paper.simulate(670, 20), paper.simulate(671, 20)),
        (paper.basins(678, (3, 3)), paper.basins(678, (3, 3)), paper.basins(678, (3, 4))),
        (paper.strobe_map(700, [4.4, -9.0], -30.0), paper.strobe_map(700, [4.4, -9.0], -30.0), paper.strobe_map(700, [4.4, -9.1], -3.0)),
    ):
        assert one == same and not one != same and one != other and not one == other and one != 1
    assert paper.orbits(680) == json.loads(json.dumps(paper.orbits(680)))


def test_names_of_units_are_units(paper: Model, found: Any) -> None:
    units = found("cam").to_pandas().attrs["units"]
    assert units == {"lift_m": "m", "slope_m_rad": "m/rad", "curvature_m_rad2": "m/rad^2", "cam_angle_rad": "rad"}
    assert found("cam").to_xarray().slope_m_rad.attrs == {"units": "m/rad"}
    assert found("cam").plot(y="slope_m_rad").get_ylabel() == "slope (m/rad)"
    matplotlib.pyplot.close("all")


def test_a_repr_says_something(found: Any) -> None:
    assert repr(found("design").needs[0]) == "<Need need=no separation to 130 rpm parameter=preload now=143.08 value=235.178>"
    assert "proved=True" in repr(found("chaos").theorems[0]) and "variational" in repr(found("verify").routes)
    assert repr(found("verify")) == f"<Verification agrees=True: {len(found('verify').agreement)} comparisons>"
