"""The paper's equations as printed, each proved or disproved, and the smallest repair of those that fail.

An equation is given as a residual that takes a set of repairs. With none, it is what the paper prints. With all, it must vanish
identically. With any proper subset it must not vanish, so that no smaller repair is enough. Residuals that vanish do so exactly, by
computer algebra. Those that do not are also evaluated at one rational point to 20 digits.

The reference is flight.py's flow, impact.py's restitution and corner_map.py's derivatives. For an intermediate formula it is the
derivative that the formula claims to be. Here x is measured from the equilibrium as in the paper, the stiffness is not 0, and phi_t
is known by its derivative and the group law, so that every damping is included.

    verdict "holds"      true as printed
            "misprint"   false as printed, but the paper continues with the repaired form
            "refuted"    false, and the paper continues with it
"""

import argparse
import json
from dataclasses import dataclass, field
from itertools import combinations

import sympy as sp

import corner_map
import normal_form
from corner_map import Curvature, Lift, Slope, T, cam
from flight import Cosine, G, Sine, UNDER, group_law, omega0_squared, omega_s, phi, t, zeta
from impact import R, r, restitution
from proof import Proof, main, vanishes

I = sp.eye(2)
h = sp.Matrix([[1, 0]])
half = T / 2
t_i = sp.Symbol("t_i", real=True)
u = sp.Symbol("u", real=True)
x = sp.Matrix(sp.symbols("x1 x2", real=True))
q, v, c1, c2, g, c = sp.symbols("q v c1 c2 g c", real=True)


@dataclass(frozen=True)
class Equation:
    """Printed equation. `residual(repairs)` is 0 if the equation is true."""

    label: str
    statement: str
    residual: object
    verdict: str = "holds"
    repair: str = ""
    repairs: tuple = ()
    note: str = ""
    values: dict = field(default_factory=dict)


# ---- the paper's letters ------------------------------------------------------------------------------------------------


def dphi(time):
    """Return phi' at a time."""
    return phi(u).diff(u).subs(u, time)


def y(time):
    """Return (c, c') at a time."""
    return cam(time)


def dy(time):
    """Return y', the derivative by time."""
    return cam(u).diff(u).subs(u, time)


def dy_dT(time):
    """Return the derivative of y by the period as the paper prints it."""
    velocity, acceleration = dy(time)
    return sp.Matrix([-time / T * velocity, -velocity / T - time / T * acceleration])


def map_printed(state):
    """Return the map of eq:lmap."""
    return phi(half) * ((I + phi(t_i) * R * phi(-t_i)) * phi(half) * state - phi(t_i) * R * y(-t_i))


def gap_printed(state):
    """Return H below eq:lmap."""
    return (h * (phi(half - t_i) * state - y(-t_i)))[0]


# ---- reduction to letters: phi_(T/2) = f0 I + f1 N, phi_(t_i) = k0 I + k1 N, N = G + zeta I ------------------------------

f0, f1, k0, k1, l0, l1, l2 = sp.symbols("f0 f1 k0 k1 l0 l1 l2", real=True)


def letters(expression):
    """Return an expression in the values of phi at T/2 and t_i and of the cam at -t_i. The result is rational in them."""
    pairs = {half - t_i: (half, -t_i), half + t_i: (half, t_i), T: (half, half)}
    expression = group_law(group_law(expression, pairs), {-t_i: (t_i, None)})
    angle = -2 * sp.pi * t_i / T
    table = {Cosine(half): f0, Sine(half): f1, Cosine(t_i): k0, Sine(t_i): k1}
    table |= {Lift(angle): l0, Slope(angle): l1, Curvature(angle): l2}
    return expression.subs(table)


def at_corner(expression):
    """Return an expression at t_i = 0, in the same letters."""
    expression = expression.subs(t_i, 0)
    table = {Cosine(T): f0**2 + (zeta**2 - omega0_squared) * f1**2, Sine(T): 2 * f0 * f1}
    table |= {Cosine(half): f0, Sine(half): f1, Cosine(0): 1, Sine(0): 0, Lift(0): l0, Slope(0): l1, Curvature(0): l2}
    return expression.subs(table)


F = f0 * I + f1 * (G + zeta * I)
# A rational point, under-damped. Values that are not listed are computed from it.
POINT = {
    zeta: sp.Rational(3, 5), omega0_squared: sp.Rational(17, 4), T: sp.Rational(7, 5), t_i: sp.Rational(3, 20),
    r: sp.Rational(7, 10), x[0]: sp.Rational(-2, 7), x[1]: sp.Rational(11, 13), l0: sp.Rational(1, 3), l1: sp.Rational(2, 9),
    l2: sp.Rational(-5, 6), q: sp.Rational(1, 5), v: sp.Rational(-13, 8), c1: sp.Rational(4, 7), c2: sp.Rational(-9, 11),
    g: sp.Rational(49, 5), c: sp.Rational(1, 6), t: sp.Rational(2, 3),
}  # fmt: skip


def computed():
    """Return phi's letters at POINT, to 60 digits."""
    shape = {omega_s: sp.sqrt(POINT[omega0_squared] - POINT[zeta] ** 2), zeta: POINT[zeta]}
    values = {}
    for cosine, sine, time in ((f0, f1, POINT[T] / 2), (k0, k1, POINT[t_i])):
        values[cosine] = UNDER[0].subs({**shape, t: time}).evalf(60)
        values[sine] = UNDER[1].subs({**shape, t: time}).evalf(60)
    return values


# ---- the flow, the impact, the map --------------------------------------------------------------------------------------


def flow(repairs):
    cosine, sine = sp.cos(omega_s * t), sp.sin(omega_s * t)
    w0_squared = zeta**2 + omega_s**2
    matrix = sp.Matrix([[zeta, 1], [-w0_squared, -zeta]]) / omega_s
    first = sp.exp(-zeta * t) * (I * cosine + matrix * sine)
    second = sp.exp(-zeta * t) / omega_s * sp.Matrix([
        [omega_s * cosine + zeta * sine, sine],
        [-w0_squared * sine, omega_s * cosine - zeta * sine],
    ])
    field_ = G.subs(omega0_squared, w0_squared)
    return [first.diff(t) - field_ * first, first.subs(t, 0) - I, first - second]


def gravity_shift(repairs):
    """Residual of: q = [x]_1 - g/omega0^2 in m q'' + b q' + k q = -m g gives x' = G x."""
    state = sp.Matrix([q + g / omega0_squared, v])
    return sp.Matrix([v, -2 * zeta * v - omega0_squared * q - g]) - G * state


def gap_meaning(repairs):
    shift = g / omega0_squared
    return (q + shift) - (c + shift if "shift" in repairs else c) - (q - c)


def restitution_law(repairs):
    state, surface = sp.Matrix([q, v]), sp.Matrix([q, c1])
    return state + R * (state - surface) - sp.Matrix([q, (1 + r) * c1 - r * v])


def zero_time_map(repairs):
    back = phi(-t_i) * x
    stepwise = phi(t_i) * (back + R * (back - y(-t_i)))
    return letters((I + phi(t_i) * R * phi(-t_i)) * x - phi(t_i) * R * y(-t_i) - stepwise)


def composition(repairs):
    flown = phi(half + t_i) * restitution(phi(half - t_i) * x, y(-t_i))
    return letters(map_printed(x) - flown)


def implicit_condition(repairs):
    """Residual of: H below eq:lmap is the gap of eq:H at -t_i, of the flight that reaches t = 0 as if there were no impact."""
    arrived = phi(half) * x
    return letters(gap_printed(x) - (h * (phi(-t_i) * arrived - y(-t_i)))[0])


def fixed_point(repairs):
    sign = -1 if "sign" in repairs else 1
    y0 = sp.Matrix([l0, 2 * sp.pi / T * l1])
    solved = -((I - F * F + sign * F * R * F).inv()) * F * R * y0
    return at_corner(map_printed(x)).subs(dict(zip(x, solved))) - solved


# ---- derivatives --------------------------------------------------------------------------------------------------------


def chain(variable):
    def residual(repairs):
        implicit = sp.Function("t_i")(x[0], x[1], T)
        total = map_printed(x).subs(t_i, implicit).diff(variable)
        printed = map_printed(x).diff(variable) + map_printed(x).diff(t_i) * implicit.diff(variable)
        return sp.expand(total - printed.subs(t_i, implicit))

    return residual


def dP_dx(repairs):
    inner = phi(t_i) * R * phi(-t_i) if "order" in repairs else phi(-t_i) * R * phi(t_i)
    return letters(map_printed(x).jacobian(x) - phi(half) * (I + inner) * phi(half))


def dP_dti(repairs):
    first, second = dphi(t_i) * R * phi(-t_i), phi(t_i) * R * dphi(-t_i)
    rest = -dphi(t_i) * R * y(-t_i) + phi(t_i) * R * dy(-t_i)
    if "brackets" in repairs:
        printed = phi(half) * ((first - second) * phi(half) * x + rest)
    else:
        # A matrix less a vector, which sympy refuses.
        printed = phi(half) * (first - second * phi(half) * x + rest)
    return letters(map_printed(x).diff(t_i) - printed)


def dti_dx(repairs):
    by_time = -(h * (dphi(half - t_i) * x - dy(-t_i)))[0]
    by_state = h * phi(half - t_i)
    gradient = sp.Matrix([gap_printed(x)]).jacobian(x)
    # dt_i/dx from these keeps H at 0.
    stays = gradient + gap_printed(x).diff(t_i) * (-by_state / by_time)
    return [letters(gap_printed(x).diff(t_i) - by_time), letters(gradient - by_state), letters(stays)]


def corner_terms():
    """Return the bracket and h (phi' x - y0'), which eq:ftaylormapcornerX and T share, with phi_0' = G."""
    y0, dy0, flown = y(0), dy(0), phi(half) * x
    bracket = (R * G - G * R) * flown + G * R * y0 - R * dy0
    return bracket, (h * (dphi(half) * x - dy0))[0]


def linearised(variable):
    """Return dP/dx or dP/dT by implicit differentiation of eq:lmap and H, at t_i = 0."""
    P, H = map_printed(x), gap_printed(x)
    return at_corner(P.diff(variable) - P.diff(t_i) * H.diff(variable) / H.diff(t_i))


def taylor_x(repairs):
    bracket, rate = corner_terms()
    sign = -1 if "sign" in repairs else 1
    printed = at_corner(phi(half) * ((I + R) + sign * bracket * h / rate) * phi(half))
    return sp.Matrix.hstack(linearised(x[0]), linearised(x[1])) - printed


def period_derivative(repairs):
    angle = -2 * sp.pi * u / T
    residual = cam(u).diff(T) - dy_dT(u)
    return residual.subs(u, -t_i).subs({Slope(angle.subs(u, t_i)): l1, Curvature(angle.subs(u, t_i)): l2})


def dP_dT(repairs):
    whole, before, after = dphi(T), half - t_i, half + t_i
    printed = (whole + dphi(after) * R * phi(before) / 2 + phi(after) * R * dphi(before) / 2) * x
    printed -= dphi(after) * R * y(-t_i) / 2 + phi(after) * R * dy_dT(-t_i)
    return letters(map_printed(x).diff(T) - printed)


def dti_dT(repairs):
    by_period = (h * (dphi(half - t_i) * x / 2 - dy_dT(-t_i)))[0]
    by_time = -(h * (dphi(half - t_i) * x - dy(-t_i)))[0]
    stays = gap_printed(x).diff(T) + gap_printed(x).diff(t_i) * (-by_period / by_time)
    return [letters(gap_printed(x).diff(T) - by_period), letters(gap_printed(x).diff(t_i) - by_time), letters(stays)]


def taylor_T(repairs):
    bracket, rate = corner_terms()
    sign = -1 if "sign" in repairs else 1
    direct = (dphi(T) + dphi(half) * R * phi(half) / 2 + phi(half) * R * dphi(half) / 2) * x
    direct -= dphi(half) * R * y(0) / 2 + phi(half) * R * dy_dT(0)
    moved = phi(half) * bracket * (h * (dphi(half) * x / 2 - dy_dT(0)))[0] / rate
    return linearised(T) - at_corner(direct + sign * moved)


# ---- A and B ------------------------------------------------------------------------------------------------------------


def derived():
    """Return A and B of corner_map.py in the paper's letters."""
    table = {corner_map.p: (1 - f0 - zeta * f1) / omega0_squared, corner_map.s: f1, corner_map.spring: omega0_squared * q}
    return corner_map.derived()["A"].subs(table), corner_map.derived()["B"].subs(table)


STIFFENING = 2 * zeta * c1 + c2 + omega0_squared * q


def eq_A(repairs):
    jump = sp.Matrix([[-r, 0], [-(1 + r) * STIFFENING / (v - c1), -r]])
    return derived()[0] - F * jump * F


def eq_B(repairs):
    rate = G * F
    acceleration = -2 * zeta * v - omega0_squared * q
    first = rate if "phi' in the first term" in repairs else F
    second = F if "phi in the second term" in repairs else rate
    sign = -1 if "minus before the third term" in repairs else 1
    printed = first * sp.Matrix([q, -r * v + (1 + r) * c1]) / 2
    printed += second * sp.Matrix([v, -r * acceleration - 2 * (1 + r) / T * c1]) / 2
    printed += sign * F * (1 + r) * v / (v - c1) * sp.Matrix([v - c1, STIFFENING]) / 2
    return derived()[1] - printed


def taylor_closed_form(repairs):
    """Residual of: the derivatives of eq:lmap with F x = (q, v) and c = q are A and B. eq:ftaylormapcornerX and T, repaired, are
    these derivatives."""
    start = dict(zip(x, F.inv() * sp.Matrix([q, v])))
    corner = {l0: q, l1: c1 * T / (2 * sp.pi), l2: c2 * (T / (2 * sp.pi)) ** 2}
    A, B = derived()
    found_A = sp.Matrix.hstack(linearised(x[0]), linearised(x[1])).subs(start).subs(corner)
    return [found_A - A, linearised(T).subs(start).subs(corner) - B]


def no_acceleration(repairs):
    return len(map_printed(x).atoms(Curvature)) + len(gap_printed(x).atoms(Curvature))


def continuity(repairs):
    A_minus, B_minus, A_plus, B_plus, C, D = normal_form.sides()
    on_border = {normal_form.dT: -(C[0] * normal_form.dx1 + C[1] * normal_form.dx2) / D}
    dx = sp.Matrix([normal_form.dx1, normal_form.dx2])
    return ((A_plus - A_minus) * dx + (B_plus - B_minus) * normal_form.dT).subs(on_border)


# ---- the region: a statement about order rather than equality -----------------------------------------------------------


def region(repairs):
    """Residual of: C dx + D dT is a positive multiple of the impact's time. The factor (1+r) phi12 (c''+ - c''-) need not be
    positive.

    As printed, the sign of the factor is left out. The repaired indicator is divided by the factor.
    """
    _, _, _, _, C, D = normal_form.sides()
    dtau = corner_map.derived()["dtau"]
    multiple = (1 + r) * corner_map.s * (normal_form.plus - normal_form.minus)
    indicator = [C[0], C[1], D]
    if "factor" in repairs:
        indicator = [entry / multiple for entry in indicator]
    # The same letter for phi12(T/2) as elsewhere.
    table = {corner_map.s: f1, corner_map.p: (1 - f0 - zeta * f1) / omega0_squared}
    return [sp.cancel((entry - time).subs(table)) for entry, time in zip(indicator, dtau)]


# ---- normal form --------------------------------------------------------------------------------------------------------

A_, B_, A_plus_, B_plus_, C_, D_, E_ = normal_form.general()
GENERAL = dict(zip([*A_, *B_, *C_, D_, E_[1]], map(sp.Rational, ("3/7", "-2/5", "5/3", "1/4", "7/2", "-9/4", "-3/8", "5/6", "11/3", "4/9"))))


def shift_as_printed(A, B):
    """Return b - (first column of A) d/c1."""
    return B - A[:, 0] * D_ / C_[0]


def b_tilde(repairs):
    printed = shift_as_printed(A_, B_)
    if "image" in repairs:
        printed += sp.Matrix([D_ / C_[0], 0])
    return printed - normal_form.shifted(A_, B_, C_, D_)


def b_tilde_sides(repairs):
    return shift_as_printed(A_, B_) - shift_as_printed(A_plus_, B_plus_)


def coordinates(repairs):
    W = normal_form.companion_coordinates(A_, C_)
    moved = W * A_ * W.inv() if "W" in repairs else W.inv() * A_ * W
    return moved - normal_form.companion(A_)


def coordinates_plus(repairs):
    """Residuals of both printed companion matrices, with W applied."""
    W = normal_form.companion_coordinates(A_, C_)
    return [W * A_ - normal_form.companion(A_) * W, W * A_plus_ - normal_form.companion(A_plus_) * W, C_ - h * W]


def b_bar(repairs):
    """Residual of B bar. The printed numbers are those of -W B~ with B~ as printed."""
    W = normal_form.companion_coordinates(A_, C_)
    tilde = normal_form.shifted(A_, B_, C_, D_) if "image" in repairs else shift_as_printed(A_, B_)
    return (W if "sign" in repairs else -W) * tilde - W * normal_form.shifted(A_, B_, C_, D_)


def determinant(repairs):
    """Residual of: -0.64 in both companion matrices is -r^2 (det phi_(T/2))^2 = -r^2 e^{-2 zeta T}."""
    A, _ = derived()
    return normal_form.companion(A)[1, 0] + r**2 * F.det() ** 2


# ---- appendix A ---------------------------------------------------------------------------------------------------------

theta, theta1, theta3 = sp.symbols("theta theta1 theta3", real=True)
kappa1, kappa2, rho0, rho1, rho2 = sp.symbols("kappa1 kappa2 rho0 rho1 rho2", positive=True)
FLANK = -kappa1 * sp.sin(theta + theta1) + sp.sqrt(rho1**2 - kappa1**2 * sp.cos(theta + theta1) ** 2)
NOSE = kappa2 * sp.sin(theta + theta3) + sp.sqrt(rho2**2 - kappa2**2 * sp.cos(theta + theta3) ** 2)


def on_circle(law, centre, radius):
    """Return the squared distance of the cam's point from a centre, less the squared radius."""
    return sp.simplify(sp.expand_trig(sp.expand(
        (law * sp.cos(theta) - centre[0]) ** 2 + (law * sp.sin(theta) - centre[1]) ** 2 - radius**2)))


def cam_laws(repairs):
    flank_centre = kappa1 * sp.Matrix([-sp.sin(theta1), -sp.cos(theta1)])
    nose_centre = kappa2 * sp.Matrix([sp.sin(theta3), sp.cos(theta3)])
    return [on_circle(FLANK, flank_centre, rho1), on_circle(NOSE, nose_centre, rho2)]


def tangency(repairs):
    """Residuals of the printed c_1 and c_2 at R, P and Q: each lift and each slope less the neighbour's.

    At P both circles have one outward normal n: O1 = P - rho1 n and O2 = P - rho2 n. Let a = n . e_r > 0, b = n . e_theta and l =
    |P|. Then O1 . e_r = l - rho1 a and O1 . e_theta = -rho1 b, and likewise for O2. These fix the sine and the cosine at P.
    """
    R_, Q_ = {theta: sp.pi / 2 - theta1}, {theta: sp.pi / 2 - theta3}
    ends = [
        FLANK.subs(R_).subs(rho1, rho0 + kappa1) - rho0,
        FLANK.diff(theta).subs(R_),
        NOSE.subs(Q_) - (kappa2 + rho2),
        NOSE.diff(theta).subs(Q_),
    ]
    a, lift = sp.symbols("a l", positive=True)
    b = sp.Symbol("b", real=True)
    flank = {sp.sin(theta + theta1): -(lift - rho1 * a) / kappa1, sp.cos(theta + theta1): rho1 * b / kappa1}
    nose = {sp.sin(theta + theta3): (lift - rho2 * a) / kappa2, sp.cos(theta + theta3): -rho2 * b / kappa2}

    def at_P(law, table):
        # With a^2 + b^2 = 1, each root is rho a.
        roots = {sp.sqrt(rho1**2 - rho1**2 * b**2): rho1 * a, sp.sqrt(rho2**2 - rho2**2 * b**2): rho2 * a}
        return law.subs(table).subs(roots)

    meet = [at_P(law(NOSE), nose) - at_P(law(FLANK), flank) for law in (lambda law: law, lambda law: law.diff(theta))]
    return [*ends, *meet, at_P(FLANK, flank) - lift]


EQUATIONS = (
    Equation("eq:gff", "phi_t = e^{-zeta t}(I cos + A sin), also written out as one matrix, is the flow of x' = G x (eq:fbsol1)", flow),
    Equation("x_t", "x = (q + g/omega0^2, q') turns the equation of motion into x' = G x", gravity_shift),
    Equation("y_t", "h (x - y) = q - c with y = (c, c')", gap_meaning, "misprint", "y = (c + g/omega0^2, c'), measured from the same equilibrium as x",
             ("shift",), "true as printed for g = 0"),
    Equation("eq:impactdynamics_2", "x+ = x + R (x - y) is the law of restitution at contact", restitution_law),
    Equation("eq:lmapd", "P_D = (I + phi_ti R phi_-ti) x - phi_ti R y_-ti is back, impact, forward", zero_time_map),
    Equation("eq:lmap", "P as printed is flight to the impact, impact, flight to the section", composition),
    Equation("implicit condition", "H(x_n, t_i) = h (phi_{T/2 - t_i} x_n - y_-ti), below eq:lmap, is eq:H after the flight to t = 0", implicit_condition),
    Equation("eq:fixedp", "x* = -[I - phi_T + F R F]^-1 F R y0 is the fixed point with t_i = 0", fixed_point, "misprint",
             "-[I - phi_T - F R F]^-1 F R y0; h (F x* - y0) = 0 then fixes T*", ("sign",)),
    Equation("eq:dPdx", "dP/dx by the chain rule through t_i(x)", chain(x[0])),
    Equation("eq:dPdT", "dP/dT by the chain rule through t_i(T)", chain(T)),
    Equation("Eq:dP_dxn", "dP/dx at fixed t_i is phi_{T/2} (I + phi_-ti R phi_ti) phi_{T/2}", dP_dx, "misprint",
             "phi_ti R phi_-ti", ("order",), "no effect at t_i = 0"),
    Equation("Eq:dP_dti", "dP/dt_i: the closing bracket stands before phi_{T/2} x, around phi R phi' alone", dP_dti, "misprint",
             "(phi'_ti R phi_-ti - phi_ti R phi'_-ti) phi_{T/2} x: the bracket opens before the first term", ("brackets",)),
    Equation("Eq:dti_dxn", "dt_i/dx with the two derivatives of H", dti_dx),
    Equation("eq:ftaylormapcornerX", "dP/dx at the corner", taylor_x, "misprint", "a minus before the bracket with h/(h (phi' x* - y0'))", ("sign",)),
    Equation("dy_dT", "dy/dT of a phase-locked cam", period_derivative),
    Equation("Eq:dP_dT", "dP/dT at fixed t_i", dP_dT),
    Equation("Eq:dti_dT", "dt_i/dT with the two derivatives of H", dti_dT),
    Equation("eq:ftaylormapcornerT", "dP/dT at the corner", taylor_T, "misprint", "a minus before the last term", ("sign",)),
    Equation("eq:Px", "A in closed form, for every damping", eq_A),
    Equation("eq:PT", "B in closed form", eq_B, "misprint",
             "phi' in the first term, phi in the second, a minus before the third",
             ("phi' in the first term", "phi in the second term", "minus before the third term")),
    Equation("eq:linearmap", "A and B follow from eq:lmap and H by implicit differentiation at the corner", taylor_closed_form),
    Equation("eq:pwlf, region", "C dx + D dT is positive just where the impact comes after the corner (A+, B+ hold)", region, "refuted",
             "divide C dx + D dT by (1+r) phi12(T/2) (c''+ - c''-). The print is right only where phi12(T/2) (c''+ - c''-) > 0. "
             "Where it is negative, as at the paper's corner, A+ and B+ hold where C dx + D dT < 0",
             ("factor",), values={normal_form.plus: sp.Rational(-8, 3), normal_form.minus: sp.Rational(3, 2)}),
    Equation("eq:pwlf, acceleration", "P does not contain the cam's acceleration", no_acceleration),
    Equation("eq:pwlf, continuity", "A- dx + B- dT = A+ dx + B+ dT where C dx + D dT = 0, C = h (A+ - A-), D = h (B+ - B-)", continuity),
    Equation("B tilde", "B~ = B - A e1 D/C1 after the shift of coordinates", b_tilde, "refuted", "B - (A - I) e1 D/C1, since the image moves too",
             ("image",), values=GENERAL),
    Equation("B tilde, sides", "the printed B~ is the same on both sides", b_tilde_sides),
    Equation("coordinates", "x = W^-1 x~ brings A- to companion form", coordinates, "misprint", "x = W x~", ("W",), values=GENERAL),
    Equation("A bar", "W A W^-1 is the companion matrix on both sides and C W^-1 = (1, 0)", coordinates_plus),
    Equation("A bar, determinant", "its lower left entry is -r^2 e^{-2 zeta T} on both sides", determinant),
    Equation("B bar", "B bar as printed, which is -W times the printed B~", b_bar, "refuted", "W B~ with B~ = B - (A - I) e1 D/C1",
             ("image", "sign"), values=GENERAL),
    Equation("appendix A, laws", "c_1 and c_2 are the flank and nose circles, angles signed", cam_laws),
    Equation("appendix A, tangency",
             "c_0 to c_3 meet with one lift and one slope if O, O1, R and O, O2, Q and O1, O2, P lie on lines, as drawn", tangency),
)  # fmt: skip


# ---- one slip, several equations ----------------------------------------------------------------------------------------


def slips():
    """Proofs that several printed equations share one slip: the later ones have the slip of the earlier one, and no other."""
    # The map of an impact at t_i, of which the sentence after eq:H speaks, in place of one at -t_i.
    opposite = phi(half) * ((I + phi(-t_i) * R * phi(t_i)) * phi(half) * x - phi(-t_i) * R * y(t_i))
    fixed = opposite.jacobian(x) - phi(half) * (I + phi(-t_i) * R * phi(t_i)) * phi(half)
    yield Proof("Eq:dP_dxn as printed is that of an impact at t_i", letters(fixed))
    bracket, rate = corner_terms()
    yield Proof("the bracket that eq:ftaylormapcornerX and T have is dP/dt_i of an impact at t_i",
                at_corner(opposite.diff(t_i) - phi(half) * bracket))
    start = dict(zip(x, F.inv() * sp.Matrix([q, v])))
    corner = {l0: q, l1: c1 * T / (2 * sp.pi), l2: c2 * (T / (2 * sp.pi)) ** 2}
    last = at_corner(phi(half) * bracket * (h * (dphi(half) * x / 2 - dy_dT(0)))[0] / rate).subs(start).subs(corner)
    third = F * (1 + r) * v / (v - c1) * sp.Matrix([v - c1, STIFFENING]) / 2
    yield Proof("the third term of eq:PT is the last of eq:ftaylormapcornerT, with its sign", last - third)


# ---- verdicts -----------------------------------------------------------------------------------------------------------


def flat(residual):
    """Return the entries of a residual."""
    if isinstance(residual, (list, tuple, sp.MatrixBase)):
        return [entry for part in residual for entry in flat(part)]
    return [sp.sympify(residual)]


def numbers(equation, residual):
    """Return a residual at the rational point."""
    values = {**POINT, **computed(), **equation.values}
    found = [sp.N(entry.subs(values), 20) for entry in flat(residual)]
    # phi's letters are rounded at 60 digits.
    return [sp.Integer(0) if abs(value) < sp.Rational(1, 10**40) else value for value in found]


def weigh(equation, repairs):
    """Return whether a residual vanishes, and its value at the point, as text."""
    try:
        residual = equation.residual(frozenset(repairs))
    except sp.matrices.exceptions.ShapeError:
        return False, "undefined: a 2x2 matrix less a vector"
    if repairs == equation.repairs:
        return vanishes(residual), "0"
    values = numbers(equation, residual)
    # A residual that is not 0 at one point does not vanish.
    return not any(values), [str(value) for value in values]


def examine(equation):
    """Return the entry of one equation, with its verdict and its evidence, and True if they are what the table says."""
    complete, _ = weigh(equation, equation.repairs)
    evidence = {"residual_as_printed": "0", "residual_repaired": None, "subsets": []}
    good = complete
    if equation.repairs:
        evidence["residual_repaired"] = "0"
        for size in range(len(equation.repairs)):
            for subset in combinations(equation.repairs, size):
                zero, value = weigh(equation, subset)
                good = good and not zero
                if subset:
                    evidence["subsets"].append({"repairs": list(subset), "residual": value})
                else:
                    evidence["residual_as_printed"] = value
        names = {str(key): str(value) for key, value in (equation.values or POINT).items()}
        evidence["at"] = names
    entry = {"label": equation.label, "statement": equation.statement, "verdict": equation.verdict}
    entry["repair"] = equation.repair or None
    entry["repairs"] = list(equation.repairs)
    entry["note"] = equation.note or None
    entry["evidence"] = evidence
    good = good and (equation.verdict == "holds") == (not equation.repairs)
    return entry, good


def examined():
    """Return the entry of every equation, and the proofs of the verdicts."""
    entries, results = [], []
    for equation in EQUATIONS:
        entry, good = examine(equation)
        entries.append(entry)
        how = "holds" if not equation.repairs else f"{equation.verdict}; repaired: {equation.repair}"
        results.append(Proof(f"{equation.label}: {how}", 0 if good else 1))
    return entries, results


def proofs():
    return examined()[1]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="The paper's equations, each proved or disproved.")
    parser.add_argument("--json", action="store_true", help="write the list of verdicts as JSON")
    if parser.parse_args().json:
        print(json.dumps(examined()[0], indent=2))
    else:
        main("printed", proofs)
