"""All roots of a system of equations in a box, by halving: every part is excluded, or holds one root, or is left undecided."""

from flint import arb, arb_mat

from .duals import Dual
from .numbers import Undecided, between, overlap, within

# Width of a part, relative to the whole box, below which it is not halved.
SMALLEST = 2.0**-32
# Most parts that are halved; the rest of the box is then undecided unless it is excluded or holds one root.
MOST = 30_000
# Factor by which boxes are widened for Krawczyk's operator, so that a root at the edge of a box is inside another.
WIDER = 1.25


def all_roots(equations, box, excluded):
    """Return (boxes that hold one root each, parts that are undecided) of a box [(low, high), ...] in doubles.

    `equations` maps a list of duals to a list of duals. `excluded` returns True for balls that are proved to hold no wanted root.
    Every wanted root lies in one of the boxes or parts. Two boxes may hold the same root, which then lies in both.
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
            # The equations cannot be evaluated over so wide a part.
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
    """Return True if the mean value form, or direct evaluation, excludes 0 in one of the equations."""
    over = equations(Dual.varied(balls))
    centre = [ball.mid() for ball in balls]
    at_centre = _values(equations, centre)
    for one, value in zip(over, at_centre):
        form = value + sum((slope * (ball - c) for slope, ball, c in zip(one.slopes, balls, centre)), arb(0))
        if not (one.value.contains(0) and form.contains(0)):
            return True
    return False


def krawczyk(equations, balls):
    """Return the image of a box under Krawczyk's operator, which holds every root in the box. Return None if the derivative has no
    inverse or the image is not finite."""
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
    """Return the only root in a box, in balls as narrow as the precision allows. Raise Undecided if it is lost in rounding."""
    for _ in range(times):
        image = krawczyk(equations, balls)
        both = [overlap(one, ball) for one, ball in zip(image, balls)] if image is not None else [None]
        if None in both:
            raise Undecided("a root is lost in rounding")
        if not any(one.rad() < ball.rad() * 0.99 for one, ball in zip(both, balls)):
            return both
        balls = both
    return balls
