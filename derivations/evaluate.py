"""The symbolic route: the derived A and B at a model's corner impact, to 30 digits.

Reads one JSON document from stdin (the model's follower, cam and study) and writes one to stdout. On failure it writes a message to
stderr, and the exit code is 1. The expressions are those that corner_map.py derived and derive.py wrote to
golden/derived/corner_map.json; nothing is proved or retyped here. The corner impact is found from the model alone:

    leave the corner at (c, v+), fly for T, be back at c with v-;   v+ = (1 + r) c' - r v-,   c' = (2 pi/T) dc/dtheta,

which is an equation for T. A root in the study's range counts if its flight stays above the cam and lands on it (v- < c'). The
slowest of these is taken.
"""

import json
import math
import sys
from bisect import bisect_right
from pathlib import Path

from mpmath import mp, mpf

import motions
import splines
from arithmetic import evaluate, exact, flow, later, responses, text

DERIVED = Path(__file__).resolve().parent.parent / "golden" / "derived" / "corner_map.json"
DIGITS = 30
# Samples over the study's periods, and samples of the height above the cam over one revolution.
SCAN, HEIGHT = 4096, 16384
# Relative width to which T is solved.
CLOSED = mpf(10) ** -60
# Size of a sum relative to its terms below which the sum counts as 0.
NOTHING = mpf(10) ** -70


class Refused(Exception):
    """The input holds no corner impact, or is no valid model."""


class Dwell:
    """Circle about the axis."""

    def __init__(self, radius):
        self.radius = radius

    def lift(self, angle, library=mp):
        return self.radius, 0, 0

    def rounded(self):
        return Dwell(float(self.radius))


class Arc:
    """Circle about a centre at polar (distance, direction), met by a line that runs `offset` to the left of the axis: (c - distance
    cos(phi))^2 + (distance sin(phi) + offset)^2 = radius^2."""

    def __init__(self, distance, direction, radius, offset=0):
        self.distance, self.direction, self.radius, self.offset = distance, direction, radius, offset

    def lift(self, angle, library=mp):
        """Return c, dc/dtheta and d^2c/dtheta^2. The derivatives come from the circle's equation, differentiated once and twice."""
        phi = angle - self.direction
        along, across = self.distance * library.cos(phi), self.distance * library.sin(phi)
        beside = across + self.offset
        outward = library.sqrt((self.radius - beside) * (self.radius + beside))
        rate = -beside * along / outward
        bend = (beside * across - along * along - rate * rate) / outward
        return along + outward, rate - across, bend - along

    def rounded(self):
        return Arc(float(self.distance), float(self.direction), float(self.radius), float(self.offset))


class Face:
    """Circle that touches a face square to the follower's motion. The lift is the distance of the circle's tangent from the axis."""

    def __init__(self, distance, direction, radius):
        self.distance, self.direction, self.radius = distance, direction, radius

    def lift(self, angle, library=mp):
        phi = angle - self.direction
        along = self.distance * library.cos(phi)
        return along + self.radius, -self.distance * library.sin(phi), -along

    def rounded(self):
        return Face(float(self.distance), float(self.direction), float(self.radius))


class Levered:
    """Law behind a lever: every lift is multiplied by the lever's ratio."""

    def __init__(self, law, ratio):
        self.law, self.ratio = law, ratio

    def lift(self, angle, library=mp):
        return tuple(self.ratio * part for part in self.law.lift(angle, library))

    def rounded(self):
        return Levered(self.law.rounded(), float(self.ratio))


def section(document, name):
    part = document.get(name)
    if not isinstance(part, dict):
        raise Refused(f"the model has no [{name}]")
    return part


def number(part, name, field):
    if field not in part:
        raise Refused(f"the model has no {name}.{field}")
    try:
        return exact(part[field])
    except ValueError as error:
        raise Refused(f"{name}.{field}: {error}") from error


def numbers(document, name, fields):
    part = section(document, name)
    return [number(part, name, field) for field in fields]


def arcs(cam):
    """Return base, flank and nose circles that touch, mirrored about pi: [(angle where it starts, law)]."""
    fields = ("base_radius", "flank_radius", "nose_radius", "flank_start_deg", "nose_end_deg")
    base, flank, nose, start, end = (number(cam, "cam", field) for field in fields)
    if not (0 < base < flank and 0 < nose < flank and 0 < start < end <= 180):
        raise Refused("cam: the circles need 0 < base < flank, 0 < nose < flank and 0 < flank_start < nose_end <= 180 deg")
    start, end = start * mp.pi / 180, end * mp.pi / 180
    # The flank touches the base circle at the ray `start`, so its centre is opposite.
    behind = flank - base
    # |O1 O2| = flank - nose fixes O2 on the ray `end`.
    span = end - start
    under_root = (flank - nose) ** 2 - (behind * mp.sin(span)) ** 2
    if under_root < 0:
        raise Refused("cam: no nose circle on the ray nose_end touches the flank circle")
    ahead = mp.sqrt(under_root) - behind * mp.cos(span)
    if ahead <= 0:
        raise Refused("cam: the nose circle's centre is not on the ray nose_end")
    # The flank and the nose touch on the line through their centres.
    centre_1, centre_2 = -behind * mp.expj(start), ahead * mp.expj(end)
    contact = cam.get("contact", "point")
    roller, offset = mpf(0), mpf(0)
    if isinstance(contact, dict):
        roller, offset = number(contact, "cam.contact", "roller_radius"), exact(contact.get("offset", 0))
        if not roller > 0 or abs(offset) >= base + roller:
            raise Refused("cam.contact: a roller needs a radius above 0 and an offset within the base circle of its centre")
    elif contact not in ("point", "flat"):
        raise Refused(f"cam.contact: {contact!r} is not a contact that this route can compute")
    # Place where the centre of the roller, or the point, passes from one circle to the next.
    passes = centre_1 + (centre_2 - centre_1) * (flank + roller) / (flank - nose)
    if contact == "flat":
        meeting = mp.arg(centre_2 - centre_1) % (2 * mp.pi)
        early = [mpf(0)] * 3
    else:
        meeting = mp.arg(passes) % (2 * mp.pi)
        early = [mp.asin(offset / radius) for radius in (base + roller, abs(passes), ahead + nose + roller)]
    if not start < meeting < end:
        raise Refused("cam: flank and nose do not touch between flank_start and nose_end")

    def circle(distance, direction, radius):
        if contact == "flat":
            return Face(distance, direction, radius)
        return Arc(distance, direction, radius + roller, offset)

    def dwell(radius):
        return Dwell(mp.sqrt((radius + roller) ** 2 - offset**2))

    turn = 2 * mp.pi
    laws = [
        (start - early[0], circle(behind, start + mp.pi, flank)),
        (meeting - early[1], circle(ahead, end, nose)),
        (end - early[2], dwell(ahead + nose)),
        (turn - end - early[2], circle(ahead, turn - end, nose)),
        (turn - meeting - early[1], circle(behind, mp.pi - start, flank)),
        (turn - start - early[0], dwell(base)),
    ]
    if not end < mp.pi:
        del laws[2]
    # The circle at angle 0 comes first.
    laws = sorted(((angle % turn, law) for angle, law in laws), key=lambda piece: piece[0])
    return [(mpf(0), laws[-1][1]), *laws]


def program(cam):
    """Return standard motions: [(angle where each piece starts, law)]."""
    turn = mp.pi / 180
    each = [(part.get("motion"), number(part, "cam.segment", "span_deg") * turn, number(part, "cam.segment", "rise"))
            for part in cam.get("segment", [])]
    return motions.program(number(cam, "cam", "base"), each)


def polynomial(cam):
    """Return polynomials: [(angle where each starts, law)]."""
    each = [(number(part, "cam.segment", "start_deg") * mp.pi / 180, [exact(power) for power in part["coefficients"]])
            for part in cam.get("segment", [])]
    return motions.polynomials(motions.joined(each))


def harmonic(cam):
    """Return a sum of cosines with phases: [(0, law)]."""
    each = zip(map(exact, cam.get("amplitudes", [])), map(exact, cam.get("phases_deg", [])))
    return motions.cosines(number(cam, "cam", "offset"), [(size, phase * mp.pi / 180) for size, phase in each])


def rectified_sine(cam):
    """Return the absolute value of a sine: [(angle where each half starts, law)]."""
    return motions.rectified(number(cam, "cam", "offset"), number(cam, "cam", "amplitude"))


def table(cam):
    """Return a spline through the rows of a table. With "fitted", the spline is near the rows, with the weight, knots, corners and
    dwells that were fitted."""
    rows = [(exact(row["angle_deg"]), exact(row["lift"])) for row in cam["rows"]]
    angles, lifts = [angle * mp.pi / 180 for angle, _ in rows], [lift for _, lift in rows]
    if "fitted" not in cam:
        basis = splines.Splines({"cubic": 3, "quintic": 5}[cam["spline"]], angles)
        return motions.polynomials(list(basis.powers(basis.through(angles, lifts))))
    fitted = cam["fitted"]
    knots, corners = ([exact(angle) for angle in fitted[name]] for name in ("knots_rad", "corners_rad"))
    dwells = [tuple(map(exact, dwell)) for dwell in fitted["dwells_rad"]]
    ends = [end for dwell in dwells for end in dwell]
    basis = splines.Splines(splines.QUINTIC, splines.knots([*knots, *ends], corners), [start for start, _ in dwells])
    numbers = basis.fitted(angles, lifts, exact(fitted["weight"]))
    return motions.polynomials(list(basis.powers(numbers)))


class Touched:
    """Piece of a contour, its radius over the polar angle, touched by a flat face or a roller. `polar` is an angle of the piece."""

    def __init__(self, radius, polar, roller, offset):
        """`roller` is None for a flat face."""
        self.radius, self.polar, self.roller, self.offset = radius, polar, roller, offset

    def touch(self, polar, library):
        """Return (cam angle, its rate by the polar angle), (lift, and its first and second derivative)."""
        radius, slope, bend = self.radius.lift(polar, library)
        square = radius * radius + slope * slope
        # The normal turns by `turns` for each radian of the polar angle, and leans back by the angle of the slope.
        turns = (square + slope * slope - radius * bend) / square
        speed, leans = library.sqrt(square), -library.atan(slope / radius)
        if self.roller is None:
            lift = radius * radius / speed
            return (polar + leans, turns), (lift, radius * slope / speed, speed / turns - lift)
        along, left = radius + self.roller * radius / speed, -self.roller * slope / speed
        away = library.sqrt(along * along + left * left)
        angle = library.atan(left / along) - library.asin(self.offset / away)
        lift, tan = library.sqrt((away - self.offset) * (away + self.offset)), library.tan(leans - angle)
        rate = (speed + self.roller * turns) * library.cos(leans - angle) / lift
        first = self.offset - lift * tan
        return (polar + angle, rate), (lift, first, -first * tan - lift * (1 + tan * tan) * (turns / rate - 1))

    def lift(self, angle, library=mp):
        """Return c, dc/dtheta and d^2c/dtheta^2. Newton's method finds the polar angle of the cam angle."""
        polar, close = self.polar, mp.eps * 100 if library is mp else 1e-15
        turn = 2 * library.pi
        for _ in range(50):
            (there, rate), lift = self.touch(polar, library)
            missed = angle - there
            step = (missed - turn * library.floor(missed / turn + 0.5)) / rate
            if abs(step) <= close:
                break
            polar += step
        return lift

    def rounded(self):
        roller = self.roller if self.roller is None else float(self.roller)
        return Touched(self.radius.rounded(), float(self.polar), roller, float(self.offset))


def contour(cam):
    """Return the lift of a follower on a contour, a spline of the cam's own radius: [(angle where each piece starts, law)]."""
    radii, contact = table(cam), cam.get("contact", "point")
    if contact == "point":
        return radii
    if isinstance(contact, dict):
        roller, offset = number(contact, "cam.contact", "roller_radius"), exact(contact.get("offset", 0))
    elif contact == "flat":
        roller, offset = None, mpf(0)
    else:
        raise Refused(f"cam.contact: {contact!r} is not a contact that this route can compute")
    turn, pieces = 2 * mp.pi, []
    for (start, radius), end in zip(radii, [start for start, _ in radii[1:]] + [turn]):
        law = Touched(radius, (start + end) / 2, roller, offset)
        pieces.append((law.touch(start, mp)[0][0] % turn, law))
    pieces.sort(key=lambda piece: piece[0])
    return pieces if pieces[0][0] == 0 else [(mpf(0), pieces[-1][1]), *pieces]


SHARP = {
    "arcs": arcs,
    "contour": contour,
    "harmonic": harmonic,
    "rectified-sine": rectified_sine,
    "program": program,
    "polynomial": polynomial,
    "table": table,
}
# Relative difference up to which two segments count as meeting. A model's numbers are doubles, which are rounded.
SAME = mpf(10) ** -9


def corners(laws):
    """Yield the corners, where c'' jumps and c' does not: (angle, (c, c', c'') before, (c, c', c'') after), derivatives by angle."""
    ends = [angle for angle, _ in laws[1:]] + [2 * mp.pi]
    for (_, before), angle, (starts, after) in zip(laws, ends, laws[1:] + laws[:1]):
        left, right = before.lift(angle), after.lift(starts)
        size = abs(left[0]) + abs(left[1]) + abs(left[2]) + abs(right[2])
        if abs(left[2] - right[2]) > SAME * size and abs(left[1] - right[1]) <= SAME * size:
            yield starts, left, right


def profile(cam):
    """Return the laws of a cam with the angles where they start. Corners are rounded and the lift is levered if the model asks for it."""
    if cam.get("law") not in SHARP:
        raise Refused(f"cam.law = {cam.get('law')!r}: this route computes {', '.join(SHARP)} only")
    laws = SHARP[cam["law"]](cam)
    half = exact(cam.get("corner_rounding_deg", 0)) * mp.pi / 360
    laws = motions.rounded(laws, [angle for angle, _, _ in corners(laws)], half) if half else laws
    ratio = exact(cam.get("lever_ratio", 1))
    if not ratio > 0:
        raise Refused("cam.lever_ratio must be above 0")
    return [(angle, Levered(law, ratio)) for angle, law in laws] if ratio != 1 else laws


class Follower:
    """Constants of a follower for flight and impact."""

    def __init__(self, document):
        fields = ("mass", "damping", "stiffness", "gravity", "rest_position", "restitution")
        mass, damping, stiffness, self.gravity, self.rest, self.r = numbers(document, "follower", fields)
        unknown = sorted(set(section(document, "follower")) - set(fields))
        if unknown:
            raise Refused(f"follower.{unknown[0]}: the laws of flight and impact of this route do not contain it")
        if not (mass > 0 and damping >= 0 and stiffness >= 0):
            raise Refused("follower: mass must be above 0, damping and stiffness at least 0")
        self.zeta, self.omega0_squared = damping / (2 * mass), stiffness / mass
        # x is measured from the spring's equilibrium. Without stiffness it is measured from the rest position.
        self.origin = self.rest - self.gravity / self.omega0_squared if stiffness else self.rest

    def spring(self, position):
        return self.omega0_squared * (position - self.rest) + self.gravity

    def responses(self, time):
        return responses(self.zeta, self.omega0_squared, time)

    def return_rate(self, response):
        """Return s' after a flight."""
        return 1 - self.omega0_squared * response[0] - 2 * self.zeta * response[1]


class Return:
    """Flights of one period from a corner back to it."""

    def __init__(self, follower, corner):
        self.follower = follower
        self.angle, self.left, self.right = corner
        self.position, self.slope = self.left[0], self.left[1]
        self.force = -follower.spring(self.position)

    def miss(self, period, response):
        """Return (1 + r s') (v+ s + force p), which is 0 if the flight ends at the corner. Here v+ is the velocity that Newton's law
        gives from the v- of the flight itself, so that no division is needed."""
        p, s = response
        r, cam = self.follower.r, 2 * mp.pi / period * self.slope
        return (1 + r) * cam * s - r * self.force * s * s + (1 + r * self.follower.return_rate(response)) * self.force * p

    def at(self, period):
        """Return `miss`, or 0 if its terms cancel to working precision: some corners are met again after every period."""
        p, s = response = self.follower.responses(period)
        value = self.miss(period, response)
        size = abs(self.force) * (abs(p) + s * s) + abs(self.slope * s) / period
        return value if abs(value) > NOTHING * size else mpf(0)

    def rounded(self):
        """Return `miss` in doubles, for the search."""
        follower, turn = self.follower, 2 * math.pi * float(self.slope)
        r, force, zeta, omega0_squared = (float(x) for x in (follower.r, self.force, follower.zeta, follower.omega0_squared))

        def miss(period, response):
            p, s = response
            rate = 1 - omega0_squared * p - 2 * zeta * s
            return (1 + r) * turn / period * s - r * force * s * s + (1 + r * rate) * force * p

        return miss

    def close(self, low, high):
        """Return the root of a sign change by regula falsi, in which the value at an end that stays put is halved. Return None
        without a root."""
        at_low, at_high = self.at(low), self.at(high)
        if (at_low < 0) == (at_high < 0):
            return None
        last = low
        for _ in range(1000):
            middle = (low * at_high - high * at_low) / (at_high - at_low)
            value = self.at(middle)
            if value == 0 or abs(middle - last) <= CLOSED * middle:
                return middle
            if (value < 0) == (at_high < 0):
                at_low /= 2
            else:
                low, at_low = high, at_high
            high, at_high, last = middle, value, middle
        return None

    def orbit(self, period, laws):
        """Return (orbit of this period, None), or (None, reason why there is no orbit)."""
        follower, (p, s) = self.follower, self.follower.responses(period)
        if abs(s) <= mpf(10) ** -40 * period:
            return None, "the follower is in resonance with the period"
        cam = 2 * mp.pi / period * self.slope
        leaving = -self.force * p / s
        arriving = self.follower.return_rate((p, s)) * leaving + s * self.force
        if cam - arriving <= mpf(10) ** -30 * (abs(cam) + abs(arriving)):
            return None, "the follower does not approach the cam at the impact"
        if not self.stays_above(period, leaving, laws):
            return None, "the flight meets the cam elsewhere"
        half = follower.responses(period / 2)
        position, velocity = flow(follower.zeta, follower.omega0_squared, half, (mpf(0), leaving), self.force)
        state = (self.position + position - follower.origin, velocity)
        return {"period": period, "arriving": arriving, "cam": cam, "half": half, "state": state, "corner": self}, None

    def stays_above(self, period, leaving, laws):
        """Return True if the follower is above the cam at every sample between the two impacts."""
        zeta, omega0_squared = float(self.follower.zeta), float(self.follower.omega0_squared)
        step = tuple(map(float, self.follower.responses(period / HEIGHT)))
        starts, rounded = [float(angle) for angle, _ in laws], [law.rounded() for _, law in laws]
        first, leaving, force, response = float(self.angle), float(leaving), float(self.force), (0.0, 0.0)
        for index in range(1, HEIGHT):
            response = later(zeta, omega0_squared, response, step)
            angle = (first + 2 * math.pi * index / HEIGHT) % (2 * math.pi)
            law = rounded[bisect_right(starts, angle) - 1]
            height = float(self.position) + response[1] * leaving + response[0] * force
            if height <= law.lift(angle, math)[0]:
                return False
        return True


def locate(document):
    """Return the follower and the slowest corner impact of the model. Raise Refused if there is none."""
    follower = Follower(document)
    cam = section(document, "cam")
    laws = profile(cam)
    slowest_rpm, fastest_rpm = numbers(document, "study", ("rpm_min", "rpm_max"))
    if not 0 < slowest_rpm < fastest_rpm:
        raise Refused("study: rpm_min must be above 0 and below rpm_max")
    first, last = 60 / fastest_rpm, 60 / slowest_rpm
    # 128 samples for each radian of the follower's own oscillation, within bounds.
    samples = max(SCAN, min(16 * SCAN, int(128 * mp.sqrt(follower.omega0_squared) * (last - first))))
    width = (last - first) / samples
    step, response = (tuple(map(float, follower.responses(time))) for time in (width, first))
    zeta, omega0_squared = float(follower.zeta), float(follower.omega0_squared)
    equations = [Return(follower, corner) for corner in corners(laws)]
    searches = [equation.rounded() for equation in equations]
    before = [search(float(first), response) for search in searches]
    found, refused = [], []
    for index in range(1, samples + 1):
        response = later(zeta, omega0_squared, response, step)
        period = first + width * index
        now = [search(float(period), response) for search in searches]
        for equation, low, high in zip(equations, before, now):
            if (low < 0) == (high < 0):
                continue
            # A hundredth more on either side, since rounding may have moved the sign change past a sample.
            root = equation.close(period - width * 1.01, period + width / 100)
            if root is None or not first <= root <= last:
                continue
            orbit, why = equation.orbit(root, laws)
            if orbit:
                found.append(orbit)
            else:
                refused.append(f"{mp.nstr(60 / root, 10)} rpm at {mp.nstr(equation.angle * 180 / mp.pi, 8)} deg: {why}")
        before = now
    if not found:
        tried = "; ".join(refused) or "no flight of one period starts and ends on a corner"
        raise Refused(f"no corner impact between study.rpm_min and study.rpm_max; {tried}")
    return follower, max(found, key=lambda orbit: orbit["period"])


def route(document):
    """Return the whole answer: the corner impact, A and B of both sides, and what follows from them."""
    follower, orbit = locate(document)
    entries = json.loads(DERIVED.read_text())["expressions"]
    corner, period = orbit["corner"], orbit["period"]
    p, s = orbit["half"]

    def side(lift):
        names = {
            "zeta": follower.zeta,
            "omega0_squared": follower.omega0_squared,
            "T": period,
            "r": follower.r,
            "spring": follower.spring(corner.position),
            "v": orbit["arriving"],
            "c1": orbit["cam"],
            "c2": (2 * mp.pi / period) ** 2 * lift[2],
            "p": p,
            "s": s,
        }
        value = {name: text(evaluate(source, names), DIGITS) for name, source in entries.items()}
        return {"A": [[value["A11"], value["A12"]], [value["A21"], value["A22"]]], "B": [value["B1"], value["B2"]]}

    sides = {"minus": side(corner.left), "plus": side(corner.right)}
    # Results that follow from A and B, computed without them. The formulas are proved in normal_form.py and corner_map.py.
    # h F = (1 - w0^2 p, s); the gap when the corner passes is h F dx + v dT/2
    e, f = (1 - follower.omega0_squared * p, s), orbit["arriving"] / 2
    # C dx + D dT = (1 + r) phi12 (c''+ - c''-) tau, tau = (e dx + f dT)/(c' - v)
    jump = (2 * mp.pi / period) ** 2 * (corner.right[2] - corner.left[2])
    jump *= (1 + follower.r) * s / (orbit["cam"] - orbit["arriving"])
    # det A = r^2 e^{-2 zeta T}, by Liouville's formula
    determinant = follower.r**2 * mp.exp(-2 * follower.zeta * period)
    # An entry that is 0 up to the width of the root is written as 0.
    size = abs(orbit["state"][0]) + period * abs(orbit["arriving"])
    state = [0 if abs(value) <= CLOSED * 10**9 * size / period else value for value in orbit["state"]]
    return {
        "period_s": text(period, DIGITS),
        "speed_rpm": text(60 / period, DIGITS),
        "cam_angle_rad": text(corner.angle, DIGITS),
        "x_star": [text(value, DIGITS) for value in state],
        **sides,
        "C": [text(jump * entry, DIGITS) for entry in e],
        "D": text(jump * f, DIGITS),
        "border": [text(entry, DIGITS) for entry in (*e, f)],
        "eigenvalues": {name: eigenvalues(one["A"], determinant) for name, one in sides.items()},
        "digits": DIGITS,
    }


def eigenvalues(matrix, determinant):
    """Return the roots of x^2 - trace x + determinant, the larger real part first. Of a complex pair, the one above the real axis is
    first."""
    half = (exact(matrix[0][0]) + exact(matrix[1][1])) / 2
    root = mp.sqrt(mp.mpc(half * half - determinant))
    return [{"re": text(value.real, DIGITS), "im": text(value.imag, DIGITS)} for value in (half + root, half - root)]


def main():
    try:
        document = json.load(sys.stdin, parse_float=str, parse_int=str)
        if not isinstance(document, dict):
            raise Refused("the input is not a JSON object")
        answer = route(document)
    except (Refused, ValueError, OSError, KeyError, ZeroDivisionError) as error:
        sys.exit(f"evaluate.py: {error}")
    json.dump(answer, sys.stdout, indent=2)
    print()


if __name__ == "__main__":
    main()
