"""Decimals as a model file writes them, balls as text that certainly holds them, and signs that are proved."""

from fractions import Fraction

from flint import arb, ctx, fmpq

# A double has no exponent beyond this; more digits than that would only take memory.
LARGEST_EXPONENT = 400
# log10(2), rounded down: more digits than that no ball of so many bits has.
BITS_TO_DIGITS = 0.30102


class Refused(Exception):
    """What was to be proved is not so, or is no model: the sentence says what was found."""


class Excluded(Refused):
    """It is proved not to be so."""


class Undecided(Refused):
    """The balls are too wide to tell."""


def decimal(value):
    """A decimal, as text or as an integer, as the rational number that it is; text may go on with " * a/b", a quotient of whole numbers."""
    if isinstance(value, bool) or not isinstance(value, (str, int)):
        raise Refused(f"{value!r} is not a number")
    written, _, factor = str(value).partition("*")
    _, _, exponent = written.lower().partition("e")
    try:
        if exponent and abs(int(exponent)) > LARGEST_EXPONENT:
            raise Refused(f"{value!r} is outside the range of a double")
        number = Fraction(written) * Fraction(factor or 1)
    except ValueError as error:
        raise Refused(f"{value!r} is not a number") from error
    return fmpq(number.numerator, number.denominator)


def ball(number):
    """A ball as {"mid", "rad"}, decimals: whatever the ball holds lies within rad of mid, and mid has no more digits than are proved,
    each right but for one unit of the last."""
    if not number.is_finite():
        raise Undecided("a ball is unbounded")
    mid, _, rad = number.str(int(ctx.prec * BITS_TO_DIGITS)).strip("[]").partition("+/-")
    return {"mid": mid.strip() or "0", "rad": rad.strip() or "0"}


def hull(balls):
    """The smallest ball, or nearly, that holds all of them."""
    balls = iter(balls)
    whole = next(balls)
    for one in balls:
        whole = whole.union(one)
    return whole


def between(low, high):
    """The ball of all numbers from one number or ball to another."""
    return arb(low).union(arb(high))


def overlap(one, other):
    """A ball that holds what two balls share; None where it is proved that they share nothing."""
    return one.intersection(other) if one.overlaps(other) else None


def within(inner, outer):
    """Whether it is proved that one ball lies in the inside of another."""
    return bool(inner.lower() > outer.lower() and inner.upper() < outer.upper())


def sign(number, what):
    """1 or -1, proved; Undecided where the ball holds 0."""
    if number > 0:
        return 1
    if number < 0:
        return -1
    raise Undecided(f"the sign of {what} is not decided: it lies in {number.str(5, more=True)}")
