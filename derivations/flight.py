"""Free flight, solved from the equation of motion for any damping.

    m q'' + b q' + k (q - rest) = -m g,     zeta = b/(2m),  omega0^2 = k/m

Two functions of time describe every flight, and need no equilibrium: the impulse response s and the step response p,

    p' = s,   s' = 1 - omega0^2 p - 2 zeta s,   p(0) = s(0) = 0.

A flight from (q, v) ends at

    Phi_t (q, v) = F_t (q, v) + load (p, s),   F_t = [[1 - omega0^2 p, s], [-omega0^2 s, 1 - omega0^2 p - 2 zeta s]],

where load = omega0^2 rest - g is the acceleration at q = 0 and v = 0. Proved, with the solution that sympy finds for the equation of
motion:

    Phi_t for under-damping, over-damping (also as the continuation of under-damping), critical damping (also as its limit), and
        stiffness 0 with and without damping
    F' = G F; the group law; det F; the shift to the equilibrium
    eq:gff in its own letters, and phi_t = F_t
"""

import sympy as sp

from proof import Proof, main

t, a, b = sp.symbols("t a b", positive=True)
zeta, omega0_squared, load = sp.symbols("zeta omega0_squared load", real=True)
q, v = sp.symbols("q v", real=True)

# x' = G x + load e2
G = sp.Matrix([[0, 1], [-omega0_squared, -2 * zeta]])


class Step(sp.Function):
    """p(t): the position after t under a unit force, from rest. Only p' = s is known of it."""

    nargs = 1

    def fdiff(self, argindex=1):
        return Impulse(self.args[0])


class Impulse(sp.Function):
    """s(t): the position after t from a unit velocity. Only s' = 1 - omega0^2 p - 2 zeta s is known of it."""

    nargs = 1

    def fdiff(self, argindex=1):
        time = self.args[0]
        return 1 - omega0_squared * Step(time) - 2 * zeta * Impulse(time)


class Cosine(sp.Function):
    """e^{-zeta t} cos(omega_s t), of which only the derivative is known."""

    nargs = 1

    def fdiff(self, argindex=1):
        time = self.args[0]
        return -zeta * Cosine(time) - (omega0_squared - zeta**2) * Sine(time)


class Sine(sp.Function):
    """e^{-zeta t} sin(omega_s t)/omega_s, of which only the derivative is known."""

    nargs = 1

    def fdiff(self, argindex=1):
        time = self.args[0]
        return Cosine(time) - zeta * Sine(time)


def propagator(p, s):
    """Return F from the two responses."""
    return sp.Matrix([[1 - omega0_squared * p, s], [-omega0_squared * s, 1 - omega0_squared * p - 2 * zeta * s]])


def fly(time, state):
    """Return Phi_t of a state, for responses of which only the derivatives are known."""
    p, s = Step(time), Impulse(time)
    return propagator(p, s) * state + load * sp.Matrix([p, s])


def phi(time):
    """Return eq:gff, with a cosine and sine of which only the derivatives are known: phi = Cosine I + Sine N, N = G + zeta I."""
    return Cosine(time) * sp.eye(2) + Sine(time) * (G + zeta * sp.eye(2))


def group_law(expression, pairs):
    """Return an expression with Cosine and Sine of sums and of negative times written by those of the terms.

    `pairs` maps a time to (x, y): time = x + y, or (x, None): time = -x.
    """
    square = zeta**2 - omega0_squared
    table = {}
    for time, (x, y) in pairs.items():
        if y is None:
            determinant = Cosine(x) ** 2 - square * Sine(x) ** 2
            table[Cosine(time)] = Cosine(x) / determinant
            table[Sine(time)] = -Sine(x) / determinant
        else:
            table[Cosine(time)] = Cosine(x) * Cosine(y) + square * Sine(x) * Sine(y)
            table[Sine(time)] = Cosine(x) * Sine(y) + Sine(x) * Cosine(y)
    return expression.subs(table)


omega_s, kappa = sp.symbols("omega_s kappa", positive=True)
damping = sp.Symbol("zeta_positive", positive=True)

# Cosine and Sine of each kind of damping. CASES has for each: name, ({zeta, omega0^2} in positive letters, p, s).
UNDER = (sp.exp(-zeta * t) * sp.cos(omega_s * t), sp.exp(-zeta * t) * sp.sin(omega_s * t) / omega_s)
OVER = (sp.exp(-zeta * t) * sp.cosh(kappa * t), sp.exp(-zeta * t) * sp.sinh(kappa * t) / kappa)
CRITICAL = (sp.exp(-damping * t), t * sp.exp(-damping * t))


def from_equilibrium(cosine, sine, zeta, omega0_squared):
    """Return p where there is a stiffness: omega0^2 p = 1 - cosine - zeta sine."""
    return (1 - cosine - zeta * sine) / omega0_squared


CASES = {
    "under-damped": ({omega0_squared: zeta**2 + omega_s**2}, from_equilibrium(*UNDER, zeta, zeta**2 + omega_s**2), UNDER[1]),
    "over-damped": ({omega0_squared: zeta**2 - kappa**2}, from_equilibrium(*OVER, zeta, zeta**2 - kappa**2), OVER[1]),
    "critically damped": (
        {zeta: damping, omega0_squared: damping**2},
        from_equilibrium(*CRITICAL, damping, damping**2),
        CRITICAL[1],
    ),
    "stiffness 0, damped": (
        {zeta: damping, omega0_squared: 0},
        (t - (1 - sp.exp(-2 * damping * t)) / (2 * damping)) / (2 * damping),
        (1 - sp.exp(-2 * damping * t)) / (2 * damping),
    ),
    "stiffness 0, undamped": ({zeta: 0, omega0_squared: 0}, t**2 / 2, t),
}


def solution(values):
    """Return q(t) from the equation of motion and the initial state, as sympy solves it."""
    position = sp.Function("q")
    motion = position(t).diff(t, 2) + 2 * zeta * position(t).diff(t) + omega0_squared * position(t) - load
    initial = {position(0): q, position(t).diff(t).subs(t, 0): v}
    return sp.dsolve(motion.subs(values), position(t), ics=initial).rhs


def proofs():
    for name, (values, p, s) in CASES.items():
        rates = [
            sp.diff(p, t) - s,
            sp.diff(s, t) - (1 - omega0_squared * p - 2 * zeta * s).subs(values),
            p.subs(t, 0),
            s.subs(t, 0),
        ]
        yield Proof(f"{name}: p and s have their derivatives and start at 0", rates)

        F = propagator(p, s).subs(values)
        solved = solution(values)
        flown = F * sp.Matrix([q, v]) + load * sp.Matrix([p, s])
        both = [flown[0] - solved, flown[1] - sp.diff(solved, t)]
        yield Proof(f"{name}: Phi_t is the solution of the equation of motion", both)

        yield Proof(f"{name}: F' = G F = F G and F_0 = I", [
            F.diff(t) - G.subs(values) * F,
            F * G.subs(values) - G.subs(values) * F,
            F.subs(t, 0) - sp.eye(2),
        ])
        yield Proof(f"{name}: F_(a+b) = F_a F_b", F.subs(t, a + b) - F.subs(t, a) * F.subs(t, b))
        yield Proof(f"{name}: det F = exp(-2 zeta t)", F.det() - sp.exp(-2 * zeta * t).subs(values))

        if values[omega0_squared] != 0:
            # x = q - load/omega0^2 flies without a constant term: this is the shift by g/omega0^2 in x_t, with the spring's rest included.
            equilibrium = load / values[omega0_squared]
            shifted = sp.Matrix([equilibrium, 0]) + F * sp.Matrix([q - equilibrium, v])
            yield Proof(f"{name}: measured from the equilibrium, Phi_t is F_t alone", shifted - flown)

    # Over-damping is under-damping with omega_s = i kappa. Critical damping is the limit omega_s -> 0.
    continued = [(under.subs(omega_s, sp.I * kappa) - over).rewrite(sp.exp) for under, over in zip(UNDER, OVER)]
    yield Proof("over-damped: the continuation omega_s = i kappa of under-damped", continued)
    limits = [sp.limit(under, omega_s, 0) - critical.subs(damping, zeta) for under, critical in zip(UNDER, CRITICAL)]
    yield Proof("critically damped: the limit omega_s -> 0 of under-damped", limits)

    # Cosine and Sine stand for the functions of any damping. They fix F, and their derivatives follow from those of p and s.
    cosine = 1 - omega0_squared * Step(t) - zeta * Impulse(t)
    abstract = cosine * sp.eye(2) + Impulse(t) * (G + zeta * sp.eye(2))
    yield Proof("F = Cosine I + Sine (G + zeta I), Cosine = 1 - omega0^2 p - zeta s, Sine = s", [
        abstract - propagator(Step(t), Impulse(t)),
        cosine.diff(t) - (-zeta * cosine - (omega0_squared - zeta**2) * Impulse(t)),
        Impulse(t).diff(t) - (cosine - zeta * Impulse(t)),
    ])
    under = {omega0_squared: zeta**2 + omega_s**2}
    whole = {Cosine(a + b): UNDER[0].subs(t, a + b), Sine(a + b): UNDER[1].subs(t, a + b),
             Cosine(-a): UNDER[0].subs(t, -a), Sine(-a): UNDER[1].subs(t, -a)}
    parts = {f(x): UNDER[i].subs(t, x) for i, f in enumerate((Cosine, Sine)) for x in (a, b)}
    sums = [f(time) for f in (Cosine, Sine) for time in (a + b, -a)]
    residuals = [(group_law(f, {a + b: (a, b), -a: (a, None)}).subs(parts).subs(under) - whole[f]) for f in sums]
    yield Proof("addition theorems of Cosine and Sine, and their values at negative times", residuals)
    yield Proof("addition theorems restate phi_(a+b) = phi_a phi_b and phi_(-a) phi_a = I", [
        group_law(phi(a + b), {a + b: (a, b)}) - phi(a) * phi(b),
        group_law(phi(-a), {-a: (a, None)}) * phi(a) - sp.eye(2),
        phi(t).diff(t) - G * phi(t),
    ])


if __name__ == "__main__":
    main("flight", proofs)
