"""All periodic orbits of one and of two impacts in one revolution, at one speed, each with its kind.

The angles of its impacts determine an orbit. Newton's law at the impacts is linear in the velocities v after them, and gives these
for any times between the impacts. It remains that every flight ends on the cam:

    v_next = (1 + r) c'_next - r (s' v + s f(c)),   E = c + s v + p f(c) - c_next = 0.

Every pair of angles is excluded, or lies near a root that is proved to be the only one there. For every root it is decided whether
its flights are clear of the cam. Two impacts nearer to each other than SHORT are excluded in another way: see `_short`.

The mean value form and Krawczyk's operator need a continuous c'. Where c' jumps, each choice of sections of the cam between its jumps
is searched by itself, with the laws of the sections continued past their ends. A root counts if it lies on its sections.
"""

from dataclasses import dataclass

from flint import arb, arb_mat

from .duals import Dual, lift, response
from .motion import Flight, Start, derivative
from .numbers import Excluded, Refused, Undecided, between, sign
from .roots import all_roots, closed_in

# Angle between two impacts, rad, below which the time that is left for the other flight is used to exclude them.
SHORT = 1 / 64
# Fractions of a flight at which a box of orbits is checked for being inside the cam.
LOOKS = (1 / 16, 1 / 4, 1 / 2, 3 / 4, 15 / 16)
# A double above a full turn, so that the box that is searched holds a turn. Margin of that box beyond a section of the cam, rad.
CIRCLE, EDGE = 2 * 3.1415926535897936, 2.0**-48
# Width of a range of angles, rad, below which it is not halved in the search for short flights.
SMALLEST = 2.0**-24


@dataclass(frozen=True)
class Orbit:
    """Periodic orbit: its impacts as (angle, velocity relative to the cam after the impact), the derivative of the impact map once
    around, and the kind. Kinds are stable, saddle (a multiplier above 1), flip (a multiplier below -1) and neutral (a pair on the
    unit circle, for a follower without loss)."""

    impacts: list
    derivative: arb_mat
    kind: str


class Orbits:
    """Orbits of a machine at a speed, rad/s."""

    def __init__(self, machine, speed):
        self.machine, self.speed = machine, speed
        self.turn, self.period = machine.cam.turn, machine.cam.turn / speed
        # Without loss, every impact and every flight preserves area: det M = 1.
        self.lossless = machine.follower.restitution == 1 and machine.follower.zeta == 0
        if not self.machine.follower.restitution > 0:
            raise Refused("a follower without restitution does not leave the cam")

    def of(self, count):
        """Return (orbits, undecided places) with `count` impacts, 1 or 2."""
        cam, orbits, undecided = self.machine.cam, [], [] if count == 1 else self._short()
        for first in cam.sections(1):
            for sections in [[first]] if count == 1 else [[first, second] for second in cam.sections(2)]:
                some, rest = self._on(sections)
                orbits, undecided = orbits + some, undecided + rest
        return orbits, undecided

    def _on(self, sections):
        """Return (orbits, undecided places) whose impacts are on these sections of the cam, one after the other."""
        laws, first, last = [section.law for section in sections], sections[0], sections[-1]
        # The box is in doubles and holds the range of angles.
        box, ranges = [(float(first.start) - EDGE, float(first.end) + EDGE)], [(first.start, first.end)]
        if len(sections) > 1:
            # The shorter flight comes first, so that each pair is searched once.
            box, ranges = [*box, (SHORT, CIRCLE / 2)], [*ranges, (SHORT, self.turn / 2)]

        def equations(unknowns):
            """Return the distance from the cam at which each flight ends."""
            return [ends for *_, ends in self._thrown(self._flights(unknowns), laws)]

        def excluded(balls):
            angle = sum(balls[1:], balls[0])
            return angle < last.start or angle > last.end or self._excluded(balls, laws)

        found, undecided = all_roots(equations, box, excluded)
        orbits = []
        # A box may hold a root outside the whole range. This root is found again a turn, or one flight, later.
        kept = []
        for one in found:
            root = closed_in(equations, one)
            places = [_inside(value, ends) for value, ends in zip(root, ranges)] + [_inside(sum(root[1:], root[0]), (last.start, last.end))]
            if any(place is False for place in places) or any(_holds(before, root) for before in kept):
                continue
            kept.append(one)
            try:
                if None in places:
                    raise Undecided("a root is on the edge of what was looked through")
                orbits.append(self._orbit(root, laws))
            except Excluded:
                continue
            except Refused:
                undecided.append(root)
        return orbits, undecided

    def _flights(self, unknowns):
        """Return (start angle, angle turned) of each flight, from the angle of the first impact and the angle turned until the second."""
        first, *others = unknowns
        if not others:
            return [(first, first.constant(self.turn))]
        return [(first, others[0]), (first + others[0], self.turn - others[0])]

    def _thrown(self, flights, laws):
        """Return, for each impact, duals: (lift, cam velocity, v+ of the flight that begins there, end of this flight less the next
        lift).

        By Newton's law, v+ of the next impact is a - r s' v+ of this one, with a = (1 + r) c' - r s f. So once around v+ = whole +
        part v+.
        """
        follower, speed, count = self.machine.follower, self.speed, len(flights)
        lifts = [lift(law, angle) for law, (angle, _) in zip(laws, flights)]
        responses, forces = [response(follower, turn / speed) for _, turn in flights], [follower.force(c) for c, _ in lifts]
        thrown = []
        for k, ((_, s, s1), force) in enumerate(zip(responses, forces)):
            cam_velocity = lifts[(k + 1) % count][1] * speed
            thrown.append((follower.rebound(cam_velocity, s * force), -follower.restitution * s1))
        whole, part = thrown[0]
        for more, factor in thrown[1:]:
            whole, part = more + factor * whole, factor * part
        velocities = [whole / (1 - part)]
        for more, factor in thrown[:-1]:
            velocities.append(more + factor * velocities[-1])
        found = []
        for k, ((c, slope), (p, s, _), force, leaves) in enumerate(zip(lifts, responses, forces, velocities)):
            found.append((c, slope * speed, leaves, c + s * leaves + p * force - lifts[(k + 1) % count][0]))
        return found

    def _excluded(self, balls, laws):
        """Return True if every orbit of a box is proved to have a flight that starts into the cam, or is inside the cam on its way."""
        cam, follower, centre = self.machine.cam, self.machine.follower, [ball.mid() for ball in balls]
        flights = self._flights(Dual.varied(balls))
        thrown, middle = self._thrown(flights, laws), self._thrown(self._flights(Dual.varied(centre)), laws)
        for k, (c, cam_velocity, leaves, _) in enumerate(thrown):
            # Mean value form, since this is a difference of numbers that vary together.
            relative, at_centre = leaves - cam_velocity, middle[k][2] - middle[k][1]
            form = at_centre.value + sum((slope * (ball - m) for slope, ball, m in zip(relative.slopes, balls, centre)), arb(0))
            if relative.value < 0 or form < 0:
                return True
            angle, time = flights[k][0], flights[k][1] / self.speed
            for part in LOOKS:
                moment = time * part
                reached = follower.fly(response(follower, moment), c, leaves)[0]
                height = reached - lift(cam, angle + moment * self.speed)[0]
                if height.value < 0:
                    return True
        return False

    def _short(self):
        """Return the places where two impacts nearer than SHORT may belong to an orbit. The list is empty if all goes well.

        Let g be the gap of a flight of time t <= SHORT/omega, with |g''| <= G. Both its velocities relative to the cam are at most G
        t/2. So the other flight leaves with 0 to r G t/2, takes T - t, and arrives with 0 to G t/(2 r). Most flights cannot.
        """
        cam, parts, undecided = self.machine.cam, [(0.0, CIRCLE)], []
        while parts:
            low, high = parts.pop()
            if self._no_short(between(low, high)):
                continue
            # Impacts on both sides of a jump of c' stay undecided, however near they are.
            if high - low < (SMALLEST if cam.is_smooth(between(low, high + SHORT)) else SHORT / 16):
                undecided.append([between(low, high), between(0, SHORT)])
                continue
            parts += [(low, (low + high) / 2), ((low + high) / 2, high)]
        return undecided

    def _no_short(self, angle):
        """Return True if it is proved that no orbit has an impact in a ball of angles and another one up to SHORT after it."""
        follower, cam, speed = self.machine.follower, self.machine.cam, self.speed
        along, longest = angle + between(0, SHORT), arb(SHORT) / speed
        if not cam.is_smooth(along):
            return False
        lift_there, slope, curvature, _ = cam.derivatives(along)
        over = abs(follower.acceleration(lift_there, slope * speed) - curvature * speed**2).abs_upper() * 2
        # While |g''| <= G, |g'| <= G t and |g| <= G t^2. These bounds give |g''| < G, so that the first bound stays true.
        near = lift_there + arb(0, over * longest * longest), slope * speed + arb(0, over * longest)
        if not abs(follower.acceleration(*near) - curvature * speed**2) < over:
            return False
        fastest = over * longest / 2
        leaves, arrives = between(0, fastest * follower.restitution), between(-fastest / follower.restitution, 0)
        other = Flight(self.machine, Start(along, leaves, speed))
        time = between(self.period - longest, self.period)
        if not other.gap(time).contains(0) or not other.gap_rate(time).overlaps(arrives):
            return True
        return any(other.gap(self.period * part) < 0 for part in LOOKS)

    def _orbit(self, root, laws):
        """Return the orbit of a root, its flights proved clear of the cam. Raise Excluded if they are not clear."""
        flights = self._flights([Dual(value, []) for value in root])
        impacts, around = [], arb_mat([[1, 0], [0, 1]])
        for (angle, turn), (_, cam_velocity, leaves, _) in zip(flights, self._thrown(flights, laws)):
            relative = leaves.value - cam_velocity.value
            if relative < 0:
                raise Excluded("an impact sends the follower into the cam")
            flight = Flight(self.machine, Start(angle.value, relative, self.speed))
            time = turn.value / self.speed
            flight.first_contact(float(time) * 2, time)
            step = derivative(flight, time)
            around = arb_mat([[step[row, column] for column in range(2)] for row in range(2)]) * around
            impacts.append((angle.value, relative))
        return Orbit(impacts, around, kind(around, self.lossless))


def _inside(value, ends):
    """Return True if a number lies between two ends, False if it does not, and None if undecided."""
    low, high = ends
    return True if value > low and value < high else False if value < low or value > high else None


def _holds(box, root):
    """Return True if a box that holds only one root holds this root. Then both roots are the same."""
    return all(bool(whole.contains(one)) for whole, one in zip(box, root))


def kind(around, lossless):
    """Return the kind of a fixed point, from the derivative of its return map: the signs of 1 - tr + det, 1 + tr + det and 1 - det."""
    trace, determinant = around[0, 0] + around[1, 1], 1 if lossless else around.det()
    if sign(1 - trace + determinant, "det(I - M)") < 0:
        return "saddle"
    if sign(1 + trace + determinant, "det(I + M)") < 0:
        return "flip"
    if lossless:
        return "neutral"
    return "stable" if sign(1 - determinant, "1 - det M") > 0 else "unstable"
