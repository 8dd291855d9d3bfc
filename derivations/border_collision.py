"""Piecewise-linear maps at a border, in terms of slopes or of trace and determinant.

The map is x -> A x + b mu on either side of a border. L is the side where the border's function is negative, R the other.

    line        x -> a x + mu (L, x < 0),  b x + mu (R, x > 0)
    plane       (x, y) -> (tau x + y + mu, -delta x), L where x < 0, with tau and delta of the side

Proved:

    fixed points and the orbit of period two, with the conditions for their place and their stability
    the stable orbits L^(n-1) R of the line, for n up to 7
    when the unstable manifold of the fixed point on L returns inside its stable manifold (Banerjee, Yorke and Grebogi 1998)
    the cone of directions that both sides then stretch
    for any continuous map of the plane, that one number decides where both fixed points lie
"""

import sympy as sp

from proof import Proof, main

a, b, mu, x = sp.symbols("a b mu x")
tau_L, tau_R, delta_L, delta_R = sp.symbols("tau_L tau_R delta_L delta_R")
one = sp.eye(2)


def side(tau, delta):
    """Return the matrix of the plane's normal form."""
    return sp.Matrix([[tau, 1], [-delta, 0]])


def orbit_of_the_line(n):
    """Return the points of the orbit L^(n-1) R: first the point on R, which is solved for, then the points on L."""
    point = x
    for letter in [b] + [a] * (n - 1):
        point = letter * point + mu
    first = sp.solve(point - x, x)[0]
    points = [first]
    for letter in [b] + [a] * (n - 2):
        points.append(letter * points[-1] + mu)
    return points


def line_proofs():
    for n in range(2, 8):
        first, *others = orbit_of_the_line(n)
        total = sum(a**k for k in range(n))
        yield Proof(f"L^{n - 1} R: the point on R is mu (1 + a + .. + a^{n - 1})/(1 - a^{n - 1} b)",
                    first - mu * total / (1 - a ** (n - 1) * b))
        # For 0 < a < 1 the last point on L is the nearest to the border, since the fixed point of L lies beyond the border.
        yield Proof(f"L^{n - 1} R: the last point on L is mu (1 + .. + a^{n - 2} + a^{n - 2} b)/(1 - a^{n - 1} b)",
                    others[-1] - mu * (sum(a**k for k in range(n - 1)) + a ** (n - 2) * b) / (1 - a ** (n - 1) * b))
        yield Proof(f"L^{n - 1} R: a times that is mu (b a^{n - 1} - 1 + (1 - a^{n})/(1 - a))/(1 - a^{n - 1} b)",
                    a * others[-1] - mu * (b * a ** (n - 1) - 1 + (1 - a**n) / (1 - a)) / (1 - a ** (n - 1) * b))
    # mu = 1, a > 1, b < -1: the least point of the folded interval is the image of the greatest, 1.
    fixed = 1 / (1 - a)
    yield Proof("a > 1, mu = 1: b + 1 - 1/(1 - a) = -a b/(a - 1) (1/a - 1/b - 1)",
                (b + 1 - fixed) - (-a * b / (a - 1)) * (1 / a - 1 / b - 1))


def plane_proofs():
    A_L, A_R = side(tau_L, delta_L), side(tau_R, delta_R)
    b_vector = sp.Matrix([1, 0])
    for name, A, tau, delta in (("L", A_L, tau_L, delta_L), ("R", A_R, tau_R, delta_R)):
        fixed = (one - A).inv() * b_vector
        yield Proof(f"{name}: the fixed point is at x = mu/(1 - tau + delta)", fixed[0] - 1 / (1 - tau + delta))
        yield Proof(f"{name}: det(I - A) = 1 - tau + delta and det(I + A) = 1 + tau + delta",
                    [(one - A).det() - (1 - tau + delta), (one + A).det() - (1 + tau + delta)])
    # The point on L is the fixed point of A_R A_L, and the point on R that of A_L A_R.
    on_L = (one - A_R * A_L).inv() * (A_R + one) * b_vector
    on_R = (one - A_L * A_R).inv() * (A_L + one) * b_vector
    Delta = (1 + delta_L) * (1 + delta_R) - tau_L * tau_R
    yield Proof("LR: det(I - A_L A_R) = (1 + delta_L)(1 + delta_R) - tau_L tau_R", (one - A_L * A_R).det() - Delta)
    yield Proof("LR: the point on L is at x = mu (1 + delta_R + tau_R)/det(I - A_L A_R)", on_L[0] - (1 + delta_R + tau_R) / Delta)
    yield Proof("LR: the point on R is at x = mu (1 + delta_L + tau_L)/det(I - A_L A_R)", on_R[0] - (1 + delta_L + tau_L) / Delta)
    yield Proof("LR: det(I + A_L A_R) = (1 - delta_L)(1 - delta_R) + tau_L tau_R",
                (one + A_L * A_R).det() - ((1 - delta_L) * (1 - delta_R) + tau_L * tau_R))


def homoclinic_proofs():
    """Proofs for mu = 1, tau_L > 1 + delta_L and tau_R < -(1 + delta_R), with the eigenvalues l1 > 1 > l2 > 0 of A_L."""
    l1, l2, s, t = sp.symbols("l1 l2 s t")
    of_L = {tau_L: l1 + l2, delta_L: l1 * l2}
    A_L, A_R = side(tau_L, delta_L).subs(of_L), side(tau_R, delta_R)
    b_vector = sp.Matrix([1, 0])
    saddle = (one - A_L).inv() * b_vector
    unstable, stable = sp.Matrix([1, -l2]), sp.Matrix([1, -l1])
    yield Proof("A_L (1, -l2) = l1 (1, -l2) and A_L (1, -l1) = l2 (1, -l1)",
                [A_L * unstable - l1 * unstable, A_L * stable - l2 * stable])
    on_border = saddle - unstable * saddle[0]
    first = A_L * on_border + b_vector
    yield Proof("the unstable manifold of the saddle on L folds at (1/(1 - l2), 0)", first - sp.Matrix([1 / (1 - l2), 0]))
    second = A_R * first + b_vector
    # Up to a positive factor, phi is the height above the stable manifold y = y_L - l1 (x - x_L).
    above = second[1] - (saddle[1] - l1 * (second[0] - saddle[0]))
    phi = l1 * (l1 - delta_L) + (l1 - 1) * (l1 * tau_R - delta_R)
    yield Proof("the image of the fold lies above the stable manifold just where phi > 0",
                above * (1 - l2) * (l1 - 1) - phi.subs(of_L))
    printed = delta_R - (tau_R + delta_L + delta_R - (1 + tau_R) * l1) * l1
    yield Proof("phi is delta_R - (tau_R + delta_L + delta_R - (1 + tau_R) l1) l1, as Glendinning and Simpson (2021) write it",
                phi - printed)


def cone_proofs():
    """Proofs for the directions (1, m) with -l2 <= m <= k2. The eigenvalues are l1 > 1 > l2 > 0 of A_L and -k1 < -1 < -k2 < 0 of A_R.

    Each matrix maps this cone into itself and stretches the first coordinate, at least l1-fold and k1-fold. Since m + l2 and k2 - m
    are not negative, every expression here is a sum, product or quotient of numbers of known sign.
    """
    l1, l2, k1, k2, m = sp.symbols("l1 l2 k1 k2 m")
    direction = sp.Matrix([1, m])
    on_L, on_R = side(l1 + l2, l1 * l2) * direction, side(-(k1 + k2), k1 * k2) * direction
    stretch_L, stretch_R = l1 + (m + l2), k1 + (k2 - m)
    yield Proof("A_L stretches (1, m) by l1 + (m + l2), and A_R by -(k1 + (k2 - m))", [on_L[0] - stretch_L, on_R[0] + stretch_R])
    slope_L, slope_R = on_L[1] / on_L[0], on_R[1] / on_R[0]
    yield Proof("A_L sends the slope m to -l2 + l2 (m + l2)/(l1 + (m + l2)), which is -l1 l2/(l1 + (m + l2)) < 0",
                [slope_L + l2 - l2 * (m + l2) / stretch_L, slope_L + l1 * l2 / stretch_L])
    yield Proof("A_R sends the slope m to k2 - k2 (k2 - m)/(k1 + (k2 - m)), which is k1 k2/(k1 + (k2 - m)) > 0",
                [slope_R - k2 + k2 * (k2 - m) / stretch_R, slope_R - k1 * k2 / stretch_R])
    yield Proof("tau_L - 1 - delta_L = (l1 - 1)(1 - l2) and -tau_R - 1 - delta_R = (k1 - 1)(1 - k2)",
                [(l1 + l2) - 1 - l1 * l2 - (l1 - 1) * (1 - l2), (k1 + k2) - 1 - k1 * k2 - (k1 - 1) * (1 - k2)])


def border_proofs():
    A = sp.Matrix(2, 2, sp.symbols("a11 a12 a21 a22"))
    B = sp.Matrix(sp.symbols("b1 b2"))
    e, f = sp.Matrix([sp.symbols("e1 e2")]), sp.Symbol("f")
    E = sp.Matrix(sp.symbols("E1 E2"))
    beta = lambda A, B: (e * (one - A).adjugate() * B)[0] + f * (one - A).det()  # noqa: E731
    other = (A + E * e, B + E * f)
    yield Proof("e adj(I - A) B + f det(I - A) is the same on both sides of a continuous map", beta(A, B) - beta(*other))
    fixed = (one - A).inv() * B
    yield Proof("the fixed point lies at e x + f mu = mu (e adj(I - A) B + f det(I - A))/det(I - A)",
                (e * fixed)[0] + f - beta(A, B) / (one - A).det())


def proofs():
    yield from line_proofs()
    yield from plane_proofs()
    yield from homoclinic_proofs()
    yield from cone_proofs()
    yield from border_proofs()


if __name__ == "__main__":
    main("border collision", proofs)
