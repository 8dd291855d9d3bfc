"""Cams of standard motions, polynomials and waves for the symbolic route: each motion is its acceleration, integrated twice.

A motion is named after the shape of its acceleration over a unit of time, from rest at one end to rest at the other. Its size follows
from a rise of 1. So only the shapes are written down here.
"""

from itertools import zip_longest

from mpmath import mp, mpf


def quarter(start, end, top, rising):
    """Return a quarter of a sine between 0 and `top`: (start, end, powers, (amplitude, rate, phase))."""
    rate = mp.pi / 2 / (end - start)
    return start, end, [], (top, rate, mpf(0) if rising else mp.pi / 2)


def trapezoid():
    """Yield quarter sines as flanks, an eighth of the time each, about a constant top, and the mirror image."""
    part = [mpf(k) / 8 for k in range(9)]
    for side, first in ((1, 0), (-1, 4)):
        yield quarter(part[first], part[first + 1], side, True)
        yield part[first + 1], part[first + 3], [mpf(side)], None
        yield quarter(part[first + 3], part[first + 4], side, False)


def modified_sine():
    """Yield a sine whose first and last eighth, a quarter of a wave each, run three times as fast as the half wave between them."""
    eighth = mpf(1) / 8
    yield mpf(0), eighth, [], (mpf(1), 4 * mp.pi, mpf(0))
    yield eighth, 1 - eighth, [], (mpf(1), 4 * mp.pi / 3, mp.pi / 2)
    yield 1 - eighth, mpf(1), [], (mpf(1), 4 * mp.pi, 3 * mp.pi / 2)


# Pieces of the acceleration: start, end, powers of the time since the start, and (A, rate, phase) of A sin(rate x + phase).
MOTIONS = {
    "parabolic": lambda: [(mpf(0), mpf(1) / 2, [mpf(1)], None), (mpf(1) / 2, mpf(1), [mpf(-1)], None)],
    "harmonic": lambda: [(mpf(0), mpf(1), [], (mpf(1), mp.pi, mp.pi / 2))],
    "cycloidal": lambda: [(mpf(0), mpf(1), [], (mpf(1), 2 * mp.pi, mpf(0)))],
    "modified-trapezoid": trapezoid,
    "modified-sine": modified_sine,
    # u (1 - u)(1 - 2 u) and u^2 (1 - u)^2 (1 - 2 u): both vanish at the ends and in the middle.
    "poly345": lambda: [(mpf(0), mpf(1), [mpf(0), mpf(1), mpf(-3), mpf(2)], None)],
    "poly4567": lambda: [(mpf(0), mpf(1), [mpf(0), mpf(0), mpf(1), mpf(-4), mpf(5), mpf(-2)], None)],
}


class Piece:
    """Law: powers of the angle since its start, plus amplitude sin(rate x + phase)."""

    def __init__(self, start, powers, sine=None):
        self.start, self.powers, self.sine = start, powers, sine

    def lift(self, angle, library=mp):
        x = angle - self.start
        value = slope = curvature = 0 * x
        for power in reversed(self.powers):
            curvature = curvature * x + 2 * slope
            slope = slope * x + value
            value = value * x + power
        if self.sine:
            amplitude, rate, phase = self.sine
            sine, cosine = library.sin(rate * x + phase), library.cos(rate * x + phase)
            value, slope = value + amplitude * sine, slope + amplitude * rate * cosine
            curvature = curvature - amplitude * rate * rate * sine
        return value, slope, curvature

    def rounded(self):
        sine = self.sine and tuple(map(float, self.sine))
        return Piece(float(self.start), [float(power) for power in self.powers], sine)


def motion(shape, start, span, base, rise):
    """Yield the pieces of one motion from `start` on: (angle where it starts, law)."""
    pieces, value, slope = [], mpf(0), mpf(0)
    for begins, ends, powers, sine in shape:
        # s'' is integrated twice, from s and s' at the end of the piece before.
        twice = [value, slope] + [power / ((k + 1) * (k + 2)) for k, power in enumerate(powers)]
        wave = None
        if sine:
            amplitude, rate, phase = sine
            wave = (-amplitude / rate**2, rate, phase)
            # The wave's own value and slope at the beginning are subtracted.
            twice[0] -= wave[0] * mp.sin(phase)
            twice[1] -= wave[0] * rate * mp.cos(phase)
        piece = Piece(mpf(0), twice, wave)
        pieces.append((begins, piece))
        value, slope, _ = piece.lift(ends - begins)
    size = rise / value
    for begins, piece in pieces:
        powers = [power * size / span**k for k, power in enumerate(piece.powers)]
        powers[0] += base
        wave = piece.sine and (piece.sine[0] * size, piece.sine[1] / span, piece.sine[2])
        yield start + span * begins, Piece(start + span * begins, powers, wave)


def program(base, segments):
    """Return motions one after the other from angle 0 on. Each segment is (name, span, rise)."""
    laws, start = [], mpf(0)
    for name, span, rise in segments:
        if name == "dwell":
            laws.append((start, Piece(start, [base])))
        elif name in MOTIONS:
            laws.extend(motion(MOTIONS[name](), start, span, base, rise))
        else:
            raise ValueError(f"cam.segment.motion = {name!r}: this route cannot compute it")
        start, base = start + span, base + rise
    return laws


def polynomials(segments):
    """Return polynomials, (start, powers) each, from their start angles on. The last one continues through the end of the turn."""
    laws = [(start, Piece(start, powers)) for start, powers in segments]
    if laws[0][0] > 0:
        start, last = laws[-1]
        laws.insert(0, (mpf(0), Piece(start - 2 * mp.pi, last.powers)))
    return laws


# Largest mismatch between two polynomials, relative to their terms, that counts as rounding of typed numbers (docs/model-file.md).
TYPED = mpf(10) ** -9


def joined(segments):
    """Return polynomials, (start, powers) each, without the mismatch that typing left between them in the lift and three derivatives.

    The periodic Bernoulli function B_{n+1}((angle - joint)/turn) turn^n/(n+1)! jumps only in its n-th derivative, only at the joint,
    by -1. Its next derivative is 1/turn all round. So the correction is the sum of these functions, each times the jump that is to be
    removed. A constant is added to all of it so that the first lift stays where it is.
    """
    turn = 2 * mp.pi

    def derivatives(powers, x):
        """Yield the lift and its derivatives up to the fourth, each with the sum of its terms' sizes."""
        for n in range(5):
            terms = [mp.ff(k, n) * power * x ** (k - n) for k, power in enumerate(powers) if k >= n]
            yield mp.fsum(terms), mp.fsum(terms, absolute=True)

    joints = []
    for (start, powers), (after, others) in zip(segments, segments[1:] + [(segments[0][0] + turn, segments[0][1])]):
        sides = zip(derivatives(powers, after - start), derivatives(others, mpf(0)))
        jumps = [(right - left, max(size, other)) for (left, size), (right, other) in sides][:4]
        joints.append((after, [jump if abs(jump) <= TYPED * size else mpf(0) for jump, size in jumps]))
    first = segments[0][0]
    added = [mp.fsum(jump * turn ** (n - k) / mp.factorial(n + 1 - k) * mp.bernpoly(n + 1 - k, (first - joint) / turn % 1)
                     for joint, jumps in [(first, joints[-1][1]), *joints[:-1]] for n, jump in enumerate(jumps) if n + 1 >= k)
             for k in range(5)]
    added[0] = mpf(0)
    found = []
    for (start, powers), (after, jumps) in zip(segments, joints):
        taylor = [derivative / mp.factorial(k) for k, derivative in enumerate(added)]
        found.append((start, [mp.fsum(both) for both in zip_longest(powers, taylor, fillvalue=mpf(0))]))
        added = [value - jump for (value, _), jump in zip(derivatives(taylor, after - start), [*jumps, mpf(0)])]
    return found


class Sum:
    """Sum of pieces."""

    def __init__(self, pieces):
        self.pieces = pieces

    def lift(self, angle, library=mp):
        return tuple(map(sum, zip(*(piece.lift(angle, library) for piece in self.pieces))))

    def rounded(self):
        return Sum([piece.rounded() for piece in self.pieces])


def cosines(offset, waves):
    """Return offset + sum a_k cos(k angle + phase_k), k from 1. Each wave is (a_k, phase_k)."""
    each = [Piece(mpf(0), [], (size, mpf(k), phase + mp.pi / 2)) for k, (size, phase) in enumerate(waves, 1)]
    return [(mpf(0), Sum([Piece(mpf(0), [offset]), *each]))]


def rectified(offset, amplitude):
    """Return offset + amplitude |sin angle|."""
    return [(start, Piece(start, [offset], (amplitude, mpf(1), mpf(0)))) for start in (mpf(0), mp.pi)]


def rounded(laws, corners, half):
    """Return laws whose corners are rounded. From `half` before a corner to `half` after it runs the quintic with c, c', c'' of both
    laws at the ends."""
    turn = 2 * mp.pi
    found = [(start + half if start in corners else start, law) for start, law in laws]
    for corner in corners:
        index = [start for start, _ in laws].index(corner)
        end = corner if index else turn
        left, right = laws[index - 1][1].lift(end - half), laws[index][1].lift(corner + half)
        # Each derivative of sum a_k x^k at -half and at half.
        system = mp.matrix(6, 6)
        for row, (x, order) in enumerate((x, order) for x in (-half, half) for order in range(3)):
            for k in range(order, 6):
                system[row, k] = mp.ff(k, order) * x ** (k - order)
        powers = list(mp.lu_solve(system, mp.matrix([*left, *right])))
        found.append((end - half, Piece(end, powers)))
        if not index:
            found.append((corner, Piece(corner, powers)))
    return sorted(found, key=lambda place: place[0])
