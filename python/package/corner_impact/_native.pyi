# Held against the compiled module by stubtest.
from collections.abc import Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, final, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from corner_impact import results

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

__all__ = ["Chart", "LocalMap", "Model", "Page", "__version__", "blocks_done", "chart_variables", "events", "main"]

__version__: str

_Array: TypeAlias = NDArray[np.float64]
_Document: TypeAlias = dict[str, Any]  # as json.loads returns it
_Speeds: TypeAlias = float | tuple[float, float, int] | Sequence[float] | NDArray[Any]
_Over: TypeAlias = tuple[str, float, float, int] | tuple[str, Sequence[float] | NDArray[Any]]
_Range: TypeAlias = tuple[float, float] | Sequence[float] | NDArray[Any]  # lowest, highest
_Path: TypeAlias = str | PathLike[str]

@final
class Model:
    @staticmethod
    def load(path: _Path) -> Model: ...
    @staticmethod
    def parse(text: str, file: str = "model") -> Model: ...
    @staticmethod
    def from_dict(fields: dict[str, Any], name: str = "dict") -> Model: ...
    @staticmethod
    def paper() -> Model: ...
    @property
    def name(self) -> str: ...
    @property
    def source(self) -> str: ...
    def notes(self, rpm: tuple[float, float] | None = None) -> list[str]: ...
    @property
    def text(self) -> str: ...
    def numbers(self) -> dict[str, float]: ...
    def errors(self) -> dict[str, float]: ...
    def unit(self, path: str) -> str: ...
    def with_number(self, name: str, value: float) -> Model: ...
    def cam(
        self, angle: ArrayLike | None = None, *, angle_rad: ArrayLike | None = None, angle_deg: ArrayLike | None = None
    ) -> results.CamLift: ...
    def simulate(
        self,
        rpm: float,
        revolutions: int = 100,
        *,
        transient: int = 0,
        start_angle_rad: float | None = None,
        start_angle_deg: float | None = None,
        cam_angle: float | None = None,
        relative_velocity: float | None = None,
        position: float | None = None,
        velocity: float | None = None,
    ) -> results.Events: ...
    def diagram(
        self,
        rpm: _Speeds,
        *,
        over: _Over | None = None,
        log: bool = False,
        transient: int = 300,
        record: int = 100,
        strobe_rad: float | None = None,
        strobe_deg: float | None = None,
        strobe: float | None = None,
        follow: Literal["up", "down"] | None = None,
        lyapunov: bool = False,
        start_angle_rad: float | None = None,
        start_angle_deg: float | None = None,
        cam_angle: float | None = None,
        relative_velocity: float | None = None,
        position: float | None = None,
        velocity: float | None = None,
        threads: int | None = None,
    ) -> results.Diagram: ...
    def strobe_map(
        self,
        rpm: float,
        position: ArrayLike,
        velocity: ArrayLike,
        revolutions: int = 1,
        *,
        cam_angle: float | None = None,
        cam_angle_rad: float | None = None,
        cam_angle_deg: float | None = None,
        jacobian: bool = False,
        threads: int | None = 1,
    ) -> results.StrobeMap: ...
    def impact_map(
        self,
        rpm: float,
        cam_angle: ArrayLike | None = None,
        relative_velocity: ArrayLike | None = None,
        *,
        cam_angle_rad: ArrayLike | None = None,
        cam_angle_deg: ArrayLike | None = None,
        threads: int | None = 1,
    ) -> results.ImpactMap: ...
    def orbits(
        self,
        rpm: float,
        revolutions: int = 1,
        impacts: int | None = None,
        *,
        guess: tuple[float, float] | Sequence[float] | None = None,
    ) -> results.Orbits: ...
    def locate(self, rpm: _Range, revolutions: int = 1) -> results.Located: ...
    def speeds(
        self,
        rpm: float | _Range | None = None,
        *,
        over: tuple[str, float, float] | None = None,
        log: bool = False,
        speeds: int = 300,
        step: float | None = None,
        starts: int = 64,
        two_impacts: bool = False,
        states: Sequence[tuple[float, float]] | None = None,
        start_angle_rad: float | None = None,
        start_angle_deg: float | None = None,
        cam_angle: float | None = None,
        transient: int = 200,
        record: int = 1600,
        longest: int = 32,
        patience: int = 100_000,
    ) -> results.SpeedSurvey: ...
    def design(
        self,
        rpm: float | _Range | None = None,
        *,
        over: _Over | None = None,
        log: bool = False,
        speeds: int = 21,
        needs: Sequence[str] = (),
    ) -> results.Design: ...
    def verify(self, external: bool = True) -> results.Verification: ...
    def compare(self, other: Model, *, external: bool = True) -> results.Comparison: ...
    def certify(
        self,
        rpm: float | _Range | None = None,
        revolutions: int = 1,
        *,
        bits: int = 128,
        orbits: bool = False,
    ) -> results.Certificate: ...
    @overload
    def basins(  # type: ignore[overload-overlap]
        self,
        rpm: float,
        grid: tuple[int, int] | None = None,
        *,
        over: None = None,
        log: bool = False,
        strobe_rad: float | None = None,
        strobe_deg: float | None = None,
        position: tuple[float, float] | None = None,
        velocity: tuple[float, float] | None = None,
        states: Sequence[tuple[float, float]] | None = None,
        transient: int = 200,
        record: int = 1600,
        longest: int = 32,
        patience: int = 100_000,
        threads: int | None = None,
    ) -> results.Basins: ...
    @overload
    def basins(
        self,
        rpm: _Speeds,
        grid: tuple[int, int] | None = None,
        *,
        over: _Over | None = None,
        log: bool = False,
        strobe_rad: float | None = None,
        strobe_deg: float | None = None,
        position: tuple[float, float] | None = None,
        velocity: tuple[float, float] | None = None,
        states: Sequence[tuple[float, float]] | None = None,
        transient: int = 200,
        record: int = 1600,
        longest: int = 32,
        patience: int = 100_000,
        threads: int | None = None,
    ) -> results.BasinShares: ...
    def continue_(
        self,
        rpm: float,
        over: tuple[str, float, float],
        *,
        revolutions: int = 1,
        impacts: int | None = None,
        step: float = 0.02,
        points: int = 2000,
        doublings: int = 0,
    ) -> results.Branches: ...
    def curve(
        self,
        rpm: _Range,
        over: tuple[str, float, float],
        *,
        events: Sequence[str] = (),
        revolutions: int = 1,
        impacts: int | None = None,
        step: float = 0.02,
        points: int = 2000,
    ) -> results.Curves: ...
    def chaos(self, rpm: float | _Range, *, trapping: bool = False) -> results.Chaos: ...
    @overload
    def figure(self, id: None = None, *, rpm: _Range | None = None) -> results.Figures: ...
    @overload
    def figure(self, id: str, *, rpm: _Range | None = None) -> results.Figure: ...
    def explain(self, what: str, *, external: bool = True) -> results.Explanation: ...
    def _repr_svg_(self) -> str: ...
    def cam_picture(
        self,
        *,
        width: str | None = None,
        height: str | None = None,
        size: str | None = None,
        font: str | None = None,
        title: bool | str | None = None,
        legend: str | None = None,
        theme: str | None = None,
        x_range: tuple[float, float] | None = None,
        y_range: tuple[float, float] | None = None,
    ) -> str: ...
    def explore(self) -> Page: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __reduce__(self) -> tuple[Any, tuple[str, str]]: ...

@final
class LocalMap:
    def __new__(cls, model: Model, rpm: _Range | None = None, revolutions: int = 1) -> LocalMap: ...
    @property
    def A_minus(self) -> _Array: ...
    @property
    def A_plus(self) -> _Array: ...
    @property
    def B_minus(self) -> _Array: ...
    @property
    def B_plus(self) -> _Array: ...
    @property
    def C(self) -> _Array: ...
    @property
    def D(self) -> float: ...
    @property
    def border(self) -> _Array: ...
    @property
    def classification(self) -> results.Classification: ...
    @property
    def corner_impact(self) -> results.CornerImpact: ...
    def __call__(self, /, dx: ArrayLike, dT: ArrayLike, steps: int = 1) -> _Array: ...
    def side(self, dx: ArrayLike, dT: ArrayLike) -> NDArray[np.int8]: ...
    def orbit(self, word: str, dT: float) -> results.LocalOrbit: ...
    def orbits(self, dT: float, longest: int = 8) -> results.LocalOrbits: ...
    def outcome(self, dT: float) -> results.LocalOutcome: ...
    def _repr_html_(self) -> str: ...
    def __reduce__(self) -> tuple[Any, tuple[Model, tuple[float, float] | None, int]]: ...

@final
class Page:
    @property
    def html(self) -> str: ...
    def save(self, path: _Path) -> None: ...
    def _repr_html_(self) -> str: ...

@final
class Chart:
    def __new__(
        cls,
        model: Model,
        axes: Mapping[str, ArrayLike],
        *,
        rpm: float | None = None,
        transient: int = 300,
        record: int = 100,
        longest: int = 32,
        patience: int = 0,
        start_angle_rad: float | None = None,
        start_angle_deg: float | None = None,
        cam_angle: float | None = None,
        relative_velocity: float | None = None,
        position: float | None = None,
        velocity: float | None = None,
    ) -> Chart: ...
    @property
    def model(self) -> Model: ...
    @property
    def axes(self) -> dict[str, NDArray[np.float64]]: ...
    @property
    def shape(self) -> tuple[int, int]: ...
    @property
    def transient(self) -> int: ...
    @property
    def record(self) -> int: ...
    @property
    def longest(self) -> int: ...
    @property
    def patience(self) -> int: ...
    @property
    def rpm(self) -> float | None: ...
    @property
    def attributes(self) -> _Document: ...
    def compute(
        self,
        rows: tuple[int, int] | None = None,
        columns: tuple[int, int] | None = None,
        *,
        threads: int | None = None,
    ) -> results.ChartPoints: ...
    def sel(self, **values: Any) -> xr.Dataset: ...
    def to_xarray(self) -> xr.Dataset: ...
    def to_netcdf(self, path: _Path) -> None: ...
    def plot(self, **how: Any) -> Axes: ...
    def begin(self, path: _Path, chunks: tuple[int, int] = (100, 100)) -> tuple[int, int]: ...
    def fill(
        self,
        path: _Path,
        block: int,
        chunks: tuple[int, int] = (100, 100),
        *,
        threads: int | None = 1,
    ) -> bool: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

def blocks_done(path: _Path) -> NDArray[np.bool_]: ...
def chart_variables(chart: Chart | None = None) -> list[_Document]: ...
def events() -> list[str]: ...
def main(words: list[str]) -> int: ...
