"""The cam: the law that holds at a ball of angles, and the corners at which two laws meet."""

from bisect import bisect_right
from dataclasses import dataclass
from math import floor, tau

from flint import arb, ctx

from .numbers import Refused, Undecided, between, hull, overlap
from .profiles import pieces_of

# Starts of pieces are looked up in doubles. An angle that is nearer than this to a start, rad, is compared in balls.
NEAR = 1e-9
# Most parts of a turn that are examined at once for the lowest lift. Bits of the lift that rounding may take, fewest first.
MOST_PARTS, ROUNDED = 1000, (3, 6, 12, 24)


@dataclass(frozen=True)
class Corner:
    """Angle at which one piece ends and the next begins.

    `smooth` counts the derivatives that agree because of how the law is made. The lift counts as the first.
    """

    angle: arb
    before: object
    after: object
    smooth: int

    def sides(self):
        """Return (c, c', c'') of the law before and of the law after."""
        return self.before.derivatives(self.angle)[:3], self.after.derivatives(self.angle)[:3]

    def jumps(self):
        """Return the jumps of c, c' and c'': law after minus law before."""
        return tuple(after - before for before, after in zip(*self.sides()))

    def bends(self):
        """Return True if c'' is proved to jump."""
        return bool(abs(self.jumps()[2]) > 0)


class Cam:
    """The [cam] table, with period 2 pi. Angles may lie in any revolution."""

    def __init__(self, table):
        self.turn = 2 * arb.pi()
        # Number of derivatives that agree at the start of each piece; None if no two laws meet there.
        self.starts, self.laws, self.smooth = zip(*pieces_of(table))
        self.rounded = [float(start) for start in self.starts]
        self.corners = [self._corner(index, agree) for index, agree in enumerate(self.smooth) if agree is not None]

    def _corner(self, index, smooth):
        # The last piece meets the first one a revolution later, so its law is turned back by a revolution.
        before = Turned(self.laws[-1], -self.turn) if index == 0 else self.laws[index - 1]
        if smooth == 0:
            raise Refused(f"cam: the lift jumps at {self.starts[index].str(8)} rad")
        return Corner(self.starts[index], before, self.laws[index], smooth)

    def _piece(self, index):
        """Return start, end and law of piece `index`, counted on through the revolutions, and the angle of its revolution."""
        turns, inside = divmod(index, len(self.laws))
        later, following = divmod(index + 1, len(self.laws))
        shift = turns * self.turn
        return self.starts[inside] + shift, self.starts[following] + later * self.turn, self.laws[inside], shift

    def _indices(self, low, high):
        """Return the indices of the pieces that may meet [low, high], in doubles."""
        count = len(self.laws)

        def index(angle):
            turns = floor(angle / tau)
            return turns * count + bisect_right(self.rounded, angle - turns * tau) - 1

        return range(index(low - NEAR), index(high + NEAR) + 1)

    def parts(self, angle):
        """Return [(law, part of the ball on it, less whole revolutions)] for every piece that the ball may meet, and True if c and c'
        are proved continuous over the ball."""
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
        """Return the piece that holds the whole ball, turned to the ball's revolution. Raise Undecided if the ball may meet a corner."""
        for index in self._indices(float(angle.lower()), float(angle.upper())):
            start, end, law, shift = self._piece(index)
            piece = Piece(start, end, Turned(law, shift))
            if piece.holds(angle):
                return piece
        raise Undecided(f"it is not proved on which piece of the cam the angle {angle.str(8)} lies")

    def lowest(self):
        """Return a ball that holds the lowest lift, about as narrow as rounding allows. Raise Undecided if none is found."""
        found = (self._lowest(arb(2) ** (bits - ctx.prec)) for bits in ROUNDED)
        lowest = next((one for one in found if one is not None), None)
        if lowest is None:
            raise Undecided("the lowest lift of the cam, where the preload is, is not decided")
        return lowest

    def _lowest(self, smallest):
        """Return the lowest lift as a ball, to about `smallest` times the size of the lift. Parts of a turn are halved until none of
        them can improve the bounds. Return None if that takes too many parts."""
        # Each part has its piece and its two ends, which are points.
        parts = [(piece, piece[0].lower(), piece[1].upper()) for piece in map(self._piece, range(len(self.laws)))]
        some = [law.derivatives(angle)[0] for start, end, law, _ in map(self._piece, range(len(self.laws))) for angle in (start, (start + end) / 2)]
        size, most, least = hull(some).abs_upper(), min(one.upper() for one in some), []
        while parts:
            seen = []
            for (start, end, law, _), low, high in parts:
                over, middle = between(low, high), ((low + high) / 2).mid()
                (lift, *_, third), (at, slope, curvature, _) = law.derivatives(over), law.derivatives(middle)
                # Taylor's formula or direct evaluation, whichever is better: the lift may be as flat as a dwell at either end of a rise.
                off = over - middle
                form = at + off * (slope + off / 2 * (curvature + off / 3 * third))
                seen.append((middle, lift.lower().max(form.lower())))
                if middle > start and middle < end:
                    most = most.min(at.upper())
            halves = []
            for (piece, low, high), (middle, lower) in zip(parts, seen):
                if lower >= most - size * smallest or not high - low > smallest:
                    least.append(lower)
                else:
                    halves += [(piece, low, middle), (piece, middle, high)]
            if len(halves) > MOST_PARTS + len(self.laws):
                return None
            parts = halves
        return between(min(least), most)

    def sections(self, turns):
        """Return the parts of `turns` turns of the cam between jumps of its velocity. Each is a piece whose law is continued past its
        ends."""
        count = len(self.laws)
        jumps = [index for index, smooth in enumerate(self.smooth) if smooth is not None and smooth < 2]
        if not jumps:
            return [Piece(arb(0), turns * self.turn, self)]
        ends = [index + turn * count for turn in range(turns) for index in jumps] + [jumps[0] + turns * count]
        return [Section(self, first, after).piece() for first, after in zip(ends, ends[1:])]

    def seen(self, angle):
        """Return (c, c', c'', c''') over the ball, and True if c and c' are proved continuous over it. The derivatives are the hull
        over all pieces that the ball may meet, each over its part. If c and c' are continuous, Taylor's formula holds with the hull
        of c''."""
        parts, smooth = self.parts(angle)
        each = [law.derivatives(part) for law, part in parts]
        return each[0] if len(each) == 1 else tuple(hull(order) for order in zip(*each)), smooth

    def derivatives(self, angle):
        """(c, c', c'', c''') over the ball."""
        return self.seen(angle)[0]

    def is_smooth(self, angle):
        """Return True if c and c' are proved continuous over the ball."""
        return self.parts(angle)[1]


@dataclass(frozen=True)
class Piece:
    """Law with the angles between which it holds, rad, in one revolution."""

    start: arb
    end: arb
    law: object

    def holds(self, angle):
        """Return True if the whole ball is proved to lie between the ends."""
        return bool(angle > self.start and angle < self.end)


class Section:
    """Law of consecutive pieces, from index `first` up to but without `after`, counted on through the revolutions. c and c' are
    continuous between them, and the first and the last piece are continued past their ends."""

    def __init__(self, cam, first, after):
        self.pieces = [cam._piece(index) for index in range(first, after)]

    def piece(self):
        """Return the section as a piece with its ends."""
        return Piece(self.pieces[0][0], self.pieces[-1][1], self)

    def derivatives(self, angle):
        """(c, c', c'', c''') over the ball: the hull over all pieces that it may meet, each over its part."""
        each = []
        for index, (start, end, law, shift) in enumerate(self.pieces):
            low = start if index > 0 else start.min(angle.lower())
            high = end if index + 1 < len(self.pieces) else end.max(angle.upper())
            part = overlap(angle, between(low, high))
            if part is not None:
                each.append(law.derivatives(part - shift))
        return each[0] if len(each) == 1 else tuple(hull(order) for order in zip(*each))


class Turned:
    """Law turned on by whole revolutions."""

    def __init__(self, law, shift):
        self.law, self.shift = law, shift

    def derivatives(self, angle):
        """(c, c', c'', c''') over the ball."""
        return self.law.derivatives(angle - self.shift)
