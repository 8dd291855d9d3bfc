"""Results of a model: what each has, as types, and which of it is a table and a plot.

Each class is the document of one command, or the columns of one run. Its declarations name the attributes that are always there; the
commands' pages describe all entries. Names of lengths and forces end in the model's units: `position_m`, or `position_mm` in millimetres.
"""

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from corner_impact._extras import need
from corner_impact._native import Chart, chart_variables
from corner_impact._result import Array, Ball, Columns, Result, axes_or_new, entries, label, mesh

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

__all__ = [
    "Attractor", "Ball", "BasinShares", "Basins", "Branch", "Branches", "CamLift", "Certificate", "Chaos", "ChartPoints", "Classification",
    "Columns", "Comparison", "CornerImpact", "Curve", "Curves", "Design", "Diagram", "Events", "Explanation", "Figure", "Figures",
    "ImpactMap", "LocalOrbit", "LocalOrbits", "LocalOutcome", "Located", "Orbit", "Orbits", "Result", "SpeedSurvey", "StrobeMap",
    "Verification", "entries",
]


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
        """Rows of impacts alone."""
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
        """Draw the basins on `ax` or a new figure. Returns the Axes. Raises ValueError without a grid."""
        if "ending" not in vars(self):
            raise ValueError("a plot is of a grid: basins(rpm, (columns, rows))")
        axes = axes_or_new(ax)
        mesh(axes, self.positions, self.velocities, self.ending, [f"{part.ending} {index}" for index, part in enumerate(self.endings)])
        names = [next(name for name in self if name.startswith(word)) for word in ("position_", "velocity_")]
        axes.set(xlabel=label(names[0]), ylabel=label(names[1]))
        return cast("Axes", axes)


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


class Branches(Result):
    """Branches of orbits through a number (`Model.continue_`)."""

    model: str
    speed_rpm: float
    parameter: str
    branches: list[Branch]
    _path = ("branches", "points")
    _drawn = ("value", "orbit_state_1", "orbit_stability")


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


class Curves(Result):
    """Curves of bifurcations through a number (`Model.curve`)."""

    model: str
    parameter: str
    own_value: float
    curves: list[Curve]
    _path = ("curves", "points")
    _drawn = ("value", "speed_rpm", "event")


class Theorem(Result):
    """A set of chaotic motions that is proved to exist. `symbols` are impacts of its strips, shape (strips,)."""

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
        """Draw the lines and points of the first panel on `ax` or a new figure. Returns the Axes. `svg` has all panels."""
        axes, document = axes_or_new(ax), self["figure"]
        for one in document["panels"][0]["series"]:
            for kind, points in _points(one).items():
                looks: dict[str, Any] = {"linestyle": "none", "marker": "."} if kind == "points" else {}
                colour = {"ink": "black", "vermilion": "orangered"}.get(one["colour"], one["colour"])
                axes.plot(*points.T, label=one["label"] or "_", color=colour, **looks | style)
        words = [f"{axis['label']} ({axis['unit']})" if axis["unit"] else axis["label"] for axis in (document["x"], document["panels"][0]["y"])]
        axes.set(xlabel=words[0], ylabel=words[1], title=self["title"])
        return cast("Axes", axes)


def _points(series: dict[str, Any]) -> dict[str, Array]:
    """Points of a series of a figure by their kind, shape (N, 2); none of words, bands and cells."""
    drawn: dict[str, Any] = {kind: data for kind, data in series["data"].items() if "points" in data}
    return {kind: np.array(data["points"], dtype=float) for kind, data in drawn.items() if data["points"]}


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
        """Select from `to_xarray` by the values of axes, named whole or by their ends: `sel(restitution=0.7)`.

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
        axes, names = axes_or_new(ax), list(self.axes)
        across = self._axis(x) if x else next(name for name in reversed(names) if not y or name != self._axis(y))
        up = next(name for name in names if name != across)
        values = self[by] if across == names[1] else self[by].T
        if by == "class":
            mesh(axes, self.axes[across], self.axes[up], values, self._classes())
        else:
            right, above = np.argsort(self.axes[across]), np.argsort(self.axes[up])
            shown = values[np.ix_(above, right)]
            drawn = axes.pcolormesh(self.axes[across][right], self.axes[up][above], shown, shading="nearest", **style)
            axes.figure.colorbar(drawn, ax=axes, label=label(by))
        axes.set(xlabel=label(across), ylabel=label(up))
        return cast("Axes", axes)


def described(chart: Chart, axes: dict[str, Array], arrays: dict[str, Any]) -> "xr.Dataset":
    """Return arrays of a chart as an xarray Dataset, with units and the meanings of codes as CF attributes."""
    attributes = {of["name"]: of["attributes"] for of in chart_variables(chart)}
    coordinates = {name: (name, values, {"units": "rpm"} if name == "rpm" else {}) for name, values in axes.items()}
    variables = {name: (list(axes), values, attributes[name]) for name, values in arrays.items()}
    found: xr.Dataset = need("xarray", "xarray").Dataset(variables, coordinates, chart.attributes)
    return found
