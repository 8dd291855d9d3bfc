"""A periodic orbit with an impact on a corner of the cam, proved to exist, and its map on either side of the corner.

    flight k   c_k + s v_k + p f(c_k) = c_(k+1)                                       it ends at the next impact
    impact     v_(k+1) = (1 + r) c'_(k+1) - r (s' v_k + s f(c_k))                     Newton's law

Here p and s are taken after the time (theta_(k+1) - theta_k) T/(2 pi), and theta_0 is the corner. The unknowns are T, v_0, and the
angle and the velocity after every other impact: as many as there are equations.
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
# An angle in doubles names the corner that lies within this distance, rad.
ROUNDED = 1e-6


@dataclass(frozen=True)
class Impact:
    """Impact: its angle, rad, the law there, and velocities, m/s: after it, of the cam, and after it relative to the cam."""

    angle: arb
    law: object
    velocity: arb
    cam_velocity: arb
    relative_velocity: arb


@dataclass(frozen=True)
class OneSided:
    """Law before a corner as it is at the corner, but with lift and slope of the law after it. These differ only by the error of decimals."""

    before: object
    after: object

    def derivatives(self, angle):
        """(c, c', c'', c''') over the ball."""
        return self.after.derivatives(angle)[:2] + self.before.derivatives(angle)[2:]


class CornerImpact:
    """Periodic orbit with an impact on a corner. `candidate` is in doubles: the corner's angle, the period, and, for each impact from
    the corner's on, the angle turned until the next impact and the velocity after it. An orbit of one impact needs no list of
    impacts. These numbers are only a guess: the proof does not trust them."""

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
        """Return the flight from the corner back to it, in doubles: c + s v + p f(c) = c."""
        follower = self.machine.follower
        p, s, _ = follower.response(self.revolutions * arb(period))
        leaves = float(-p * follower.force(self.corner.sides()[0][0]) / s)
        return {"turn_rad": self.revolutions * float(self.machine.cam.turn), "velocity_after_m_s": leaves}

    def _solve(self, candidate):
        """Solve for T and the impacts by Krawczyk's operator. Raise Refused if the root is not on the pieces of the cam for which it
        was sought."""
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
        """Return residuals, in duals, of the equations of the orbit. All are 0 if every flight ends at the next impact, and Newton's
        law gives the velocity after it."""
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
        """Prove that each flight leaves the cam, stays clear of it, and ends in an impact that is no graze."""
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
        # Reorder from flights to impacts: the last flight ends at the corner's impact, which comes first.
        self.velocities_before = self.velocities_before[-1:] + self.velocities_before[:-1]

    def _choose_section(self):
        """Put the section in the middle of the longest flight, and compute the state there."""
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
        """Return the numbers of the impacts, in order from the section on."""
        count = len(self.impacts)
        return [((self.longest + 1 + later) % count) for later in range(count)]

    def impact_law(self, number, side):
        """Return the law at an impact; at the corner, the law of `side`."""
        if number > 0:
            return self.impacts[number].law
        return OneSided(self.corner.before, self.corner.after) if side == "before" else self.corner.after

    def implicit(self, side):
        """Return [A | B], 2 x 3, and (e, f), by dual numbers. The time of each impact is differentiated implicitly.

        `side` is "before" or "after": the law of the cam before or after the corner is used, continued past the corner.
        """
        follower, turn = self.machine.follower, self.machine.cam.turn
        position, velocity, period = Dual.varied([self.position, self.velocity, self.period])
        angle, rate, border = period.constant(self.section), turn / period, None
        for number in self.course():
            impact, law = self.impacts[number], self.impact_law(number, side)
            turns = 0 if number > self.longest else self.revolutions
            here = impact.angle + turns * turn
            if number == 0:
                # State at the phase of the corner if there were no impact.
                arrived = follower.fly(response(follower, (here - angle) / rate), position, velocity)
                border = arrived[0].slopes
            time = period.constant((here - angle.value) / rate.value)
            for _ in range(2):
                # The first pass holds the time fixed. The gap's derivatives then give the derivatives of the time for the second pass.
                reached, before = follower.fly(response(follower, time), position, velocity)
                # The values are known. Values that are carried along would widen at each impact.
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
        """Return [A | B] in another way. For one impact in one revolution, the expressions of golden/derived are evaluated. For other
        orbits, explicit matrices are multiplied."""
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
        """Return [A | B] as a product of matrices once around. In flight xi -> Phi xi + (v, a) t/T dT, and at an impact xi -> S xi -
        (0, (1 + r) c'/T) dT."""
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
        """Return [A | B] of a side and (e, f). Each entry is the intersection of the results of two routes; raise Refused if they do
        not meet."""
        (one, border), other = self.implicit(side), self.closed_form(side)
        both = [[overlap(one[row, column], other[row, column]) for column in range(3)] for row in range(2)]
        if None in both[0] + both[1]:
            raise Refused("implicit differentiation contradicts the closed form: one of them is wrong")
        return arb_mat(both), border


def _column(position, velocity):
    return arb_mat([[0, 0, position], [0, 0, velocity]])


def eigenvalues(a):
    """Return (real part, imaginary part) of both eigenvalues of a 2 x 2 matrix, the larger first. Raise Undecided if they may be equal."""
    half = (a[0, 0] + a[1, 1]) / 2
    # Discriminant: ((a - d)/2)^2 + b c. The square is written as a product, since the power of a ball about 0 is not a number.
    apart = (a[0, 0] - a[1, 1]) / 2
    under = apart * apart + a[0, 1] * a[1, 0]
    root_of = abs(under).sqrt()
    if sign(under, "the discriminant of a side's matrix") > 0:
        return [(half + root_of, arb(0)), (half - root_of, arb(0))]
    return [(half, root_of), (half, -root_of)]
