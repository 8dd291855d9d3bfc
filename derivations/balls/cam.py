"""The cam: which law holds at a ball of angles, and where two laws meet."""

from bisect import bisect_right
from dataclasses import dataclass
from math import floor, tau

from flint import arb

from .numbers import Refused, Undecided, between, hull, overlap
from .profiles import pieces_of

# Starts of pieces are looked up in doubles: what lies nearer than this to a start is compared in balls.
NEAR = 1e-9


@dataclass(frozen=True)
class Corner:
    """Where one piece ends and another begins.

    `smooth` counts the derivatives, the lift being the first, that agree because of how the law is made.
    """

    angle: arb
    before: object
    after: object
    smooth: int

    def sides(self):
        """(c, c', c'') of the law before and of the law after."""
        return self.before.derivatives(self.angle)[:3], self.after.derivatives(self.angle)[:3]

    def jumps(self):
        """Law after less law before: of c, c' and c''."""
        return tuple(after - before for before, after in zip(*self.sides()))

    def bends(self):
        """Whether c'' is proved to jump."""
        return bool(abs(self.jumps()[2]) > 0)


class Cam:
    """The [cam] table, 2 pi periodic; angles may be any number, of as many revolutions as it takes."""

    def __init__(self, table):
        self.turn = 2 * arb.pi()
        # For every piece, how many derivatives agree where it begins.
        self.starts, self.laws, self.smooth = zip(*pieces_of(table))
        self.rounded = [float(start) for start in self.starts]
        self.corners = [self._corner(index, agree) for index, agree in enumerate(self.smooth) if agree is not None]

    def _corner(self, index, smooth):
        # The law of the last piece goes on to a revolution on, where the first one's corner is.
        before = Turned(self.laws[-1], -self.turn) if index == 0 else self.laws[index - 1]
        if smooth == 0:
            raise Refused(f"cam: the lift jumps at {self.starts[index].str(8)} rad")
        return Corner(self.starts[index], before, self.laws[index], smooth)

    def _piece(self, index):
        """Start, end and law of piece `index`, counted on through the revolutions, and the angle of its revolution."""
        turns, inside = divmod(index, len(self.laws))
        later, following = divmod(index + 1, len(self.laws))
        shift = turns * self.turn
        return self.starts[inside] + shift, self.starts[following] + later * self.turn, self.laws[inside], shift

    def _indices(self, low, high):
        """Pieces that may meet [low, high], doubles."""
        count = len(self.laws)

        def index(angle):
            turns = floor(angle / tau)
            return turns * count + bisect_right(self.rounded, angle - turns * tau) - 1

        return range(index(low - NEAR), index(high + NEAR) + 1)

    def parts(self, angle):
        """[(law, part of the ball on it, less whole revolutions)], for every piece that the ball may meet; and whether c and
        c' are continuous over the ball for certain."""
        parts, smooth = [], True
        for index in self._indices(float(angle.lower()), float(angle.upper())):
            start, end, law, shift = self._piece(index)
            part = overlap(angle, between(start, end))
            if part is not None:
                agree = self.smooth[index % len(self.laws)]
                smooth = smooth and (not parts or agree is None or agree >= 2)
                parts.append((law, part - shift))
        if not parts:
            raise Undecided("no piece of the cam holds an angle that is no number")
        return parts, smooth

    def piece_of(self, angle):
        """The piece that holds all of the ball, in the revolution that it is in; Undecided where the ball may meet a corner."""
        for index in self._indices(float(angle.lower()), float(angle.upper())):
            start, end, law, shift = self._piece(index)
            piece = Piece(start, end, Turned(law, shift))
            if piece.holds(angle):
                return piece
        raise Undecided(f"it is not proved on which piece of the cam the angle {angle.str(8)} lies")

    def sections(self, turns):
        """The parts of so many turns of the cam, each without a jump of its velocity inside, as pieces whose laws go on past their ends."""
        count = len(self.laws)
        jumps = [index for index, smooth in enumerate(self.smooth) if smooth is not None and smooth < 2]
        if not jumps:
            return [Piece(arb(0), turns * self.turn, self)]
        ends = [index + turn * count for turn in range(turns) for index in jumps] + [jumps[0] + turns * count]
        return [Section(self, first, after).piece() for first, after in zip(ends, ends[1:])]

    def seen(self, angle):
        """(c, c', c'', c''') over the ball, the hull of all pieces that it may meet, each over its part; and whether c and c' are
        continuous over it for certain, so that Taylor's formula holds with the hull of c''."""
        parts, smooth = self.parts(angle)
        each = [law.derivatives(part) for law, part in parts]
        return each[0] if len(each) == 1 else tuple(hull(order) for order in zip(*each)), smooth

    def derivatives(self, angle):
        """(c, c', c'', c''') over the ball."""
        return self.seen(angle)[0]

    def is_smooth(self, angle):
        """Whether c and c' are continuous over the ball for certain."""
        return self.parts(angle)[1]


@dataclass(frozen=True)
class Piece:
    """A law with the angles between which it holds, rad, of one revolution."""

    start: arb
    end: arb
    law: object

    def holds(self, angle):
        """Whether all of a ball is proved to lie between its ends."""
        return bool(angle > self.start and angle < self.end)


class Section:
    """The law of the pieces from one to the one before another, counted on through the revolutions: c and c' are continuous where these
    meet, and the first and the last of them go on past their ends."""

    def __init__(self, cam, first, after):
        self.pieces = [cam._piece(index) for index in range(first, after)]

    def piece(self):
        """The section with its ends."""
        return Piece(self.pieces[0][0], self.pieces[-1][1], self)

    def derivatives(self, angle):
        """(c, c', c'', c''') over the ball, the hull of all pieces that it may meet, each over its part."""
        each = []
        for index, (start, end, law, shift) in enumerate(self.pieces):
            low = start if index > 0 else start.min(angle.lower())
            high = end if index + 1 < len(self.pieces) else end.max(angle.upper())
            part = overlap(angle, between(low, high))
            if part is not None:
                each.append(law.derivatives(part - shift))
        return each[0] if len(each) == 1 else tuple(hull(order) for order in zip(*each))


class Turned:
    """A law some revolutions on."""

    def __init__(self, law, shift):
        self.law, self.shift = law, shift

    def derivatives(self, angle):
        """(c, c', c'', c''') over the ball."""
        return self.law.derivatives(angle - self.shift)
