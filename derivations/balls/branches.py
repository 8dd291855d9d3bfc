"""The number and the kinds of the orbits of one impact in one revolution, at every speed of a range.

Let c, c' and f(c) be taken at the angle of the impact, and p, s, s' after the period T. Newton's law gives the velocity v after the
impact. The flight with this velocity ends on the cam where F is 0:

    (1 + r s') v = (1 + r) c' omega - r s f,      F = (1 + r) omega s c' - N f,      N = r s^2 - (1 + r s') p.

The angle enters only by the direction of (c', f), which turns with W = c'' f + w0^2 c'^2. An *arc* is a part of the cam on which
neither W nor f changes sign. On an arc there is at most one such orbit at any speed, and exactly one if F has different signs at the
ends of the arc. An orbit can begin or end where F = 0 at an end of an arc: at a *fold* (W = 0) or at a *corner impact*. It can also
end at a *graze*, where its flight touches the cam (g = g' = 0). With M the derivative of the impact map and u = v - c' omega,

    det M = r^2 e^(-2 zeta T),    det(I - M) = -(omega r/u) dF/dtheta,    det(I + M) = 2 (1 + det M) - det(I - M).

So the kind of an orbit changes at an end of the arc, or at a *flip*, where H = 2 (1 + det M) u + omega r dF/dtheta is 0.

Ranges of speeds are halved until a range has nothing to decide, or one event. Krawczyk's operator proves that the equations of the
event have one root in the range. The orbits at either end of the range then exist up to the event.
"""

from dataclasses import dataclass

from flint import arb, ctx

from .duals import Dual, lift, response
from .motion import Flight, Start
from .numbers import Excluded, Refused, Undecided, between, hull, overlap, within
from .roots import all_roots, closed_in, krawczyk

# Width of a range of speeds, rpm, below which it is not halved; and the width at or below which events are looked for in it.
SMALLEST, NARROW = 2.0**-14, 1.0
# Most ranges of speeds that are examined for one arc. An arc that is not clear is not halved beyond this number of parts of the whole
# range. The rest is then undecided. Fewer bits than FEWEST_BITS decide little.
MOST, UNCLEAR, FEWEST_BITS = 2000, 64, 53
# Fractions of a flight at which the gap is checked for being negative.
LOOKS = tuple(part / 16 for part in (1, 3, 5, 7, 8, 9, 11, 13, 15))
# Most halvings of an arc to show that no part of it holds an impact, and to narrow the place of an impact.
SHARES, PLACES = 6, 50
# The ends of a ball of angles are found to 1/NEAR of its width.
NEAR = 8
# Number of intervals of a flight among which the lowest gap is looked for.
MOMENTS = 256
# Kind of an orbit whose kind is not decided, and of a range in which nothing is decided.
ORBIT, UNDECIDED = "orbit", "undecided"
# Factor by which a box about a root is widened before Krawczyk's operator is tried on it.
WIDER = 1.25


@dataclass(frozen=True)
class End:
    """End of an arc: its angle, and the event that happens to an orbit whose impact comes here (None if no event)."""

    angle: arb
    event: str


@dataclass(frozen=True)
class Arc:
    """Part of the cam with its law. `is_clear` is True if it is proved that neither W nor f changes sign on the arc."""

    low: End
    high: End
    law: object
    is_clear: bool


@dataclass(frozen=True)
class Event:
    """Speed at which the orbit of an arc appears, vanishes or changes its kind, with the period, s, and the angle of the impact, rad."""

    kind: str
    period: arb
    angle: arb
    end: End = None

    def is_same(self, other, turn):
        """Return True if both events happen at the same end of two arcs, perhaps a turn apart."""
        ends = self.end is not None and other is not None and other.end is not None
        return ends and any((self.end.angle + turns * turn).overlaps(other.end.angle) for turns in (-1, 0, 1))


@dataclass(frozen=True)
class Orbit:
    """F (`gap`), u (`leaves`) and H (`flips`) at a dual angle and period."""

    gap: Dual
    leaves: Dual
    flips: Dual

    def flip(self):
        """Return F and H, which both vanish at a flip."""
        return [self.gap, self.flips]


@dataclass(frozen=True)
class Stretch:
    """Range of speeds, rpm, with the kinds of all orbits in it and the event at which it begins."""

    low: arb
    high: arb
    kinds: list
    event: Event


class Branches:
    """Orbits of one impact of a machine, arc by arc of its cam."""

    def __init__(self, machine):
        self.machine, self.turn = machine, machine.cam.turn
        follower = machine.follower
        if not follower.restitution > 0:
            raise Refused("a follower without restitution does not leave the cam")
        if follower.restitution == 1 and follower.zeta == 0:
            raise Refused("a follower without loss has orbits that are neither stable nor unstable")
        self.arcs = [arc for section in self._sections() for arc in self._arcs(*section)]

    def _sections(self):
        """Yield (start, end, law) for each part of the cam inside which c'' does not jump."""
        cam = self.machine.cam
        jumps = [corner for corner in cam.corners if corner.smooth <= 2]
        if any(corner.smooth < 2 for corner in jumps):
            raise Refused("the proof cannot count orbits over a range of speeds where the cam's velocity jumps")
        if not jumps:
            yield End(arb(0), None), End(self.turn, None), cam
            return
        if len(jumps) != len(cam.laws):
            raise Refused("the proof cannot count orbits over a range of speeds if c'' jumps between some pieces of the cam, and not between all")
        ends = [End(corner.angle, "corner-impact" if corner.bends() else None) for corner in jumps]
        ends.append(End(ends[0].angle + self.turn, ends[0].event))
        for low, high, law in zip(ends, ends[1:], cam.laws):
            yield low, high, law

    def _arcs(self, low, high, law):
        """Yield the arcs of a section, which is cut where W or f is 0. A section whose roots are not all proved is one arc that is
        not clear."""
        follower = self.machine.follower
        _, slope, curvature, _ = law.derivatives(between(low.angle, high.angle))
        if slope == 0 and curvature == 0:
            # A dwell has no such orbit. At the same height the follower returns no faster than it left, and slower with damping. But
            # v+ = -r v- asks for a return at v+/r, and there is a loss: r < 1, or damping.
            return

        def turned(unknowns):
            c, c1, c2, c3 = law.derivatives(unknowns[0].value)
            height, slope, curvature = (unknowns[0].through(*pair) for pair in ((c, c1), (c1, c2), (c2, c3)))
            return [curvature * follower.force(height) + follower.omega0_squared * slope * slope]

        def pressed(unknowns):
            return [follower.force(lift(law, unknowns[0])[0])]

        box, cuts, is_clear = [(float(low.angle.lower()), float(high.angle.upper()))], [], True
        for equations, event in ((turned, "fold"), (pressed, None)):
            roots, rest = all_roots(equations, box, lambda balls: False)
            is_clear = is_clear and not rest
            for (angle,) in (closed_in(equations, root) for root in roots):
                # Two boxes may hold the same root. A root that overlaps an end of the section is merged with that end.
                if angle.overlaps(low.angle):
                    low = End(hull([angle, low.angle]), low.event)
                elif angle.overlaps(high.angle):
                    high = End(hull([angle, high.angle]), high.event)
                elif angle > low.angle and angle < high.angle and not any(angle.overlaps(cut.angle) for cut in cuts):
                    cuts.append(End(angle, event))
        ends = [low, *(sorted(cuts, key=lambda cut: float(cut.angle)) if is_clear else []), high]
        for one, other in zip(ends, ends[1:]):
            yield Arc(one, other, law, is_clear)

    def over(self, low, high):
        """Return the orbits from one speed, rpm, to another as stretches by rising speed, without gaps. Raise Refused if the bits are
        too few."""
        if ctx.prec < FEWEST_BITS:
            raise Refused(f"bits = {ctx.prec}: a range of speeds needs at least {FEWEST_BITS}")
        courses = [self._course(arc, low, high) for arc in self.arcs]
        cuts = []
        for start, _, event in sorted((turn for course in courses for turn in course), key=lambda turn: float(turn[0])):
            if cuts and start.overlaps(cuts[-1][0]):
                # The common end of two arcs gives one event. Undecided ranges may begin at the same speed.
                if event is not None and not event.is_same(cuts[-1][1], self.turn):
                    raise Undecided("two events are at one speed, to as many digits as there are")
                continue
            cuts.append((start, event))
        stretches = []
        for k, (start, event) in enumerate(cuts):
            at = [max((turn for turn in course if not turn[0] > start), key=lambda turn: float(turn[0]))[1] for course in courses]
            end = cuts[k + 1][0] if k + 1 < len(cuts) else arb(high)
            kinds = sorted(kind for kind in at if kind is not None)
            if stretches and stretches[-1].kinds == kinds and (event is None or event.kind is None):
                stretches[-1] = Stretch(stretches[-1].low, end, kinds, stretches[-1].event)
            else:
                stretches.append(Stretch(start, end, kinds, event))
        return stretches

    def _course(self, arc, low, high):
        """Return [(first speed, rpm, kind of the orbit of an arc from there on or None, event there or None)] by rising speed."""
        found, parts = [], [(low, high)]

        def add(start, kind, event=None):
            if event is not None or not found or found[-1][1] != kind:
                found.append((start, kind, event))

        # If an arc may hold several orbits, the best that can be shown is that it holds none.
        left, smallest = MOST, SMALLEST if arc.is_clear else (high - low) / UNCLEAR
        while parts:
            low, high = parts.pop()
            left -= 1
            is_last = left < 0 or high - low < smallest
            try:
                before, event, after = self._part(arc, low, high, is_last)
            except Undecided:
                if is_last:
                    add(arb(low), UNDECIDED)
                    continue
                middle = (low + high) / 2
                parts += [(middle, high), (low, middle)]
                continue
            add(arb(low), before)
            if event is not None:
                add(60 / event.period, after, event)
        return found

    def _part(self, arc, low, high, is_last=False):
        """Return (kind before, event, kind after) of a range with one event, or (kind, None, kind) of a range without. A kind is None
        if there is no orbit. Raise Undecided if neither is proved."""
        period = 60 / between(low, high)
        signs = [self._sign(arc.law, end.angle, period) if arc.is_clear else 0 for end in (arc.low, arc.high)]
        if signs[0] * signs[1] > 0:
            return None, None, None
        place = self._place(arc, period, signs)
        if self._is_nowhere(arc.law, place, period, 0 if 0 not in signs else SHARES):
            return None, None, None
        if signs == [0, 0]:
            raise Undecided("an orbit may come or go at either end of an arc")
        is_narrow = high - low <= NARROW
        events = []
        if 0 in signs:
            if not is_narrow:
                raise Undecided("an orbit may come or go at an end of an arc")
            end = arc.low if signs[0] == 0 else arc.high

            def at_end(unknowns):
                return [self._orbit(arc.law, unknowns[0].constant(end.angle), unknowns[0]).gap]

            (found,) = self._root(at_end, [period])
            events.append(Event(end.event, found, end.angle, end))
        orbit = self._orbit(arc.law, *Dual.varied([place, period]))
        leaves = self._narrowed(arc.law, place, period, orbit.leaves, "leaves")
        flight = Flight(self.machine, Start(place, leaves, self.turn / period), arc.law)
        try:
            flight.first_contact(float(period.upper()) * 2, period)
        except Excluded:
            return None, None, None
        except Refused as reason:
            if 0 in signs or not is_narrow:
                raise Undecided(str(reason)) from reason
            events.append(self._graze(arc.law, flight, place, period))
        # F rises along the arc if its sign is 1 at the upper end or -1 at the lower end.
        rises = signs[1] - signs[0] > 0
        kind = "saddle" if rises else None
        if kind is None:
            flips = self._narrowed(arc.law, place, period, orbit.flips, "flips")
            if not flips.contains(0):
                kind = "stable" if flips > 0 else "flip"
            elif is_last:
                kind = ORBIT
            elif events or not is_narrow:
                raise Undecided("the kind of an orbit is not decided")
            else:
                angle, found = self._root(lambda unknowns: self._orbit(arc.law, *unknowns).flip(), [place, period])
                events.append(Event("flip", found, angle))
        if not events:
            return kind, None, kind
        if len(events) > 1:
            raise Undecided("two events are near to one another")
        before, after = (self._part(arc, end, end)[0] for end in (low, high))
        if before == after:
            raise Refused(f"the orbits at {low} and {high} rpm are the same, but there is an event in between")
        return before, events[0], after

    def _orbit(self, law, angle, period):
        """Return F, u and H at a dual angle and period."""
        follower = self.machine.follower
        c, c1, c2, c3 = law.derivatives(angle.value)
        lift, slope, curvature = (angle.through(*pair) for pair in ((c, c1), (c1, c2), (c2, c3)))
        p, s, s1 = response(follower, period)
        r, speed, force = follower.restitution, self.turn / period, follower.force(lift)
        thrown = 1 + r * s1
        # N = r s^2 - p (1 + r s')
        n = r * s * s - p * thrown
        # F = (1 + r) omega s c' - N f, and by the angle, with f' = -w0^2 c'
        pull = (1 + r) * speed * s
        gap = pull * slope - n * force
        by_angle = pull * curvature + follower.omega0_squared * slope * n
        # (1 + r s') u = r ((1 - s') c' omega - s f)
        leaves = r * (slope * speed * (1 - s1) - s * force) / thrown
        decay = r * r * (-2 * follower.zeta * period.value).exp()
        determinant = period.through(decay, -2 * follower.zeta * decay)
        return Orbit(gap, leaves, 2 * (1 + determinant) * leaves + speed * r * by_angle)

    def _narrowed(self, law, angle, period, over, name):
        """Return the number `name` of an orbit over a box, narrowed by the mean value form. `over` is this number with its
        derivatives over the box."""
        middle = angle.mid(), period.mid()
        at = getattr(self._orbit(law, *(Dual(one, []) for one in middle)), name).value
        form = at + sum((slope * (ball - m) for slope, ball, m in zip(over.slopes, (angle, period), middle)), arb(0))
        return overlap(over.value, form)

    def _sign(self, law, angle, period):
        """Return the sign of F at an angle over a ball of periods; 0 if it is not proved."""
        over = self._orbit(law, *Dual.varied([arb(angle), period])).gap
        gap = self._narrowed(law, arb(angle), period, over, "gap")
        return 1 if gap > 0 else -1 if gap < 0 else 0

    def _place(self, arc, period, signs):
        """Return a ball of angles that holds the impacts on an arc, about as narrow as the ball of periods allows."""
        if signs == [0, 0]:
            return between(arc.low.angle, arc.high.angle)
        # The impacts lie between the last angle where F has the sign of the lower end and the first angle where F has the sign of the
        # upper end.
        signs = [signs[0] or -signs[1], signs[1] or -signs[0]]
        place = [arc.low.angle, arc.high.angle]
        known = [float(arc.low.angle.upper()), float(arc.high.angle.lower())]
        # Angles up to which each sign may still extend.
        beyond = known[::-1]
        for _ in range(PLACES):
            for side in range(2):
                middle = (known[side] + beyond[side]) / 2
                if self._sign(arc.law, middle, period) == signs[side]:
                    known[side], place[side] = middle, arb(middle)
                else:
                    beyond[side] = middle
            if max(abs(beyond[side] - known[side]) for side in range(2)) < (known[1] - known[0]) / NEAR:
                break
        return between(*place)

    def _is_nowhere(self, law, angle, period, shares):
        """Return True if it is proved that no orbit with its impact in a ball of angles leaves the cam and stays above it. The ball
        is halved up to `shares` times."""
        balls = [angle, period]
        over, middle = self._looked_at(law, *Dual.varied(balls)), self._looked_at(law, *(Dual(one.mid(), []) for one in balls))
        for one, at in zip(over, middle):
            form = at.value + sum((slope * (ball - ball.mid()) for slope, ball in zip(one.slopes, balls)), arb(0))
            if one.value < 0 or form < 0:
                return True
        low, high = angle.lower(), angle.upper()
        halves = between(low, (low + high) / 2), between((low + high) / 2, high)
        return shares > 0 and all(self._is_nowhere(law, half, period, shares - 1) for half in halves)

    def _looked_at(self, law, angle, period):
        """Yield u, and then the gap at some moments of the flight, as duals."""
        follower, cam, speed = self.machine.follower, self.machine.cam, self.turn / period
        leaves = self._orbit(law, angle, period).leaves
        yield leaves
        position, slope = lift(law, angle)
        for part in LOOKS:
            time = period * part
            reached, _ = follower.fly(response(follower, time), position, leaves + slope * speed)
            yield reached - lift(cam, angle + time * speed)[0]

    def _graze(self, law, flight, angle, period):
        """Return the event at which the flight of an orbit touches the cam. The flight is proved to be clear of the cam, except
        during a time in which the gap is convex."""
        whole, centre = float(period.mid()), flight.centre
        gaps = [float(centre.gap(arb(whole * k / MOMENTS))) for k in range(MOMENTS + 1)]
        lowest = [k for k in range(1, MOMENTS) if gaps[k] < gaps[k - 1] and gaps[k] <= gaps[k + 1]]
        if not lowest:
            raise Undecided("a flight is not proved to be clear of the cam, and touches it nowhere")
        middle, half = whole * min(lowest, key=lambda k: gaps[k]) / MOMENTS, whole / 16
        while (lowest := flight.lowest(between(middle - half, middle + half))) is None:
            half /= 2
            if half < whole / MOMENTS / 4:
                raise Undecided("the gap is not proved to be convex where a flight may touch the cam")
        window = middle - half, middle + half
        try:
            flight.first_contact(2 * whole, period, window)
        except Refused as reason:
            raise Undecided(str(reason)) from reason

        def touching(unknowns):
            angle, period, time = unknowns
            orbit, speed, follower = self._orbit(law, angle, period), self.turn / period, self.machine.follower
            position, slope = lift(law, angle)
            reached, velocity = follower.fly(response(follower, time), position, orbit.leaves + slope * speed)
            there, rises = lift(self.machine.cam, angle + time * speed)
            return [orbit.gap, reached - there, velocity - rises * speed]

        at, found, _ = self._root(touching, [angle, period, lowest])
        return Event("graze", found, at)

    def _root(self, equations, balls):
        """Return the only root of equations in a box, in which the second unknown, or the only one, is the period. Raise Undecided if
        the root is not proved to be the only one, or not in the range of speeds."""
        wide = [ball.mid() + arb(0, ball.rad() * WIDER) for ball in balls]
        image = krawczyk(equations, wide)
        if image is None or not all(within(one, whole) for one, whole in zip(image, wide)):
            raise Undecided("an event is not proved to be the only one")
        found = closed_in(equations, image)
        at = 0 if len(balls) == 1 else 1
        if not within(found[at], balls[at]):
            raise Undecided("an event is not in the range of speeds")
        return found

