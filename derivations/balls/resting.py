"""Motions that rest on the cam, followed from the release of the follower until they rest again.

A follower on the cam is pressed against it while

    a(theta) = f(c) - 2 zeta omega c' - omega^2 c''

is below 0, and is released where a rises above 0. The motion after a release does not depend on what came before. So if every motion
after a release rests again, each motion that ever rests is periodic some time later.

A motion comes to rest by an infinite sequence of impacts. After an impact with a velocity u relative to the cam, let the gap of all
flights bend with -A <= g'' <= -a < 0. Then a flight rises by u^2/2a at most, takes 2u/a at most, and returns with sqrt(A/a) u at
most. The impact leaves a fraction r of this velocity. With q = r sqrt(A/a) < 1 the impacts end within

    2u/a (1 + q + q^2 + ...) = 2u/(a (1 - q)).
"""

from dataclasses import dataclass

from flint import arb

from .motion import Flight, Start, impact
from .numbers import Refused, Undecided, between, hull

# Number of parts of a piece of the cam at first, and how often a part is halved while the sign of a in it is not decided.
PARTS = 16
HALVINGS = 40
# Number of parts of the time until rest, in each of which the bend of the gap is enclosed.
LOOKS = 4
# Added to a velocity that may be 0, m/s, so that bounds by it are above 0.
SLOWEST = 2.0**-64
# Impacts after which a motion is given up, and most turns of the cam during a flight.
MOST_IMPACTS = 2000
MOST_TURNS = 30


@dataclass(frozen=True)
class Release:
    """Release of the follower: the angle, rad, the law of the cam from there on, and the angle up to which a stays above 0. `jumps`
    is True if the release is at the start of a piece, where a may jump."""

    angle: arb
    law: object
    end: arb
    jumps: bool


@dataclass(frozen=True)
class Hop:
    """Motion after a release: after `impacts` impacts an infinite sequence follows, which ends at the angle `rests`, rad, at the
    latest. The next release is `to`, `revolutions` revolutions on."""

    impacts: int
    rests: arb
    to: int
    revolutions: int


class Resting:
    """Motions of a machine at a speed, rad/s, that start at a release of the follower."""

    def __init__(self, machine, speed):
        self.machine, self.speed, self.turn = machine, speed, machine.cam.turn
        cam = machine.cam
        if any(corner.smooth < 2 for corner in cam.corners):
            raise Refused("the velocity of the cam jumps")
        if not machine.follower.restitution < 1:
            raise Refused("no motion comes to rest without a loss at impacts")
        ends = [*cam.starts[1:], cam.starts[0] + self.turn]
        # Stretches of a turn in which a has one sign: (start, end, law, sign).
        self.stretches = [one for piece in zip(cam.starts, ends, cam.laws) for one in self._signs(*piece)]
        before = [self.stretches[-1], *self.stretches]
        self.releases = [
            Release(start, law, end, any(start is one for one in cam.starts))
            for (*_, last), (start, end, law, sign) in zip(before, self.stretches)
            if last < 0 < sign
        ]

    def _pressure(self, law, angle):
        """Return (a, da/dtheta) over a ball of angles."""
        lift, slope, curvature, third = law.derivatives(angle)
        follower, speed = self.machine.follower, self.speed
        a = follower.acceleration(lift, speed * slope) - speed**2 * curvature
        return a, -follower.omega0_squared * slope - 2 * follower.zeta * speed * curvature - speed**2 * third

    def _signs(self, start, end, law):
        """Return the stretches of a piece of the cam in which a has one sign, in order. Neighbours of one sign are joined."""
        cuts = [start, *(start + (end - start) * part / PARTS for part in range(1, PARTS)), end]
        whole, parts = [], [(low, high, 0) for low, high in zip(cuts, cuts[1:])]
        while parts:
            low, high, halved = parts.pop(0)
            over, rate = self._pressure(law, between(low, high))
            ends = [self._pressure(law, angle)[0] for angle in (low, high)]
            signs = [1 if one > 0 else -1 if one < 0 else 0 for one in ends]
            # If a is monotone and has one sign at both ends, it has this sign on the whole stretch.
            is_monotone = rate > 0 or rate < 0
            if over > 0 or over < 0 or (is_monotone and signs[0] == signs[1] != 0):
                found = [(low, high, signs[0])]
            elif is_monotone and signs[0] * signs[1] < 0 and halved > 0:
                root = self._root(law, low, high, rate)
                found = [(low, root, signs[0]), (root, high, signs[1])]
            elif halved < HALVINGS:
                middle = (low + high) / 2
                parts[:0] = [(low, middle, halved + 1), (middle, high, halved + 1)]
                continue
            else:
                raise Undecided(f"whether the cam presses at {float(low):.6g} rad is not decided")
            for low, high, sign in found:
                if whole and whole[-1][-1] == sign:
                    low = whole.pop()[0]
                whole.append((low, high, sign))
        return [(low, high, law, sign) for low, high, sign in whole]

    def _root(self, law, low, high, rate):
        """Return the only zero of a in a stretch in which a is monotone, by Newton's method on balls."""
        angle = between(low, high)
        while True:
            middle = angle.mid()
            step = middle - self._pressure(law, middle)[0] / rate
            narrower = angle.intersection(step)
            if not narrower.rad() < angle.rad() * 0.75:
                return narrower
            angle, rate = narrower, self._pressure(law, narrower)[1]

    def hop(self, index):
        """Return the motion after a release; None if it is not proved to rest within MOST_IMPACTS impacts. Raise Refused if the balls
        are too wide to decide."""
        release = self.releases[index]
        start = Start(release.angle, arb(0), self.speed)
        flight = Flight(self.machine, start, release.law)
        horizon = MOST_TURNS * float(self.turn / self.speed)
        clear = self._lifted(flight, release)
        for count in range(1, MOST_IMPACTS + 1):
            start = impact(flight, flight.first_contact(horizon, clear=clear)).start
            rests = self._rests(start)
            if rests is not None:
                end, angle, to = rests
                turns = round(float((angle - self.releases[to].angle) / self.turn))
                return Hop(count, end - turns * self.turn, to, turns)
            flight, clear = Flight(self.machine, start), None
        return None

    def _lifted(self, flight, release):
        """Return a time up to which the follower is proved to be above the cam after a release, where g = g' = 0."""
        follower, speed = self.machine.follower, self.speed
        step = (release.end - release.angle) / speed
        for _ in range(HALVINGS):
            step /= 2
            time = between(0, step.upper())
            position, velocity = flight.state(time)
            _, _, curvature, third = release.law.derivatives(flight.angle(time))
            acceleration = follower.acceleration(position, velocity)
            if release.jumps:
                rises = acceleration - speed**2 * curvature
            else:
                # g'' = 0 as well, and g''' = q''' - omega^3 c''' with q''' = -2 zeta q'' - w0^2 v.
                rises = -2 * follower.zeta * acceleration - follower.omega0_squared * velocity - speed**3 * third
            if rises > 0:
                return step.lower()
        raise Undecided("the follower is not proved to leave the cam where it lets go")

    def _rests(self, start):
        """Return (latest angle at which the follower rests, angle of the next release, index of that release) after an impact. Return
        None if rest before that release is not proved."""
        follower, cam, speed, velocity = self.machine.follower, self.machine.cam, self.speed, start.velocity.abs_upper() + SLOWEST
        place = self._pressed(start.angle)
        a = -self._contact(start.angle)
        if place is None or not a > 0:
            return None
        to, release = place
        # Bounds that are assumed of the flights and proved below: twice the values for a constant acceleration a.
        lasts, height, relative = (2 * bound for bound in (2 * velocity / (a * (1 - follower.restitution)), velocity**2 / (2 * a), velocity))
        end = (start.angle + speed * lasts).upper()
        if not end < release:
            return None
        off = between(-follower.omega0_squared * height, 0) + 2 * follower.zeta * arb(0, relative.upper())
        ends = [start.angle + (end - start.angle) * look / LOOKS for look in range(LOOKS + 1)]
        bend = -hull(self._contact(between(*part)) + off for part in zip(ends, ends[1:]))
        least, most = arb(bend.lower()), arb(bend.upper())
        if not least > 0:
            return None
        comes_back = (most / least).sqrt()
        q = follower.restitution * comes_back
        holds = q < 1 and velocity**2 / (2 * least) < height and velocity * comes_back < relative
        return (end, release, to) if holds and 2 * velocity / (least * (1 - q)) < lasts else None

    def _contact(self, angle):
        """Return a over a ball of angles, across the pieces of the cam in it."""
        lift, slope, curvature, _ = self.machine.cam.derivatives(angle)
        return self.machine.follower.acceleration(lift, self.speed * slope) - self.speed**2 * curvature

    def _pressed(self, angle):
        """Return (index of a release, its angle) after an angle from which on the cam presses until that release; None if that is not
        proved."""
        turns = int(float(angle) // float(self.turn))
        for to, release in enumerate(self.releases):
            last = next(index for index, (start, *_) in enumerate(self.stretches) if start is release.angle)
            # Go back over the stretches that press. The first stretch of a turn comes after the last one of the turn before.
            first = last
            while self.stretches[first - 1][-1] < 0:
                first -= 1
            begins = self.stretches[first][0] - (self.turn if first < 0 else 0)
            for shift in ((turns + more) * self.turn for more in (-1, 0, 1)):
                if begins + shift < angle and angle < release.angle + shift:
                    return to, release.angle + shift
        return None
