"""Covering relations and cones of the impact map: boxes of impacts that the map stretches across each other.

An h-set is N = centre + x unstable + y stable, with x and y in ranges. A strip S is a part of N over its whole range of y. The map
f^n carries S through n impacts, which take k revolutions. S covers N if

    f^n(S) has no point with x in the range of N and y outside the range of N,
    the left edge of S goes beyond one side of N and the right edge beyond the other.

S keeps the cones |dy| <= L |dx|, and stretches the vectors in them, if with Df^n = [[a, b], [c, d]] in x and y

    a has one sign on all of S,   |c| + L |d| <= L (|a| - L |b|),   |a| - L |b| > 1.

For each sign of a, the matrices with the last two properties are a convex set. So it is enough to prove them on each box of S.
"""

from dataclasses import dataclass

from flint import arb, arb_mat, fmpq

from .motion import Flight, Start, impact
from .numbers import Refused, Undecided, between, decimal, within

# Number of halvings of a box after which its condition counts as not proved.
HALVINGS = 40


def _pair(entry, name):
    pair = entry[name]
    if not isinstance(pair, list) or len(pair) != 2:
        raise Refused(f"{name} is not a pair of numbers")
    return tuple(decimal(number) for number in pair)


def _range(entry, name):
    low, high = _pair(entry, name)
    if low > high:
        raise Refused(f"{name} is not a range")
    return low, high


@dataclass(frozen=True)
class Strip:
    """Part of N over its whole range of y, with the number of impacts and of revolutions until it returns."""

    x: tuple
    impacts: int
    revolutions: int


class HSet:
    """N and its strips from a data file. The numbers are rational, in degrees of cam angle and in m/s relative to the cam after an impact."""

    def __init__(self, entry):
        self.rpm, self.x, self.y = (_range(entry, name) for name in ("rpm", "x", "y"))
        self.centre, self.unstable, self.stable = (_pair(entry, name) for name in ("centre", "unstable", "stable"))
        slope = entry["cone_slope"]
        self.cone_slope = None if slope is None else arb(decimal(slope))
        self.strips = [Strip(_range(strip, "x"), int(strip["impacts"]), int(strip["revolutions"])) for strip in entry["strips"]]
        (a, c), (b, d) = self.unstable, self.stable
        size = a * d - b * c
        if size == 0:
            raise Refused("the two directions of N are parallel")
        degree = arb.pi() / 180
        # (rad, m/s) = middle + turned (x, y), and back.
        self.middle = arb_mat([[self.centre[0] * degree], [arb(self.centre[1])]])
        self.turned = arb_mat([[a * degree, b * degree], [arb(c), arb(d)]])
        self.back = arb_mat([[d / size / degree, arb(-b / size)], [-c / size / degree, arb(a / size)]])
        self._stands()

    def _stands(self):
        """Check what the theorem requires of N and its strips before any motion. Raise Refused otherwise. Rational numbers decide all
        of it."""
        corners = [[o + x * a + y * b for o, a, b in zip(self.centre, self.unstable, self.stable)] for x in self.x for y in self.y]
        if not min(velocity for _, velocity in corners) > 0:
            raise Refused("N contains impacts after which the follower does not leave the cam")
        angles = [angle for angle, _ in corners]
        if not max(angles) - min(angles) < 360:
            raise Refused("N is wider than a revolution")
        for strip in self.strips:
            if not (self.x[0] < strip.x[0] < strip.x[1] < self.x[1]):
                raise Refused(f"the strip of {strip.impacts} impacts is not inside N")
            if strip.impacts < 1 or strip.revolutions < 1:
                raise Refused("a strip takes at least one impact and one revolution")
        ordered = sorted(strip.x for strip in self.strips)
        if any(not before[1] < after[0] for before, after in zip(ordered, ordered[1:])):
            raise Refused("two strips of N meet")

    def entropy(self):
        """Return a lower bound, as a ball, of the entropy per revolution of the full shift on the strips. The entropy is log(lambda),
        where the sum of lambda^-k over the strips is 1 and k counts the revolutions of a strip."""
        # The sum falls from the number of strips at lambda = 1 to at most 1 where lambda is that number.
        low, high = fmpq(1), fmpq(len(self.strips))
        while high - low > fmpq(1, 2**30):
            middle = (low + high) / 2
            if sum((1 / arb(middle) ** strip.revolutions for strip in self.strips), arb(0)) > 1:
                low = middle
            else:
                high = middle
        return arb(low).log()


class Journey:
    """The starts in a box of x and y, at the speeds of an h-set, followed from impact to impact.

    Each start is `middle` + `matrix` (dx, dy, domega) + `rest`: a point, the derivative over the whole box, and the uncertainty of
    the middle. So the box is not wrapped into a box of angle and velocity at each impact.
    """

    def __init__(self, machine, h_set, box):
        self.machine, self.h_set, self.times = machine, h_set, []
        x, y, rpm = (between(*side) for side in box)
        ranges = [x, y, rpm * arb.pi() / 30]
        self.speed = ranges[2]
        self.offsets = arb_mat([[arb(0, one.rad())] for one in ranges])
        at = h_set.middle + h_set.turned * arb_mat([[one.mid()] for one in ranges[:2]])
        turned = h_set.turned
        self.matrix = arb_mat([[turned[row, 0], turned[row, 1], 0] for row in range(2)])
        self._put(at, arb_mat(2, 1))
        # Widest extent so far of the box by x, by y and by the speed, in coordinates of N.
        self.reach = [arb(0), arb(0), arb(0)]

    def _put(self, at, rest):
        """Make the middle a point: its uncertainty joins the rest."""
        self.middle = [at[row, 0].mid() for row in range(2)]
        self.rest = rest + arb_mat([[arb(0, at[row, 0].rad())] for row in range(2)])

    def go(self, horizon, known=None):
        """Go to the next impact. `known` are times that hold the first contact of each flight. If they are also proved to hold only
        one contact of every flight in the ball, this contact is the first."""
        for axis in range(3):
            column = self.h_set.back * arb_mat([[self.matrix[row, axis] * self.offsets[axis, 0]] for row in range(2)])
            self.reach[axis] = max(self.reach[axis], *(column[row, 0].abs_upper() for row in range(2)))
        off = self.matrix * self.offsets + self.rest
        # The ball is centred on `middle` itself, from which the image of the middle is computed.
        state = [arb(middle, off[row, 0].abs_upper()) for row, middle in enumerate(self.middle)]
        flight = Flight(self.machine, Start(*state, self.speed))
        time = None if known is None else flight.contact_near(known)
        time = flight.first_contact(horizon) if time is None else time
        self.times.append(time)
        there = impact(flight, time)
        by_state = arb_mat([[there.derivative[row, column] for column in range(2)] for row in range(2)])
        moved = by_state * self.matrix
        self.matrix = arb_mat([[moved[row, 0], moved[row, 1], moved[row, 2] + there.derivative[row, 2]] for row in range(2)])
        self._put(arb_mat([[there.centre.angle], [there.centre.velocity]]), by_state * self.rest)

    def seen(self, revolutions):
        """Return the image of the middle, the image of the box, and the derivative by x, y and the speed, all in coordinates of N.
        Angles are turned back by `revolutions`."""
        turns = arb_mat([[2 * arb.pi() * revolutions], [arb(0)]])
        back, at = self.h_set.back, arb_mat([[middle] for middle in self.middle])
        middle = back * (at + self.rest - turns - self.h_set.middle)
        matrix = back * self.matrix
        whole = middle + matrix * self.offsets
        return [middle[row, 0] for row in range(2)], [whole[row, 0] for row in range(2)], matrix


class Proof:
    """Proof for one strip of an h-set: it covers N and, if there are cones, keeps them."""

    def __init__(self, machine, h_set, strip):
        self.machine, self.h_set, self.strip = machine, h_set, strip
        self.growth, self.signs, self.boxes = None, set(), 0
        self.x, self.y = between(*h_set.x), between(*h_set.y)
        # A strip that returns after k revolutions has no flight of more than k + 1. The extra one allows for the width of N.
        self.horizon = (strip.revolutions + 1) * 60 / float(h_set.rpm[0])

    def prove(self):
        """Prove the strip. Raise Refused, or Undecided, with a sentence that says what fails and where."""
        sides = [set(self._pieces((edge, edge), self._beyond)) for edge in self.strip.x]
        if not (len(sides[0]) == len(sides[1]) == 1 and sides[0] != sides[1]):
            raise Refused(f"{self._name()}: the images of its edges do not lie beyond different sides of N")
        for growth in self._pieces(self.strip.x, self._covers):
            self.boxes += 1
            if growth is not None:
                self.growth = growth if self.growth is None else min(self.growth, growth)
        if len(self.signs) > 1:
            raise Refused(f"{self._name()}: the strip is folded, because a has both signs")

    def _name(self):
        return f"the strip of {self.strip.impacts} impacts"

    def _pieces(self, x, judge):
        """Yield the result of `judge` for each box of the strip. A box for which `judge` raises Refused is halved; Violated is passed on."""
        waiting = [((x, self.h_set.y, self.h_set.rpm), (), HALVINGS)]
        while waiting:
            box, known, left = waiting.pop()
            journey = Journey(self.machine, self.h_set, box)
            try:
                # The contacts of a part of a box lie within those of the box.
                for index in range(self.strip.impacts):
                    journey.go(self.horizon, known[index] if index < len(known) else None)
                yield judge(*journey.seen(self.strip.revolutions))
                continue
            except Violated:
                raise
            except Refused as reason:
                if left == 0:
                    at = ", ".join(f"{name} = {float(side[0]):.9g}" for name, side in zip(("x", "y", "rpm"), box))
                    raise Undecided(f"{self._name()}, about {at}: {reason}") from reason
            axis = max(range(3), key=lambda side: journey.reach[side])
            low, high = box[axis]
            for half in (low, (low + high) / 2), ((low + high) / 2, high):
                waiting.append(((*box[:axis], half, *box[axis + 1 :]), tuple(journey.times), left - 1))

    def _beyond(self, middle, whole, _):
        """Return the side of N, "left" or "right", beyond which the whole image lies. Raise Violated or Undecided if it does not."""
        if whole[0] < self.x.lower():
            return "left"
        if whole[0] > self.x.upper():
            return "right"
        if within(middle[0], self.x):
            raise Violated(f"{self._name()}: an edge does not go beyond N, but to x = {middle[0].str(6)}")
        raise Undecided("an edge is not proved to go beyond N")

    def _covers(self, middle, whole, matrix):
        """Return the least growth in the cones, or None if there are no cones. Raise Violated or Undecided if the conditions are not
        proved."""
        if whole[0].overlaps(self.x) and not within(whole[1], self.y):
            if within(middle[0], self.x) and not middle[1].overlaps(self.y):
                raise Violated(f"{self._name()}: its image leaves N at x = {middle[0].str(6)}, y = {middle[1].str(6)}")
            raise Undecided("the image is not proved to stay between top and bottom of N")
        slope = self.h_set.cone_slope
        if slope is None:
            return None
        a, b, c, d = (abs(matrix[row, column]) for row in range(2) for column in range(2))
        if matrix[0, 0].overlaps(arb(0)):
            raise Undecided("the sign of a is not proved")
        growth = a - slope * b
        if not (growth > 1 and c + slope * d <= slope * growth):
            raise Undecided(f"the cones are not proved to be kept: growth {growth.str(4)}")
        self.signs.add(bool(matrix[0, 0] > 0))
        return growth.lower()


class Violated(Refused):
    """The opposite of what was to be proved is proved."""
