"""Existence and uniqueness of the root of a system of equations, by Krawczyk's operator over balls."""

from flint import arb, arb_mat, ctx

from .duals import Dual
from .numbers import Refused, Undecided, within

NEWTON = 8
# Largest distance of a root from its guess, relative to the size of the unknown.
NEAR = 1e-6
# Bits that rounding may take, and how often the box about the root is widened by a factor of eight.
ROUNDING, WIDENINGS = 16, 8
# Boxes, relative to the sizes of the unknowns, in which the root is tried to be proved the only one; widest first.
ALONE = (1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 1e-4, 1e-5, 1e-6)


def _evaluated(equations, point):
    """Return the values, n x 1, and the Jacobian, n x n, over a box."""
    found = equations(Dual.varied(point))
    return arb_mat([[one.value] for one in found]), arb_mat([one.slopes for one in found])


def inverse(jacobian):
    """Return an approximate inverse of a matrix of balls. Raise Undecided if there may be none."""
    try:
        return jacobian.mid().inv()
    except ZeroDivisionError as error:
        raise Undecided("the equations' derivative cannot be inverted: the root may not be alone") from error


def _operator(equations, centre, value, near, radii):
    """Return the box about a centre and its image under Krawczyk's operator: c - Y F(c) + (1 - Y F'(X)) (X - c)."""
    box = [one + arb(0, radius) for one, radius in zip(centre, radii)]
    jacobian = _evaluated(equations, box)[1]
    offsets = arb_mat([[arb(0, radius)] for radius in radii])
    one = arb_mat([[int(i == j) for j in range(len(radii))] for i in range(len(radii))])
    image = arb_mat([[c] for c in centre]) - near * value + (one - near * jacobian) * offsets
    return box, [image[row, 0] for row in range(len(radii))]


def root(equations, guess, names):
    """Return one ball for each unknown, which together hold exactly one root of the equations, and the widest box of ALONE in which
    the equations have no other root (0.0 if none is proved).

    `equations` maps a list of duals to a list of duals, and `guess` is in doubles. Raise Refused if no root is near the guess, and
    Undecided if the balls are too wide for a proof.
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
        """Return the image of a box if the operator sends the box into its interior, else None. Then the box holds one root, inside
        the image."""
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
