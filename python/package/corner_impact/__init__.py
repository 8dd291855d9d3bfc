"""Cam-follower systems with impacts: runs, maps, charts, orbits, corner impacts and their proofs.

Start with a `Model`. Its methods return results: dicts with attributes, tables (`to_pandas`, `to_xarray`) and plots. Runs and maps
are columns of numpy arrays. Studies are the documents that `corner-impact NAME --json` prints. `corner_impact.results` lists the
classes.

Angles are in rad or deg, as their names say. Cam angles lie in [0, 2 pi), with 0 at the middle of the base circle. Positions are in
the cam's coordinates. Units are those of the model, by default m, s and kg.

Long calls release the interpreter, and Ctrl-C ends them. A wrong argument raises `ValueError`. If one of many runs fails, its result
is NaN or a class of its own.
"""

from corner_impact._errors import ModelError
from corner_impact._native import Chart, LocalMap, Model, Page, __version__, blocks_done, chart_variables, events
from corner_impact._result import Result

EVENTS: tuple[str, ...] = tuple(events())
"""Kinds of events, in the order of the codes in columns `event`."""

__all__ = ["EVENTS", "Chart", "LocalMap", "Model", "ModelError", "Page", "Result", "__version__", "blocks_done", "chart_variables"]
