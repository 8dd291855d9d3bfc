"""Periodic quintic smoothing splines by another way than the program's: B-splines, quadrature and one dense system.

Of all curves the spline has the least

    integral of c'''^2 + weight sum over rows of (c(row) - lift)^2

The curve is a sum of periodic B-splines of degree 5, by the recursion of Cox and de Boor, with a knot at every row; a corner is
four knots in one, across which only lift and slope are continuous. A dwell ends in three, across which the curvature is, too, and
equations hold the curve constant in between. The integral
is that of a polynomial of degree 4 in each piece, which three points of Gauss give exactly. All of it to 40 digits.
"""

import numpy as np
from mpmath import mp, mpf
from scipy.interpolate import BSpline

DEGREE = 5
DIGITS = 16
ROWS = 30
# Weights with angles in radians: near a circle, between, and near the rows.
WEIGHTS = ["3e3", "1e6", "1e9"]
# Where the splines are compared: between rows and at them.
PLACES = [mpf(11) * k + mpf(k) / 7 for k in range(32)]


class Knots:
    """Knots once round, and the B-splines on them."""

    def __init__(self, angles):
        self.angles = angles
        self.count = len(angles)

    def at(self, index):
        turns, inside = divmod(index, self.count)
        return self.angles[inside] + turns * 2 * mp.pi

    def piece(self, angle):
        """The index of the last knot that is not behind an angle of [0, 2 pi + first knot)."""
        inside = [index for index in range(-1, self.count) if self.at(index) <= angle < self.at(index + 1)]
        return inside[0]

    def values(self, angle, order, piece=None):
        """Derivatives of every B-spline, as one row of a matrix."""
        piece = self.piece(angle) if piece is None else piece
        row = [mpf(0)] * self.count
        for index in range(piece - DEGREE, piece + 1):
            row[index % self.count] += self.derivative(index, DEGREE, order, angle, piece)
        return row

    def derivative(self, index, degree, order, angle, piece):
        if order == 0:
            return self.value(index, degree, angle, piece)
        total = mpf(0)
        for sign, first in ((1, index), (-1, index + 1)):
            width = self.at(first + degree) - self.at(first)
            if width:
                total += sign * degree / width * self.derivative(first, degree - 1, order - 1, angle, piece)
        return total

    def value(self, index, degree, angle, piece):
        if degree == 0:
            return mpf(index == piece)
        total = mpf(0)
        width = self.at(index + degree) - self.at(index)
        if width:
            total += (angle - self.at(index)) / width * self.value(index, degree - 1, angle, piece)
        width = self.at(index + degree + 1) - self.at(index + 1)
        if width:
            end = self.at(index + degree + 1)
            total += (end - angle) / width * self.value(index + 1, degree - 1, angle, piece)
        return total


def penalty(knots):
    """The integral of the product of the third derivatives of every two B-splines."""
    form = mp.zeros(knots.count)
    nodes = [(-mp.sqrt(mpf(3) / 5), mpf(5) / 9), (mpf(0), mpf(8) / 9), (mp.sqrt(mpf(3) / 5), mpf(5) / 9)]
    for piece in range(knots.count):
        low, high = knots.at(piece), knots.at(piece + 1)
        if low == high:
            continue
        for node, share in nodes:
            row = mp.matrix([knots.values((low + high) / 2 + node * (high - low) / 2, 3, piece)])
            form += row.T * row * (share * (high - low) / 2)
    return form


def spline(angles, lifts, weight, corner=None, dwell=None):
    """The residuals, what the rows leave of freedom, and lift, slope and curvature at PLACES."""
    radians = [mp.radians(angle) for angle in angles]
    times = {corner: 4} | {end: 3 for end in dwell or ()}
    repeated = [angle for index, angle in enumerate(radians) for _ in range(times.get(index, 1))]
    knots = Knots(repeated)
    seen = mp.matrix([knots.values(angle, 0) for angle in radians])
    form = penalty(knots) + weight * (seen.T * seen)
    held = []
    if dwell:
        first, last = dwell
        held += [knots.values(radians[first], order) for order in (1, 2)]
        for row in range(first, last):
            one, two = (knots.values(radians[index], 0) for index in (row, row + 1))
            held += [[b - a for a, b in zip(one, two)]]
            # Constant on its first piece, a curve with four continuous derivatives has one number left on each of the others.
            if row == first:
                held += [knots.values(radians[row + 1], order) for order in (1, 2)]
    count, more = knots.count, len(held)
    system = mp.zeros(count + more)
    for i in range(count):
        for j in range(count):
            system[i, j] = form[i, j]
        for j in range(more):
            system[i, count + j] = system[count + j, i] = held[j][i]
    right = mp.zeros(count + more, len(lifts) + 1)
    known = weight * seen.T
    column = known * mp.matrix(lifts)
    for i in range(count):
        right[i, 0] = column[i]
        for j in range(len(lifts)):
            right[i, j + 1] = known[i, j]
    # One solution for the lifts, and one for each row alone: where it is seen again is the trace.
    inverse = system**-1
    solved = inverse * right
    coefficients = solved[:count, 0]
    fitted = seen * coefficients
    trace = sum((seen[row, :] * solved[:count, row + 1])[0] for row in range(len(lifts)))
    residuals = [lift - fitted[index] for index, lift in enumerate(lifts)]
    at = []
    for place in PLACES:
        angle = mp.radians(place)
        at.append([(mp.matrix([knots.values(angle, order)]) * coefficients)[0] for order in range(3)])
    return residuals, trace, at


def rows():
    """Uneven angles, and a lift rounded to a hundredth."""
    angles = [mpf(12) * k + mpf(6) / 5 * (mpf(k * k % 7) / 2 - mpf(3) / 2) + 2 for k in range(ROWS)]
    lift = [5 - 4 * mp.cos(mp.radians(angle)) + mp.cos(mp.radians(2 * angle - 30)) for angle in angles]
    return angles, [mpf(int(mp.nint(100 * value))) / 100 for value in lift]


def resting(angle, first, last):
    """A rise to 5 up to `first`, rest there up to `last`, and a return up to 360, rounded to a hundredth."""
    part = angle / first if angle < first else min(mpf(1), (360 - angle) / (360 - last))
    return mpf(int(mp.nint(500 * (10 * part**3 - 15 * part**4 + 6 * part**5)))) / 100


def scipys():
    """The largest difference of a B-spline and its third derivative from scipy's, over a turn."""
    angles, _ = rows()
    knots = Knots([mp.radians(angle) for angle in angles])
    worst = 0.0
    for index in range(3, 9):
        basis = BSpline.basis_element(np.array([float(knots.at(index + k)) for k in range(DEGREE + 2)]), False)
        for part in range(1, 12):
            angle = knots.at(index) + (knots.at(index + DEGREE + 1) - knots.at(index)) * part / 12
            piece = knots.piece(angle)
            for order, scale in ((0, 1), (3, 500)):
                here = knots.derivative(index, DEGREE, order, angle, piece)
                worst = max(worst, abs(float(here) - float(basis.derivative(order)(float(angle)))) / scale)
    return worst


def document():
    """Splines of one table: plain ones, one with a corner, one with a dwell."""
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
