"""The order of the cam's jump decides the local map.

The lift's j-th derivative in time jumps by J at the corner, and the lower ones do not. A follower arrives with velocity v while the
cam moves at c', so that u = c' - v is the velocity of approach. One flight hits the cam at the time s after the corner. Its state
after the impact, carried to the moment of the corner by free flight, differs between the law before the corner and the law after it
by

    velocity    (1+r) J s^(j-1)/(j-1)!           position    -(1+r) J (j-1) s^j/j!

to leading order. One revolution from a deviation z = (dx, dT) ends apart by

    P+ - P-  =  (1+r) J/(j-1)! (n z)^(j-1) F e2,    n z = (h F dx + v dT/2)/u, the time from the corner to first order.

So j = 1 leaves a gap, j = 2 a jump of A and B of rank one, and j = 3 equal A and B and a jump of the second derivative.

Proved: the local law for every j >= 2 at once, with j a symbol and E = s^(j-1) a small quantity of its own. The terms left out are of
the size of s E and E^2 in the velocity, and of s^2 E, s E^2 and E^3 in the position. Also proved are that law and the revolution, for
j = 1, 2, 3, 4 one by one. For j = 1 the number of impacts is proved too: one on either side, none after the corner, or two before it.
"""

import functools

import sympy as sp

from sympy import QQ
from sympy.polys.rings import ring

from corner_map import derived
from corner_map import T as period
from corner_map import c1 as c1_of_map
from corner_map import c2 as c2_of_map
from corner_map import p as step_response
from corner_map import s as impulse_response
from corner_map import spring, v
from flight import G, omega0_squared, propagator, zeta
from impact import r, restitution
from proof import Proof, main

dx1, dx2, dT = sp.symbols("dx1 dx2 dT", real=True)
g, h = sp.symbols("g h", real=True)
u, u_minus, u_plus = sp.symbols("u u_minus u_plus")
e2 = sp.Matrix([0, 1])
F = propagator(step_response, impulse_response)
ORDERS = (1, 2, 3, 4)


# Letters of the polynomials. With w = 1/u as a letter of its own, series of polynomials stay polynomials.
NAMES = "zeta omega0_squared spring v r g h dT rate u u_minus u_plus w w_minus w_plus"
LIFTS = [f"c{k}{side}" for side in ("", "_minus", "_plus") for k in range(2, 6)]
POLYNOMIALS, *LETTERS = ring(NAMES.split() + LIFTS, QQ)
LETTER = dict(zip(NAMES.split() + LIFTS, LETTERS))


def times(left, right):
    """Return the product of two series in epsilon, to the order that is kept."""
    return [sum((left[k] * right[n - k] for k in range(n + 1)), POLYNOMIALS(0)) for n in range(len(left))]


def plus(*terms):
    return [sum(entries, POLYNOMIALS(0)) for entries in zip(*terms)]


def scaled(factor, series):
    return [POLYNOMIALS(factor) * entry for entry in series]


def constant(value, highest):
    return [POLYNOMIALS(value)] + [POLYNOMIALS(0)] * highest


def linear(value, highest):
    return [POLYNOMIALS(0), POLYNOMIALS(value)] + [POLYNOMIALS(0)] * (highest - 1)


def flown(time, state):
    """Return the state after free flight for a time that is 0 with epsilon, from x' = G x - spring e2. Position is measured from the
    corner's."""
    highest = len(time) - 1
    zeta, omega0_squared, spring = (LETTER[name] for name in ("zeta", "omega0_squared", "spring"))

    def field(position, velocity):
        return [velocity, plus(scaled(-omega0_squared, position), scaled(-2 * zeta, velocity))]

    total = list(state)
    rate = field(*state)
    rate[1] = plus(rate[1], constant(-spring, highest))
    power = constant(1, highest)
    for count in range(1, highest + 1):
        power = scaled(QQ(1, count), times(power, time))
        total = [plus(entry, times(power, change)) for entry, change in zip(total, rate)]
        rate = field(*rate)
    return total


def approach(order, side):
    """Return u and 1/u as letters. If the velocity jumps (order 1), they are those of the side."""
    suffix = f"_{side}" if order == 1 else ""
    return LETTER["u" + suffix], LETTER["w" + suffix]


def lifts(order, side):
    """Return c', c'', ... of a side as letters, from index 1. Below `order` they are the same on both sides."""
    own = [LETTER[f"c{k}" + (f"_{side}" if k >= order else "")] for k in range(2, 6)]
    return [POLYNOMIALS(0), LETTER["v"] + approach(order, side)[0], *own]


@functools.lru_cache
def near_corner(order, side, highest):
    """Return the time of an impact on one side's law, and the state after it at the moment of the corner. Both are series in epsilon
    up to `highest`.

    Without an impact the flight would pass the corner in (epsilon g, v + epsilon h), if it did not last epsilon dT/2 longer on either
    side of the corner. The cam keeps its angles (rate = 1/T).
    """
    cam = lifts(order, side)
    g, h, dT, rate, v, r = (LETTER[name] for name in ("g", "h", "dT", "rate", "v", "r"))
    extra = linear(dT * QQ(1, 2), highest)
    # T*/T = 1/(1 + epsilon dT/T*)
    ratio = [(-dT * rate) ** power for power in range(highest + 1)]
    incoming = [linear(g, highest), plus(constant(v, highest), linear(h, highest))]

    def surface(time):
        # The cam's angle is 2 pi time/T, so c^(k) scales with (T*/T)^k.
        position, velocity = constant(0, highest), constant(0, highest)
        power, factorial = constant(1, highest), 1
        for k in range(1, highest + 2):
            slope = times(power, ratio)
            velocity = plus(velocity, scaled(cam[k] * QQ(1, factorial), slope))
            power, factorial = times(slope, time), factorial * k
            position = plus(position, scaled(cam[k] * QQ(1, factorial), power))
        return position, velocity

    # The gap closes at the rate u, so contact fixes one coefficient of the time after the other.
    _, inverse = approach(order, side)
    time = constant(0, highest)
    for power in range(1, highest + 1):
        gap = flown(plus(extra, time), incoming)[0][power] - surface(time)[0][power]
        time[power] = reduced(gap * inverse)
    before, cam_state = flown(plus(extra, time), incoming), surface(time)
    after = [before[0], plus(scaled(1 + r, cam_state[1]), scaled(-r, before[1]))]
    return time, [[reduced(entry) for entry in series] for series in flown(plus(extra, scaled(-1, time)), after)]


def reduced(polynomial):
    """Return a polynomial reduced by u w = 1, on either side."""
    for suffix in ("", "_minus", "_plus"):
        relation = LETTER["u" + suffix] * LETTER["w" + suffix] - 1
        polynomial = polynomial.rem([relation])
    return polynomial


def apart(order, highest):
    """Return the difference of the two sides' states at the moment of the corner, plus less minus, as two series."""
    after, before = (near_corner(order, side, highest)[1] for side in ("plus", "minus"))
    return [[left - right for left, right in zip(*pair)] for pair in zip(after, before)]


def jump(order):
    """Return J, the jump of c^(order)."""
    return symbolic(lifts(order, "plus")[order] - lifts(order, "minus")[order])


MEANT = {sp.Symbol(f"w{suffix}"): 1 / sp.Symbol(f"u{suffix}") for suffix in ("", "_minus", "_plus")}
MEANT |= {sp.Symbol("rate"): 1 / period}
MEANT |= {sp.Symbol(name): letter for name, letter in
          {"zeta": zeta, "omega0_squared": omega0_squared, "spring": spring, "v": v, "r": r, "dT": dT, "g": g, "h": h}.items()}


def symbolic(polynomial):
    """Return a polynomial in the letters of the other scripts, with w = 1/u."""
    return polynomial.as_expr().subs(MEANT)


def every_order_proofs():
    """Proofs for j >= 2 as a symbol. Here t is the time of the impact on the law before the corner, and E = t^(j-1)."""
    j = sp.Symbol("j", positive=True)
    t, E, V1, J, J1, factorial, c1 = sp.symbols("t E V1 J J1 factorial c1", real=True)
    d0, dt, dE, second, third = sp.symbols("d0 dt dE c2 c3", real=True)
    keep = 2

    def kept(expression):
        polynomial = sp.Poly(sp.expand(expression), t, E)
        return sum(value * t**a * E**b for (a, b), value in polynomial.terms() if a <= keep and b <= keep)

    def flight(time, state):
        total, rate, power = state, G * state - spring * e2, sp.Integer(1)
        for count in range(1, keep + 2):
            power = kept(power * time / count)
            total, rate = (total + rate * power).applyfunc(kept), G * rate
        return total

    def law(time):
        return sp.Matrix([c1 * time + second * time**2 / 2 + third * time**3 / 6, c1 + second * time + third * time**2 / 2])

    # The law after the corner is met delta = E t d later, and (t + delta)^k = t^k (1 + E d)^k, to E^2.
    d = d0 + dt * t + dE * E
    delta = E * t * d

    def power(exponent):
        return 1 + exponent * E * d + exponent * (exponent - 1) / 2 * (E * d) ** 2

    # (j-1)! = factorial:  c+ - c- = J t^j/j! + J1 t^(j+1)/(j+1)!,  and its derivative
    lift = E * t * (J / (j * factorial) * power(j) + J1 * t / ((j + 1) * j * factorial) * power(j + 1))
    slope = E * (J / factorial * power(j - 1) + J1 * t / (j * factorial) * power(j))
    on_minus = law(t)
    arriving = sp.Matrix([on_minus[0], v + V1 * t])
    later = flight(delta, arriving)
    on_plus = (law(t + delta) + sp.Matrix([lift, slope])).applyfunc(kept)
    # The gap at the second contact is E t times the coefficients here, to the orders that fix d.
    gap = sp.Poly(later[0] - on_plus[0], t, E)
    known = sp.solve([gap.coeff_monomial(E * t * monomial) for monomial in (1, t, E)], [d0, dt, dE], dict=True)[0]
    yield Proof("any j >= 2: the law after the corner is met later by J s^j/(j! (v - c')) to leading order",
                known[d0] - J / (j * factorial) / (v - c1))
    minus = flight(-t, restitution(arriving, on_minus))
    plus_side = flight(-t - delta, restitution(later, on_plus))
    position, velocity = (sp.Poly(kept(entry), t, E) for entry in plus_side - minus)

    def at(entry, monomial):
        return entry.coeff_monomial(monomial).subs(known)

    yield Proof("any j >= 2: velocities differ by (1+r) J s^(j-1)/(j-1)! and terms of the size of s^j",
                [at(velocity, E) - (1 + r) * J / factorial, *(at(velocity, monomial) for monomial in (1, t, t**2))])
    yield Proof("any j >= 2: positions differ by -(1+r) J (j-1) s^j/j! and smaller terms",
                [at(position, E * t) + (1 + r) * J * (j - 1) / (j * factorial),
                 *(at(position, monomial) for monomial in (1, t, t**2, E, E**2))])


def each_order_proofs():
    """Proofs for j = 1 to 4 by series. They share only the equation of motion and restitution with the proofs for a symbolic order."""
    still = {dT: 0}
    for order in ORDERS[1:]:
        position, velocity = ([symbolic(entry).subs(still) for entry in series] for series in apart(order, order))
        s, power = g / u, order - 1
        yield Proof(f"j = {order}: velocities differ by (1+r) J s^{power}/{power}!, by nothing below",
                    [*velocity[:power], velocity[power] - (1 + r) * jump(order) * s**power / sp.factorial(power)])
        leading = -(1 + r) * jump(order) * power * s**order / sp.factorial(order)
        yield Proof(f"j = {order}: positions differ by -(1+r) J {power} s^{order}/{order}!, by nothing below",
                    [*position[:order], position[order] - leading])
    # j = 1: each side has its own c', and so its own time of impact. s is the time on the law before the corner, and h = 0.
    s = sp.Symbol("s", real=True)
    position, velocity = ([symbolic(entry).subs(still | {h: 0, g: u_minus * s}) for entry in series] for series in apart(1, 2))
    S_plus, S_minus = (symbolic(c[2] + 2 * LETTER["zeta"] * c[1]) + spring for c in (lifts(1, "plus"), lifts(1, "minus")))
    yield Proof("j = 1, hit on both sides: velocities differ by (1+r) J + (1+r) (S+ u-/u+ - S-) s, S = c'' + 2 zeta c' + spring",
                [velocity[0] - (1 + r) * jump(1), velocity[1] - (1 + r) * (S_plus * u_minus / u_plus - S_minus) * s])
    yield Proof("j = 1, hit on both sides: positions differ by -(1+r)/2 (S+ (u-/u+)^2 - S-) s^2",
                [*position[:2], position[2] + (1 + r) / 2 * (S_plus * (u_minus / u_plus) ** 2 - S_minus) * s**2])


def revolution_proofs():
    """Proofs for P+ - P- over a whole revolution, along any deviation epsilon (dx1, dx2, dT)."""
    deviation = sp.Matrix([dx1, dx2])
    flown_to_the_corner = {g: (F * deviation)[0], h: (F * deviation)[1]}

    def after(series, power):
        """Return F times the coefficient of epsilon^power at the corner."""
        return F * sp.Matrix([symbolic(entry[power]).subs(flown_to_the_corner) for entry in series])

    n_z = ((F * deviation)[0] + v * dT / 2) / u
    words = {1: "a gap (1+r) J F e2", 2: "(1+r) J (n z) F e2", 3: "half a second derivative, (1+r) J (n z)^2 F e2",
             4: "a sixth of a third derivative, (1+r) J (n z)^3 F e2"}
    for order in ORDERS:
        series, power = apart(order, max(order - 1, 1)), order - 1
        claimed = (1 + r) * jump(order) / sp.factorial(power) * n_z**power * F * e2
        yield Proof(f"j = {order}: over a revolution the sides differ by {words[order]}, by nothing below",
                    [*(after(series, lower) for lower in range(power)), after(series, power) - claimed])

    # Comparison with what corner_map.py derives from the composition itself.
    A, B = derived()["A"], derived()["B"]

    def derivative(order, side):
        cam = lifts(order, side)
        own = {c1_of_map: symbolic(cam[1]), c2_of_map: symbolic(cam[2])}
        return A.subs(own) * deviation + B.subs(own) * dT

    for order, side in ((1, "minus"), (1, "plus"), (2, "minus"), (2, "plus"), (3, "minus"), (3, "plus"), (4, "minus")):
        found = after(near_corner(order, side, max(order - 1, 1))[1], 1)
        yield Proof(f"j = {order}: the {side} side's first derivatives are A and B of corner_map.py for its own c' and c''",
                    found - derivative(order, side))
    jump_of_derivative = derivative(2, "plus") - derivative(2, "minus")
    yield Proof("j = 2: what the sides differ by is (A+ - A-) dx + (B+ - B-) dT of corner_map.py",
                after(apart(2, 1), 1) - jump_of_derivative)


def velocity_jump_proofs():
    """Proofs for j = 1 to leading order, where lengths and times shrink like g: straight flight over a cam with a kink.

    The flight is g + v t before an impact, and the cam is c-' t and c+' t. The flight arrives from above, so u- > 0, and u+ = u- + J.
    """
    before, after, t = sp.symbols("c1_minus c1_plus t", real=True)
    closing_minus, closing_plus = before - v, after - v
    J = after - before
    struck, struck_after = ((1 + r) * lift - r * v for lift in (before, after))
    yield Proof("j = 1, -u- < J <= r u-: one impact on either side, a gap (1+r) J", struck_after - struck - (1 + r) * J)
    yield Proof("j = 1, J <= -u-: a flight that passes the corner at g is g - u+ t above the cam after it; a gap -(1+r) u-",
                [g + v * t - after * t - (g - closing_plus * t), v - struck + (1 + r) * closing_minus])
    # After an impact before the corner at t1 = g/u- < 0, the follower moves at r u- - J relative to the cam after the corner.
    t1 = g / closing_minus
    position = g + v * t1
    t2 = -r * g / (J - r * closing_minus)
    twice = (1 + r) * after - r * struck
    yield Proof("j = 1, J > r u-: hit at t1 before the corner it hits again at -r u- t1/(J - r u-) after it",
                [position - before * t1, position + struck * (t2 - t1) - after * t2,
                 t2 + r * closing_minus * t1 / (J - r * closing_minus), struck - after - (r * closing_minus - J)])
    yield Proof("j = 1, J > r u-: a gap r (1+r) u-; it leaves at r (J - r u-), so a third impact does not follow",
                [struck_after - twice - r * (1 + r) * closing_minus, twice - after - r * (J - r * closing_minus)])
    yield Proof("j = 1: all three are (1+r) times J held between -u- and r u-: they meet at the ends",
                [((1 + r) * J + (1 + r) * closing_minus).subs(after, before - closing_minus),
                 ((1 + r) * J - r * (1 + r) * closing_minus).subs(after, before + r * closing_minus)])


def proofs():
    yield from every_order_proofs()
    yield from each_order_proofs()
    yield from revolution_proofs()
    yield from velocity_jump_proofs()


if __name__ == "__main__":
    main("jump order", proofs)
