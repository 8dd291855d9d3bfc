"""Runs scripts that the command wrote and checks what they draw: legends, labels, and whether every series has its data."""

import runpy
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.collections import PolyCollection

ROW = 15
for name in sys.argv[1:]:
    drawn = runpy.run_path(name)
    page, panels, rows = drawn["PAGE"], drawn["PANELS"], drawn["rows"]
    entries = [series["legend"][1] for panel in panels for series in panel["series"] if "legend" in series]
    assert ROW * len(set(entries)) <= page[1] / 6 + 0.01, f"{name}: {len(set(entries))} rows of {page[1]}"
    axes = [(f"panel {number}", panel) for number, panel in enumerate(panels)]
    axes += [(f"across panel {number}", panel["across"]) for number, panel in enumerate(panels)]
    names = [words for _, _, words, angle, _ in drawn["TEXTS"] if angle]
    for axis, at in axes:
        # The bars of attractors have names instead of numbers.
        is_named = "attractor" in names and not at["ticks"]
        assert is_named or len(at["labels"]) >= 3, f"{name}, {axis}: {at['labels']}"
    frames = plt.gcf().get_axes()
    assert len(frames) == len(panels), name
    read = {key for key, of in rows.items() if of}
    there = {(n, i) for n, panel in enumerate(panels) for i, it in enumerate(panel["series"]) if it["kind"] != "words"}
    assert read <= there and read, f"{name}: {read} of {there}"
    for number, frame in enumerate(frames):
        lines = [len(line.get_xdata()) for line in frame.lines]
        # Reference lines have two points each.
        points = sum(lines) - 2 * (len(panels[number]["marks"]) + len(drawn["MARKS"]) * panels[number]["across"]["has_marks"])
        kinds = {index: it["kind"] for index, it in enumerate(panels[number]["series"])}
        of_kind = [(kinds[key[1]], len(of)) for key, of in rows.items() if key[0] == number]
        wanted = sum(count for kind, count in of_kind if kind not in ("band", "region"))
        assert points == wanted, f"{name}: {points} of {wanted} points of panel {number}"
        regions = sum(len(it.get_paths()) for it in frame.collections if isinstance(it, PolyCollection))
        wanted = sum(count for kind, count in of_kind if kind == "region")
        assert regions >= wanted, f"{name}: {regions} of {wanted} rectangles of panel {number}"
    plt.close("all")
print(len(sys.argv) - 1)
