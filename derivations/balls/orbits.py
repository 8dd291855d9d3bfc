"""All periodic orbits of one and of two impacts in one revolution, at one speed, each with its kind.

An orbit is the angles of its impacts: Newton's law at every impact is linear in the velocities v after them and gives these, whatever
the times between the impacts, and what is left is that every flight ends on the cam,

    v_next = (1 + r) c'_next - r (s' v + s f(c)),   E = c + s v + p f(c) - c_next = 0.

Every pair of angles is excluded, or near a root that is proved to be alone, and of every root it is decided whether its flights are
clear of the cam. Impacts of a pair that are nearer to one another than SHORT are excluded otherwise: see `_short`.

The mean value form and Krawczyk's operator need a continuous c'. Where c' jumps, each choice of sections of the cam between its jumps is
looked through by itself, with the laws of the sections continued past their ends, and a root counts where it lies on its sections.
"""

from dataclasses import dataclass

from flint import arb, arb_mat

from .duals import Dual, lift, response
from .motion import Flight, Start, derivative
from .numbers import Excluded, Refused, Undecided, between, sign
from .roots import all_roots, closed_in

# Angle between two impacts below which they are told apart by the time that is left for the other flight, rad.
SHORT = 1 / 64
# Parts of a flight at which a box of orbits is looked at for being inside of the cam.
LOOKS = (1 / 16, 1 / 4, 1 / 2, 3 / 4, 15 / 16)
# A double above a whole turn, so that the box to look through holds one, and how far that box goes beyond a section of the cam, rad.
CIRCLE, EDGE = 2 * 3.1415926535897936, 2.0**-48
# Parts of the whole circle that the short flights are not halved beyond.
SMALLEST = 2.0**-24


@dataclass(frozen=True)
class Orbit:
    """Impacts as (angle, velocity relative to the cam after it), the derivative of the impact map once around, and the kind:
    stable, saddle (a multiplier above 1) or flip (one below -1)."""

    impacts: list
    derivative: arb_mat
    kind: str


class Orbits:
    """The orbits of a machine at a speed, rad/s."""

    def __init__(self, machine, speed):
        self.machine, self.speed = machine, speed
        self.turn, self.period = machine.cam.turn, machine.cam.turn / speed
        if not self.machine.follower.restitution > 0:
            raise Refused("a follower without restitution does not leave the cam")

    def of(self, count):
        """(orbits, places that are undecided) of `count` impacts, 1 or 2."""
        cam, orbits, undecided = self.machine.cam, [], [] if count == 1 else self._short()
        for first in cam.sections(1):
            for sections in [[first]] if count == 1 else [[first, second] for second in cam.sections(2)]:
                some, rest = self._on(sections)
                orbits, undecided = orbits + some, undecided + rest
        return orbits, undecided

    def _on(self, sections):
        """(orbits, places that are undecided) whose impacts are on these parts of the cam, one after the other."""
        laws, first, last = [section.law for section in sections], sections[0], sections[-1]
        # The doubles about a range of angles, so that the box to look through holds it.
        box, ranges = [(float(first.start) - EDGE, float(first.end) + EDGE)], [(first.start, first.end)]
        if len(sections) > 1:
            # The shorter flight first: each pair once.
            box, ranges = [*box, (SHORT, CIRCLE / 2)], [*ranges, (SHORT, self.turn / 2)]

        def equations(unknowns):
            """How far each flight ends from the cam."""
            return [ends for *_, ends in self._thrown(self._flights(unknowns), laws)]

        def excluded(balls):
            angle = sum(balls[1:], balls[0])
            return angle < last.start or angle > last.end or self._excluded(balls, laws)

        found, undecided = all_roots(equations, box, excluded)
        orbits = []
        # A box may hold a root that lies beyond the whole one: then it is there again a turn, or the other flight, on.
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
        """(angle of its start, angle turned) of each flight, from the angle of the first impact and what is turned to the second."""
        first, *others = unknowns
        if not others:
            return [(first, first.constant(self.turn))]
        return [(first, others[0]), (first + others[0], self.turn - others[0])]

    def _thrown(self, flights, laws):
        """(lift, cam velocity, v+ of the flight that begins there, where that ends less the next lift) of each impact, duals.

        The impacts throw: v+ of the next is a - r s' v+ of this one, a = (1 + r) c' - r s f, so that once around v+ = all + part v+.
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
        """Whether every flight of a box leaves into the cam, comes from inside of it, or is inside of it on its way."""
        cam, follower, centre = self.machine.cam, self.machine.follower, [ball.mid() for ball in balls]
        flights = self._flights(Dual.varied(balls))
        thrown, middle = self._thrown(flights, laws), self._thrown(self._flights(Dual.varied(centre)), laws)
        for k, (c, cam_velocity, leaves, _) in enumerate(thrown):
            # By the mean value form: a difference of numbers that vary together.
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
        """Where two impacts nearer than SHORT may belong to an orbit, which is nowhere if all goes well.

        Of a flight of time t <= SHORT/omega with |g''| <= G, g its gap, both its velocities relative to the cam are at most G t/2:
        the other flight leaves with 0 to r G t/2, takes T - t, and arrives with 0 to G t/(2 r). Most flights cannot.
        """
        cam, parts, undecided = self.machine.cam, [(0.0, CIRCLE)], []
        while parts:
            low, high = parts.pop()
            if self._no_short(between(low, high)):
                continue
            # Between impacts on both sides of a jump of c' nothing is decided, however near they are.
            if high - low < (SMALLEST if cam.is_smooth(between(low, high + SHORT)) else SHORT / 16):
                undecided.append([between(low, high), between(0, SHORT)])
                continue
            parts += [(low, (low + high) / 2), ((low + high) / 2, high)]
        return undecided

    def _no_short(self, angle):
        """Whether no orbit has an impact in a ball of angles and another one up to SHORT after it."""
        follower, cam, speed = self.machine.follower, self.machine.cam, self.speed
        along, longest = angle + between(0, SHORT), arb(SHORT) / speed
        if not cam.is_smooth(along):
            return False
        lift_there, slope, curvature, _ = cam.derivatives(along)
        over = abs(follower.acceleration(lift_there, slope * speed) - curvature * speed**2).abs_upper() * 2
        # While |g''| <= G, |g'| <= G t and |g| <= G t^2: with those it is below G, so that it stays so.
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
        """The orbit of a root, its flights clear of the cam; Excluded where they are not."""
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
        return Orbit(impacts, around, kind(around))


def _inside(value, ends):
    """Whether a number lies between two ends; None where that is not decided."""
    low, high = ends
    return True if value > low and value < high else False if value < low or value > high else None


def _holds(box, root):
    """Whether a box that holds one root alone holds this one: then it is that one."""
    return all(bool(whole.contains(one)) for whole, one in zip(box, root))


def kind(around):
    """What the derivative of a return map says of its fixed point, from the signs of 1 - tr + det, 1 + tr + det and 1 - det."""
    trace, determinant = around[0, 0] + around[1, 1], around.det()
    if sign(1 - trace + determinant, "det(I - M)") < 0:
        return "saddle"
    if sign(1 + trace + determinant, "det(I + M)") < 0:
        return "flip"
    return "stable" if sign(1 - determinant, "1 - det M") > 0 else "unstable"
