"""Cam-follower impact oscillators: runs, maps, charts, orbits, corner impacts and their proofs.

Everything starts from a `Model`. Runs and maps come as dicts of numpy arrays, which pandas, polars and xarray take as they
are; studies as the documents that `corner-impact NAME --json` prints, as dicts. Angles are in rad where a name does not end in
`_deg`, cam angles in [0, 2 pi) with 0 at the middle of the base circle, positions in the cam's coordinates, and all units
those of the model: names say m, s and kg.

Long calls release the interpreter, and Ctrl-C ends them. What is wrong with an argument is a `ValueError`; in the middle of
many runs one that fails is NaN, or a class of its own.
"""

from corner_impact._errors import ModelError
from corner_impact._native import Chart, Model, Page, __version__, blocks_done, chart_variables, events

EVENTS: tuple[str, ...] = tuple(events())
"""The kinds of events, in the order of the codes in columns `event`."""

__all__ = ["EVENTS", "Chart", "Model", "ModelError", "Page", "__version__", "blocks_done", "chart_variables"]
