"""Orbits by brute force: dense scans, Newton's method in 60 digits, and flights that are checked closely."""

import math
from decimal import Decimal, getcontext

import numpy as np
from mpmath import mp, mpf

from cams import TURN, exact

getcontext().prec = 75
# Step of a difference, small enough that its error is below 40 digits; and size that counts as 0 beside a number of size 1.
STEP, ZERO = mpf(10) ** -22, mpf(10) ** -40
# Largest error of a gap in doubles, relative to the size of the lift.
ROUNDING = 1e-13


class Follower:
    """Follower with m q'' + b q' + k (q - rest) = -m g."""

    def __init__(self, mass, damping, stiffness, gravity, rest_position, restitution):
        m, b, k, g, rest = map(exact, (mass, damping, stiffness, gravity, rest_position))
        self.damping, self.spring, self.push = b / m, k / m, k * rest / m - g
        self.restitution = exact(restitution)
        self.rate = float(self.damping) + math.sqrt(float(self.spring))

    def flow(self, times):
        """Return (a, b, e, c, d, f): after a time q = a q0 + b v0 + e, v = c q0 + d v0 + f. Doubles in arrays, or one number of 60
        digits.

        The Taylor series of a small part of the time is squared until it covers the whole time.
        """
        exactly = isinstance(times, mpf)
        longest = float(abs(times)) if exactly else float(np.max(np.abs(times)))
        # A power of two, which rounds nothing.
        rate = 2.0 ** math.ceil(math.log2(max(self.rate, 1.0 / longest)))
        parts, terms, number = (14, 16, decimal) if exactly else (1, 20, float)
        halvings = parts + max(0, math.ceil(math.log2(rate * longest)))
        # The equation of (q, v/rate) in the time times the rate, pushed by 1: q' = v, v' = 1 - spring q - damping v.
        spring, damping = number(self.spring / rate**2), number(self.damping / rate)
        t = number(times * rate / 2**halvings) if exactly else times * (rate / 2.0**halvings)
        zero, one = t * 0, t * 0 + 1
        # A^n t^n/n! of (1, 0) and (0, 1), and A^(n-1) t^n/n! of the push.
        columns, sums = [(one, zero), (zero, one), (zero, t)], [[one, zero], [zero, one], [zero, t]]
        for n in range(1, terms):
            columns = [(t * y / (n + i), t * (-spring * x - damping * y) / (n + i)) for i, (x, y) in zip((0, 0, 1), columns)]
            sums = [[x + dx, y + dy] for (x, y), (dx, dy) in zip(sums, columns)]
        (a, c), (b, d), (e, f) = sums
        for _ in range(halvings):
            e, f = e + a * e + b * f, f + c * e + d * f
            cross = b * c
            a, b, c, d = a * a + cross, b * (a + d), c * (a + d), d * d + cross
        if exactly:
            a, b, c, d, e, f = (mpf(str(x)) for x in (a, b, c, d, e, f))
        push = self.push if exactly else float(self.push)
        return a, b / rate, e * (push / rate**2), c * rate, d, f * (push / rate)


def decimal(number):
    """Return a number as a Decimal with five digits more than mpmath carries. Decimals are faster."""
    return Decimal(mp.nstr(number, mp.dps + 5))


class Machine:
    """Cam and follower at a speed. Flights of one impact last `turns` turns."""

    def __init__(self, cam, follower, rpm, turns=1):
        self.cam, self.follower, self.rpm, self.turns = cam, follower, rpm, turns
        self.revolution = 60 / (rpm if isinstance(rpm, mpf) else exact(rpm))
        self.omega = TURN / self.revolution
        self.period = turns * self.revolution
        self.r = follower.restitution
        self.whole = follower.flow(self.period)
        numbers = (self.whole, self.r, self.omega)
        self.searched = {}
        self._numbers = (tuple(map(float, self.whole)), float(self.r), float(self.omega)), numbers

    def law(self, lift, slope):
        """Return a number that is 0 if an impact at this lift and slope throws the follower so that it returns.

        The flight gives (1 - a) c - e - b u = 0, and the impact gives u (1 + r d) = (1 + r) omega c' - r (c c0 + f). Then u is
        eliminated.
        """
        (a, b, e, c, d, f), r, omega = self._numbers[isinstance(lift, mpf)]
        back, thrown = (1 - a) * lift - e, (1 + r) * omega * slope - r * (c * lift + f)
        return back * (1 + r * d) - b * thrown

    def velocities(self, lift, slope):
        """Return the velocities before and after the impact, from the better conditioned of the two equations."""
        a, b, e, c, d, f = self.whole
        r, scale = self.r, self.follower.rate + 1 / self.period
        back, thrown = (1 - a) * lift - e, (1 + r) * self.omega * slope - r * (c * lift + f)
        after = back / b if abs(b) * scale > abs(1 + r * d) else thrown / (1 + r * d)
        return c * lift + d * after + f, after

    def scan(self, count=4000):
        """Return brackets in doubles, (law, low, high), of the angles at which the law changes its sign, also between close roots."""
        found = []
        near = 10.0 ** np.linspace(-11, -2, 28)
        for start, end, (_, law) in zip(self.cam.seams, self.cam.seams[1:], self.cam.pieces):
            width = end - start
            if not width > 0:
                continue
            inner = np.linspace(start, end, max(8, int(count * width / math.tau)) + 1)
            grid = np.unique(np.concatenate([inner, start + near[near < width / 2], end - near[near < width / 2]]))
            grid = grid[(grid >= start) & (grid <= end)]
            values = self.law(*law(grid))
            found += [(law, grid[i], grid[i + 1]) for i in np.nonzero(np.signbit(values[1:]) != np.signbit(values[:-1]))[0]]
            # Two roots may lie between two points of the grid, so each minimum of |law| is examined closely.
            size = np.abs(values)
            is_least = (size[1:-1] < size[:-2]) & (size[1:-1] < size[2:]) & (size[1:-1] < 1e-3 * self._size(grid))
            least = np.nonzero(is_least)[0] + 1
            for i in least:
                if np.signbit(values[i - 1]) == np.signbit(values[i]) == np.signbit(values[i + 1]):
                    found += self._touching(law, grid[i - 1], grid[i], grid[i + 1])
        return found

    def _size(self, grid):
        """Return the largest size of the terms of the law on a grid."""
        _, slope = self.cam.at(grid)
        a, b, e, c, d, f = map(abs, map(float, self.whole))
        r, omega = float(self.r), float(self.omega)
        return (self.cam.size * (1 + a) + e) * (1 + r * d) + b * (2 * omega * np.abs(slope).max() + r * (c * self.cam.size + f))

    def _touching(self, law, low, middle, high):
        sign = np.sign(self.law(*law(np.array([middle]))))[0]
        for _ in range(60):
            grid = np.linspace(low, high, 9)
            values = sign * self.law(*law(grid))
            i = int(np.argmin(values))
            if values[i] < 0:
                return [(law, low, grid[i]), (law, grid[i], high)]
            if high - low < 1e-9:
                return []
            low, high = grid[max(i - 1, 0)], grid[min(i + 1, 8)]
        return []

    def one_impact(self, count=4000):
        """Return (orbits, doubtful angles) of one impact."""
        orbits, doubtful = [], []
        for law, low, high in self.scan(count):
            below = np.signbit(self.law(*law(np.array([low]))))[0]
            for _ in range(60):
                middle = 0.5 * (low + high)
                if np.signbit(self.law(*law(np.array([middle]))))[0] == below:
                    low = middle
                else:
                    high = middle
            orbit = self._one(law, low)
            if orbit == "doubtful":
                doubtful.append([low])
            elif orbit:
                orbits.append(orbit)
        return orbits, doubtful

    def _one(self, law, guess, near=None):
        """Return the orbit of the root of a piece's law next to a guess; None if there is none, "doubtful" if that is uncertain."""
        start, end = next((a, b) for a, b, piece in zip(self.cam.exact, self.cam.exact[1:], self.cam.pieces) if piece[1] is law)
        angle, slope = newton(lambda angle: self.law(*law(angle)), mpf(guess) if near is None else near)
        if angle is None:
            return "doubtful"
        if min(abs(angle - start), abs(angle - end)) < 1e-13:
            return "doubtful"
        if not start < angle < end:
            # Outside its piece the root does not count. The law of the other piece is searched by itself.
            return None if near is None else "doubtful"
        lift, rise = law(angle)
        before, after = self.velocities(lift, rise)
        orbit = self.judged([(angle, before - self.omega * rise, after - self.omega * rise)], [self.period])
        if isinstance(orbit, dict):
            terms = abs(lift) + abs(self.whole[2]) + abs(self.whole[1] * self.omega * rise) + abs(self.whole[1] * before)
            orbit["blur"] = float(terms / abs(slope)) * 1e-15 if slope else 1.0
        return orbit

    def pair(self, first, turned):
        """Return two residuals, which are 0 if the second impact comes `turned` after the first, and the numbers they are made of.

        The first flight leaves so that it ends on the cam, and the second leaves by the law of impact. The residuals are the end of
        the second flight, and the law at the first impact. Everything, u included, is multiplied by b of the first flight.
        """
        exactly = isinstance(first, mpf)
        number = mpf if exactly else float
        omega, r = number(self.omega), number(self.r)
        whole = TURN if exactly else math.tau
        at = self.cam.one if exactly else self.cam.at
        (c1, s1), (c2, s2) = at(first), at(first + turned)
        a, b, e, c, d, f = self.follower.flow(turned / omega)
        u1 = c2 - a * c1 - e
        v2 = b * (c * c1 + f) + d * u1
        u2 = (1 + r) * omega * s2 * b - r * v2
        a2, b2, e2, c_2, d2, f2 = self.follower.flow((whole - turned) / omega)
        ends, v1 = b * (a2 * c2 + e2 - c1) + b2 * u2, b * (c_2 * c2 + f2) + d2 * u2
        return ends, u1 - (1 + r) * omega * s1 * b + r * v1, (b, u1, v2, u2, v1, s1, s2)

    def two_impacts(self, count=160):
        """Return (orbits, doubtful pairs of angles) of two impacts, as far as a grid of `count` angles shows them."""
        first, turned = np.linspace(0, math.tau, 2 * count), np.concatenate([[1e-4, 1e-3, 0.004, 0.01], np.linspace(0.02, math.pi + 0.02, count)])
        # One flow for each time serves every angle.
        ends, law, _ = self.pair(first[:, None], turned[None, :])

        def crossed(values):
            corners = [np.signbit(values[i:len(values) - 1 + i, j:values.shape[1] - 1 + j]) for i in (0, 1) for j in (0, 1)]
            total = sum(corner.astype(int) for corner in corners)
            return (total > 0) & (total < 4)

        i, j = np.nonzero(crossed(ends) & crossed(law))
        x, y = 0.5 * (first[i] + first[i + 1]), 0.5 * (turned[j] + turned[j + 1])
        if not len(x):
            return [], []
        for _ in range(12):
            h = 1e-7
            at, by_x, by_y = (self.pair(*place)[:2] for place in ((x, y), (x + h, y), (x, y + h)))
            m = [[(by[k] - at[k]) / h for by in (by_x, by_y)] for k in (0, 1)]
            determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0]
            with np.errstate(all="ignore"):
                dx, dy = (at[0] * m[1][1] - at[1] * m[0][1]) / determinant, (m[0][0] * at[1] - m[1][0] * at[0]) / determinant
            good = np.isfinite(dx) & np.isfinite(dy) & (y - dy > 1e-5) & (y - dy < math.pi + 0.1)
            dx, dy = dx[good], dy[good]
            x, y = x[good] - np.clip(dx, -0.05, 0.05), y[good] - np.clip(dy, -0.05, 0.05)
            if not len(x):
                return [], []
        # Keep those that have converged and arrive from above.
        b, u1, v2, u2, v1, s1, s2 = self.pair(x, y)[2]
        with np.errstate(all="ignore"):
            above = (v1 / b - float(self.omega) * s1 < 1e-6) & (v2 / b - float(self.omega) * s2 < 1e-6)
        good = (np.abs(dx) + np.abs(dy) < 1e-6) & above
        x, y = x[good], y[good]
        orbits, doubtful, seen = [], [], []
        for first, turned in sorted(zip(np.mod(x, math.tau), y)):
            if any(abs(first - a) < 1e-6 and abs(turned - b) < 1e-6 for a, b in seen):
                continue
            seen.append((first, turned))
            orbit = self._two(mpf(first), mpf(turned))
            if orbit == "doubtful":
                doubtful.append([first, (first + turned) % math.tau])
            elif orbit and not any(same(angles_of(orbit), angles_of(other), 1e-9) for other in orbits):
                orbits.append(orbit)
        return orbits, doubtful

    def confirmed(self, angles):
        """Return the orbit next to given angles; None if there is none, "doubtful" if that is uncertain."""
        if len(angles) == 2:
            found = self._two(angles[0], (angles[1] - angles[0]) % TURN)
        else:
            found = self._one(self.cam.pieces[self.cam.piece(angles[0])][1], float(angles[0]), angles[0] % TURN)
        if isinstance(found, dict) and not same(angles_of(found), angles, 1e-6):
            return None
        return found

    def _two(self, first, turned):
        for _ in range(40):
            at = self.pair(first, turned)
            by = self.pair(first + STEP, turned), self.pair(first, turned + STEP)
            m = [[(one[k] - at[k]) / STEP for one in by] for k in (0, 1)]
            determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0]
            if not determinant:
                return None
            dx, dy = (at[0] * m[1][1] - at[1] * m[0][1]) / determinant, (m[0][0] * at[1] - m[1][0] * at[0]) / determinant
            if not (abs(dx) < 1 and abs(dy) < 1):
                return None
            first, turned = first - dx, turned - dy
            if abs(dx) + abs(dy) < mpf(10) ** -42:
                break
        else:
            return None
        first = first % TURN
        if not 0 < turned < TURN:
            return None
        b, u1, v2, u2, v1, s1, s2 = self.pair(first, turned)[2]
        if abs(b) * (self.follower.rate + 1 / self.period) < 1e-6:
            # The flight lasts half a swing, or hardly any time, so that its end does not fix its velocity at the start.
            return "doubtful"
        omega, second = self.omega, (first + turned) % TURN
        if any(min(abs(angle - seam) for seam in self.cam.exact) < 1e-13 for angle in (first, second)):
            return "doubtful"
        impacts = [(first, v1 / b - omega * s1, u1 / b - omega * s1), (second, v2 / b - omega * s2, u2 / b - omega * s2)]
        orbit = self.judged(impacts, [turned / omega, (TURN - turned) / omega])
        if isinstance(orbit, dict):
            size = max(abs(m[0][0]) + abs(m[0][1]), abs(m[1][0]) + abs(m[1][1]))
            orbit["blur"] = float(1e-15 * (self.cam.size * abs(b) / abs(determinant) * size))
        return orbit

    def judged(self, impacts, times):
        """Return the orbit of impacts (angle, relative velocity before and after); None if it is no orbit, "doubtful" if that is
        uncertain."""
        fastest = float(self.omega) * self.cam.stroke
        if any(before > 0 or after < 0 for _, before, after in impacts):
            return None
        if self.r == 0 or any(-before < 1e-9 * fastest for _, before, _ in impacts):
            return "doubtful"
        standing = [self.clear(angle, after, time) for (angle, _, after), time in zip(impacts, times)]
        if False in standing:
            return None
        if None in standing:
            return "doubtful"
        return {"impacts": impacts, "times": times, "gap": min(standing)}

    def clear(self, angle, after, time):
        """Return the least gap of a flight, checked closely; False if it is below the cam, None if rounding does not decide."""
        cam, omega, scale = self.cam, float(self.omega), self.cam.stroke
        start, slope = cam.one(angle)
        velocity = after + self.omega * slope
        turned = float(self.omega * time)
        swings = int(self.follower.rate * float(time))
        ends = 10.0 ** np.linspace(-10, -1.5, 120)
        parts = [np.linspace(0, 1, 1500 + 40 * min(swings, 400))[1:-1], ends, 1 - ends]
        seams = np.concatenate([cam.seams[:-1] + math.tau * k for k in range(-1, 2 + math.ceil(turned / math.tau))])
        inside = np.concatenate([seams[:-1, None] + (seams[1:] - seams[:-1])[:, None] * np.linspace(0, 1, 12)[None, :-1]]).ravel()
        parts.append((inside - float(angle)) / turned)
        parts = np.unique(np.concatenate(parts))
        parts = parts[(parts > 1e-10) & (parts < 1 - 1e-10)]
        a, b, e, *_ = self.follower.flow(parts * float(time))
        gap = a * float(start) + b * float(velocity) + e - cam.at(float(angle) + turned * parts)[0]
        if gap.min() < -1e-8 * scale:
            return False
        least = mpf("inf")
        inner = np.nonzero((gap[1:-1] <= gap[:-2]) & (gap[1:-1] <= gap[2:]) & (gap[1:-1] < 0.05 * scale))[0] + 1
        exactly = lambda part: self.gap(angle, start, velocity, time, part)
        for i in inner:
            lowest = self.lowest(angle, start, velocity, time, parts[i - 1], parts[i + 1])
            if lowest < 1e-5 * scale:
                lowest, is_between = self._closest(exactly, parts[i - 1], parts[i + 1], turned, angle)
                if not is_between and lowest > 0:
                    # The gap rises or falls all along; only rounding showed a minimum.
                    continue
            if lowest < -ROUNDING * cam.size:
                return False
            if lowest < ROUNDING * cam.size:
                return None
            least = min(least, lowest)
        # The gap is positive next to both ends, unless the flight has been below the cam.
        for part in (mpf(10) ** -10, 1 - mpf(10) ** -10):
            if exactly(part) < 0:
                return False
        return min(least, mpf(scale))

    def gap(self, angle, start, velocity, time, part):
        a, b, e, *_ = self.follower.flow(time * part)
        return a * start + b * velocity + e - self.cam.one(angle + self.omega * time * part)[0]

    def lowest(self, angle, start, velocity, time, low, high):
        turned = float(self.omega * time)
        for _ in range(12):
            parts = np.linspace(low, high, 33)
            a, b, e, *_ = self.follower.flow(parts * float(time))
            gap = a * float(start) + b * float(velocity) + e - self.cam.at(float(angle) + turned * parts)[0]
            i = int(np.argmin(gap))
            low, high = parts[max(i - 1, 0)], parts[min(i + 1, 32)]
        return float(gap[i])

    def _closest(self, gap, low, high, turned, angle):
        """Return the least gap between two parts of a flight, by golden section between the seams, and True if it is not at an end."""
        low, high, seams = mpf(float(low)), mpf(float(high)), []
        for k in range(-1, self.turns + 2):
            seams += [(seam + k * TURN - angle) / mpf(turned) for seam in self.cam.exact]
        cuts = [low, *sorted(seam for seam in seams if low < seam < high), high]
        golden, found = (mp.sqrt(5) - 1) / 2, [(gap(part), part) for part in cuts]
        for left, right in zip(cuts, cuts[1:]):
            x, y = right - golden * (right - left), left + golden * (right - left)
            gx, gy = gap(x), gap(y)
            for _ in range(40):
                if gx < gy:
                    right, y, gy = y, x, gx
                    x = right - golden * (right - left)
                    gx = gap(x)
                else:
                    left, x, gx = x, y, gy
                    y = left + golden * (right - left)
                    gy = gap(y)
            found += [(gx, x), (gy, y)]
        least, part = min(found)
        return least, min(part - low, high - part) > 1e-6 * (high - low)

    def kind(self, orbit):
        """Return stable, saddle, flip or unstable, by differences of where each flight ends; None if a sign is too close to decide."""
        whole = mp.eye(2)
        for (angle, _, after), time, (_, before, _) in zip(orbit["impacts"], orbit["times"], orbit["impacts"][1:] + orbit["impacts"][:1]):
            ends = []
            for change in ((0, 0), (STEP, 0), (0, STEP)):
                begin, leaves = angle + change[0], after + change[1]
                lift, slope = self.cam.one(begin)
                moment = time
                for _ in range(6):
                    a, b, e, c, d, f = self.follower.flow(moment)
                    velocity = leaves + self.omega * slope
                    there, steep = self.cam.one(begin + self.omega * moment)
                    place, arrives = a * lift + b * velocity + e, c * lift + d * velocity + f
                    moment = moment - (place - there) / (arrives - self.omega * steep)
                ends.append((begin + self.omega * moment, -self.r * (arrives - self.omega * steep)))
            step = mp.matrix([[(ends[k][row] - ends[0][row]) / STEP for k in (1, 2)] for row in (0, 1)])
            whole = step * whole
        trace, determinant = whole[0, 0] + whole[1, 1], whole[0, 0] * whole[1, 1] - whole[0, 1] * whole[1, 0]
        signs = [1 - trace + determinant, 1 + trace + determinant, 1 - determinant]
        if min(map(abs, signs)) < 1e-9 * (1 + abs(trace)):
            return None
        return "saddle" if signs[0] < 0 else "flip" if signs[1] < 0 else "stable" if signs[2] > 0 else "unstable"

    def at_speed(self, rpm):
        return Machine(self.cam, self.follower, rpm, self.turns)


def newton(function, x, change=STEP):
    """Return (root, derivative) near x in 40 digits or more. The root is None if Newton's method does not converge."""
    slope = mpf(0)
    for _ in range(80):
        value = function(x)
        slope = (function(x + change) - value) / change
        if not slope:
            return None, slope
        step = value / slope
        if not abs(step) < 1:
            return None, slope
        x -= step
        if abs(step) < ZERO * (1 + abs(x)):
            return x, slope
    return None, slope


def angles_of(orbit):
    return [angle for angle, *_ in orbit["impacts"]]


def apart(one, other):
    off = abs(mpf(one) - mpf(other)) % TURN
    return min(off, TURN - off)


def same(one, other, within):
    """Return True if two lists of angles are the same impacts, whichever comes first."""
    turned = [other[k:] + other[:k] for k in range(len(other))]
    return len(one) == len(other) and any(all(apart(a, b) < within for a, b in zip(one, turn)) for turn in turned)


# Corner impacts: the law at a corner as a function of the period.


def corner_roots(cam, follower, low, high, turns):
    """Yield (law as a function of the period, bracket of a sign change in doubles, angle, order, side) for each corner between two speeds."""
    times = np.linspace(60 * turns / high, 60 * turns / low, 4000)
    flows = follower.flow(times)
    for angle, order in cam.corners():
        lift = cam.one(angle)[0]
        for side in (-1, 1) if order == 1 else (1,):
            slope = cam.one(angle, side)[1]

            def law(time, flow=None, lift=lift, slope=slope):
                (a, b, e, c, d, f), number = flow or follower.flow(time), mpf if isinstance(time, mpf) else float
                r, omega = number(follower.restitution), number(TURN * turns) / time
                x, s = number(lift), number(slope)
                return ((1 - a) * x - e) * (1 + r * d) - b * ((1 + r) * omega * s - r * (c * x + f))

            values = law(times, flows)
            for i in np.nonzero(np.signbit(values[1:]) != np.signbit(values[:-1]))[0]:
                yield law, times[i:i + 2], angle, order, side


def corner_impact(cam, follower, turns, root):
    """Return (speed, angle, side, True if doubtful) at a root of the law at a corner; None if it is no orbit."""
    law, ends, angle, order, side = root
    time = bracketed(law, *map(mpf, map(float, ends)))
    if time is None:
        return None
    machine = Machine(cam, follower, 60 * turns / time, turns)
    before, after = machine.velocities(cam.one(angle)[0], cam.one(angle, side)[1])
    minus, plus = (machine.omega * cam.one(angle, one)[1] for one in (-1, 1))
    orbit = machine.judged([(angle, before - minus, after - plus)], [machine.period])
    return orbit and (float(60 * turns / time), float(angle), side if order == 1 else 0, orbit == "doubtful")


def corner_impacts(cam, follower, low, high, turns=1):
    """Return the corner impacts of one impact between two speeds."""
    found = (corner_impact(cam, follower, turns, root) for root in corner_roots(cam, follower, low, high, turns))
    return [place for place in found if place and low < place[0] < high]


def bracketed(function, low, high):
    """Return a root between two signs in 40 digits, by bisection and then Newton's method; None if there is none."""
    below = function(low) < 0
    for _ in range(20):
        middle = (low + high) / 2
        if (function(middle) < 0) == below:
            low = middle
        else:
            high = middle
    return newton(function, low, low * STEP)[0]
