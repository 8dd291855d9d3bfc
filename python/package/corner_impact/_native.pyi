# Held against the compiled module by stubtest.
from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any, Literal, TypeAlias, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["Chart", "Model", "Page", "__version__", "blocks_done", "chart_variables", "events", "main"]

__version__: str

# Arrays by name; documents as json.loads makes them.
_Columns: TypeAlias = dict[str, NDArray[Any]]
_Document: TypeAlias = dict[str, Any]
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
    def cam(self, angle: ArrayLike) -> _Columns: ...
    def simulate(
        self,
        rpm: float,
        revolutions: int = 100,
        *,
        transient: int = 0,
        cam_angle: float = 0.0,
        relative_velocity: float | None = None,
        position: float | None = None,
        velocity: float | None = None,
    ) -> _Columns: ...
    def diagram(
        self,
        rpm: float | tuple[float, float, int],
        *,
        over: tuple[str, float, float, int] | None = None,
        log: bool = False,
        transient: int = 300,
        record: int = 100,
        strobe: float | None = None,
        follow: Literal["up", "down"] | None = None,
        lyapunov: bool = False,
        cam_angle: float = 0.0,
        relative_velocity: float | None = None,
        position: float | None = None,
        velocity: float | None = None,
        threads: int | None = None,
    ) -> _Columns: ...
    def strobe_map(
        self,
        rpm: float,
        position: ArrayLike,
        velocity: ArrayLike,
        revolutions: int = 1,
        *,
        cam_angle: float = 0.0,
        jacobian: bool = False,
        threads: int | None = 1,
    ) -> _Columns: ...
    def impact_map(
        self,
        rpm: float,
        cam_angle: ArrayLike,
        relative_velocity: ArrayLike,
        *,
        threads: int | None = 1,
    ) -> _Columns: ...
    def orbits(
        self,
        rpm: float,
        revolutions: int = 1,
        impacts: int | None = None,
        *,
        guess: tuple[float, float] | None = None,
    ) -> _Document: ...
    def locate(self, rpm: tuple[float, float], revolutions: int = 1) -> _Document: ...
    def speeds(
        self,
        rpm: float | tuple[float, float] | None = None,
        *,
        over: tuple[str, float, float] | None = None,
        log: bool = False,
        speeds: int = 300,
        step: float | None = None,
        starts: int = 64,
        two_impacts: bool = False,
        states: Sequence[tuple[float, float]] | None = None,
        cam_angle: float = 0.0,
        transient: int = 200,
        record: int = 1600,
        longest: int = 32,
        patience: int = 100_000,
    ) -> _Document: ...
    def design(
        self,
        rpm: float | tuple[float, float] | None = None,
        *,
        over: tuple[str, float, float, int] | None = None,
        log: bool = False,
        speeds: int = 21,
        needs: Sequence[str] = (),
    ) -> _Document: ...
    def verify(self, external: bool = True) -> _Document: ...
    def compare(self, other: Model, *, external: bool = True) -> _Document: ...
    def certify(
        self,
        rpm: float | tuple[float, float] | None = None,
        revolutions: int = 1,
        *,
        bits: int = 128,
        orbits: bool = False,
    ) -> _Document: ...
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
        cam_angle: float = 0.0,
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
    ) -> _Columns: ...
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
