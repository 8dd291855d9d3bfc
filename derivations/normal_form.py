"""The border collision of the corner map: continuity, the border, and the normal form.

There are two inputs. The first is A and B of corner_map.py, with c'' of either side. They give the rank of the difference, the border
{C, D}, and the side of the border on which each map holds. The second, for the change of coordinates, is any continuous
piecewise-linear map

    x -> A- x + B- mu  on one side of C x + D mu = 0,    A+ = A- + E C,  B+ = B- + E D,  C = e1^T (A+ - A-),

so E = (1, E2): nothing there is special to the cam. Proved:

  continuity      A+ - A- = kappa F e2 (h F) and B+ - B- = kappa F e2 v/2, kappa = -(1+r)(c''+ - c''-)/(v - c')
  region          C dx + D dT = (1+r) phi12(T/2) (c''+ - c''-) tau, tau the impact's time from the corner. With r > -1 the
                  sign of C dx + D dT is that of tau exactly where phi12(T/2) (c''+ - c''-) > 0: there A-, B- hold on
                  C dx + D dT < 0. Where the product is negative the sides change places; where it is 0 there is no border.
  B tilde         B - (A - I) e1 D/c1, the same on both sides
  companion form  W = T- O-: W A- W^-1 and W A+ W^-1 are companion matrices, C W^-1 = (1, 0)
  B bar           W B tilde; its second entry is r kappa det F phi12 (v+ phi11 det F + v phi22)/(2 phi11):
                  0 exactly where r = 0 or v+ phi11 e^{-zeta T} + v phi22 = 0 (given C1 != 0). Without damping that is
                  v+ = -v, which holds on every orbit that closes with phi12 != 0; with damping it fails.
"""

import sympy as sp

from corner_map import c1, c2, derived, p, s, spring, v
from flight import omega0_squared, propagator, zeta
from impact import r
from proof import Proof, main

minus, plus = sp.symbols("cpp_minus cpp_plus", real=True)
dx1, dx2, dT = sp.symbols("dx1 dx2 dT", real=True)

# phi_(T/2), and the factor of the difference between the maps of the two sides
F = propagator(p, s)
kappa = -(1 + r) * (plus - minus) / (v - c1)
h = sp.Matrix([[1, 0]])
e1, e2 = sp.Matrix([1, 0]), sp.Matrix([0, 1])
v_plus = (1 + r) * c1 - r * v


def sides():
    """Return A-, B-, A+, B+, C, D of the corner map."""
    A, B = derived()["A"], derived()["B"]
    A_minus, B_minus, A_plus, B_plus = A.subs(c2, minus), B.subs(c2, minus), A.subs(c2, plus), B.subs(c2, plus)
    return A_minus, B_minus, A_plus, B_plus, h * (A_plus - A_minus), (h * (B_plus - B_minus))[0]


def shifted(A, B, C, D):
    """Return B of the map in x + e1 D mu/C1. Both the point and its image move."""
    return B - (A - sp.eye(2)) * e1 * D / C[0]


def companion_coordinates(A, C):
    """Return W = T- O-, where O- = [C; C A], T- = [[1, 0], [d1, 1]] and d1 = -trace A."""
    return sp.Matrix([[1, 0], [-A.trace(), 1]]) * sp.Matrix.vstack(C, C * A)


def companion(A):
    """Return the companion form with A's characteristic polynomial."""
    return sp.Matrix([[A.trace(), 1], [-A.det(), 0]])


def general():
    """Return a continuous piecewise-linear map with free entries: A-, B-, A+, B+, C, D, E."""
    A = sp.Matrix(2, 2, sp.symbols("a11 a12 a21 a22"))
    B = sp.Matrix(sp.symbols("b1 b2"))
    C = sp.Matrix([sp.symbols("C1 C2")])
    D, E2 = sp.symbols("D E2")
    E = sp.Matrix([1, E2])
    return A, B, A + E * C, B + E * D, C, D, E


def corner_proofs():
    A_minus, B_minus, A_plus, B_plus, C, D = sides()
    yield Proof("A+ - A- = kappa F e2 (h F), of rank one", A_plus - A_minus - kappa * F * e2 * h * F)
    yield Proof("B+ - B- = kappa F e2 v/2", B_plus - B_minus - kappa * F * e2 * v / 2)
    yield Proof("A11 - A22 = 2 zeta A12, on either side", A_minus[0, 0] - A_minus[1, 1] - 2 * zeta * A_minus[0, 1])

    # tau = dtau . (dx, dT), the same for both sides
    dtau = derived()["dtau"]
    tau = dtau[0] * dx1 + dtau[1] * dx2 + dtau[2] * dT
    indicator = (C * sp.Matrix([dx1, dx2]))[0] + D * dT
    product = F[0, 1] * (plus - minus)
    yield Proof("C dx + D dT = (1 + r) phi12 (c''+ - c''-) tau", indicator - (1 + r) * product * tau)

    # On the border, tau = 0, both maps give the same image.
    on_border = {dT: sp.solve(tau, dT)[0]}
    image = (A_plus - A_minus) * sp.Matrix([dx1, dx2]) + (B_plus - B_minus) * dT
    yield Proof("the map is continuous where the impact is on the corner", image.subs(on_border))
    # The difference is a multiple of the indicator everywhere. Dividing by phi12 needs C1 != 0, as the normal form does.
    E = F * e2 / F[0, 1]
    whole = sp.Matrix.hstack(A_plus - A_minus, B_plus - B_minus) - E * sp.Matrix.hstack(C, sp.Matrix([D]))
    yield Proof("A+ - A- = E C and B+ - B- = E D with E = F e2/phi12, whose first entry is 1", [whole, E[0] - 1])


def change_proofs():
    A_minus, B_minus, A_plus, B_plus, C, D, E = general()
    mu = sp.Symbol("mu")
    point = sp.Matrix(sp.symbols("x1 x2"))
    move = e1 * D * mu / C[0]
    for name, A, B in (("-", A_minus, B_minus), ("+", A_plus, B_plus)):
        image = A * (point - move) + B * mu + move
        yield Proof(f"after the shift the {name} side is A x~ + B~ mu with B~ = B - (A - I) e1 D/C1",
                    image - A * point - shifted(A, B, C, D) * mu)
    yield Proof("C x~ = C x + D mu", (C * (point + move))[0] - (C * point)[0] - D * mu)
    yield Proof("B~ is the same on both sides", shifted(A_minus, B_minus, C, D) - shifted(A_plus, B_plus, C, D))
    W = companion_coordinates(A_minus, C)
    yield Proof("W A- = (companion of A-) W", W * A_minus - companion(A_minus) * W)
    yield Proof("W A+ = (companion of A+) W", W * A_plus - companion(A_plus) * W)
    yield Proof("W built on -C is -W", companion_coordinates(A_minus, -C) + W)
    yield Proof("C = (1, 0) W, so C bar = C W^-1 = (1, 0)", C - sp.Matrix([[1, 0]]) * W)
    lam = sp.Symbol("lambda")
    yield Proof("d1 = -trace A- and d2 = det A- are the coefficients of the characteristic polynomial",
                (lam * sp.eye(2) - A_minus).det() - (lam**2 - A_minus.trace() * lam + A_minus.det()))
    # Fixed points on either side: W's last row makes (I - A bar) x = B bar solvable in closed form.
    B_bar = W * shifted(A_minus, B_minus, C, D)
    first = (B_bar[0] + B_bar[1]) / (sp.eye(2) - A_minus).det()
    fixed = sp.Matrix([first, B_bar[1] - A_minus.det() * first])
    yield Proof("the fixed point's first coordinate is (B bar_1 + B bar_2) mu/det(I - A)",
                companion(A_minus) * fixed + B_bar - fixed)


def second_entry():
    """Return B bar_2 of the corner map, as derived and as claimed."""
    A_minus, B_minus, _, _, C, D = sides()
    B_bar = companion_coordinates(A_minus, C) * shifted(A_minus, B_minus, C, D)
    claimed = r * kappa * F.det() * F[0, 1] * (v_plus * F[0, 0] * F.det() + v * F[1, 1]) / (2 * F[0, 0])
    return B_bar[1], claimed


def closing():
    """Return the state T/2 after (q, v+) and the state T/2 before (q, v). The orbit closes if both are the same.

    The position is measured from the corner's, where the acceleration at v = 0 is -spring. The state before is solved for as the
    start of a forward flight: F start + load (p, s) = (0, v).
    """
    forward = F * sp.Matrix([0, v_plus]) - spring * sp.Matrix([p, s])
    start = F.inv() * (sp.Matrix([0, v]) + spring * sp.Matrix([p, s]))
    return forward, start


def second_entry_proofs():
    found, claimed = second_entry()
    yield Proof("B bar_2 = r kappa det F phi12 (v+ phi11 det F + v phi22)/(2 phi11)", found - claimed)

    # Without damping F preserves area, so p and s are no longer free: omega0^2 p^2 - 2 p + s^2 = 0.
    undamped = {zeta: 0}
    bound = (F.det() - 1).subs(undamped)
    yield Proof("zeta = 0: det F = 1 says omega0^2 (omega0^2 p^2 - 2 p + s^2) = 0",
                bound - omega0_squared * (omega0_squared * p**2 - 2 * p + s**2))
    forward, start = closing()
    gap = (forward - start).subs(undamped)
    # s^2 = 2 p - omega0^2 p^2 is substituted by clearing one power of s at a time
    relation = sp.Poly(s**2 - 2 * p + omega0_squared * p**2, s)

    def modulo(expression):
        numerator, denominator = sp.fraction(sp.together(sp.sympify(expression)))
        return sp.expand(sp.rem(sp.Poly(sp.expand(numerator), s), relation).as_expr()), denominator

    numerator, denominator = modulo(gap[0])
    yield Proof("zeta = 0: the orbit's two ends differ in position by phi12 (v+ + v)",
                modulo(numerator - s * (v_plus + v) * denominator)[0])
    yield Proof("zeta = 0: B bar_2 is proportional to v+ + v, so 0 on every orbit that closes with phi12 != 0",
                modulo((claimed - r * kappa * s * (v_plus + v) / 2).subs(undamped))[0])
    # The velocities are equal if the orbit closes, and opposite by the reflection of time: so both are 0.
    velocity_forward = forward[1].subs(undamped)
    velocity_start = start[1].subs(undamped)
    reflected = modulo((velocity_forward + velocity_start).subs(c1, -(1 - r) * v / (1 + r)))[0]
    yield Proof("zeta = 0 and v+ = -v: the velocities on the section before and after are opposite, so x*' = 0 where the orbit closes", reflected)


def damped_example():
    """Return (v+ phi11 det F + v phi22)/v on an orbit that closes with zeta > 0. It is not 0, so B bar_2 is not 0.

    With zeta = 1 and omega0^2 = 0, p and s at T/2 = 1 are known. The two equations of closing give v+ and spring in terms of v.
    """
    s_value = (1 - sp.exp(-2)) / 2
    p_value = (1 - s_value) / 2
    values = {zeta: 1, omega0_squared: 0, s: s_value, p: p_value}
    w, force, speed = sp.symbols("w force speed")
    Fv = F.subs(values)
    forward = Fv * sp.Matrix([0, w]) - force * sp.Matrix([p_value, s_value])
    start = Fv.inv() * (sp.Matrix([0, speed]) + force * sp.Matrix([p_value, s_value]))
    closed = sp.solve(list(forward - start), [w, force], dict=True)[0]
    return sp.simplify((w * Fv[0, 0] * Fv.det() + speed * Fv[1, 1]).subs(closed) / speed)


def proofs():
    yield from corner_proofs()
    yield from change_proofs()
    yield from second_entry_proofs()
    example = damped_example()
    yield Proof("zeta = 1, stiffness 0, T = 2: an orbit that closes has B bar_2 != 0",
                0 if example.is_zero is False and abs(example.evalf(40)) > sp.Rational(1, 10**6) else 1)


if __name__ == "__main__":
    print("(v+ phi11 det F + v phi22)/v at zeta = 1, stiffness 0, T = 2:", damped_example())
    main("normal form", proofs)
