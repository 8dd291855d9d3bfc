"""Classes of results: the attributes of each, as types, with its table and its plot.

Each class is the document of one command, or the columns of one run. Its declarations name the attributes that are always there; the
commands' pages describe all entries. Names of lengths and forces end in the model's units: `position_m`, or `position_mm` in
millimetres.
"""

import html
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from corner_impact._extras import need
from corner_impact._native import Chart, chart_variables
from corner_impact._result import Array, Ball, Columns, Result, axes_or_new, drawn, entries, label, mesh

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

__all__ = [
    "Attractor", "Ball", "BasinShares", "Basins", "Branch", "Branches", "CamLift", "Certificate", "Chaos", "ChartPoints", "Classification",
    "Columns", "Comparison", "CornerImpact", "Curve", "Curves", "Design", "Diagram", "Events", "Explanation", "Figure", "Figures",
    "ImpactMap", "LocalOrbit", "LocalOrbits", "LocalOutcome", "Located", "Orbit", "Orbits", "Result", "SpeedSurvey", "StrobeMap",
    "Verification", "entries",
]


def refuse(**given: str) -> None:
    """Raise TypeError if an argument is given that a plot does not use."""
    if names := [name for name, value in given.items() if value]:
        raise TypeError(f"this plot has no choice of {', '.join(names)}")


def logarithmic(shown: "Axes") -> "Axes":
    """Make both axes logarithmic, with room for 0 and for values of both signs where there are any."""
    axes: Any = shown
    for axis, turn, limits, values in (
        (axes.xaxis, axes.set_xscale, axes.set_xlim, [line.get_xdata() for line in axes.lines]),
        (axes.yaxis, axes.set_yscale, axes.set_ylim, [line.get_ydata() for line in axes.lines]),
    ):
        every = np.concatenate([np.asarray(part, dtype=float) for part in values])
        found = every[np.isfinite(every)]
        sizes = np.abs(found[found != 0])
        if sizes.size and (found > 0).all():
            turn("log")
        elif sizes.size:
            least = float(sizes.min())
            turn("symlog", linthresh=least, linscale=2)
            limits(min(3 * found.min(), -least / 2), max(3 * found.max(), least / 2))
            axis.get_major_locator().set_params(numticks=7)
    return shown


class Events(Columns):
    """Events of one run (`Model.simulate`), one row an event."""

    revolution: Array
    time_s: Array
    cam_angle_rad: Array
    cam_angle_deg: Array
    event: Array
    position_m: Array
    velocity_before_m_s: Array
    velocity_after_m_s: Array
    cam_velocity_m_s: Array
    _drawn = ("time_s", "position", "event")

    @property
    def impacts(self) -> "Events":
        """Rows of impacts alone."""
        return Events({name: column[self["event"] == 0] for name, column in self.items()})


class Diagram(Columns):
    """Events or states over many values of one number (`Model.diagram`), one row an event or state."""

    rpm: Array
    revolution: Array
    cam_angle_rad: Array
    cam_angle_deg: Array
    event: Array
    position_m: Array
    velocity_before_m_s: Array
    velocity_after_m_s: Array
    velocity_m_s: Array
    lyapunov_per_revolution: Array
    lyapunov_error: Array

    @property
    def impacts(self) -> "Diagram":
        """Rows of impacts alone. Raises AttributeError if the diagram is of states at a section."""
        if "event" not in self:
            raise AttributeError("a diagram of states at a section has no impacts")
        return Diagram({name: column[self["event"] == 0] for name, column in self.items()})

    def _columns_drawn(self) -> tuple[str, str, str]:
        return next(iter(self)), "cam_angle_deg" if "event" in self else "position", ""


class CamLift(Columns):
    """Lift of a cam and its derivatives (`Model.cam`), of the shape of the angles."""

    lift_m: Array
    slope_m_rad: Array
    curvature_m_rad2: Array
    cam_angle_rad: Array
    cam_angle_deg: Array
    _drawn = ("cam_angle_deg", "lift", "")
    _looks = {"linestyle": "-"}


class StrobeMap(Columns):
    """Images of states (`Model.strobe_map`), of the broadcast shape of the starts."""

    position_m: Array
    velocity_m_s: Array
    jacobian: Array
    _drawn = ("position", "velocity", "")


class ImpactMap(Columns):
    """Next impacts (`Model.impact_map`), of the broadcast shape of the departures."""

    cam_angle_rad: Array
    cam_angle_deg: Array
    relative_velocity_m_s: Array
    flight_s: Array
    _drawn = ("cam_angle_deg", "relative_velocity", "")


class Impact(Result):
    """An impact of an orbit."""

    revolution: int
    cam_angle_rad: float
    cam_angle_deg: float
    velocity_before_m_s: float
    velocity_after_m_s: float


class Orbit(Result):
    """A periodic orbit. `state` has shape (2,): position and velocity; `multipliers` is complex, shape (2,)."""

    known: str
    revolutions: int
    impacts: list[Impact]
    state: Array
    multipliers: Array
    stability: str
    stable: bool
    residual: float


class Orbits(Result):
    """Periodic orbits at one speed (`Model.orbits`)."""

    model: str
    speed_rpm: float
    section_angle_rad: float
    section_angle_deg: float
    complete: list[Result]
    orbits: list[Orbit]
    _path = ("orbits",)
    _drawn = ("state_1", "state_2", "stability")
    _words = {"state_1": "position ({length})", "state_2": "velocity ({length}/s)"}


class Classification(Result):
    """Event at a corner impact, by Feigin's classification."""

    scenario: str
    real_eigenvalues_above_one: Result
    real_eigenvalues_below_minus_one: Result
    fixed_points_exist_for: Result
    period_two_orbit: bool
    border: Array


class CornerImpact(Result):
    """A corner impact with its map. `state` has shape (2,): position and velocity at the section."""

    known: str
    speed_rpm: float
    period_s: float
    revolutions: int
    impacts: int
    cam_angle_rad: float
    cam_angle_deg: float
    section_angle_rad: float
    section_angle_deg: float
    jump_order: int
    state: Array
    map: Result
    classification: Classification
    agreement: list[Result]
    agrees: bool


class Located(Result):
    """Corner impacts over a range of speeds (`Model.locate`)."""

    model: str
    rpm: Array
    revolutions: int
    corner_impacts: list[CornerImpact]
    complete: list[Result]
    agrees: bool
    _path = ("corner_impacts",)
    _drawn = ("speed_rpm", "cam_angle_deg", "classification_scenario")


class LocalOrbit(Result):
    """A periodic orbit of the local map. `points` has shape (letters, 2); `multipliers` is complex, shape (2,)."""

    word: str
    points: Array
    multipliers: Array
    stability: str
    stable: bool
    admissible: bool
    margin: float


class LocalOrbits(Result):
    """Periodic orbits of the local map (`LocalMap.orbits`)."""

    period_change_s: float
    orbits: list[LocalOrbit]
    _path = ("orbits",)
    _drawn = ("points_1_1", "points_1_2", "word")


class LocalOutcome(Result):
    """Motions of the local map on one side of the corner impact (`LocalMap.outcome`)."""

    speeds: str
    fixed_points: list[LocalOrbit]
    period_two: LocalOrbit | None
    periodic_orbits: list[LocalOrbit]
    ends: list[Result]
    _path = ("ends",)
    _drawn = ("end", "starts", "")


class Verification(Result):
    """A corner impact by every route (`Model.verify`)."""

    corner_impact: CornerImpact
    routes: Result
    orbits: Result
    agreement: list[Result]
    eigenvalues: Result
    normal_form: Result
    classification: Classification
    conditions: list[Result]
    local_map: list[LocalOutcome]
    linear_range: list[Result]
    published: list[Result]
    skipped: list[Result]
    agrees: bool
    _path = ("agreement",)
    _drawn = ("tolerance", "max_abs_diff", "agrees")
    _words = {"tolerance": "tolerance", "max_abs_diff": "largest difference"}

    def _title(self) -> str:
        fails = len(self["agreement"]) - sum(one["agrees"] for one in self["agreement"])
        failed = [one["route"] for one in self["skipped"] if one["failed"]]
        words = f"{len(self['agreement'])} comparisons" + (f", {fails} disagree" if fails else "")
        return f"{type(self).__name__} agrees={self['agrees']}: {words}" + (f"; failed: {', '.join(failed)}" if failed else "")

    def plot(self, ax: "Axes | None" = None, *, x: str = "", y: str = "", by: str = "", **style: Any) -> "Axes":
        """Draw differences over tolerances on logarithmic axes, or other columns. The arguments are those of `Result.plot`."""
        return logarithmic(super().plot(ax, x=x, y=y, by=by, **style))


class Attractor(Result):
    """An attractor over a range, with its share of the starts at each value."""

    id: str
    kind: str
    revolutions: int | None
    impacts: int | None
    from_rpm: float
    to_rpm: float
    birth: Result | None
    death: Result | None
    shares: list[Result]


class SpeedSurvey(Result):
    """Attractors over a range (`Model.speeds`)."""

    model: str
    rpm: Array
    known: str
    starts: int
    detachment_rpm: float | None
    attractors: list[Attractor]
    coexistence: list[Result]
    _path = ("attractors",)

    def _columns_drawn(self) -> tuple[str, str, str]:
        return "value" if "over" in self else "speed_rpm", "share", "id"

    def _plotted(self) -> dict[str, Array]:
        return Shares(self).table()


class Shares(Result):
    """Shares of the attractors, one row for each attractor and value."""

    _path = ("attractors", "shares")


class Separation(Result):
    """Speed at which the follower first leaves the cam."""

    speed_rpm: float
    error_rpm: float
    cam_angle_rad: float
    cam_angle_deg: float
    located: bool


class Need(Result):
    """A number of the model that would meet a need. `value` is None if no value does."""

    need: str
    parameter: str
    now: float
    value: float | None
    unit: str
    known: str


class Design(Result):
    """Contact force, separation and loads (`Model.design`)."""

    geometry: Result
    separation: Separation
    contact_force: list[Result]
    loads: list[Result]
    needs: list[Need]
    _path = ("contact_force",)

    def _columns_drawn(self) -> tuple[str, str, str]:
        return "value" if "over" in self else "speed_rpm", "least", ""

    def _label(self, name: str) -> str:
        words = {"least": "least contact force", "largest": "largest contact force"}.get(name.rpartition("_")[0])
        return f"{words} ({label(name).partition('(')[2]}" if words else super()._label(name)

    def plot(self, ax: "Axes | None" = None, *, x: str = "", y: str = "", by: str = "", **style: Any) -> "Axes":
        """Draw the least contact force with the speed of separation, or other columns. The arguments are those of `Result.plot`."""
        axes: Any = super().plot(ax, x=x, y=y, by=by, **style)
        separation = self["separation"]
        if (x or self._columns_drawn()[0]) == "speed_rpm" and separation:
            axes.axvline(separation["speed_rpm"], color="black", linestyle="--", label="separation")
            axes.legend()
        return cast("Axes", axes)


class Change(Result):
    """A number that differs between two models."""

    quantity: str
    a: float
    b: float
    difference: float
    error: float


class Comparison(Result):
    """Differences of two models (`Model.compare`)."""

    models: Result
    verdict: Result
    fields: list[Result]
    changes: list[Change]
    unchanged: list[Change]
    _path = ("changes",)
    _drawn = ("error", "difference", "")

    def plot(self, ax: "Axes | None" = None, *, x: str = "", y: str = "", by: str = "", **style: Any) -> "Axes":
        """Draw differences over errors on logarithmic axes, or other columns. The arguments are those of `Result.plot`."""
        return logarithmic(super().plot(ax, x=x, y=y, by=by, **style))


class Certificate(Result):
    """Proofs in ball arithmetic (`Model.certify`): corner impacts, orbits, or counts of orbits."""

    bits: int
    known: str
    corner_impacts: list[Result]
    orbits: list[Result]
    counts: list[Result]
    undecided: list[Result]

    def _lists(self) -> tuple[str, ...]:
        return (next(name for name in ("corner_impacts", "counts", "orbits") if name in self), *(["impacts"] if "orbits" in self else []))

    def _columns_drawn(self) -> tuple[str, str, str]:
        plots = {"counts": ("from_rpm", "one_impact_orbits", ""), "orbits": ("cam_angle_deg", "relative_velocity", "kind")}
        return plots.get(self._lists()[0], ("speed_rpm", "cam_angle_deg", "verdict"))


class Ending(Result):
    """A motion on which starts settle, and their share."""

    ending: str
    revolutions: int
    impacts: int
    growth: float
    growth_error: float
    starts: int
    share: float
    share_standard_error: float


class Basins(Result):
    """Basins of attraction at one speed (`Model.basins`).

    With a grid there are `ending`, int32 of shape (velocities, positions), with an index of `endings` or -1 for each start, and
    `positions` and `velocities`, the starts along each axis.
    """

    model: str
    rpm: float
    cam_angle_rad: float
    cam_angle_deg: float
    starts: int
    endings: list[Ending]
    below_cam: int
    failed: int
    ending: Array
    positions: Array
    velocities: Array
    _path = ("endings",)

    def to_xarray(self) -> "xr.Dataset":
        """Return the grid as an xarray Dataset along `velocity` and `position`, or without a grid the table of endings."""
        if "ending" not in vars(self):
            return super().to_xarray()
        found: Any = self._dataset({"ending": (("velocity", "position"), self.ending)})
        dataset: xr.Dataset = found.assign_coords(velocity=self.velocities, position=self.positions)
        return dataset

    def plot(self, ax: "Axes | None" = None, *, x: str = "", y: str = "", by: str = "", **style: Any) -> "Axes":
        """Draw the basins on `ax` or a new figure; `style` goes to `pcolormesh`. Returns the Axes.

        Raises ValueError without a grid, and TypeError if `x`, `y` or `by` is given, since a grid has no choice of columns.
        """
        if "ending" not in vars(self):
            raise ValueError("a plot is of a grid: basins(rpm, (columns, rows))")
        refuse(x=x, y=y, by=by)
        axes = axes_or_new(ax)
        mesh(axes, self.positions, self.velocities, self.ending, self._names(), **style)
        names = [next(name for name in self if name.startswith(word)) for word in ("position_", "velocity_")]
        axes.set(xlabel=label(names[0]), ylabel=label(names[1]))
        return cast("Axes", axes)


    def _names(self) -> list[str]:
        """Return a name for each ending, with a number if another ending has the same name."""
        def named(part: Result) -> str:
            period = [f"{part[what]} {what if part[what] != 1 else what[:-1]}" for what in ("revolutions", "impacts") if what in part]
            return ", ".join([part["ending"], *period])

        names = [named(part) for part in self.endings]
        return [f"{name} ({names[: index + 1].count(name)})" if names.count(name) > 1 else name for index, name in enumerate(names)]


class BasinShares(Result):
    """Shares of the basins over several values (`Model.basins`)."""

    model: str
    over: str
    range: Array
    values_: list[Result]
    _path = ("values", "endings")

    def _columns_drawn(self) -> tuple[str, str, str]:
        return "value" if "rpm" in self else "speed_rpm", "share", "ending"


class BranchPoint(Result):
    """An orbit on a branch. `special` is None, or says what happens there."""

    speed_rpm: float
    value: float
    special: Any
    orbit: Orbit


class Branch(Result):
    """A branch of orbits, with the reasons for its ends."""

    begins: str
    ends: str
    points: list[BranchPoint]
    _path = ("points",)
    _drawn = ("value", "orbit_state_1", "orbit_stability")
    _words = {"orbit_state_1": "position ({length})", "orbit_state_2": "velocity ({length}/s)"}

    def table(self) -> dict[str, Array]:
        """Return one row a point, with the cam angle of the orbit's first impact as `cam_angle_rad` or `cam_angle_deg`."""
        return super().table() | _first_impacts(self["points"])


class Branches(Result):
    """Branches of orbits through a number (`Model.continue_`)."""

    model: str
    speed_rpm: float
    parameter: str
    branches: list[Branch]
    _path = ("branches", "points")
    _drawn = ("value", "orbit_state_1", "orbit_stability")
    _words = {"orbit_state_1": "position ({length})", "orbit_state_2": "velocity ({length}/s)"}

    def table(self) -> dict[str, Array]:
        """Return one row a point, with the cam angle of the orbit's first impact as `cam_angle_rad` or `cam_angle_deg`."""
        return super().table() | _first_impacts([point for branch in self["branches"] for point in branch["points"]])


def _first_impacts(points: list[dict[str, Any]]) -> dict[str, Array]:
    """Return the cam angle of the first impact of each point's orbit as a column; NaN without an impact."""
    firsts = [next(iter(point["orbit"]["impacts"]), dict[str, Any]()) for point in points]
    name = next((name for first in firsts for name in first if name.startswith("cam_angle")), "")
    return {name: np.array([first.get(name, np.nan) for first in firsts])} if name else {}


class CurvePoint(Result):
    """A bifurcation on a curve. `multipliers` is complex, shape (2,) or (4,)."""

    speed_rpm: float
    value: float
    cam_angle_rad: float
    cam_angle_deg: float
    revolutions: int
    impacts: int
    happens: str | None
    multipliers: Array


class Curve(Result):
    """A curve of one kind of bifurcation, with the reasons for its ends."""

    event: str
    begins: str
    ends: str
    points: list[CurvePoint]
    _path = ("points",)
    _drawn = ("value", "speed_rpm", "happens")


class Curves(Result):
    """Curves of bifurcations through a number (`Model.curve`)."""

    model: str
    parameter: str
    own_value: float
    curves: list[Curve]
    _path = ("curves", "points")
    _drawn = ("value", "speed_rpm", "event")


class Theorem(Result):
    """A set of chaotic motions that is proved to exist. `symbols` are the numbers of impacts of its strips, shape (strips,)."""

    rpm: Array
    symbols: Array
    entropy_per_revolution: float
    cones: bool
    proved: bool
    h_set: Result
    strips: list[Result]


class Chaos(Result):
    """Proofs of chaos (`Model.chaos`)."""

    model: str
    rpm: Array
    known: str
    theorems: list[Theorem]
    open: list[Result]
    trapping: Result
    _path = ("theorems",)
    _drawn = ("rpm_1", "entropy_per_revolution", "")
    _words = {"rpm_1": "lowest speed (rpm)", "rpm_2": "highest speed (rpm)"}


class Figures(Result):
    """Figures of the report (`Model.figure`)."""

    model: str
    figures: list[Result]
    _path = ("figures",)


class Figure(Result):
    """A figure of the report with every number that it shows (`Model.figure`). `svg` is the picture."""

    model: str
    id: str
    place: str
    title: str
    caption: str
    command: str
    figure: Result
    svg: str

    def _repr_svg_(self) -> str:
        return self.svg

    def _repr_html_(self) -> str:
        return f"<table><caption>{html.escape(self['title'])}</caption></table>{self.svg}"

    def table(self) -> dict[str, Array]:
        """Return all points as columns `panel`, `series`, `x` and `y`."""
        drawn = [
            (panel, series, points)
            for panel, part in enumerate(self["figure"]["panels"])
            for series, one in enumerate(part["series"])
            for points in _points(one).values()
        ]
        counts = [len(points) for *_, points in drawn]
        both = np.concatenate([np.zeros((0, 2)), *(points for *_, points in drawn)])
        places = [np.repeat(np.array([one[index] for one in drawn], dtype=int), counts) for index in (0, 1)]
        return {"panel": places[0], "series": places[1], "x": both[:, 0], "y": both[:, 1]}

    def plot(self, ax: "Axes | None" = None, *, x: str = "", y: str = "", by: str = "", **style: Any) -> "Axes":
        """Draw the lines, points and clouds of the first panel on `ax` or a new figure. Returns the Axes. `svg` has all panels.

        Raises TypeError if `x`, `y` or `by` is given, since a figure has no choice of columns.
        """
        refuse(x=x, y=y, by=by)
        axes, document = axes_or_new(ax), self["figure"]
        kinds: dict[str, dict[str, Any]] = {"points": {"linestyle": "none", "marker": "."}, "density": {"linestyle": "none", "marker": ".", "markersize": 1, "markeredgewidth": 0}}
        for one in document["panels"][0]["series"]:
            for kind, points in _points(one).items():
                colour = {"ink": "black", "vermilion": "orangered"}.get(one["colour"], one["colour"])
                looks: dict[str, Any] = {"color": colour, "label": one["label"] or "_", **kinds.get(kind, {})} | style
                drawn(axes.plot, *points.T, **looks)
        if document["panels"][0]["y"]["to_scale"]:
            axes.set_aspect("equal")
        if any(one["label"] for one in document["panels"][0]["series"]):
            for handle in axes.legend().legend_handles:
                handle.set_markersize(6)
        words = [f"{axis['label']} ({axis['unit']})" if axis["unit"] else axis["label"] for axis in (document["x"], document["panels"][0]["y"])]
        axes.set(xlabel=words[0], ylabel=words[1], title=self["title"])
        return cast("Axes", axes)


def _points(series: dict[str, Any]) -> dict[str, Array]:
    """Return the points of a figure's series by kind, shape (N, 2). A cloud gives the middles of its cells; words and bands give nothing."""
    found: dict[str, Array] = {}
    for kind, data in series["data"].items():
        if kind == "density" and data["counts"]:
            cells = np.array(data["counts"], dtype=int)[:, 0]
            places = ((cells % data["columns"], data["columns"], data["x"]), (cells // data["columns"], data["rows"], data["y"]))
            found[kind] = np.column_stack([low + (high - low) * (at + 0.5) / count for at, count, (low, high) in places])
        elif "points" in data and data["points"]:
            found[kind] = np.array(data["points"], dtype=float)
    return found


class Explanation(Result):
    """Meaning of a name (`Model.explain`)."""

    what: str
    sentence: str
    formula: str | None
    label: str | None
    inputs: list[Result]
    value: Any
    routes: Result
    known: str
    code: Result | None
    derivation: Result | None
    tests: list[Result]
    paper: str | None
    _path = ("inputs",)
    _drawn = ("name", "value", "")


class ChartPoints(Columns):
    """Points of a chart (`Chart.compute`): arrays of shape (rows, columns). `axes` has the values of both axes by name."""

    class_: Array
    revolutions: Array
    impacts: Array
    growth_rate: Array
    growth_error: Array
    impact_speed: Array
    axes: dict[str, Array]
    chart: Chart

    def table(self) -> dict[str, Array]:
        """Return one row for each point, with the values of the axes first, and names for classes."""
        names = dict(zip(self.axes, (values.ravel() for values in np.meshgrid(*self.axes.values(), indexing="ij"))))
        return names | {name: np.array(self._classes())[column.ravel()] if name == "class" else column.ravel() for name, column in self.items()}

    def to_xarray(self) -> "xr.Dataset":
        """Return the points as an xarray Dataset, with units and the meanings of codes as CF attributes (extra `xarray`)."""
        return described(self.chart, self.axes, dict(self))

    def sel(self, method: Any = None, tolerance: Any = None, drop: bool = False, **values: Any) -> "xr.Dataset":
        """Select from `to_xarray` by the values of axes, named in full or by the last part of the name: `sel(restitution=0.7)`.

        Raises KeyError if an axis has no such value, and ValueError if there is no such axis. Options are those of xarray.
        """
        whole = {self._axis(name): value for name, value in values.items()}
        return self.to_xarray().sel(whole, method=method, tolerance=tolerance, drop=drop)

    def _axis(self, name: str) -> str:
        found = [axis for axis in self.axes if name in (axis, axis.rpartition(".")[2])]
        if not found:
            raise ValueError(f"there is no axis {name!r}; there are: {', '.join(self.axes)}")
        return found[0]

    def _classes(self) -> list[str]:
        return next(str(of["attributes"]["flag_meanings"]).split() for of in chart_variables() if of["name"] == "class")

    def plot(self, ax: "Axes | None" = None, *, x: str = "", y: str = "", by: str = "class", **style: Any) -> "Axes":
        """Draw the variable `by` over the axes `x` and `y` (the second and the first), on `ax` or a new figure. Returns the Axes."""
        if by not in self:
            raise ValueError(f"there is no variable {by!r}; there are: {', '.join(self)}")
        axes, names = axes_or_new(ax), list(self.axes)
        across = self._axis(x) if x else next(name for name in reversed(names) if not y or name != self._axis(y))
        up = next(name for name in names if name != across)
        values = self[by] if across == names[1] else self[by].T
        if by == "class":
            mesh(axes, self.axes[across], self.axes[up], values, self._classes(), **style)
        else:
            right, above = np.argsort(self.axes[across]), np.argsort(self.axes[up])
            shown = values[np.ix_(above, right)]
            looks: dict[str, Any] = {"shading": "nearest"} | style
            cells = drawn(axes.pcolormesh, self.axes[across][right], self.axes[up][above], shown, **looks)
            axes.figure.colorbar(cells, ax=axes, label=label(by))
        axes.set(xlabel=label(across), ylabel=label(up))
        return cast("Axes", axes)


def described(chart: Chart, axes: dict[str, Array], arrays: dict[str, Any]) -> "xr.Dataset":
    """Return arrays of a chart as an xarray Dataset, with units and the meanings of codes as CF attributes."""
    attributes = {of["name"]: of["attributes"] for of in chart_variables(chart)}
    coordinates = {name: (name, values, {"units": "rpm"} if name == "rpm" else {}) for name, values in axes.items()}
    variables = {name: (list(axes), values, attributes[name]) for name, values in arrays.items()}
    found: xr.Dataset = need("xarray", "xarray").Dataset(variables, coordinates, chart.attributes)
    return found
