"""200 rational points with the derived A and B to 50 digits, against which the closed forms in Rust are tested.

The denominators of the inputs are powers of two, so that a double holds each input exactly. A point is drawn again if an entry of A
or B is less than a hundredth of the terms that it is the sum of. A double could not meet 1e-12 of such an entry.
"""

import math
import random
from fractions import Fraction

from mpmath import mp, mpf

import closed_forms
from arithmetic import evaluate, responses, text

SEED = 20080417
DIGITS = 50
# Number of points for each kind of damping.
KINDS = {
    "under-damped": 60,
    "undamped": 50,
    "over-damped": 40,
    "critically damped": 10,
    "stiffness 0, damped": 20,
    "stiffness 0, undamped": 20,
}
ENTRIES = ("A11", "A12", "A21", "A22", "B1", "B2")
LARGEST_CANCELLATION = 100


class Sized:
    """Number with the sum of the sizes of the terms that it is made of."""

    def __init__(self, value, size=None):
        self.value, self.size = value, abs(value) if size is None else size

    def __add__(self, other):
        other = sized(other)
        return Sized(self.value + other.value, self.size + other.size)

    def __mul__(self, other):
        other = sized(other)
        return Sized(self.value * other.value, self.size * other.size)

    def __truediv__(self, other):
        other = sized(other)
        return Sized(self.value / other.value, self.size * other.size / other.value**2)

    def __neg__(self):
        return Sized(-self.value, self.size)

    def __sub__(self, other):
        return self + -sized(other)

    def __rsub__(self, other):
        return sized(other) + -self

    __radd__, __rmul__ = __add__, __mul__


def sized(value):
    return value if isinstance(value, Sized) else Sized(mpf(value))


def program(names):
    """Run closed_forms.py on inputs of any kind, and return all names with their values."""
    for name, source in closed_forms.CLOSED_FORMS.items():
        if name not in names:
            names[name] = evaluate(source, names)
    return names


def cancellation(inputs, p, s):
    """Return the largest factor by which the terms of an entry of A or B exceed the entry."""
    names = {name: sized(mpf(value.numerator) / value.denominator) for name, value in inputs.items()}
    zeta, omega0_squared, half = names["zeta"].value, names["omega0_squared"].value, names["T"].value / 2
    square = omega0_squared - zeta**2
    # In doubles, cosine and sine are off by as much as their argument is rounded.
    turn = max(1, mp.sqrt(square) * half) if square > 0 else 1
    reach = min(half, 1 / mp.sqrt(square)) if square > 0 else s
    decay = mp.exp(-zeta * half)
    cosine = 1 - omega0_squared * p - zeta * s
    names |= {"p": sized(p), "s": Sized(s, max(abs(s), decay * reach * turn))}
    names["cosine"] = Sized(cosine, max(abs(cosine), decay * turn) if square > 0 else abs(cosine))
    found = program(names)
    return max(found[name].size / abs(found[name].value) if found[name].value else mp.inf for name in ENTRIES)


def dyadic(value, bits):
    """Return the nearest multiple of 2^-bits."""
    return Fraction(round(value * 2**bits), 2**bits)


def draw(kind, uniform):
    """Return random inputs of one kind, without regard to cancellation."""
    period = dyadic(uniform(0.02, 0.5), 14)
    # omega0 T/2, up to almost a whole turn
    rate = 2 * uniform(0.1, 6.0) / float(period)
    omega0_squared = dyadic(rate * rate, 8)
    zeta = Fraction(0)
    if kind == "under-damped":
        zeta = dyadic(uniform(0.01, 0.9) * rate / (1 + rate * float(period) / 2), 10)
    elif kind == "over-damped":
        zeta = dyadic(uniform(1.1, 2.5) * rate, 10)
    elif kind == "critically damped":
        zeta = dyadic(min(rate, 6 / float(period)), 6)
        omega0_squared = zeta**2
    elif kind == "stiffness 0, damped":
        zeta, omega0_squared = dyadic(uniform(0.05, 3.0) / float(period), 10), Fraction(0)
    elif kind == "stiffness 0, undamped":
        omega0_squared = Fraction(0)
    lever = uniform(-0.6, 0.6)
    spring = dyadic(float(omega0_squared) * lever if omega0_squared else 30 * lever, 8)
    v = dyadic(-uniform(0.3, 60.0), 10)
    c1 = v + dyadic(-float(v) * uniform(0.3, 2.0), 10)
    return {
        "zeta": zeta,
        "omega0_squared": omega0_squared,
        "T": period,
        "r": dyadic(uniform(0.0, 1.0), 8),
        "spring": spring,
        "v": v,
        "c1": c1,
        "c2": dyadic(uniform(-8000.0, 8000.0), 6),
    }


def points(expressions):
    """Return [(kind, inputs, names, value, apart)]. `value` has the entries from the derived expressions, and `apart` is their
    largest relative difference from closed_forms.py."""
    generator = random.Random(SEED)

    def uniform(low, high):
        return low + (high - low) * generator.random()

    rows = []
    for kind, count in KINDS.items():
        kept = 0
        while kept < count:
            inputs = draw(kind, uniform)
            assert all(Fraction(float(value)) == value for value in inputs.values())
            names = {name: mpf(value.numerator) / value.denominator for name, value in inputs.items()}
            names["p"], names["s"] = responses(names["zeta"], names["omega0_squared"], names["T"] / 2)
            if not cancellation(inputs, names["p"], names["s"]) < LARGEST_CANCELLATION:
                continue
            value = {name: evaluate(expressions[name], names) for name in ENTRIES}
            transcribed = program(dict(names))
            apart = max(abs(transcribed[name] / value[name] - 1) for name in ENTRIES)
            rows.append((kind, inputs, names, value, apart))
            kept += 1
    return rows


def disagreement(rows):
    """Return the largest relative difference between the derived expressions and closed_forms.py over the points."""
    return max(row[4] for row in rows)


def in_doubles(rows):
    """Return the largest relative error of closed_forms.py in double precision, with cosine and sine from the library's functions."""
    worst = 0.0
    for _, inputs, _, value, _ in rows:
        names = {name: float(entry) for name, entry in inputs.items()}
        zeta, half = names["zeta"], names["T"] / 2
        square = names["omega0_squared"] - zeta * zeta
        rate, decay = math.sqrt(abs(square)), math.exp(-zeta * half)
        if square > 0:
            cosine, sine = decay * math.cos(rate * half), decay * math.sin(rate * half) / rate
        elif rate:
            cosine, sine = decay * math.cosh(rate * half), decay * math.sinh(rate * half) / rate
        else:
            cosine, sine = decay, decay * half
        found = program({**names, "cosine": cosine, "s": sine})
        worst = max(worst, *(float(abs(mpf(found[name]) / value[name] - 1)) for name in ENTRIES))
    return worst


def entry(row):
    """Return a point as it is written."""
    kind, inputs, names, value, _ = row
    decimals = {name: {"exact": str(number), "decimal": repr(float(number))} for name, number in inputs.items()}
    value = {name: text(number, DIGITS) for name, number in value.items()}
    return {
        "kind": kind,
        "inputs": decimals,
        "p": text(names["p"], DIGITS),
        "s": text(names["s"], DIGITS),
        "A": [[value["A11"], value["A12"]], [value["A21"], value["A22"]]],
        "B": [value["B1"], value["B2"]],
    }
