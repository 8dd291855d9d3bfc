"""The [cam] table of a model as pieces: [(angle where it starts, law, number of derivatives that agree there)].

The decimals of the table are exact. The lift counts as a derivative, so that 2 means that lift and slope agree. The number counts
only derivatives that agree because of how the law is made. None means that no two laws meet there.
"""

from math import floor

from flint import arb, arb_mat, arb_poly, fmpq

from .laws import Circle, Levered, OffsetCircle, Waves
from .numbers import Refused, Undecided, decimal

# Most rows of a table. Measured cams have fewer, and larger systems take minutes to solve in balls.
MOST_ROWS = 1000


def pieces_of(table):
    """Return the pieces of a [cam] table, by rising start in [0, 2 pi)."""
    law = table.get("law")
    if law not in LAWS:
        raise Refused(f"cam.law = {law!r}: must be one of {', '.join(LAWS)}")
    if table.get("corner_rounding_deg", 0) != 0:
        raise Refused("cam.corner_rounding_deg: the proofs do not cover rounded corners")
    pieces, ratio = LAWS[law](table), _lever_ratio(table)
    return [(start, Levered(piece, ratio), agree) for start, piece, agree in pieces] if ratio != 1 else pieces


def _lever_ratio(table):
    ratio = decimal(table.get("lever_ratio", 1))
    if not ratio > 0:
        raise Refused("cam.lever_ratio must be above 0")
    return arb(ratio) if ratio != 1 else ratio


def _number(table, name, where="cam"):
    if name not in table:
        raise Refused(f"the model has no {where}.{name}")
    return decimal(table[name])


def _radians(degrees):
    return arb(degrees) * arb.pi() / 180


def arcs(table):
    """Return the pieces of base, flank and nose circles that touch, mirrored about pi. Where circles touch, lift and slope agree."""
    fields = ("base_radius", "flank_radius", "nose_radius", "flank_start_deg", "nose_end_deg")
    base, flank, nose, start_deg, end_deg = (_number(table, name) for name in fields)
    if not (0 < base < flank and 0 < nose < flank and 0 < start_deg < end_deg <= 180):
        raise Refused("cam: the circles need 0 < base < flank, 0 < nose < flank and 0 < flank_start < nose_end <= 180 deg")
    start, end, turn = _radians(start_deg), _radians(end_deg), 2 * arb.pi()
    sin, cos = _radians(end_deg - start_deg).sin_cos()
    # The flank's centre lies opposite its first ray. |O1 O2| = flank - nose fixes the nose's centre on the flank's last ray.
    behind, apart = arb(flank - base), arb(flank - nose)
    ahead = ((apart - behind * sin) * (apart + behind * sin)).sqrt() - behind * cos
    if not ahead > 0:
        raise Refused("cam: the flank and the nose circle do not touch")
    # In axes whose first axis is the flank's first ray: O1 = (-behind, 0), O2 = ahead (cos, sin).
    between = ahead * cos + behind, ahead * sin
    contact, tip, offset = table.get("contact", "point"), arb(0), arb(0)
    if isinstance(contact, dict):
        tip, offset = (arb(_number(contact, name, "cam.contact")) for name in ("roller_radius", "offset"))
        if not (tip > 0 and abs(offset) < base + tip):
            raise Refused("cam.contact: a roller needs a radius above 0, and an offset that its base circle reaches")
    elif contact not in ("point", "flat"):
        raise Refused(f"cam.contact: {contact!r} is not a contact that the proofs cover")
    if contact == "flat":
        # A flat face touches both circles along their common normal.
        (x, y), early = between, [arb(0)] * 3
    else:
        # The point, or the roller's centre, passes from one circle to the other there. The roller's centre is its radius further out.
        stretch = (flank + tip) / apart
        x, y = stretch * between[0] - behind, stretch * between[1]
        early = [(offset / radius).asin() for radius in (base + tip, (x * x + y * y).sqrt(), ahead + nose + tip)]
    meeting = start + arb.atan2(y, x)
    if not (meeting > start and meeting < end):
        raise Refused("cam: flank and nose do not touch between flank_start and nose_end")

    def circle(distance, direction, radius):
        if contact == "flat":
            return Waves(arb(0), [radius], [(distance, 1, -direction)])
        return OffsetCircle(distance, direction, radius + tip, offset) if offset != 0 else Circle(distance, direction, radius + tip)

    def dwell(radius):
        return Waves(arb(0), [((radius + tip - offset) * (radius + tip + offset)).sqrt() if offset != 0 else radius + tip])

    rising, falling = (circle(behind, angle, arb(flank)) for angle in (start + arb.pi(), arb.pi() - start))
    near, far = (circle(ahead, angle, arb(nose)) for angle in (end, turn - end))
    up = [angle - sooner for angle, sooner in zip((start, meeting, end), early)]
    down = [turn - angle - sooner for angle, sooner in zip((start, meeting, end), early)]
    pieces = [(up[0], rising), (up[1], near), (up[2], dwell(ahead + nose)), (down[2], far), (down[1], falling), (down[0], dwell(arb(base)))]
    if end_deg == 180:
        del pieces[2]
    # With an offset the flank may begin before angle 0, or the last dwell after a full turn.
    pieces = [(angle - turn * floor(float(angle / turn)), law, 2) for angle, law in pieces]
    return sorted(pieces, key=lambda piece: float(piece[0]))


def harmonic(table):
    """Return c = offset + sum a_k cos(k theta + p_k), one law for the whole turn."""
    pairs = zip(table.get("amplitudes", ()), table.get("phases_deg", ()), strict=True)
    waves = [(arb(decimal(a)), k, _radians(decimal(phase))) for k, (a, phase) in enumerate(pairs, start=1)]
    return [(arb(0), Waves(arb(0), [_number(table, "offset")], waves), None)]


def rectified_sine(table):
    """Return c = offset + amplitude |sin theta|. The lift agrees at 0 and pi, and the slope jumps there."""
    offset, amplitude = _number(table, "offset"), arb(_number(table, "amplitude"))
    # sin u = cos(u - pi/2)
    hump = [(amplitude, 1, -arb.pi() / 2)]
    return [(start, Waves(start, [offset], hump), 1) for start in (arb(0), arb.pi())]


# Largest mismatch between two polynomials, relative to their terms, that counts as rounding of typed decimals; and the number of
# derivatives in which it does.
TYPED, JOINED = fmpq(1, 10**9), 4


def polynomial(table):
    """Return c = sum a_k (theta - start)^k. The mismatch that typing left between two polynomials is taken out, so that they agree up
    to a corner."""
    starts, laws, spans, missed, smooth = _typed(table)

    def along(first):
        """Yield the correction of each piece, from the correction of the first one, and at last the correction of the first a
        revolution later."""
        yield first
        for span, jumps in zip(spans, missed):
            first = first(arb_poly([span, 1])) - jumps
            yield first

    # The correction of the first piece keeps its lift and is of degree 4. A revolution later each power adds to those below it, and
    # no term below the fourth may differ.
    *_, open_by = along(arb_poly([]))
    rises = [arb_poly([2 * arb.pi(), 1]) ** k for k in range(1, JOINED + 1)]
    powers = arb_mat([[rise[n] if n < k else 0 for k, rise in enumerate(rises, 1)] for n in range(JOINED)])
    first = powers.solve(arb_mat([[-open_by[n]] for n in range(JOINED)]))
    joined = [law + added for law, added in zip(laws, along(arb_poly([0, *first.entries()])))]
    # The balls of c'' decide whether it jumps, as for a motion.
    agree = [min(count, 2) for count in (smooth[-1], *smooth[:-1])]
    return [(start, Waves(start, law.coeffs()), count) for start, law, count in zip(starts, joined, agree)]


def missed_by(table):
    """Return the largest mismatch of lift and of slope between the pieces of a cam as typed; 0 for laws other than polynomials."""
    if table.get("law") != "polynomial":
        return arb(0), arb(0)
    *_, missed, _ = _typed(table)
    return tuple(max((abs(_lever_ratio(table) * jumps[n]).upper() for jumps in missed), key=float) for n in (0, 1))


def _typed(table):
    """Return starts, laws and spans of the polynomials as typed, and the mismatches and agreements with the next one, as from `_missed`."""
    starts = [_radians(_number(segment, "start_deg", "cam.segment")) for segment in table.get("segment", ())]
    laws = [arb_poly([decimal(a) for a in segment.get("coefficients", ())]) for segment in table.get("segment", ())]
    if not laws:
        raise Refused("no cam.segment")
    spans = [end - start for start, end in zip(starts, starts[1:] + [starts[0] + 2 * arb.pi()])]
    met = (_missed(law, span, after) for law, span, after in zip(laws, spans, laws[1:] + laws[:1]))
    return starts, laws, spans, *zip(*met)


def _missed(law, span, after):
    """Return the mismatch between a law and the next one that is to be taken out, as a polynomial about the start of the next one,
    and the number of derivatives that agree there afterwards."""
    before, sizes = (of(arb_poly([span, 1])) for of in (law, arb_poly([abs(a) for a in law])))
    jumps, smooth = [], JOINED
    for n in range(JOINED):
        jump, size = after[n] - before[n], sizes[n].max(abs(after[n]))
        is_corner = abs(jump) > TYPED * size
        if not is_corner and not abs(jump) <= TYPED * size:
            raise Undecided("whether two polynomials of the cam meet is not decided")
        jumps.append(arb(0) if is_corner else jump)
        smooth = min(smooth, n) if is_corner else smooth
    return arb_poly(jumps), smooth


def spline(table):
    """Return the periodic spline through the rows, solved in balls. Degree 3 agrees up to c'', and degree 5 up to c''''."""
    turn = fmpq(360)
    rows = [(decimal(row["angle_deg"]), decimal(row["lift"])) for row in table.get("rows", ())]
    # Angles in one turn, from 0 on.
    rows = sorted((angle - turn * (angle / turn).floor(), lift) for angle, lift in rows)
    degree = {"cubic": 3, "quintic": 5}.get(table.get("spline"))
    if degree is None or not 3 <= len(rows) <= MOST_ROWS:
        raise Refused(f"cam: the proofs cover a table only as a cubic or quintic spline of 3 to {MOST_ROWS} rows")
    count, size = len(rows), (degree - 1) // 2
    ends = rows[1:] + [(rows[0][0] + turn, rows[0][1])]
    # Widths are in units of the mean width. The unknowns of a row are its slope and, for degree 5, its curvature.
    gaps = [(fmpq(count) * (b - a) / turn, v, w - v) for (a, v), (b, w) in zip(rows, ends)]
    matrix, right = arb_mat(size * count, size * count), arb_mat(size * count, 1)
    for index, (h, value, rise) in enumerate(gaps):
        after = (index + 1) % count
        d = rise / h
        if degree == 3:
            # c'' at the ends of a piece: (6 d - 4 s0 - 2 s1)/h and (2 s0 + 4 s1 - 6 d)/h.
            equations = [(index, [4 / h], [2 / h], 6 * d / h), (after, [2 / h], [4 / h], 6 * d / h)]
        else:
            # c'''' = (-360 d + 192 s0 + 168 s1)/h^3 + (36 k0 - 24 k1)/h^2 and c''' = (60 d - 36 s0 - 24 s1)/h^2 + (3 k1 - 9 k0)/h
            # at the start; at the end the mirror image.
            a, b, c, e, f, g = 192 / h**3, 168 / h**3, 36 / h**2, 24 / h**2, 9 / h, 3 / h
            top, low = 360 * d / h**3, 60 * d / h**2
            equations = [
                (2 * index, [a, c], [b, -e], top),
                (2 * index + 1, [c, f], [e, -g], low),
                (2 * after, [b, e], [a, -c], top),
                (2 * after + 1, [-e, -g], [-c, f], -low),
            ]
        for row, at_start, at_end, known in equations:
            for column in range(size):
                matrix[row, size * index + column] += arb(at_start[column])
                matrix[row, size * after + column] += arb(at_end[column])
            right[row, 0] += arb(known)
    solution = matrix.solve(right)
    unit, pieces = 2 * arb.pi() / count, []
    for index, (h, value, rise) in enumerate(gaps):
        left, far = ([solution[size * at + k, 0] for k in range(size)] for at in (index, (index + 1) % count))
        e0, e1 = left[0] - rise / h, far[0] - rise / h
        if degree == 3:
            coefficients = [arb(value), left[0], -(2 * e0 + e1) / h, (e0 + e1) / h**2]
        else:
            e0, e1, k0, k1 = e0 / h, e1 / h, left[1], far[1]
            coefficients = [
                arb(value),
                left[0],
                k0 / 2,
                (-6 * e0 - 4 * e1 + (k1 - 3 * k0) / 2) / h,
                (8 * e0 + 7 * e1 + (3 * k0 - 2 * k1) / 2) / h**2,
                (-3 * (e0 + e1) + (k1 - k0) / 2) / h**3,
            ]
        start = _radians(rows[index][0])
        pieces.append((start, Waves(start, [a / unit**k for k, a in enumerate(coefficients)]), degree))
    return pieces


def program(table):
    """Return the motions one after the other. Each starts and ends at rest, so that lift and slope agree; they also agree inside a
    motion.

    As in the reader of model files, spans are taken as parts of their sum, and the last rise closes the lift.
    """
    segments = table.get("segment", ())
    spans = [_number(segment, "span_deg", "cam.segment") for segment in segments]
    rises = [decimal(segment.get("rise", 0)) for segment in segments]
    degrees, base = sum(spans, fmpq(0)), _number(table, "base")
    moving = [index for index, segment in enumerate(segments) if segment.get("motion") != "dwell"]
    pieces, turned, lifted, start, lift = [], fmpq(0), fmpq(0), arb(0), base
    for index, (segment, span, rise) in enumerate(zip(segments, spans, rises)):
        turned, lifted = turned + span, lifted + rise
        to = base if moving and index == moving[-1] else base + lifted if index in moving else lift
        end = 2 * arb.pi() * arb(turned / degrees)
        if segment.get("motion") not in MOTIONS:
            raise Refused(f"cam.segment.motion = {segment.get('motion')!r}: must be one of {', '.join(MOTIONS)}")
        pieces += Placed(start, end - start, arb(lift), arb(to - lift)).pieces(MOTIONS[segment["motion"]])
        start, lift = end, to
    if not pieces:
        raise Refused("no cam.segment")
    return pieces


class Placed:
    """Place of a motion: its start and its span, rad, the lift at the start, and the rise."""

    def __init__(self, start, span, lift, rise):
        self.start, self.span, self.lift, self.rise = start, span, lift, rise

    def pieces(self, motion):
        """Return the pieces of a motion. For a rise of 1 over a span of 1, `motion` returns [(start, reference x, coefficients, wave)]."""
        return [(self.start + self.span * x, self.law(*law), 2) for x, *law in motion()]

    def law(self, about, coefficients, wave):
        """Return s = sum a_k y^k + amplitude cos(frequency y + phase), y = x - about, stretched to the place."""
        scaled = [self.rise * a / self.span**k for k, a in enumerate(coefficients)]
        waves = [(self.rise * amplitude, frequency / self.span, phase) for amplitude, frequency, phase in wave]
        return Waves(self.start + self.span * about, [self.lift + scaled[0]] + scaled[1:], waves)


def _halves(*powers):
    """s = sum a_k x^k, k from 0, up to the middle, and 1 - s(1 - x) from there, about the end."""
    first = [arb(a) for a in powers]
    # -(-1)^k a_k, since y = x - 1.
    last = [1 - first[0]] + [-a if k % 2 == 0 else a for k, a in enumerate(first)][1:]
    return [(fmpq(0), fmpq(0), first, []), (fmpq(1, 2), fmpq(1), last, [])]


def _sine(about, lift, velocity, peak, frequency):
    """s = lift + velocity y + peak/f^2 (f y - sin(f y)), y = x - about: its acceleration is peak sin(f y)."""
    amplitude = peak / frequency**2
    # -sin = cos(. + pi/2)
    return about, [arb(lift), velocity + amplitude * frequency], [(amplitude, frequency, arb.pi() / 2)]


def _modified_trapezoid():
    """Acceleration C sin(4 pi x), C, C cos(4 pi (x - 3/8)) and antisymmetric, C = 8 pi/(pi + 2) for a rise of 1."""
    peak, frequency = 8 * arb.pi() / (arb.pi() + 2), 4 * arb.pi()
    # At 1/8: s' = C/(4 pi), s = C/(4 pi)^2 (pi/2 - 1); at 1/2: s' = 2.
    velocity, covered = peak / frequency, peak / frequency**2 * (arb.pi() / 2 - 1)
    eighth = fmpq(1, 8)
    return [
        (fmpq(0), *_sine(fmpq(0), 0, arb(0), peak, frequency)),
        (eighth, eighth, [covered, velocity, peak / 2], []),
        (3 * eighth, *_sine(fmpq(1, 2), fmpq(1, 2), arb(2), -peak, frequency)),
        (5 * eighth, 7 * eighth, [1 - covered, velocity, -peak / 2], []),
        (7 * eighth, *_sine(fmpq(1), 1, arb(0), peak, frequency)),
    ]


def _modified_sine():
    """Acceleration C sin(4 pi x), C sin(pi/3 + 4 pi x/3), C sin(4 pi (x - 1)), C = 4 pi^2/(pi + 4) for a rise of 1."""
    peak, frequency = 4 * arb.pi() ** 2 / (arb.pi() + 4), 4 * arb.pi()
    # At 1/2: s' = C/pi.
    return [
        (fmpq(0), *_sine(fmpq(0), 0, arb(0), peak, frequency)),
        (fmpq(1, 8), *_sine(fmpq(1, 2), fmpq(1, 2), peak / arb.pi(), -peak, frequency / 3)),
        (fmpq(7, 8), *_sine(fmpq(1), 1, arb(0), peak, frequency)),
    ]


def _cycloidal():
    """s = x - sin(2 pi x)/(2 pi): acceleration 2 pi sin(2 pi x)."""
    return [(fmpq(0), *_sine(fmpq(0), 0, arb(0), 2 * arb.pi(), 2 * arb.pi()))]


def _simple_harmonic():
    """s = (1 - cos(pi x))/2."""
    half = arb(fmpq(1, 2))
    return [(fmpq(0), fmpq(0), [half], [(-half, arb.pi(), arb(0))])]


MOTIONS = {
    "dwell": lambda: [(fmpq(0), fmpq(0), [arb(0)], [])],
    "parabolic": lambda: _halves(0, 0, 2),
    "harmonic": _simple_harmonic,
    "cycloidal": _cycloidal,
    "modified-trapezoid": _modified_trapezoid,
    "modified-sine": _modified_sine,
    "poly345": lambda: _halves(0, 0, 0, 10, -15, 6),
    "poly4567": lambda: _halves(0, 0, 0, 0, 35, -84, 70, -20),
}

LAWS = {
    "arcs": arcs,
    "harmonic": harmonic,
    "rectified-sine": rectified_sine,
    "program": program,
    "polynomial": polynomial,
    "table": spline,
}
