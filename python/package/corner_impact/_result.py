"""The base of all results: a dict with attributes, tables, plots and a picture for notebooks."""

import html
import json
from collections.abc import Iterator
from os import PathLike
from typing import TYPE_CHECKING, Any, ClassVar, TypeGuard, cast, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray

from corner_impact._extras import need
from corner_impact._native import events

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes

Array = NDArray[Any]
Path = str | PathLike[str]

LENGTHS = ("m", "cm", "mm", "um", "in", "ft", "thou")
UNITS = {
    **{f"_{length}{end}": length + by for end, by in (("_rad2", "/rad^2"), ("_rad", "/rad"), ("_s", "/s"), ("", "")) for length in LENGTHS},
    "_s": "s", "_rad": "rad", "_deg": "deg", "_rpm": "rpm", "_n": "N", "_mn": "mN", "_kn": "kN", "_kgf": "kgf", "_lbf": "lbf", "_j": "J",
}  # fmt: skip
"""Units by the ends of names. The first end that fits decides, so longer ends come before shorter ones."""


class Result(dict[str, Any]):
    """Result of the program: a dict with the entries of the command's document, which are also attributes.

    A subscript returns an entry as the document has it. An attribute returns it as an object: a table as a `Result`, a list of tables
    as a list of `Result`s, numbers as a numpy array, and a pair `re`, `im` as a complex number. An angle has two attributes, such as
    `cam_angle_rad` and `cam_angle_deg`. A name that Python or dict reserves ends in an underscore: `class_`, `values_`.

    `to_pandas`, `to_xarray` and `plot` show the main table of the result.
    """

    _path: ClassVar[tuple[str, ...]] = ()
    """Lists within lists whose entries are the rows of the main table."""
    _drawn: ClassVar[tuple[str, str, str]] = ("", "", "")
    """Columns of a plot: across, up, and the column that distinguishes series. A name may lack its unit."""
    _words: ClassVar[dict[str, str]] = {}
    """Labels of axes for columns whose names do not say enough."""
    _looks: ClassVar[dict[str, Any]] = {"linestyle": "none", "marker": "o", "markeredgewidth": 0}
    """Style of a plot."""

    def __getattr__(self, name: str) -> Any:
        if not name.startswith("__"):
            own = name[:-1] if name.endswith("_") else name
            if own in self:
                return _object(self[own], _hints(type(self)).get(name))
            for unit, other, turn in (("_deg", "_rad", np.degrees), ("_rad", "_deg", np.radians)):
                if own.endswith(unit) and (turned := own.removesuffix(unit) + other) in self:
                    angle = _object(self[turned], None)
                    return float(turn(angle)) if isinstance(angle, float | int) else turn(angle)
        raise AttributeError(f"{type(self).__name__} has no {name!r}; it has: {', '.join(self)}")

    def __dir__(self) -> list[str]:
        turned = [name[:-4] + {"_rad": "_deg", "_deg": "_rad"}[name[-4:]] for name in self if name.endswith(("_rad", "_deg"))]
        return [*super().__dir__(), *(name for name in self if name.isidentifier()), *turned]

    def __eq__(self, other: object) -> bool:
        """Compare class and entries, arrays by their values with NaN equal to NaN. The time that a study took is ignored."""
        if not isinstance(other, Result):
            return _same(dict(self), other)
        return type(self) is type(other) and _same(self._compared(), other._compared())

    def __ne__(self, other: object) -> bool:
        return not self == other

    def _compared(self) -> dict[str, Any]:
        return {name: value for name, value in (dict(self) | vars(self)).items() if name not in ("wall_s", "chart")}

    def __repr__(self) -> str:
        return f"<{self._title()}>"

    def _title(self) -> str:
        sizes = [f"{len(value)} {name}" for name, value in self.items() if _is_list(value) and name in self._lists()]
        parts = [type(self).__name__, *(["of", str(self["model"])] if isinstance(self.get("model"), str) else []), *sizes]
        plain = [
            f"{name}={value:.7g}" if isinstance(value, float) else f"{name}={value}" if isinstance(value, str | int) else name
            for name, value in self.items()
            if name not in ("schema", "model")
        ]
        while not sizes and plain and len(" ".join([*parts, plain[0]])) < 80:
            parts.append(plain.pop(0))
        return " ".join(parts)

    def to_dict(self) -> dict[str, Any]:
        """Return the entries as a plain dict, as the command's document has them."""
        return dict(self)

    def table(self) -> dict[str, Array]:
        """Return the main table as columns by name, each of shape (rows,).

        Lists of numbers become numbered columns such as `state_1`, complex numbers become `_re` and `_im`, and lists of tables become
        their lengths. A result without a list of its own is a table of one row.
        """
        if not self._lists():
            return _columns([dict(_flat("", dict(self)))])
        return _columns(list(_rows(self, self._lists())))

    def to_pandas(self) -> "pd.DataFrame":
        """Return the main table as a pandas DataFrame, with units by column in `attrs["units"]`. Raises ImportError without pandas (extra `pandas`)."""
        frame: pd.DataFrame = need("pandas", "pandas").DataFrame(self.table())
        frame.attrs["units"] = {name: unit["units"] for name in map(str, frame.columns) if (unit := _unit(name))}
        return frame

    def to_xarray(self) -> "xr.Dataset":
        """Return the main table as an xarray Dataset along `row`, with units as attributes. Raises ImportError without xarray (extra `xarray`)."""
        return self._dataset({name: (("row",), column) for name, column in self.table().items()})

    def to_netcdf(self, path: Path) -> None:
        """Write `to_xarray` to a netCDF file. Raises ImportError without h5netcdf and xarray (extra `netcdf`)."""
        need("h5netcdf", "netcdf")
        dataset: Any = self.to_xarray()
        # A netCDF file has neither None nor tables. None is left out, and tables are written as text.
        notes = {name: note for name, note in dataset.attrs.items() if note is not None}
        dataset.attrs = {name: json.dumps(note) if _is_dict(note) or _is_list(note) else note for name, note in notes.items()}
        dataset.to_netcdf(path, engine="h5netcdf")

    def plot(self, ax: "Axes | None" = None, *, x: str = "", y: str = "", by: str = "", **style: Any) -> "Axes":
        """Draw column `y` of the main table over column `x`, one series for each value of `by`, on `ax` or a new figure.

        Each class of results has default columns. `style` goes to `matplotlib.axes.Axes.plot`. Returns the Axes. Raises ValueError if
        there is no such column or nothing to plot, and ImportError without matplotlib (extra `plot`).
        """
        names, table = self._columns_drawn(), self._plotted()
        if not (x or names[0]) or not table:
            raise ValueError(f"{type(self).__name__} has nothing to plot" + (f"; its columns: {', '.join(table)}" if table else ""))
        (across, rights), (up, ups) = (_column(table, name) for name in (x or names[0], y or names[1]))
        series = _column(table, by or names[2])[1] if by or names[2] else np.zeros(len(ups))
        axes = axes_or_new(ax)
        whole = need("matplotlib.cbook", "plot").normalize_kwargs(style, need("matplotlib.lines", "plot").Line2D)
        looks: dict[str, Any] = {**self._looks, "markersize": next(size for most, size in SIZES if len(ups) < most)} | whole
        for kind in dict.fromkeys(series.tolist()):
            here = series == kind
            drawn(axes.plot, rights[here], ups[here], **{"label": str(kind) if by or names[2] else "_"} | looks)
        axes.set(xlabel=self._label(across), ylabel=self._label(up))
        if rights.dtype.kind == "U":
            axes.tick_params(axis="x", labelrotation=90)
        if len(np.unique(series)) > 1:
            axes.legend(title=label(by or names[2]), markerscale=6 / looks["markersize"])
        return cast("Axes", axes)

    def _label(self, name: str) -> str:
        """Return the label of an axis: the words of the class, the varied number for `value`, or the name."""
        if name == "value" and isinstance(varied := self.get("over", self.get("parameter")), str):
            return label(varied)
        length = _length(self)
        return self._words[name].format(length=length) if name in self._words and (length or "{" not in self._words[name]) else label(name)

    def _lists(self) -> tuple[str, ...]:
        return self._path

    def _columns_drawn(self) -> tuple[str, str, str]:
        return self._drawn

    def _plotted(self) -> dict[str, Array]:
        """Return the columns of plots."""
        return self.table()

    def _dataset(self, variables: dict[str, tuple[tuple[str, ...], Array]]) -> "xr.Dataset":
        described = {name: (dims, column, _unit(name)) for name, (dims, column) in variables.items()}
        notes = {name: value for name, value in self.items() if isinstance(value, str | int | float) and value is not True and value is not False}
        found: xr.Dataset = need("xarray", "xarray").Dataset(described, attrs=notes)
        return found

    def _repr_html_(self) -> str:
        scalars = {name: value for name, value in self.items() if isinstance(value, str | int | float)}
        title = self._title()
        return entries(title, scalars) + _html(self.table() if self._lists() or isinstance(self, Columns) else {})


class Columns(Result):
    """Columns of numbers: numpy arrays by name, all of one shape."""

    _dims: ClassVar[tuple[str, ...]] = ("row",)
    """Names of the dimensions, if the columns have that many."""

    def _title(self) -> str:
        shape = next(iter(self.values())).shape
        return f"{type(self).__name__} of shape {shape}"

    def _parts(self) -> Iterator[tuple[str, Array]]:
        """Yield the columns, with each entry of a matrix as a column."""
        for name, column in self.items():
            if name == "jacobian":
                yield from ((f"{name}_{row}_{of}", column[..., row - 1, of - 1]) for row in (1, 2) for of in (1, 2))
            else:
                yield name, column

    def table(self) -> dict[str, Array]:
        """Return the columns flattened, each of shape (rows,), with names for codes of events."""
        return {name: np.array(events())[column] if name == "event" else np.ravel(column) for name, column in self._parts()}

    def to_xarray(self) -> "xr.Dataset":
        """Return the columns as an xarray Dataset in their own shape. Raises ImportError without xarray (extra `xarray`)."""
        def dims(column: Array) -> tuple[str, ...]:
            return self._dims if column.ndim == len(self._dims) else tuple(f"dim_{axis}" for axis in range(column.ndim))

        found = {name: np.array(events())[column] if name == "event" else column for name, column in self._parts()}
        return self._dataset({name: (dims(column), column) for name, column in found.items()})


class Ball(Result):
    """Number proved to lie within `rad` of `mid`; both are decimal strings."""

    mid: str
    rad: str

    def __float__(self) -> float:
        return float(self["mid"])


SIZES = ((200, 6.0), (2000, 3.0), (20_000, 1.5), (np.inf, 0.8))
"""Sizes of markers, in points, by the number of markers."""


def drawn(method: Any, *data: Any, **style: Any) -> Any:
    """Draw with a method of matplotlib. Raises TypeError if the method does not accept a part of `style`."""
    try:
        return method(*data, **style)
    except AttributeError as error:
        raise TypeError(f"plot takes x, y, by and what {method.__name__} of matplotlib takes: {error}") from error


def axes_or_new(ax: "Axes | None") -> Any:
    """Return `ax`, or the Axes of a new figure."""
    return need("matplotlib.pyplot", "plot").subplots(layout="constrained")[1] if ax is None else ax


def mesh(axes: Any, x: Array, y: Array, codes: Array, names: list[str], **style: Any) -> None:
    """Draw codes, counted from 0, on a grid, with a colour for each name. Other codes are left out."""
    colours = need("matplotlib", "plot").colormaps["viridis"].resampled(max(len(names), 2))
    right, up = np.argsort(x), np.argsort(y)
    shown = np.ma.masked_outside(codes[np.ix_(up, right)], 0, len(names) - 1)
    looks = {"shading": "nearest", "cmap": colours, "vmin": -0.5, "vmax": max(len(names), 2) - 0.5} | style
    cells = drawn(axes.pcolormesh, x[right], y[up], shown, **looks)
    axes.figure.colorbar(cells, ax=axes, ticks=range(len(names))).set_ticklabels(names)


def label(name: str) -> str:
    """Return a name as the label of an axis: `cam angle (deg)`."""
    unit = _unit(name).get("units")
    if name == "rpm":
        return "speed (rpm)"
    ending = next((end for end in UNITS if unit and name.endswith(end)), "")
    words = name.removesuffix(ending).replace("_", " ")
    return f"{words} ({unit})" if unit else words


def entries(title: str, found: dict[str, Any]) -> str:
    """Return a table of names and values as HTML."""
    rows = "".join(f"<tr><th>{html.escape(name)}</th><td>{html.escape(str(value))}</td></tr>" for name, value in found.items())
    return f"<table><caption>{html.escape(title)}</caption>{rows}</table>"


def _html(table: dict[str, Array], most: int = 10) -> str:
    """Return the first rows of a table as HTML."""
    if not table:
        return ""
    count = len(next(iter(table.values())))
    cells = [[html.escape(f"{cell:.7g}" if isinstance(cell, float) else str(cell)) for cell in column[:most].tolist()] for column in table.values()]
    head = "".join(f"<th>{html.escape(name)}</th>" for name in table)
    body = "".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for row in zip(*cells))
    return f"<table><tr>{head}</tr>{body}</table>" + (f"<p>{count} rows, of which {most} are shown</p>" if count > most else "")


def _unit(name: str) -> dict[str, str]:
    return next(({"units": unit} for end, unit in UNITS.items() if name.endswith(end)), dict[str, str]())


def _length(node: Any) -> str:
    """Return the unit of length of a document, by the name of the first velocity in it; empty without one."""
    inner: list[Any] = list(node.values()) if _is_dict(node) else node if _is_list(node) else []
    names = [name for name in (node if _is_dict(node) else ()) if name.startswith("velocity_") and name.endswith("_s")]
    if names:
        return names[0].removeprefix("velocity_").removeprefix("before_").removesuffix("_s")
    return next((found for part in inner if (found := _length(part))), "")


def _same(one: Any, other: Any) -> bool:
    """Return True if two entries are equal, arrays by their values."""
    if _is_dict(one) and _is_dict(other):
        return one.keys() == other.keys() and all(_same(one[name], other[name]) for name in one)
    if not (hasattr(one, "shape") or hasattr(other, "shape")):
        return bool(one == other)
    a: Array = np.asarray(one)
    b: Array = np.asarray(other)
    return a.shape == b.shape and np.array_equal(a, b, equal_nan=a.dtype.kind == b.dtype.kind == "f")


def _column(table: dict[str, Array], name: str) -> tuple[str, Array]:
    """Return a column by its name, by the angle's other unit, or by the name without its unit."""
    if name in table:
        return name, table[name]
    if name.endswith("_deg") and (rad := name[:-4] + "_rad") in table:
        return name, np.degrees(table[rad])
    for end in UNITS:
        if name + end in table:
            return name + end, table[name + end]
    raise ValueError(f"there is no column {name!r}; there are: {', '.join(table)}")


def _is_dict(value: Any) -> TypeGuard[dict[str, Any]]:
    return isinstance(value, dict)


def _is_list(value: Any) -> TypeGuard[list[Any]]:
    return isinstance(value, list)


_HINTS: dict[type[Result], dict[str, Any]] = {}


def _hints(of: type[Result]) -> dict[str, Any]:
    """Return the declarations of a class. They are kept, since finding them takes a while."""
    if of not in _HINTS:
        _HINTS[of] = get_type_hints(of)
    return _HINTS[of]


def _class(hint: Any) -> type[Result]:
    """Return the class that a declaration has for tables."""
    parts = [hint, *get_args(hint), *(inner for part in get_args(hint) for inner in get_args(part))]
    return next((part for part in parts if isinstance(part, type) and issubclass(part, Result)), Result)


def _object(value: Any, hint: Any) -> Any:
    """Return an entry of a document as an object."""
    if _is_dict(value):
        if value.keys() == {"re", "im"} and all(isinstance(part, float | int) for part in value.values()):
            return complex(value["re"], value["im"])
        return Ball(value) if value.keys() == {"mid", "rad"} else _class(hint)(value)
    if not _is_list(value):
        return value
    if not value:
        return np.zeros(0) if get_origin(hint) is np.ndarray else []
    objects: list[Any] = [_object(part, hint) for part in value]
    if all(isinstance(part, float | int | complex | None) and not isinstance(part, bool) for part in objects):
        return np.array([np.nan if part is None else part for part in objects])
    if len({getattr(part, "shape", None) for part in objects}) == 1 and isinstance(objects[0], np.ndarray):
        return np.array(objects)
    return objects


def _rows(node: dict[str, Any], path: tuple[str, ...]) -> Iterator[dict[str, Any]]:
    """Yield the entries of a list within lists. Each has its index in the outer lists, and the plain entries there."""
    name, *rest = path or ("",)
    for index, part in enumerate(node[name] if name in node else []):
        if rest:
            plain = {key: value for key, value in part.items() if not _is_dict(value) and not _is_list(value)}
            yield from ({name: index} | plain | row for row in _rows(part, tuple(rest)))
        else:
            yield dict(_flat("", part))


def _flat(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    """Yield an entry as columns."""
    if _is_dict(value):
        if value.keys() == {"mid", "rad"}:
            yield name, float(value["mid"])
            return
        for key, part in value.items():
            yield from _flat(f"{name}_{key}" if name else key, part)
    elif _is_list(value) and any(_is_dict(part) and not part.keys() <= {"re", "im", "mid", "rad"} for part in value):
        yield name, len(value)
    elif _is_list(value) and value and not any(isinstance(part, str) for part in value):
        for index, part in enumerate(value, 1):
            yield from _flat(f"{name}_{index}", part)
    elif _is_list(value):
        yield name, ", ".join(value) if value else 0
    else:
        yield name, value


def _columns(rows: list[dict[str, Any]]) -> dict[str, Array]:
    """Return rows as columns of numbers, booleans or text. Missing cells are NaN or empty text."""
    found: dict[str, Array] = {}
    for name in dict.fromkeys(name for row in rows for name in row):
        cells: list[Any] = [row.get(name) for row in rows]
        kinds: set[Any] = {type(cell) for cell in cells}
        if kinds <= {bool} or kinds <= {int}:
            found[name] = np.array(cells)
        elif kinds <= {int, float, type(None)}:
            found[name] = np.array([np.nan if cell is None else cell for cell in cells], dtype=float)
        else:
            found[name] = np.array(["" if cell is None else str(cell) for cell in cells])
    return found
