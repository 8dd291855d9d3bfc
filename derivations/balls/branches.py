"""The number and the kinds of the orbits of one impact in one revolution, at every speed of a range.

With c, c' and f(c) at the impact's angle and p, s, s' after the period T, Newton's law gives the velocity after the impact, and the
flight with that velocity ends on the cam where F is 0:

    (1 + r s') v = (1 + r) c' omega - r s f,      F = (1 + r) omega s c' - N f,      N = r s^2 - (1 + r s') p.

The angle enters by the direction of (c', f) alone, which turns with W = c'' f + w0^2 c'^2. So on an *arc*, a part of the cam on which
neither W nor f changes sign, there is at most one such orbit at any speed, and one just where F has different signs at its ends.
What is left to decide is where a speed has F = 0 at an end of an arc, a *fold* (W = 0) or a *corner impact*; where the flight of the
orbit *grazes* the cam (g = g' = 0); and where its kind changes. With M the derivative of the impact map and u = v - c' omega,

    det M = r^2 e^(-2 zeta T),    det(I - M) = -(omega r/u) dF/dtheta,    det(I + M) = 2 (1 + det M) - det(I - M),

so that the kind changes at an end of the arc, or where H = 2 (1 + det M) u + omega r dF/dtheta is 0: a *flip*.

Ranges of speeds are halved until there is nothing to decide, or one event: its equations have one root in the range by Krawczyk's
operator, and what there is at either end of the range is there up to the event.
"""

from dataclasses import dataclass

from flint import arb, ctx

from .duals import Dual, lift, response
from .motion import Flight, Start
from .numbers import Excluded, Refused, Undecided, between, hull, overlap, within
from .roots import all_roots, closed_in, krawczyk

# Ranges of speeds are not halved below this width, rpm; below the other one, events are looked for in them.
SMALLEST, NARROW = 2.0**-14, 1.0
# Ranges of speeds that are looked at for one arc, and parts of the whole one that are not halved further for an arc that is not
# clear; what is left of them then is undecided. Fewer bits than these decide little.
MOST, UNCLEAR, FEWEST_BITS = 2000, 64, 53
# Parts of a flight at which it is looked at for being inside of the cam.
LOOKS = tuple(part / 16 for part in (1, 3, 5, 7, 8, 9, 11, 13, 15))
# How often an arc is halved to show that none of it holds an impact, and to find where it may.
SHARES, PLACES = 6, 50
# To how many parts of itself the ends of a ball of angles are found.
NEAR = 8
# Moments of a flight among which the lowest is looked for.
MOMENTS = 256
# What becomes of an orbit where its kind is not decided, and where nothing is.
ORBIT, UNDECIDED = "orbit", "undecided"
# Krawczyk's operator is tried on boxes so much wider than what holds the root.
WIDER = 1.25


@dataclass(frozen=True)
class End:
    """Where two arcs meet: the angle, and what happens to an orbit whose impact comes here; None where nothing does."""

    angle: arb
    event: str


@dataclass(frozen=True)
class Arc:
    """A part of the cam with its law; `is_clear` where it is proved that neither W nor f changes sign on it."""

    low: End
    high: End
    law: object
    is_clear: bool


@dataclass(frozen=True)
class Event:
    """At one speed the orbit of an arc appears, vanishes or changes its kind."""

    kind: str
    period: arb
    angle: arb
    end: End = None

    def is_same(self, other, turn):
        """Whether both are what happens at one end of two arcs, perhaps a turn apart."""
        ends = self.end is not None and other is not None and other.end is not None
        return ends and any((self.end.angle + turns * turn).overlaps(other.end.angle) for turns in (-1, 0, 1))


@dataclass(frozen=True)
class Orbit:
    """F, u and H of a dual angle and period."""

    gap: Dual
    leaves: Dual
    flips: Dual

    def flip(self):
        """What is 0 at a flip."""
        return [self.gap, self.flips]


@dataclass(frozen=True)
class Stretch:
    """From one speed to the next, rpm: the kinds of all orbits there, and the event that it begins with."""

    low: arb
    high: arb
    kinds: list
    event: Event


class Branches:
    """The orbits of one impact of a machine, by the arcs of its cam."""

    def __init__(self, machine):
        self.machine, self.turn = machine, machine.cam.turn
        follower = machine.follower
        if not follower.restitution > 0:
            raise Refused("a follower without restitution does not leave the cam")
        if follower.restitution == 1 and follower.zeta == 0:
            raise Refused("a follower without loss has orbits that are neither stable nor unstable")
        self.arcs = [arc for section in self._sections() for arc in self._arcs(*section)]

    def _sections(self):
        """(start, end, law) of the parts of the cam inside of which c'' does not jump."""
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
        """The arcs of a section, cut where W is 0."""
        follower = self.machine.follower
        _, slope, curvature, _ = law.derivatives(between(low.angle, high.angle))
        if slope == 0 and curvature == 0:
            # A dwell: the follower comes back to a height from which it fell with less velocity, if any, than it left with, and
            # r v- = -v+ says that it does with more.
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
                # Two boxes may hold the same root, and one that cannot be told from an end counts as part of it.
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
        """What becomes of the orbits from one speed, rpm, to another, as stretches by rising speed, none left out."""
        if ctx.prec < FEWEST_BITS:
            raise Refused(f"bits = {ctx.prec}: a range of speeds needs at least {FEWEST_BITS}")
        courses = [self._course(arc, low, high) for arc in self.arcs]
        cuts = []
        for start, _, event in sorted((turn for course in courses for turn in course), key=lambda turn: float(turn[0])):
            if cuts and start.overlaps(cuts[-1][0]):
                # An end of two arcs is one event, and undecided ranges may begin together.
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
        """[(speed from which on, rpm, what becomes of the orbit of an arc, event there if there is one)], by rising speed."""
        found, parts = [], [(low, high)]

        def add(start, kind, event=None):
            if event is not None or not found or found[-1][1] != kind:
                found.append((start, kind, event))

        # An arc on which there may be several orbits can at best be shown to hold none.
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
        """(what is there before, event, what is there after) of a range with one event, or (what is there, None, the same)."""
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
        # F rises along the arc where its sign at the upper end is 1, or at the lower one -1.
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
        """F and H and u of a dual angle and period."""
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
        """A number over a box, by the mean value form too; `over` is it with its derivatives over the box."""
        middle = angle.mid(), period.mid()
        at = getattr(self._orbit(law, *(Dual(one, []) for one in middle)), name).value
        form = at + sum((slope * (ball - m) for slope, ball, m in zip(over.slopes, (angle, period), middle)), arb(0))
        return overlap(over.value, form)

    def _sign(self, law, angle, period):
        """The sign of F at an angle and a ball of periods; 0 where it is not proved."""
        over = self._orbit(law, *Dual.varied([arb(angle), period])).gap
        gap = self._narrowed(law, arb(angle), period, over, "gap")
        return 1 if gap > 0 else -1 if gap < 0 else 0

    def _place(self, arc, period, signs):
        """A ball of angles that holds the impacts of an arc, as narrow as the ball of periods lets it be."""
        if signs == [0, 0]:
            return between(arc.low.angle, arc.high.angle)
        # Between the last angle where F has the sign of one end and the first where it has that of the other.
        signs = [signs[0] or -signs[1], signs[1] or -signs[0]]
        place = [arc.low.angle, arc.high.angle]
        known = [float(arc.low.angle.upper()), float(arc.high.angle.lower())]
        # How far beyond what is known it may still be found.
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
        """Whether from none of a ball of angles an orbit leaves the cam and stays outside of it on its way."""
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
        """u, and the gap at some moments of the flight."""
        follower, cam, speed = self.machine.follower, self.machine.cam, self.turn / period
        leaves = self._orbit(law, angle, period).leaves
        yield leaves
        position, slope = lift(law, angle)
        for part in LOOKS:
            time = period * part
            reached, _ = follower.fly(response(follower, time), position, leaves + slope * speed)
            yield reached - lift(cam, angle + time * speed)[0]

    def _graze(self, law, flight, angle, period):
        """The event in which the flight of an orbit touches the cam: it is clear of it but for a time over which the gap is convex."""
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
        """The one root of equations in a box, the second of which, or the only one, is the period."""
        wide = [ball.mid() + arb(0, ball.rad() * WIDER) for ball in balls]
        image = krawczyk(equations, wide)
        if image is None or not all(within(one, whole) for one, whole in zip(image, wide)):
            raise Undecided("an event is not proved to be the only one")
        found = closed_in(equations, image)
        at = 0 if len(balls) == 1 else 1
        if not within(found[at], balls[at]):
            raise Undecided("an event is not in the range of speeds")
        return found

