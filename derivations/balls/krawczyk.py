"""Existence and uniqueness of the root of a system of equations, by Krawczyk's operator over balls."""

from flint import arb, arb_mat, ctx

from .duals import Dual
from .numbers import Refused, Undecided, within

NEWTON = 8
# Parts of its size by which a root may be off from where it was looked for.
NEAR = 1e-6
# Bits that rounding may take, and how often the box about the root is made eight times as wide.
ROUNDING, WIDENINGS = 16, 8
# Parts of the unknowns' size within which the root is tried to be shown to be alone.
ALONE = (1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 1e-4, 1e-5, 1e-6)


def _evaluated(equations, point):
    """Values, n x 1, and Jacobian, n x n, over a box."""
    found = equations(Dual.varied(point))
    return arb_mat([[one.value] for one in found]), arb_mat([one.slopes for one in found])


def inverse(jacobian):
    """About the inverse of a matrix of balls; Undecided where there may be none."""
    try:
        return jacobian.mid().inv()
    except ZeroDivisionError as error:
        raise Undecided("the equations' derivative cannot be inverted: the root may not be alone") from error


def _operator(equations, centre, value, near, radii):
    """The box about a centre, and what Krawczyk's operator makes of it: c - Y F(c) + (1 - Y F'(X)) (X - c)."""
    box = [one + arb(0, radius) for one, radius in zip(centre, radii)]
    jacobian = _evaluated(equations, box)[1]
    offsets = arb_mat([[arb(0, radius)] for radius in radii])
    one = arb_mat([[int(i == j) for j in range(len(radii))] for i in range(len(radii))])
    image = arb_mat([[c] for c in centre]) - near * value + (one - near * jacobian) * offsets
    return box, [image[row, 0] for row in range(len(radii))]


def root(equations, guess, names):
    """Balls that hold one root of the equations, one for each unknown; and the widest part of its size, of those tried, within which
    the equations have no other.

    `equations` makes a list of duals of one; the guess is doubles. Refused where no root is near the guess, or where the
    balls are too wide for a proof.
    """
    centre = [arb(value) for value in guess]
    sizes = [abs(value) if value != 0 else arb(1) for value in centre]
    last = None
    for _ in range(NEWTON):
        value, jacobian = _evaluated(equations, centre)
        step = inverse(jacobian) * value.mid()
        centre = [(one - step[row, 0]).mid() for row, one in enumerate(centre)]
        moved = max(float(abs(step[row, 0]) / sizes[row]) for row in range(len(centre)))
        if not moved < 1 or (last is not None and moved >= last):
            break
        last = moved
    for name, value, start, size in zip(names, centre, guess, sizes):
        if not abs(value - start) < size * max(NEAR, 2.0 ** (ROUNDING - ctx.prec)):
            raise Refused(f"no root of the equations lies in the box searched: {name} would have to be {value.str(8, radius=False)}, "
                          f"not {start!r}")
    value, jacobian = _evaluated(equations, centre)
    near = inverse(jacobian)
    radii = [size * arb(2) ** (ROUNDING - ctx.prec) for size in sizes]

    def proved(radii):
        """The operator's image of a box that it sends into its inside: there is one root in the box, and it is in the image."""
        box, image = _operator(equations, centre, value, near, radii)
        return image if all(within(one, whole) for one, whole in zip(image, box)) else None

    for _ in range(WIDENINGS):
        image = proved(radii)
        if image is not None:
            # The root lies in the image of every box that holds it.
            reach = [one.rad() + abs(one.mid() - c) for one, c in zip(image, centre)]
            alone = next((part for part in ALONE if proved([size * part for size in sizes]) is not None), 0.0)
            return _operator(equations, centre, value, near, reach)[1], alone
        radii = [8 * radius for radius in radii]
    raise Undecided(f"{ctx.prec} bits are too few to prove that the equations have a root")
