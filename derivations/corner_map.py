"""The stroboscopic map of a cam-follower and its derivatives at a corner impact, from first principles.

For any damping, any stiffness, any restitution r > 0 and any cam c(theta) that turns through 2 pi in T:

    fly from -T/2 to the impact at tau, impact, fly from tau to T/2;    tau from contact, q(tau) = c(2 pi tau/T).

P(x, T) is that composition. With H the gap at contact, H(x, T, tau) = 0 defines tau, and

    dP/dx = P_x - P_tau H_x/H_tau,    dP/dT = P_T - P_tau H_T/H_tau.

A and B are these derivatives at tau = 0. The inputs are the derivatives of the two responses (flight.py), restitution and the chain
rule. Of the cam, only c, c', c'' at the corner remain. Proved:

    A and B are those of closed_forms.py, and hold for c'' of either side
    they depend on position only through the spring's force
    det A, and the time of the impact

Assumed, as in the composition: the follower approaches the cam, v < c', and flies after the impact. With r > 0 it does fly, since it
leaves at r (c' - v) relative to the cam. With r = 0 it leaves with the cam's velocity and flies only if S = c'' + 2 zeta c' + spring
is below 0. If S > 0, the cam holds the follower until a moment that the cam alone decides, so that A is the zero matrix.
"""

import sympy as sp

import closed_forms
from flight import Impulse, Step, fly, load, omega0_squared, propagator, zeta
from impact import r, restitution
from proof import Proof, main

T = sp.Symbol("T", positive=True)
tau = sp.Symbol("tau", real=True)
x1, x2 = sp.symbols("x1 x2", real=True)
p, s = sp.symbols("p s", real=True)
q, v, c1, c2, spring = sp.symbols("q v c1 c2 spring", real=True)
l0, l1, l2 = sp.symbols("l0 l1 l2", real=True)


class Lift(sp.Function):
    """c(theta), with theta measured from the corner."""

    nargs = 1

    def fdiff(self, argindex=1):
        return Slope(self.args[0])


class Slope(sp.Function):
    """dc/dtheta."""

    nargs = 1

    def fdiff(self, argindex=1):
        return Curvature(self.args[0])


class Curvature(sp.Function):
    """d^2c/dtheta^2 of the side that the impact is on."""

    nargs = 1


def cam(time):
    """Return (c, c') at a time from the corner. The cam's angle is 2 pi time/T, so both depend on T."""
    angle = 2 * sp.pi * time / T
    return sp.Matrix([Lift(angle), 2 * sp.pi / T * Slope(angle)])


def one_revolution():
    """Return P and the gap H as functions of x1, x2, T and tau, before tau is made implicit."""
    before = fly(T / 2 + tau, sp.Matrix([x1, x2]))
    surface = cam(tau)
    after = restitution(before, surface)
    return fly(T / 2 - tau, after), before[0] - surface[0]


def at_corner(expression):
    """Return an expression at tau = 0, where x has flown to (q, v) with q = c. The result is in p, s of T/2, spring, v, c', c''."""
    F = propagator(p, s)
    start = F.inv() * (sp.Matrix([q, v]) - load * sp.Matrix([p, s]))
    expression = sp.sympify(expression).subs(tau, 0)
    expression = expression.subs({Step(T / 2): p, Impulse(T / 2): s, Lift(0): l0, Slope(0): l1, Curvature(0): l2})
    expression = expression.subs({x1: start[0], x2: start[1]})
    expression = expression.subs({l0: q, l1: c1 * T / (2 * sp.pi), l2: c2 * (T / (2 * sp.pi)) ** 2})
    # The acceleration by spring and gravity at the corner is -spring.
    expression = expression.subs(load, omega0_squared * q - spring)
    return sp.cancel(sp.together(expression))


def derive():
    """Return A, B, the derivatives of the impact time, H and its rate, all at the corner."""
    P, H = one_revolution()
    rate = at_corner(sp.diff(H, tau))
    P_tau = sp.diff(P, tau).applyfunc(at_corner)

    def total(variable):
        time = sp.cancel(-at_corner(sp.diff(H, variable)) / rate)
        column = sp.diff(P, variable).applyfunc(at_corner) + P_tau * time
        return column.applyfunc(sp.cancel), time

    columns = {variable: total(variable) for variable in (x1, x2, T)}
    A = sp.Matrix.hstack(columns[x1][0], columns[x2][0])
    B = columns[T][0]
    return {"A": A, "B": B, "dtau": [columns[variable][1] for variable in (x1, x2, T)], "H": at_corner(H), "rate": rate}


_DERIVED = []


def derived():
    """Return derive(), computed once."""
    if not _DERIVED:
        _DERIVED.append(derive())
    return _DERIVED[0]


INPUTS = {str(symbol): symbol for symbol in (zeta, omega0_squared, T, r, spring, v, c1, c2, p, s)}


def transcribed():
    """Return closed_forms.py as sympy expressions in the inputs."""
    names = dict(INPUTS)
    for name, text in closed_forms.CLOSED_FORMS.items():
        names[name] = sp.sympify(text, locals=names)
    return names


def expressions():
    """Return the derived A and B as text, for evaluation elsewhere."""
    A, B = derived()["A"], derived()["B"]
    entries = {"A11": A[0, 0], "A12": A[0, 1], "A21": A[1, 0], "A22": A[1, 1], "B1": B[0], "B2": B[1]}
    return {name: str(sp.collect(sp.expand(sp.numer(sp.together(entry))), (p, s)) / sp.factor(sp.denom(sp.together(entry))))
            for name, entry in entries.items()}


def proofs():
    found = derived()
    A, B = found["A"], found["B"]
    table = transcribed()
    for row in range(2):
        for column in range(2):
            name = f"A{row + 1}{column + 1}"
            yield Proof(f"{name} of the derivation is {name} of closed_forms.py", A[row, column] - table[name])
    for row in range(2):
        yield Proof(f"B{row + 1} of the derivation is B{row + 1} of closed_forms.py", B[row] - table[f"B{row + 1}"])

    strangers = [entry.free_symbols - set(INPUTS.values()) for entry in [*A, *B]]
    yield Proof("A and B know no position, rest or gravity but through spring", [len(names) for names in strangers])
    yield Proof("the point is in contact, and the gap opens at v - c'", [found["H"], found["rate"] - (v - c1)])

    F = propagator(p, s)
    yield Proof("det A = r^2 (det F)^2 on either side", A.det() - r**2 * F.det() ** 2)
    gap = [F[0, 0], F[0, 1], v / 2]
    yield Proof("the impact comes at tau = (h F dx + v dT/2)/(c' - v)", [
        time - slope / (c1 - v) for time, slope in zip(found["dtau"], gap)
    ])

    alpha = table["alpha"]
    acceleration = sp.Matrix([v, -2 * zeta * v - spring])
    v_plus = (1 + r) * c1 - r * v
    after = sp.Matrix([v_plus, -2 * zeta * v_plus - spring])
    saltation = sp.Matrix([[-r, 0], [alpha, -r]])
    # A second view of the jump: the saltation matrix maps the field before the impact, less the cam's motion, to that after it.
    cam_motion = sp.Matrix([c1, c2])
    yield Proof("the jump of A carries x' - y' before the impact to x' - y' after it",
                saltation * (acceleration - cam_motion) - (after - cam_motion))
    yield Proof("r = -1 (no impact) leaves A = F F", (A - F * F).subs(r, -1))
    yield Proof("r = -1 (no impact) leaves B = d/dT of free flight, F x'",
                (B - F * acceleration).subs(r, -1))


if __name__ == "__main__":
    main("corner map", proofs)
