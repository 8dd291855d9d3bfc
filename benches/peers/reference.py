"""The runs that every peer is measured against: events of the closed form at fifty digits, computed anew each time.

The reference shares no code with the peers. A gap is scanned on each circle of the cam in steps of a degree or less. A minimum
between two points is found first, so that no contact is missed there. A change of sign is then refined by bisection and the secant
rule until nothing changes. The numbers of the model are the doubles that every program reads.
"""

import math
from dataclasses import dataclass

import mpmath as mp

DIGITS = 50
# Largest step of the scan, rad.
STEP = math.radians(1.0)


@dataclass
class Circle:
    """Circle seen from the cam's axis: c = kappa cos phi + sqrt(rho^2 - kappa^2 sin^2 phi), phi = theta - direction."""

    start: mp.mpf
    distance: mp.mpf
    direction: mp.mpf
    radius: mp.mpf

    def law(self, theta):
        """Return c and dc/dtheta."""
        sin, cos = mp.sin(theta - self.direction), mp.cos(theta - self.direction)
        kappa = self.distance
        root = mp.sqrt(self.radius**2 - (kappa * sin) ** 2)
        return kappa * cos + root, -kappa * sin - kappa**2 * sin * cos / root


class Reference:
    """The paper's system at a speed, at DIGITS digits."""

    def __init__(self, model, rpm):
        mp.mp.dps = DIGITS
        follower, cam = model["follower"], model["cam"]
        assert follower["damping"] == 0.0 and cam["law"] == "arcs", "the reference knows the paper's system only"
        number = {name: mp.mpf(value) for name, value in {**follower, **cam}.items() if not isinstance(value, str)}
        self.omega = mp.mpf(rpm) * 2 * mp.pi / 60
        self.omega0_squared = number["stiffness"] / number["mass"]
        self.omega0 = mp.sqrt(self.omega0_squared)
        self.equilibrium = number["rest_position"] - number["gravity"] / self.omega0_squared
        self.restitution = number["restitution"]
        self.circles = self.outline(number)

    @staticmethod
    def outline(number):
        base, flank, nose = (number[f"{name}_radius"] for name in ("base", "flank", "nose"))
        rise, top = (mp.radians(number[name]) for name in ("flank_start_deg", "nose_end_deg"))
        # Tangency: the flank's centre is opposite R, the nose's is on the ray of Q, and |O1 O2| = rho1 - rho2.
        out, apart, span = flank - base, flank - nose, top - rise
        reach = mp.sqrt(apart**2 - (out * mp.sin(span)) ** 2) - out * mp.cos(span)
        # P lies on the line through both centres; in axes with R at angle 0 the flank's centre is (-out, 0).
        stretch = flank / apart
        meeting = rise + mp.atan2(stretch * reach * mp.sin(span), stretch * (reach * mp.cos(span) + out) - out)
        turn, zero = 2 * mp.pi, mp.mpf(0)
        return [
            Circle(zero, zero, zero, base),
            Circle(rise, out, rise + mp.pi, flank),
            Circle(meeting, reach, top, nose),
            Circle(top, zero, zero, reach + nose),
            Circle(turn - top, reach, turn - top, nose),
            Circle(turn - meeting, out, turn - rise - mp.pi, flank),
            Circle(turn - rise, zero, zero, base),
        ]

    @property
    def corner(self):
        """Angle of P, where the flank meets the nose."""
        return self.circles[2].start

    def circle_at(self, theta):
        return [circle for circle in self.circles if circle.start <= theta][-1]

    def flight(self, state, t):
        offset, sin, cos = state[0] - self.equilibrium, mp.sin(self.omega0 * t), mp.cos(self.omega0 * t)
        position = self.equilibrium + offset * cos + state[1] / self.omega0 * sin
        return position, state[1] * cos - self.omega0 * offset * sin

    def first_contact(self, theta, state, circle, span):
        """Return the time of the first contact with `circle` within `span`, s, or None."""

        def gap(t):
            (q, v), (lift, slope) = self.flight(state, t), circle.law(theta + self.omega * t)
            return q - lift, v - self.omega * slope

        count = max(2, math.ceil(span * self.omega / STEP))
        low, at_low = mp.mpf(0), gap(mp.mpf(0))
        for k in range(1, count + 1):
            high = span * k / count
            at_high = gap(high)
            if at_low[1] < 0 < at_high[1] and at_high[0] > 0:
                lowest = refine(lambda t: gap(t)[1], low, high)
                if gap(lowest)[0] < 0:
                    return refine(lambda t: gap(t)[0], low, lowest)
            # At the start of a flight from the cam the gap is 0 and grows. It closes only after its maximum.
            if at_high[0] < 0:
                if low == 0 and at_low[1] > 0:
                    low = refine(lambda t: gap(t)[1], low, high)
                return refine(lambda t: gap(t)[0], low, high)
            low, at_low = high, at_high
        return None

    def run(self, theta, state, turn, most=10**9):
        """Return impacts as (turned, cam angle, v-, v+) until the cam has turned by `turn` or `most` impacts have happened."""
        theta, state, turned, impacts = mp.mpf(theta), tuple(map(mp.mpf, state)), mp.mpf(0), []
        index = self.circles.index(self.circle_at(theta))
        while turned < turn and len(impacts) < most:
            ends = self.circles[index + 1].start if index + 1 < len(self.circles) else 2 * mp.pi
            span = min(ends - theta, turn - turned) / self.omega
            t = self.first_contact(theta, state, self.circles[index], span)
            flown = span if t is None else t
            state = self.flight(state, flown)
            turned, theta = turned + self.omega * flown, theta + self.omega * flown
            if t is not None:
                lift, slope = self.circles[index].law(theta)
                velocity = self.omega * slope
                after = velocity + self.restitution * (velocity - state[1])
                impacts.append((turned, theta, state[1], after))
                state = lift, after
            elif turned < turn:
                index = (index + 1) % len(self.circles)
                theta = self.circles[index].start
        return impacts

    def graze(self, touch, back, offset):
        """Return the start, `back` rad before, of a flight that is `offset` above the cam at `touch` and has the cam's velocity there."""
        touch = mp.mpf(touch)
        lift, slope = self.circle_at(touch).law(touch)
        theta = touch - mp.mpf(back)
        return theta, *self.flight((lift + mp.mpf(offset), self.omega * slope), -mp.mpf(back) / self.omega)


def refine(function, low, high):
    """Return the root between two signs: bisection and the secant rule in turn, until nothing changes."""
    at_low, at_high = function(low), function(high)
    tolerance = mp.mpf(10) ** (-DIGITS + 8) * high
    while high - low > tolerance:
        for middle in (high - at_high * (high - low) / (at_high - at_low), (low + high) / 2):
            # A step to either side, so that both ends close in.
            for probe in (middle, middle + tolerance / 4, middle - tolerance / 4):
                if not low < probe < high:
                    continue
                value = function(probe)
                if (value < 0) == (at_low < 0):
                    low, at_low = probe, value
                else:
                    high, at_high = probe, value
    return (low + high) / 2
