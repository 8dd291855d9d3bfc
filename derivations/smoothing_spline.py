"""Periodic quintic smoothing splines of small tables by splines.py, written to 16 digits, with their degrees of freedom.

The freedom is the trace of the matrix that maps the lifts of the rows to the lifts of the spline: the sum of each row's effect on the
spline at that row.
"""

import numpy as np
from mpmath import mp, mpf
from scipy.interpolate import BSpline

import splines

DIGITS = 16
ROWS = 30
# Weights with angles in radians: near a circle, between, and near the rows.
WEIGHTS = ["3e3", "1e6", "1e9"]
# Angles, in degrees, at which the splines are compared.
PLACES = [mpf(11) * k + mpf(k) / 7 for k in range(32)]


def spline(angles, lifts, weight, corner=None, dwell=None):
    """Return the residuals, the degrees of freedom, and lift, slope and curvature at PLACES."""
    radians = [mp.radians(angle) for angle in angles]
    corners = [] if corner is None else [radians[corner]]
    dwells = [tuple(radians[end] for end in dwell)] if dwell else []
    # A row inside a dwell is no knot.
    free = [angle for angle in radians if not any(first < angle < last for first, last in dwells)]
    basis = splines.Splines(splines.QUINTIC, splines.knots(free, corners), [first for first, _ in dwells])
    solved, rows = basis.near(radians, weight)
    numbers = solved.solve(splines.seen(rows, lifts, weight, basis.count))

    def sum_of(row, numbers):
        return sum(value * numbers[column] for column, value in row.items())

    residuals = [lift - sum_of(row, numbers) for row, lift in zip(rows, lifts)]
    alone = (sum_of(row, solved.solve(splines.seen([row], [1], weight, basis.count))) for row in rows)
    at = [[sum_of(basis.values(mp.radians(place), order), numbers) for order in range(3)] for place in PLACES]
    return residuals, sum(alone), at


def rows():
    """Return uneven angles, and lifts rounded to a hundredth."""
    angles = [mpf(12) * k + mpf(6) / 5 * (mpf(k * k % 7) / 2 - mpf(3) / 2) + 2 for k in range(ROWS)]
    lift = [5 - 4 * mp.cos(mp.radians(angle)) + mp.cos(mp.radians(2 * angle - 30)) for angle in angles]
    return angles, [mpf(int(mp.nint(100 * value))) / 100 for value in lift]


def resting(angle, first, last):
    """Return the lift of a rise to 5 up to `first`, a rest up to `last`, and a return up to 360, rounded to a hundredth."""
    part = angle / first if angle < first else min(mpf(1), (360 - angle) / (360 - last))
    return mpf(int(mp.nint(500 * (10 * part**3 - 15 * part**4 + 6 * part**5)))) / 100


def scipys():
    """Return the largest difference of some B-splines and their third derivatives from SciPy's."""
    angles, _ = rows()
    basis = splines.Splines(splines.QUINTIC, [mp.radians(angle) for angle in angles])
    worst = 0.0
    for index in range(3, 9):
        ends = [basis.at(index + k) for k in range(splines.QUINTIC + 2)]
        theirs = BSpline.basis_element(np.array([float(end) for end in ends]), False)
        for part in range(1, 12):
            angle = ends[0] + (ends[-1] - ends[0]) * part / 12
            for order, scale in ((0, 1), (3, 500)):
                here = basis.values(angle, order)[index]
                worst = max(worst, abs(float(here) - float(theirs.derivative(order)(float(angle)))) / scale)
    return worst


def document():
    """Return splines over the same angles: plain ones, one with a corner, one with a dwell."""
    angles, _ = rows()
    cases = [{"weight": weight} for weight in WEIGHTS]
    cases += [{"weight": "1e6", "corner": 11}, {"weight": "1e6", "dwell": [13, 17]}]
    found = []
    for case in cases:
        lifts = rows()[1]
        if "dwell" in case:
            first, last = case["dwell"]
            lifts = [resting(angle, angles[first], angles[last]) for angle in angles]
        residuals, trace, at = spline(angles, lifts, mpf(case["weight"]), case.get("corner"), case.get("dwell"))
        squares = sum(residual**2 for residual in residuals)
        found.append({
            **case,
            "lifts": [mp.nstr(lift, 6) for lift in lifts],
            "distance": mp.nstr(max(abs(residual) for residual in residuals), DIGITS),
            "freedom": mp.nstr(trace, DIGITS),
            "noise": mp.nstr(mp.sqrt(squares / (ROWS - trace)), DIGITS),
            "at": [[mp.nstr(number, DIGITS) for number in place] for place in at],
        })  # fmt: skip
    return {
        "angles_deg": [mp.nstr(angle, 10) for angle in angles],
        "places_deg": [mp.nstr(place, 20) for place in PLACES],
        "splines": found,
    }
