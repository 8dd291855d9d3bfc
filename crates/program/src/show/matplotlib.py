import csv
from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.collections import PolyCollection
from matplotlib.patheffects import withStroke

# Places and lengths are in units of the page, from its upper left corner; a unit is a part of a point.
UNIT = 72 * WIDTH / 25.4 / PAGE[0]
plt.rcParams.update({"font.size": 12.5 * UNIT, "axes.linewidth": 0.8 * UNIT, "lines.solid_joinstyle": "round"})

rows = {}
with open(Path(__file__).parent / DATA, encoding="utf-8", newline="") as file:
    for row in csv.DictReader(file):
        rows.setdefault((int(row["panel_number"]), int(row["series_number"])), []).append(row)


def draw(frame, series, of, rim):
    x, y, wide, high = ([float(row[name] or "nan") for row in of] for name in ("x", "y", "width", "height"))
    colour, kind, width = series["colour"], series["kind"], series.get("width", 1) * UNIT
    look = {"path_effects": [withStroke(linewidth=width + rim * UNIT, foreground="white")]} if rim else {}
    if kind in ("line", "area", "arrow"):
        dashes = {"dashes": [part * UNIT / width for part in series["dashes"]]} if series["dashes"] else {}
        (drawn,) = frame.plot(x, y, color=colour, linewidth=width, **dashes, **look)
        if kind == "area":
            drawn = frame.fill_between(x, y, frame.get_ylim()[0], color=colour, alpha=0.22, linewidth=0)
        if kind == "arrow":
            for at in range(1, len(x)):
                if x[at - 1] == x[at - 1] and x[at] == x[at] and (at + 1 == len(x) or x[at + 1] != x[at + 1]):
                    arrow = {"arrowstyle": "-|>", "color": colour, "linewidth": width, "mutation_scale": 9 * UNIT}
                    frame.annotate("", (x[at], y[at]), (x[at - 1], y[at - 1]), arrowprops=arrow)
        return drawn
    if kind == "band":
        low, top = ([at + sign * part / 2 for at, part in zip(y, high)] for sign in (-1, 1))
        return frame.fill_between(x, low, top, color=colour, alpha=0.35, linewidth=0.8 * UNIT)
    if kind == "region":
        corners = [[(a + s * w / 2, b + t * h / 2) for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))] for a, b, w, h in zip(x, y, wide, high)]
        return frame.add_collection(PolyCollection(corners, facecolor=colour, alpha=series["strength"], linewidth=0))
    if kind == "cell":
        return frame.plot(x, y, "o", color=colour, markersize=series["size"] * UNIT, markeredgewidth=0)[0]
    if kind == "point":
        size = series["size"] * UNIT * (1 if series["filled"] or len(x) <= 40 else 0.5)
        face = colour if series["filled"] else "none"
        return frame.plot(x, y, series["marker"], color=colour, markerfacecolor=face, markersize=size, **look)[0]


def place(x, y):
    return x / PAGE[0], 1 - y / PAGE[1]


figure = plt.figure(figsize=(WIDTH / 25.4, WIDTH / 25.4 * PAGE[1] / PAGE[0]))
for number, panel in enumerate(PANELS):
    left, top, wide, high = panel["frame"]
    frame = figure.add_axes((*place(left, top + high), wide / PAGE[0], high / PAGE[1]))
    across = panel["across"]
    frame.set(xlim=across["range"], ylim=panel["range"])
    frame.set_xticks(across["ticks"], across["labels"] if across["is_labelled"] else [""] * len(across["ticks"]))
    frame.set_yticks(panel["ticks"], panel["labels"])
    for lines, line in ((MARKS if across["has_marks"] else [], frame.axvline), (panel["marks"], frame.axhline)):
        for at, is_dashed in lines:
            line(at, color="#8a8a8a", linewidth=0.8 * UNIT, dashes=(2, 3) if is_dashed else (1, 0))
    for index, series in enumerate(panel["series"]):
        drawn = draw(frame, series, rows.get((number, index), []), panel["rim"])
        if "legend" in series:
            look = {"frameon": False, "borderpad": 0, "borderaxespad": 0, "handlelength": 1.6, "handletextpad": 0.48}
            at = place(*series["legend"])
            figure.add_artist(plt.Axes.legend(frame, [drawn], [series["label"]], loc="center left", bbox_to_anchor=at, bbox_transform=figure.transFigure, **look))
    for x, y, words, beside, up in panel["words"]:
        away = [4 * UNIT * {"left": 1, "bottom": 1, "center": 0, "right": -1, "top": -1}[side] for side in (beside, up)]
        frame.annotate(words, (x, y), away, textcoords="offset points", ha=beside, va=up)
for x, y, words, angle, size in TEXTS:
    side = "center" if angle else "left"
    up = {"va": "bottom", "rotation_mode": "anchor"} if angle else {"va": "baseline"}
    figure.text(*place(x, y), words, rotation=angle, ha=side, fontsize=size * UNIT, **up)

if __name__ == "__main__":
    figure.savefig(Path(__file__).with_suffix(".matplotlib.png"), dpi=300)
