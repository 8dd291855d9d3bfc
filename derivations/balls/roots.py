"""All roots of a system of equations in a box, by halving it: every part is excluded, or holds one root, or is left undecided."""

from flint import arb, arb_mat

from .duals import Dual
from .numbers import Undecided, between, overlap, within

# Parts of the whole box that are not halved any more.
SMALLEST = 2.0**-32
# Parts that are looked at; what is left of the box then is undecided.
MOST = 30_000
# Krawczyk's operator is tried on boxes so much wider, so that a root at the edge of one is inside of another.
WIDER = 1.25


def all_roots(equations, box, excluded):
    """(boxes that hold one root each, parts that are undecided) of a box [(low, high), ...] in doubles.

    `equations` makes a list of duals of one, `excluded` says of balls whether they certainly hold no root that is wanted. Every
    root that is wanted lies in one of the boxes or of the parts; two boxes may hold the same one, and then it is in both.
    """
    sizes = [high - low for low, high in box]
    found, undecided, parts, looked_at = [], [], [list(box)], 0
    while parts:
        part, looked_at = parts.pop(), looked_at + 1
        balls = [between(low, high) for low, high in part]
        if any(all(whole.contains(ball) for whole, ball in zip(one, balls)) for one in found):
            continue
        try:
            if excluded(balls) or _misses(equations, balls):
                continue
            wide = [ball.mid() + arb(0, ball.rad() * WIDER) for ball in balls]
            image = krawczyk(equations, wide)
        except Undecided:
            # The equations say nothing of so wide a part.
            image = None
        if image is not None:
            if all(within(one, whole) for one, whole in zip(image, wide)):
                found.append(wide)
                continue
            if None in [overlap(one, ball) for one, ball in zip(image, balls)]:
                continue
        widths = [(high - low) / size for (low, high), size in zip(part, sizes)]
        widest = max(range(len(part)), key=lambda axis: widths[axis])
        if widths[widest] < SMALLEST or looked_at > MOST:
            undecided.append(balls)
            continue
        low, high = part[widest]
        for half in ((low, (low + high) / 2), ((low + high) / 2, high)):
            parts.append(part[:widest] + [half] + part[widest + 1 :])
    return found, undecided


def _values(equations, centre):
    return [one.value for one in equations(Dual.varied(centre))]


def _misses(equations, balls):
    """Whether the mean value form, or the plain one, excludes 0 in one of the equations."""
    over = equations(Dual.varied(balls))
    centre = [ball.mid() for ball in balls]
    at_centre = _values(equations, centre)
    for one, value in zip(over, at_centre):
        form = value + sum((slope * (ball - c) for slope, ball, c in zip(one.slopes, balls, centre)), arb(0))
        if not (one.value.contains(0) and form.contains(0)):
            return True
    return False


def krawczyk(equations, balls):
    """What Krawczyk's operator makes of a box: every root in the box lies in it; None where the derivative has no inverse."""
    count = len(balls)
    over = equations(Dual.varied(balls))
    centre = [ball.mid() for ball in balls]
    jacobian = arb_mat([one.slopes for one in over])
    try:
        inverse = jacobian.mid().inv()
    except ZeroDivisionError:
        return None
    step = inverse * arb_mat([[value] for value in _values(equations, centre)])
    off = arb_mat([[int(i == j) for j in range(count)] for i in range(count)]) - inverse * jacobian
    spread = off * arb_mat([[ball - c] for ball, c in zip(balls, centre)])
    image = [c - step[row, 0] + spread[row, 0] for row, c in enumerate(centre)]
    return image if all(one.is_finite() for one in image) else None


def closed_in(equations, balls, times=200):
    """The root that a box holds alone, in balls as narrow as the precision allows."""
    for _ in range(times):
        image = krawczyk(equations, balls)
        both = [overlap(one, ball) for one, ball in zip(image, balls)] if image is not None else [None]
        if None in both:
            raise Undecided("a root is lost in rounding")
        if not any(one.rad() < ball.rad() * 0.99 for one, ball in zip(both, balls)):
            return both
        balls = both
    return balls
