"""The cams of the independent check with SciPy: lift, slope and curvature of every law, from the numbers of a model file.

Circles are computed as seen from the axis, motions are written as in handbooks, and splines are SciPy's.
"""

import math
import sys
from bisect import bisect_right

try:
    import numpy as np
    from scipy import linalg
    from scipy.interpolate import BPoly, BSpline, PPoly, make_interp_spline
except ImportError as missing:
    sys.exit(f"this check needs numpy and scipy: {missing}")

# Size of a sum relative to its terms below which it counts as 0: well above the integrator's error.
NOISE = 1e-8


class CannotCheck(Exception):
    """The input is not a model that this check supports, or there is nothing to check."""


def number(table, key, least=None):
    value = table.get(key)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise CannotCheck(f"{key} must be a number, not {value!r}")
    if least is not None and not value > least:
        raise CannotCheck(f"{key} must be above {least}, not {value}")
    return float(value)


class Circle:
    """Stretch of the cam's outline. The lift is where a line parallel to the ray at theta, `offset` to its left, leaves the circle."""

    def __init__(self, centre, radius, offset=0.0):
        self.x, self.y = centre
        self.radius, self.offset = radius, offset

    def law(self, theta):
        """Return the lift, and its first and second derivative by the angle."""
        cos, sin = math.cos(theta), math.sin(theta)
        # The circle's centre along the ray and across it, and half of the chord that the circle cuts from the line.
        along, across = self.x * cos + self.y * sin, self.x * sin - self.y * cos
        beside = across + self.offset
        square = (self.radius - beside) * (self.radius + beside)
        if square <= 0.0:
            raise CannotCheck(f"the line of motion at {theta} rad misses the circle of radius {self.radius}")
        chord = math.sqrt(square)
        shrinks = beside * along / chord
        return along + chord, -across - shrinks, -along - (along**2 - beside * across + shrinks**2) / chord

    def mirrored(self):
        return Circle((self.x, -self.y), self.radius, self.offset)

    def last_ray(self, theta):
        """Return the angle from theta to the nearest line that only touches the circle. The lift is not analytic there."""
        distance = math.hypot(self.x, self.y)
        from_centre = math.remainder(theta - math.atan2(self.y, self.x), math.tau)
        ways = [(self.radius - self.offset, -from_centre), (self.radius + self.offset, from_centre)]
        return min([math.asin(reach / distance) + turned for reach, turned in ways if reach < distance], default=math.inf)


class Tangent(Circle):
    """Stretch of the outline under a flat face. The lift is the distance of its tangent from the axis."""

    def law(self, theta):
        """Return the lift, and its first and second derivative by the angle."""
        cos, sin = math.cos(theta), math.sin(theta)
        along, across = self.x * cos + self.y * sin, self.x * sin - self.y * cos
        return along + self.radius, -across, -along

    def mirrored(self):
        return Tangent((self.x, -self.y), self.radius)

    def last_ray(self, theta):
        """Return infinity: the lift is analytic everywhere."""
        return math.inf


class Stretch:
    """Displacement in closed form over a stretch: a polynomial and a sine of the fraction of the stretch."""

    def __init__(self, start, span, base, rise, powers, sine=(0.0, 1.0, 0.0), centre=None):
        self.start, self.span, self.base, self.rise = start, span, base, rise
        # Angles are taken in the turn about this angle.
        self.centre = start + 0.5 * span if centre is None else centre
        self.powers, self.sine = np.polynomial.Polynomial(powers), sine

    def law(self, theta):
        """Return the lift, and its first and second derivative by the angle."""
        part = (self.centre - self.start + math.remainder(theta - self.centre, math.tau)) / self.span
        size, rate, phase = self.sine
        turned = rate * part + phase
        lift = self.powers(part) + size * math.sin(turned)
        slope = self.powers.deriv()(part) + size * rate * math.cos(turned)
        bend = self.powers.deriv(2)(part) - size * rate**2 * math.sin(turned)
        return self.base + self.rise * lift, self.rise * slope / self.span, self.rise * bend / self.span**2

    def last_ray(self, theta):
        """Return infinity: the lift is analytic everywhere."""
        return math.inf


class Levered:
    """Stretch behind a lever: every lift is multiplied by the lever's ratio."""

    def __init__(self, stretch, ratio):
        self.stretch, self.ratio = stretch, ratio

    def law(self, theta):
        """Return the lift, and its first and second derivative by the angle."""
        lift, slope, bend = self.stretch.law(theta)
        return self.ratio * lift, self.ratio * slope, self.ratio * bend

    def last_ray(self, theta):
        """Return the angle to the place where the stretch is not analytic."""
        return self.stretch.last_ray(theta)


PI = math.pi
# Displacements from 0 to 1 in a unit of time, as handbooks of cams print them: (end, powers, (size, rate, phase)).
DISPLACEMENTS = {
    "dwell": [(1.0, [0.0], (0.0, 1.0, 0.0))],
    "parabolic": [(0.5, [0.0, 0.0, 2.0], (0.0, 1.0, 0.0)), (1.0, [-1.0, 4.0, -2.0], (0.0, 1.0, 0.0))],
    "harmonic": [(1.0, [0.5], (-0.5, PI, 0.5 * PI))],
    "cycloidal": [(1.0, [0.0, 1.0], (-0.5 / PI, 2.0 * PI, 0.0))],
    "modified-sine": [
        (0.125, [0.0, PI / (4.0 + PI)], (-0.25 / (4.0 + PI), 4.0 * PI, 0.0)),
        (0.875, [2.0 / (4.0 + PI), PI / (4.0 + PI)], (-2.25 / (4.0 + PI), 4.0 * PI / 3.0, PI / 3.0)),
        (1.0, [4.0 / (4.0 + PI), PI / (4.0 + PI)], (-0.25 / (4.0 + PI), 4.0 * PI, 0.0)),
    ],
    "poly345": [(1.0, [0.0, 0.0, 0.0, 10.0, -15.0, 6.0], (0.0, 1.0, 0.0))],
    "poly4567": [(1.0, [0.0, 0.0, 0.0, 0.0, 35.0, -84.0, 70.0, -20.0], (0.0, 1.0, 0.0))],
}
# First half of the modified trapezoid. The second half is its image, s(u) = 1 - s(1 - u).
WHOLE = 2.0 + PI
FIRST_HALF = [
    (0.125, [0.0, 2.0 / WHOLE], (-0.5 / (PI * WHOLE), 4.0 * PI, 0.0)),
    (0.375, [(PI / 16.0 - 0.5 / PI) / WHOLE, (2.0 - PI) / WHOLE, 4.0 * PI / WHOLE], (0.0, 1.0, 0.0)),
    (0.5, [-0.5 * PI / WHOLE, (2.0 + 2.0 * PI) / WHOLE], (-0.5 / (PI * WHOLE), 4.0 * PI, -PI)),
]


def imaged(powers, sine):
    """Return 1 - s(1 - u)."""
    turned = np.polynomial.Polynomial(powers)(np.polynomial.Polynomial([1.0, -1.0]))
    size, rate, phase = sine
    return (1.0 - turned).coef, (size, rate, -rate - phase)


DISPLACEMENTS["modified-trapezoid"] = FIRST_HALF + [
    (1.0 - start, *imaged(powers, sine)) for (_, powers, sine), start in zip(reversed(FIRST_HALF), (0.375, 0.125, 0.0))
]


def program(numbers):
    """Return the pieces of standard motions one after the other: angles where they start, and laws."""
    start, base, starts, laws = 0.0, number(numbers, "base"), [], []
    for part in numbers.get("segment", []):
        span, rise = math.radians(number(part, "span_deg", least=0.0)), number(part, "rise")
        begins = 0.0
        if part.get("motion") not in DISPLACEMENTS:
            raise CannotCheck(f"cam.segment.motion = {part.get('motion')!r}: this route cannot compute it")
        for ends, powers, sine in DISPLACEMENTS[part["motion"]]:
            starts.append(start + begins * span)
            laws.append(Stretch(start, span, base, rise, powers, sine))
            begins = ends
        start, base = start + span, base + rise
    return starts, laws


def polynomials(numbers):
    """Return polynomials of the angle from where they start: angles where they start, and laws."""
    each = [(math.radians(number(part, "start_deg")), part["coefficients"]) for part in numbers.get("segment", [])]
    starts = [start for start, _ in each]
    ends = [*starts[1:], starts[0] + math.tau]
    laws = [Stretch(start, 1.0, 0.0, 1.0, powers, centre=0.5 * (start + end)) for (start, powers), end in zip(each, ends)]
    if starts[0] > 0.0:
        starts, laws = [0.0, *starts], [laws[-1], *laws]
    return starts, laws


class Waves:
    """Sum of cosines, by its Fourier coefficients."""

    def __init__(self, offset, waves):
        self.offset, self.waves = offset, np.array(waves)
        self.k = 1j * np.arange(1, len(waves) + 1)

    def law(self, theta):
        """Return the lift, and its first and second derivative by the angle."""
        turned = self.waves * np.exp(self.k * theta)
        lift, slope, bend = (float(np.sum(self.k**order * turned).real) for order in range(3))
        return self.offset + lift, slope, bend

    def last_ray(self, theta):
        """Return infinity: the lift is analytic everywhere."""
        return math.inf


def harmonic(numbers):
    """Return a sum of cosines for the whole turn: the angle where it starts, and its law."""
    phases = np.radians(numbers["phases_deg"])
    return [0.0], [Waves(number(numbers, "offset"), np.array(numbers["amplitudes"]) * np.exp(1j * phases))]


def rectified_sine(numbers):
    """Return a half wave and its image: angles where they start, and laws."""
    offset, amplitude = number(numbers, "offset"), number(numbers, "amplitude")
    return [0.0, PI], [Waves(offset, [-1j * sign * amplitude]) for sign in (1.0, -1.0)]


def pieces(polynomial):
    """Return the pieces of a piecewise polynomial of one turn: angles where they start, and laws. The first knot may lie after 0."""
    ends = polynomial.x
    found = [
        (low % math.tau, Stretch(low, 1.0, 0.0, 1.0, powers[::-1], centre=0.5 * (low + high)))
        for low, high, powers in zip(ends, ends[1:], polynomial.c.T)
        if low < high
    ]
    found.sort(key=lambda place: place[0])
    if found[0][0] > 0.0:
        found.insert(0, (0.0, found[-1][1]))
    return [low for low, _ in found], [law for _, law in found]


def table(numbers):
    """Return a spline through the rows, by SciPy, or near them: angles where its pieces start, and laws."""
    angles, lifts = np.array([(row["angle_deg"], row["lift"]) for row in numbers["rows"]], dtype=float).T
    angles = np.radians(angles)
    if "fitted" not in numbers:
        degree = {"cubic": 3, "quintic": 5}[numbers["spline"]]
        around = np.append(angles, angles[0] + math.tau), np.append(lifts, lifts[0])
        spline = PPoly.from_spline(make_interp_spline(*around, k=degree, bc_type="periodic"))
        # Drop the pieces outside the turn.
        return pieces(PPoly(spline.c[:, degree:-degree], spline.x[degree:-degree]))
    return pieces(smoothed(numbers["fitted"], angles, lifts))


def smoothed(fitted, angles, lifts):
    """Return the quintic with the least integral of c'''^2 + weight sum (c(row) - lift)^2, by least squares.

    The integral is a sum of squares: c'''^2 is of degree 4 in each piece, for which Gauss's rule with three points is exact. Lift,
    slope and curvature are continuous where three knots coincide. At corners four coincide, and only lift and slope are continuous.
    The lift is constant where all B-splines that are not 0 have one factor.
    """
    corners, dwells = fitted["corners_rad"], fitted["dwells_rad"]
    places = np.unique([*fitted["knots_rad"], *(end for dwell in dwells for end in dwell)])
    inside = np.repeat(places, np.where(np.isin(places, corners), 4, 3))
    # All B-splines that reach into the turn from the first knot on.
    count = len(inside)
    around = np.concatenate([inside - math.tau, inside, inside + math.tau])[count - 5 : 2 * count + 6]
    each = BSpline(around, np.eye(count + 5), 5)
    columns = np.arange(count + 5) % count
    for start, _ in dwells:
        last = np.searchsorted(around, start, side="right") - 1
        still = columns[last - 5 : last + 1]
        columns[np.isin(columns, still)] = still.min()
    unknown, columns = np.unique(columns, return_inverse=True)
    together = np.eye(len(unknown))[columns]

    nodes, shares = np.polynomial.legendre.leggauss(3)
    ends = np.unique(around[5 : 6 + count])
    half = 0.5 * np.diff(ends)[:, None]
    bending = each((ends[:-1, None] + half + half * nodes).ravel(), 3) * np.sqrt(half * shares).reshape(-1, 1)
    weight = math.sqrt(fitted["weight"])
    rows = each(np.where(angles < inside[0], angles + math.tau, angles))
    system = np.vstack([bending, weight * rows]) @ together
    numbers = linalg.lstsq(system, np.append(np.zeros(len(bending)), weight * lifts), lapack_driver="gelsy")[0]
    spline = PPoly.from_spline(BSpline(around, together @ numbers, 5))
    # Drop the pieces outside the turn.
    return PPoly(spline.c[:, 5 : 5 + count], spline.x[5 : 6 + count])


class Touched:
    """Stretch of a contour, its radius over the polar angle, touched by a flat face or a roller."""

    def __init__(self, radius, polar, contact):
        self.radius, self.polar, self.is_flat = radius, polar, contact == "flat"
        self.roller, self.offset = (0.0, 0.0) if self.is_flat else (number(contact, "roller_radius", least=0.0), number(contact, "offset"))
        self.middle = self.touch(polar)[0]

    def touch(self, polar):
        """Return the cam angle at which the follower touches at a polar angle, its rate by the polar angle, the lift, and its first
        and second derivative."""
        radius, slope, bend = self.radius.law(polar)
        speed = math.hypot(radius, slope)
        turns = (radius**2 + 2.0 * slope**2 - radius * bend) / speed**2
        if not (radius > 0.0 and (turns > 0.0 if self.is_flat else speed + self.roller * turns > 0.0)):
            raise CannotCheck(f"the follower does not touch the contour at its polar angle {polar}")
        # Complex numbers: the real part is along the ray at the polar angle, the imaginary part to its left.
        normal = complex(radius, -slope) / speed
        leans = math.atan2(normal.imag, normal.real)
        if self.is_flat:
            lift = radius * normal.real
            return polar + leans, turns, lift, -radius * normal.imag, speed / turns - lift
        centre = radius + self.roller * normal
        angle = math.atan2(centre.imag, centre.real) - math.asin(self.offset / abs(centre))
        lift, tan = math.sqrt(abs(centre) ** 2 - self.offset**2), math.tan(leans - angle)
        # The centre moves square to the normal.
        rate = (speed + self.roller * turns) * math.cos(leans - angle) / lift
        first = self.offset - lift * tan
        return polar + angle, rate, lift, first, -first * tan - lift * (1.0 + tan**2) * (turns / rate - 1.0)

    def law(self, theta):
        """Return the lift, and its first and second derivative by the angle. Newton's method finds the polar angle."""
        theta = self.middle + math.remainder(theta - self.middle, math.tau)
        polar = self.polar
        for _ in range(50):
            angle, rate, *lift = self.touch(polar)
            step = (theta - angle) / rate
            polar += step
            if abs(step) < 1e-15:
                break
        return tuple(self.touch(polar)[2:])

    def last_ray(self, theta):
        """Return infinity: the lift is analytic everywhere."""
        return math.inf


def contour(numbers):
    """Return the follower's lift on a contour whose radius is a spline: angles where its pieces start, and laws."""
    starts, radii = table(numbers)
    contact = numbers.get("contact", "point")
    if contact == "point":
        return starts, radii
    ends = [*starts[1:], math.tau]
    places = [(low, Touched(radius, 0.5 * (low + high), contact)) for radius, low, high in zip(radii, starts, ends)]
    found = sorted(((law.touch(low)[0] % math.tau, law) for low, law in places), key=lambda place: place[0])
    if found[0][0] > 0.0:
        found.insert(0, (0.0, found[-1][1]))
    return [low for low, _ in found], [law for _, law in found]


LAWS = {
    "contour": contour,
    "harmonic": harmonic,
    "rectified-sine": rectified_sine,
    "program": program,
    "polynomial": polynomials,
    "table": table,
}


class Cam:
    """Stretches, each from its start angle on: circles, motions, polynomials, waves, and mirror images of circles."""

    def __init__(self, numbers):
        if numbers.get("law") == "arcs":
            self.starts, self.circles = self.arcs(numbers)
        elif numbers.get("law") in LAWS:
            self.starts, self.circles = LAWS[numbers["law"]](numbers)
            self.base = max(abs(self.law(start)[0]) for start in self.starts)
        else:
            raise CannotCheck(f"cam.law = {numbers.get('law')!r}: this route cannot check it")
        self.is_rounded = False
        self.round(0.5 * math.radians(numbers.get("corner_rounding_deg", 0)))
        if "lever_ratio" in numbers:
            ratio = number(numbers, "lever_ratio", least=0.0)
            self.base, self.circles = ratio * self.base, [Levered(circle, ratio) for circle in self.circles]

    def round(self, half):
        """Round each corner. From `half` before it to `half` after it runs the quintic with lift, slope and curvature of both laws at
        the ends."""
        if not half:
            return
        starts, laws = list(self.starts), list(self.circles)
        for theta, before, after, _ in self.corners():
            ends = [before.law(theta - half), after.law(theta + half)]
            quintic = PPoly.from_bernstein_basis(BPoly.from_derivatives([theta - half, theta + half], ends))
            blend = Stretch(theta - half, 1.0, 0.0, 1.0, quintic.c[::-1, 0], centre=theta)
            starts[self.starts.index(theta)] = theta + half
            # A blend across the end of a turn is entered at both ends of the turn.
            for start in {(theta - half) % math.tau, max(theta - half, 0.0)}:
                starts.append(start)
                laws.append(blend)
        order = np.argsort(starts)
        self.starts, self.circles = [starts[index] for index in order], [laws[index] for index in order]
        self.is_rounded = True

    def arcs(self, numbers):
        base, flank, nose = (number(numbers, key, least=0.0) for key in ("base_radius", "flank_radius", "nose_radius"))
        start, end = (math.radians(number(numbers, key)) for key in ("flank_start_deg", "nose_end_deg"))
        if not 0.0 <= start < end <= math.pi:
            raise CannotCheck("the cam needs 0 <= flank_start_deg < nose_end_deg <= 180")
        self.base = base
        toward_start, toward_end = (np.array([math.cos(angle), math.sin(angle)]) for angle in (start, end))
        # The flank touches the base circle at `start` and encloses it, so its centre lies behind the axis.
        flank_centre = -(flank - base) * toward_start
        # The nose touches the flank from inside, so their centres are flank - nose apart. The root along the ray at `end`:
        b, c = toward_end @ flank_centre, flank_centre @ flank_centre - (flank - nose) ** 2
        if flank <= base or flank <= nose or b * b < c or b + math.sqrt(b * b - c) <= 0.0:
            raise CannotCheck("the circles of the cam cannot touch each other")
        nose_distance = b + math.sqrt(b * b - c)
        nose_centre, top = nose_distance * toward_end, nose_distance + nose
        contact = numbers.get("contact", "point")
        is_roller = isinstance(contact, dict)
        if not is_roller and contact not in ("point", "flat"):
            raise CannotCheck(f"cam.contact = {contact!r}: this route cannot check it")
        roller, offset = (number(contact, key) for key in ("roller_radius", "offset")) if is_roller else (0.0, 0.0)
        normal = (nose_centre - flank_centre) / (flank - nose)
        # A flat face touches both circles where its normal is theirs; a roller does where its centre is on the line of motion.
        meeting_point = normal if contact == "flat" else flank_centre + (flank + roller) * normal
        meeting = math.atan2(meeting_point[1], meeting_point[0])
        if not start < meeting < end:
            raise CannotCheck("flank and nose of the cam do not meet between flank_start_deg and nose_end_deg")
        reaches = [base + roller, math.hypot(*meeting_point), top + roller]
        if abs(offset) >= reaches[0]:
            raise CannotCheck("the roller's line of motion misses the base circle")
        early = [0.0] * 3 if contact == "flat" else [math.asin(offset / reach) for reach in reaches]

        def circle(centre, radius):
            return Tangent(centre, radius) if contact == "flat" else Circle(centre, radius + roller, offset)

        axis = np.zeros(2)
        rising = [circle(flank_centre, flank), circle(nose_centre, nose)]
        stretches = [
            (start - early[0], rising[0]),
            (meeting - early[1], rising[1]),
            (end - early[2], circle(axis, top)),
            (math.tau - end - early[2], rising[1].mirrored()),
            (math.tau - meeting - early[1], rising[0].mirrored()),
            (math.tau - start - early[0], circle(axis, base)),
        ]
        if end == math.pi:
            del stretches[2]
        stretches = sorted(((first % math.tau, law) for first, law in stretches), key=lambda stretch: stretch[0])
        # The last stretch continues up to the first.
        stretches.insert(0, (0.0, stretches[-1][1]))
        return [first for first, _ in stretches], [law for _, law in stretches]

    def law(self, theta):
        return self.circles[bisect_right(self.starts, theta % math.tau) - 1].law(theta)

    def corners(self):
        """Yield (angle, circle before, circle after, angle to the nearest other boundary) for each jump of the curvature."""
        # On a short polynomial, rounding would look like a jump.
        for i, theta in enumerate([] if self.is_rounded else self.starts):
            before, after = self.circles[i - 1], self.circles[i]
            if abs(after.law(theta)[1] - before.law(theta)[1]) > NOISE * self.base:
                continue
            if abs(after.law(theta)[2] - before.law(theta)[2]) > NOISE * self.base:
                others = self.starts[:i] + self.starts[i + 1 :]
                yield theta, before, after, min(abs(math.remainder(theta - other, math.tau)) for other in others)
