"""A periodic orbit with an impact on a corner of the cam, proved to exist, and its map on either side of the corner.

    flight k   c_k + s v_k + p f(c_k) = c_(k+1)                                       it comes down where the next impact is
    impact     v_(k+1) = (1 + r) c'_(k+1) - r (s' v_k + s f(c_k))                     Newton's law

with p, s after (theta_(k+1) - theta_k) T/(2 pi), and theta_0 the corner: as many equations as there are unknowns, T, v_0 and the
angle and velocity after every other impact.
"""

import json
from dataclasses import dataclass
from pathlib import Path

from flint import arb, arb_mat, fmpq

from arithmetic import evaluate

from .duals import Dual, lift, response
from .krawczyk import root
from .motion import Flight, Start
from .numbers import Refused, Undecided, overlap, sign

DERIVED = Path(__file__).resolve().parent.parent.parent / "golden" / "derived" / "corner_map.json"
# An angle that is told in doubles names the corner that it is this near to, rad.
ROUNDED = 1e-6


@dataclass(frozen=True)
class Impact:
    """Where an impact is, rad, the law that holds there and the velocities, m/s: after it, of the cam, relative to it after."""

    angle: arb
    law: object
    velocity: arb
    cam_velocity: arb
    relative_velocity: arb


@dataclass(frozen=True)
class OneSided:
    """The law before a corner as it is at the corner, with lift and slope of the law after it: they differ by what decimals are off."""

    before: object
    after: object

    def derivatives(self, angle):
        """(c, c', c'', c''') over the ball."""
        return self.after.derivatives(angle)[:2] + self.before.derivatives(angle)[2:]


class CornerImpact:
    """The orbit. `candidate` is in doubles: the corner's angle, the period, and of each impact from the corner's on the angle
    turned until the next and the velocity after, or nothing of them where there is one. They are what is tried, and nothing is
    believed of them."""

    def __init__(self, machine, candidate):
        self.machine, self.revolutions = machine, candidate["revolutions"]
        self.corner = self._corner(candidate["cam_angle_rad"])
        self._solve(candidate)
        self._prove_flights()
        self._choose_section()

    def _corner(self, angle):
        corners = [one for one in self.machine.cam.corners if abs(one.angle - angle).lower() < ROUNDED]
        if not corners:
            raise Refused(f"no corner of the cam is at {angle!r} rad")
        corner = corners[0]
        if corner.smooth < 2:
            raise Refused("the cam's velocity jumps at this corner: the map has a gap, so there are no matrices that agree on a border")
        if corner.smooth > 2 or not corner.bends():
            raise Refused("the cam's acceleration does not jump at this corner by more than the error of its decimals: the map is smooth")
        return corner

    def _only_flight(self, period):
        """The flight from the corner back to it, in doubles: c + s v + p f(c) = c."""
        follower = self.machine.follower
        p, s, _ = follower.response(self.revolutions * arb(period))
        leaves = float(-p * follower.force(self.corner.sides()[0][0]) / s)
        return {"turn_rad": self.revolutions * float(self.machine.cam.turn), "velocity_after_m_s": leaves}

    def _solve(self, candidate):
        """T and the impacts, by Krawczyk's operator."""
        cam = self.machine.cam
        flights = candidate.get("impacts") or [self._only_flight(candidate["period_s"])]
        turns = [impact["turn_rad"] for impact in flights]
        places = [candidate["cam_angle_rad"] + sum(turns[:k]) for k in range(len(turns))]
        self.pieces = [cam.piece_of(arb(place)) for place in places[1:]]
        laws = [self.corner.after] + [piece.law for piece in self.pieces]
        end = self.corner.angle + self.revolutions * cam.turn

        def equations(unknowns):
            # The corner's lift and slope are the same on both sides, and its angle does not vary.
            angles = [unknowns[0].constant(self.corner.angle)] + unknowns[2::2]
            return self.closing(laws, unknowns[0], angles, [unknowns[1]] + unknowns[3::2])

        guess, names = [candidate["period_s"], flights[0]["velocity_after_m_s"]], ["T", "v+ at the corner"]
        for k, place in enumerate(places[1:], start=1):
            guess += [place, flights[k]["velocity_after_m_s"]]
            names += [f"the angle of impact {k + 1}", f"v+ of impact {k + 1}"]
        found, self.alone = root(equations, guess, names)
        self.period, self.speed = found[0], cam.turn / found[0]
        angles, velocities = [self.corner.angle] + found[2::2], [found[1]] + found[3::2]
        self.impacts = []
        for angle, law, velocity in zip(angles, laws, velocities):
            cam_velocity = law.derivatives(angle)[1] * self.speed
            self.impacts.append(Impact(angle, law, velocity, cam_velocity, velocity - cam_velocity))
        for angle, piece in zip(angles[1:], self.pieces):
            if not piece.holds(angle):
                raise Refused(f"the root, at {angle.str(10)} rad, is not on the piece of the cam for which its equations hold")
        self.angles = angles + [end]

    def closing(self, laws, period, angles, velocities):
        """What is 0 where every flight ends at the next impact with the velocity that this leaves with, in duals."""
        follower, rate = self.machine.follower, self.machine.cam.turn / period
        lifts = [lift(law, angle) for law, angle in zip(laws, angles)]
        angles = angles + [angles[0] + self.revolutions * self.machine.cam.turn]
        lifts, velocities, found = lifts + lifts[:1], velocities + velocities[:1], []
        for k in range(len(laws)):
            p, s, s1 = response(follower, (angles[k + 1] - angles[k]) / rate)
            force = follower.force(lifts[k][0])
            before = s1 * velocities[k] + s * force
            found.append(lifts[k][0] + s * velocities[k] + p * force - lifts[k + 1][0])
            found.append(velocities[k + 1] - follower.rebound(lifts[k + 1][1] * rate, before))
        return found

    def _prove_flights(self):
        """Each flight leaves the cam, is clear of it and comes down, and the impact that ends it is a blow."""
        self.velocities_before = []
        for k, impact in enumerate(self.impacts):
            if not impact.relative_velocity > 0:
                into = impact.relative_velocity < 0
                raise Refused(f"impact {k + 1} {'sends the follower into the cam' if into else 'cannot be distinguished from a graze'}")
            time = (self.angles[k + 1] - self.angles[k]) / self.speed
            if not time > 0:
                raise Refused("the impacts are not in order")
            flight = Flight(self.machine, Start(impact.angle, impact.relative_velocity, self.speed), impact.law)
            flight.first_contact(float(time) * 2, time)
            self.velocities_before.append(flight.state(time)[1])
        # Before impact k + 1; that before the corner's is the last flight's.
        self.velocities_before = self.velocities_before[-1:] + self.velocities_before[:-1]

    def _choose_section(self):
        """The section in the middle of the longest flight, and the state there."""
        turns = [float(after - before) for before, after in zip(self.angles, self.angles[1:])]
        self.longest = max(range(len(turns)), key=lambda k: turns[k])
        before, after = self.angles[self.longest], self.angles[self.longest + 1]
        self.section = (before + after) / 2
        follower, leaving = self.machine.follower, self.impacts[self.longest]
        lift_there = leaving.law.derivatives(leaving.angle)[0]
        flown = follower.response((after - before) / 2 / self.speed)
        self.position, self.velocity = follower.fly(flown, lift_there, leaving.velocity)
        self.state = [self.position - follower.origin, self.velocity]

    def course(self):
        """The impacts in order from the section on, each with its number."""
        count = len(self.impacts)
        return [((self.longest + 1 + later) % count) for later in range(count)]

    def impact_law(self, number, side):
        """The law at an impact; at the corner, that of the side."""
        if number > 0:
            return self.impacts[number].law
        return OneSided(self.corner.before, self.corner.after) if side == "before" else self.corner.after

    def implicit(self, side):
        """2 x 3 [A | B], and (e, f), by dual numbers: the time of each impact is differentiated implicitly.

        `side` is "before" or "after": with the law of the cam before the corner or after it, continued past it.
        """
        follower, turn = self.machine.follower, self.machine.cam.turn
        position, velocity, period = Dual.varied([self.position, self.velocity, self.period])
        angle, rate, border = period.constant(self.section), turn / period, None
        for number in self.course():
            impact, law = self.impacts[number], self.impact_law(number, side)
            turns = 0 if number > self.longest else self.revolutions
            here = impact.angle + turns * turn
            if number == 0:
                # At the corner's phase, as if there were no impact.
                arrived = follower.fly(response(follower, (here - angle) / rate), position, velocity)
                border = arrived[0].slopes
            time = period.constant((here - angle.value) / rate.value)
            for _ in range(2):
                # First with the time held fixed: from what the gap is off by follows how the time varies; then with it.
                reached, before = follower.fly(response(follower, time), position, velocity)
                # Values are known; what is carried along would know them less and less.
                c, c1 = lift(law, Dual(impact.angle, (angle + time * rate).slopes))
                gap = reached - c
                closing = before.value - c1.value * rate.value
                time = Dual(time.value, [t - g / closing for t, g in zip(time.slopes, gap.slopes)])
            position, velocity = c, Dual(impact.velocity, follower.rebound(c1 * rate, before).slopes)
            angle = Dual(here, (angle + time * rate).slopes)
        end = self.section + self.revolutions * turn
        ends = follower.fly(response(follower, (end - angle) / rate), position, velocity)
        return arb_mat([one.slopes for one in ends]), border

    def closed_form(self, side):
        """[A | B] another way: of one impact by the expressions of golden/derived, of several by the product of explicit matrices."""
        return self._derived(side) if len(self.impacts) == 1 and self.revolutions == 1 else self._product(side)

    def _derived(self, side):
        follower, law = self.machine.follower, self.impact_law(0, side)
        lift_there, _, curvature, _ = law.derivatives(self.corner.angle)
        p, s, _ = follower.response(self.period / 2)
        names = {
            "zeta": follower.zeta,
            "omega0_squared": follower.omega0_squared,
            "T": self.period,
            "r": follower.restitution,
            "spring": -follower.force(lift_there),
            "v": self.velocities_before[0],
            "c1": self.impacts[0].cam_velocity,
            "c2": curvature * self.speed**2,
            "p": p,
            "s": s,
        }
        expressions = json.loads(DERIVED.read_text())["expressions"]
        value = {name: evaluate(source, names) for name, source in expressions.items()}
        return arb_mat([[value[name] for name in row] for row in (("A11", "A12", "B1"), ("A21", "A22", "B2"))])

    def _product(self, side):
        """xi -> Phi xi + (v, a) t/T dT in flight, xi -> S xi - (0, (1 + r) c'/T) dT at an impact, once around."""
        follower, turn = self.machine.follower, self.machine.cam.turn
        deviation = arb_mat([[1, 0, 0], [0, 1, 0]])
        angle, state = self.section, (self.position, self.velocity)

        def flown(deviation, state, time):
            p, s, s1 = flight = follower.response(time)
            # Phi = [[1 - w0^2 p, s], [-w0^2 s, s']]
            flow = arb_mat([[1 - follower.omega0_squared * p, s], [-follower.omega0_squared * s, s1]])
            position, velocity = follower.fly(flight, *state)
            part = time / self.period
            return flow * deviation + _column(velocity * part, follower.acceleration(position, velocity) * part)

        for number in self.course():
            impact, law = self.impacts[number], self.impact_law(number, side)
            here = impact.angle + (0 if number > self.longest else self.revolutions) * turn
            deviation = flown(deviation, state, (here - angle) / self.speed)
            lift_there, _, curvature, _ = law.derivatives(impact.angle)
            before, cam_velocity, r = self.velocities_before[number], impact.cam_velocity, follower.restitution
            # S = [[-r, 0], [alpha, -r]], alpha = -(1 + r) (c'' + 2 zeta c' - f(c))/(v - c')
            strength = curvature * self.speed**2 + 2 * follower.zeta * cam_velocity - follower.force(lift_there)
            blow = arb_mat([[-r, 0], [-(1 + r) * strength / (before - cam_velocity), -r]])
            deviation = blow * deviation - _column(arb(0), (1 + r) * cam_velocity / self.period)
            angle, state = here, (lift_there, impact.velocity)
        return flown(deviation, state, (self.section + self.revolutions * turn - angle) / self.speed)

    def side_map(self, side):
        """[A | B] of a side and (e, f): what two routes share, which must meet in every entry."""
        (one, border), other = self.implicit(side), self.closed_form(side)
        both = [[overlap(one[row, column], other[row, column]) for column in range(3)] for row in range(2)]
        if None in both[0] + both[1]:
            raise Refused("implicit differentiation contradicts the closed form: one of them is wrong")
        return arb_mat(both), border


def _column(position, velocity):
    return arb_mat([[0, 0, position], [0, 0, velocity]])


def eigenvalues(a):
    """(real part, imaginary part) of both eigenvalues of a 2 x 2 matrix, the larger first; Undecided where they may be double."""
    half = (a[0, 0] + a[1, 1]) / 2
    # ((a - d)/2)^2 + b c, under the root. A product, since the power of a ball about 0 comes out as no number.
    apart = (a[0, 0] - a[1, 1]) / 2
    under = apart * apart + a[0, 1] * a[1, 0]
    root_of = abs(under).sqrt()
    if sign(under, "the discriminant of a side's matrix") > 0:
        return [(half + root_of, arb(0)), (half - root_of, arb(0))]
    return [(half, root_of), (half, -root_of)]
