"""Cams of every law: lift and slope in doubles for many angles at once, or in 60 digits for one."""

import math

import numpy as np
from mpmath import mp, mpf

mp.dps = 60
TURN = 2 * mp.pi


def exact(number):
    """Return the decimal that a model file holds."""
    return mpf(repr(number))


def radians(degrees):
    return exact(degrees) * mp.pi / 180


# A cam is a list of (angle where a piece begins, function). The function returns lift and slope at an angle, for numpy and for mpmath.


class Law:
    """Formula with its numbers in 60 digits, and as doubles."""

    def __init__(self, formula, *numbers):
        self.formula, self.exact = formula, numbers
        self.floats = [[float(n) for n in number] if isinstance(number, list) else float(number) for number in numbers]

    def __call__(self, angle):
        if isinstance(angle, mpf):
            return self.formula(mp, angle, *self.exact)
        return self.formula(np, angle, *self.floats)


def powers(_, angle, start, coefficients):
    x, value, slope = angle - start, 0 * angle, 0 * angle
    for coefficient in reversed(coefficients):
        slope = slope * x + value
        value = value * x + coefficient
    return value, slope


def waves(library, angle, offset, sizes, phases):
    turned = [(k, size, k * angle + phase) for k, (size, phase) in enumerate(zip(sizes, phases), 1)]
    value = sum((size * library.cos(x) for _, size, x in turned), 0 * angle + offset)
    return value, sum((-k * size * library.sin(x) for k, size, x in turned), 0 * angle)


def circle(library, angle, distance, direction, radius):
    """Return the far crossing of a ray with a circle, and its slope: d^2 + c^2 - 2 d c cos(x) = R^2, differentiated as it stands."""
    x = angle - direction
    along = distance * library.cos(x)
    value = along + library.sqrt(radius**2 - (distance * library.sin(x)) ** 2)
    return value, -distance * library.sin(x) * value / (value - along)


def stroke(library, angle, start, span, base, rise, coefficients, sine):
    """Return base + rise (powers and a sine of the fraction of the span), and its slope."""
    value, slope = powers(library, (angle - start) / span, 0, coefficients)
    size, rate, phase = sine
    x = rate * (angle - start) / span + phase
    value, slope = value + size * library.sin(x), slope + size * rate * library.cos(x)
    return base + rise * value, rise * slope / span


def from_acceleration(pieces):
    """Return a motion from 0 to 1 in a unit of time from its acceleration: [(begin, powers of the time since then, sine)].

    The acceleration is given as (duration, a), or as (duration, a, rate, phase) for a sin(rate x + phase).
    """
    place, velocity, moment, found = mpf(0), mpf(0), mpf(0), []
    for duration, size, *wave in pieces:
        rate, phase = wave or (mpf(1), mp.pi / 2)
        if wave:
            # s'' = a sin(rate x + phase)
            amplitude = -size / rate**2
            coefficients = [place - amplitude * mp.sin(phase), velocity - amplitude * rate * mp.cos(phase)]
            sine = [amplitude, rate, phase]
        else:
            coefficients, sine = [place, velocity, size / 2], [mpf(0), mpf(1), mpf(0)]
        found.append((moment, coefficients, sine))
        place, velocity = stroke(mp, duration, 0, mpf(1), 0, 1, coefficients, sine)
        moment += duration
    return [(start, [c / place for c in coefficients], [sine[0] / place, *sine[1:]]) for start, coefficients, sine in found]


EIGHTH, NONE = mpf(1) / 8, [mpf(0), mpf(1), mpf(0)]
MOTIONS = {
    "dwell": [(mpf(0), [mpf(0)], NONE)],
    "parabolic": from_acceleration([(mpf(1) / 2, mpf(1)), (mpf(1) / 2, mpf(-1))]),
    "harmonic": from_acceleration([(mpf(1), mpf(1), mp.pi, mp.pi / 2)]),
    "cycloidal": from_acceleration([(mpf(1), mpf(1), TURN, mpf(0))]),
    "modified-sine": from_acceleration(
        [(EIGHTH, mpf(1), 4 * mp.pi, mpf(0)), (6 * EIGHTH, mpf(1), 4 * mp.pi / 3, mp.pi / 2), (EIGHTH, mpf(1), 4 * mp.pi, 3 * mp.pi / 2)]
    ),
    "modified-trapezoid": from_acceleration(
        [part for side in (1, -1) for part in (
            (EIGHTH, mpf(side), 4 * mp.pi, mpf(0)), (2 * EIGHTH, mpf(side)), (EIGHTH, mpf(side), 4 * mp.pi, mp.pi / 2))]
    ),
    "poly345": [(mpf(0), [mpf(n) for n in (0, 0, 0, 10, -15, 6)], NONE)],
    "poly4567": [(mpf(0), [mpf(n) for n in (0, 0, 0, 0, 35, -84, 70, -20)], NONE)],
}


def arcs(law):
    base, flank, nose = (exact(law[name + "_radius"]) for name in ("base", "flank", "nose"))
    start, end = radians(law["flank_start_deg"]), radians(law["nose_end_deg"])
    # The flank's centre is behind the axis. The nose's is on the ray on which the nose ends, as far from the flank's as two circles
    # that touch.
    back = flank - base
    ahead = -back * mp.cos(end - start) + mp.sqrt((flank - nose) ** 2 - (back * mp.sin(end - start)) ** 2)
    nose_x, nose_y = ahead * mp.cos(end) + back * mp.cos(start), ahead * mp.sin(end) + back * mp.sin(start)
    touch = flank / (flank - nose)
    meets = mp.atan2(touch * nose_y - back * mp.sin(start), touch * nose_x - back * mp.cos(start))
    level = lambda radius: Law(powers, mpf(0), [radius])
    up = [(mpf(0), level(base)), (start, Law(circle, back, start + mp.pi, flank)), (meets, Law(circle, ahead, end, nose))]
    down = [(TURN - end, Law(circle, ahead, -end, nose)), (TURN - meets, Law(circle, back, mp.pi - start, flank))]
    return [*up, (end, level(ahead + nose)), *down, (TURN - start, level(base))]


def program(law):
    start, base, pieces = mpf(0), exact(law["base"]), []
    for part in law["segment"]:
        span, rise = radians(part["span_deg"]), exact(part["rise"])
        for begins, coefficients, sine in MOTIONS[part["motion"]]:
            pieces.append((start + begins * span, Law(stroke, start + begins * span, span, base, rise, coefficients, sine)))
        start, base = start + span, base + rise
    return pieces


def polynomial(law):
    pieces = [(radians(part["start_deg"]), [exact(c) for c in part["coefficients"]]) for part in law["segment"]]
    around = [(mpf(0), Law(powers, pieces[-1][0] - TURN, pieces[-1][1]))] if pieces[0][0] > 0 else []
    return around + [(start, Law(powers, start, coefficients)) for start, coefficients in pieces]


def hermite(h, left, right):
    """Return the powers of a polynomial from 0 to h with given derivatives at both ends: two at each end, or three at each."""
    (y0, s0, *k0), (y1, s1, *k1) = left, right
    if not k0:
        rise = (y1 - y0) / h
        return [y0, s0, (3 * rise - 2 * s0 - s1) / h, (s0 + s1 - 2 * rise) / h**2]
    a, b, c = y0, s0, k0[0] / 2
    # Remainders at the other end after the first three powers.
    y, s, k = y1 - (a + h * (b + h * c)), (s1 - b - 2 * c * h) * h, (k1[0] - 2 * c) * h**2
    return [a, b, c, (10 * y - 4 * s + k / 2) / h**3, (-15 * y + 7 * s - k) / h**4, (6 * y - 3 * s + k / 2) / h**5]


def table(law):
    """Return the spline of a table. Digits cancel between neighbouring rows, so that twice as many are carried."""
    with mp.workdps(2 * mp.dps):
        return spline(law)


def spline(law):
    """Return a periodic spline. Slopes, and for degree 5 curvatures, at the rows are such that the next derivatives do not jump."""
    rows = [(radians(angle), exact(lift)) for angle, lift in law["rows"]]
    count, quintic = len(rows), law["spline"] == "quintic"
    widths = [(rows[(i + 1) % count][0] - rows[i][0]) % TURN for i in range(count)]
    each = 2 if quintic else 1

    def coefficients(i, unknowns):
        j = (i + 1) % count
        ends = [(rows[n][1], *(unknowns[each * n + k] for k in range(each))) for n in (i, j)]
        return hermite(widths[i], *ends)

    def jumps(unknowns):
        found, pieces = [], [coefficients(i, unknowns) for i in range(count)]
        for i in range(count):
            before, after, h = pieces[i - 1], pieces[i], widths[i - 1]
            for order in ((3, 4) if quintic else (2,)):
                end = sum(mp.ff(k, order) * before[k] * h ** (k - order) for k in range(order, len(before)))
                found.append((end - mp.factorial(order) * after[order]) * h**order)
        return found

    # The jumps are linear in the unknowns. The system is solved in doubles, again and again for the remainder.
    zero = [mpf(0)] * (each * count)
    right = jumps(zero)
    matrix = np.zeros((each * count, each * count))
    for column in range(each * count):
        unit = list(zero)
        unit[column] = mpf(1)
        matrix[:, column] = [float(one - other) for one, other in zip(jumps(unit), right)]
    # Rows and columns are scaled to one size, however near two rows of the table are.
    of_rows = 1 / np.abs(matrix).max(axis=1)
    of_columns = 1 / np.abs(matrix * of_rows[:, None]).max(axis=0)
    scaled = matrix * of_rows[:, None] * of_columns
    unknowns, left = zero, right
    while max(map(abs, left)) > mpf(10) ** -52 * max(abs(lift) for _, lift in rows):
        size = max(map(abs, left))
        step = of_columns * np.linalg.solve(scaled, of_rows * [float(one / size) for one in left])
        unknowns = [one - size * mpf(float(off)) for one, off in zip(unknowns, step)]
        before, left = left, jumps(unknowns)
        if not max(map(abs, left)) < max(map(abs, before)) / 2:
            raise ValueError("the spline is not found")
    pieces = [(rows[i][0] % TURN, rows[i][0], coefficients(i, unknowns)) for i in range(count)]
    pieces.sort(key=lambda piece: piece[0])
    found = [(start, Law(powers, start, numbers)) for start, _, numbers in pieces]
    around = [(mpf(0), Law(powers, pieces[-1][0] - TURN, pieces[-1][2]))] if pieces[0][0] > 0 else []
    return around + found


def rectified(law):
    offset, size = exact(law["offset"]), exact(law["amplitude"])
    half = lambda sign: Law(waves, offset, [sign * size], [-mp.pi / 2])
    return [(mpf(0), half(1)), (mp.pi, half(-1))]


def harmonic(law):
    sizes, phases = [exact(a) for a in law["amplitudes"]], [radians(p) for p in law["phases_deg"]]
    return [(mpf(0), Law(waves, exact(law["offset"]), sizes, phases))]


LAWS = {"arcs": arcs, "program": program, "polynomial": polynomial, "table": table, "rectified-sine": rectified, "harmonic": harmonic}


class Cam:
    def __init__(self, law):
        self.pieces = LAWS[law["law"]](law)
        # The program takes out mismatches of polynomials, and sums of rises, of the size of rounding. So these cams are not exact here.
        self.is_exact = law["law"] not in ("polynomial", "program")
        self.exact = [start for start, _ in self.pieces] + [TURN]
        self.seams = np.array([float(start) for start in self.exact])
        sample = self.at(np.linspace(0.0, math.tau, 2000, endpoint=False))[0]
        self.low, self.stroke = float(sample.min()), max(float(np.ptp(sample)), 1e-9)
        self.size = float(np.abs(sample).max())

    def at(self, angles):
        """Return lift and slope at doubles."""
        angles = np.mod(angles, math.tau)
        which = np.clip(np.searchsorted(self.seams, angles, side="right") - 1, 0, len(self.pieces) - 1)
        lift, slope = np.empty_like(angles), np.empty_like(angles)
        for index in np.unique(which):
            here = which == index
            lift[here], slope[here] = self.pieces[index][1](angles[here])
        return lift, slope

    def piece(self, angle):
        """Return the index of the piece that holds an angle. At a seam it is the piece that begins there."""
        return max(index for index, start in enumerate(self.exact[:-1]) if start <= angle % TURN)

    def one(self, angle, side=0):
        """Return lift and slope in 60 digits. With side -1 at a seam they are those of the piece before it."""
        angle = angle % TURN
        index = self.piece(angle)
        if side < 0 and angle == self.exact[index]:
            index, angle = (index - 1, angle) if index else (len(self.pieces) - 1, angle + TURN)
        return self.pieces[index][1](angle)

    def corners(self):
        """Return (angle, order) of each seam at which a derivative up to the third jumps, found by differences."""
        found = []
        for start in self.exact[:-1]:
            sides = []
            for sign in (-1, 1):
                law = self.pieces[self.piece(start + sign * mpf(10) ** -30)][1]
                at = start + TURN if sign < 0 and start == 0 else start
                slopes = [law(at + k * mpf(10) ** -12)[1] for k in (-1, 0, 1)]
                second, third = (slopes[2] - slopes[0]) * mpf(10) ** 12 / 2, (slopes[2] - 2 * slopes[1] + slopes[0]) * mpf(10) ** 24
                sides.append((slopes[1], second, third))
            orders = [k for k, (a, b) in enumerate(zip(*sides), 1) if abs(a - b) > 1e-6 * self.stroke]
            if orders:
                found.append((start, orders[0]))
        return found
