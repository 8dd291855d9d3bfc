"""Decimals of a model file as rationals, balls as text that certainly holds them, and proved signs."""

from fractions import Fraction

from flint import arb, ctx, fmpq

# Largest exponent that is read. Doubles have none beyond it, and larger numbers would only take memory.
LARGEST_EXPONENT = 400
# Decimal digits per bit of a ball: log10(2), rounded down.
BITS_TO_DIGITS = 0.30102


class Refused(Exception):
    """A statement that is not proved, or an input that is no valid model. The message says what was found."""


class Excluded(Refused):
    """The statement is proved to be false."""


class Undecided(Refused):
    """The balls are too wide to decide the statement."""


def decimal(value):
    """Return a decimal, given as text or as an integer, as an exact rational. Text may end with " * a/b", a quotient of whole
    numbers. Raise Refused for anything else."""
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
    """Return a ball as {"mid", "rad"}, in decimals. Every number of the ball lies within rad of mid. `mid` has no more digits than
    are proved, each right up to one unit of the last."""
    if not number.is_finite():
        raise Undecided("a ball is unbounded")
    mid, _, rad = number.str(int(ctx.prec * BITS_TO_DIGITS)).strip("[]").partition("+/-")
    return {"mid": mid.strip() or "0", "rad": rad.strip() or "0"}


def hull(balls):
    """Return the smallest ball, or nearly, that holds all of the balls."""
    balls = iter(balls)
    whole = next(balls)
    for one in balls:
        whole = whole.union(one)
    return whole


def between(low, high):
    """Return the ball of all numbers from one number or ball to another."""
    return arb(low).union(arb(high))


def overlap(one, other):
    """Return a ball that holds the common part of two balls; None if it is proved that there is none."""
    return one.intersection(other) if one.overlaps(other) else None


def within(inner, outer):
    """Return True if one ball is proved to lie in the interior of another."""
    return bool(inner.lower() > outer.lower() and inner.upper() < outer.upper())


def sign(number, what):
    """Return the proved sign, 1 or -1. Raise Undecided if the ball holds 0."""
    if number > 0:
        return 1
    if number < 0:
        return -1
    raise Undecided(f"the sign of {what} is not decided: it lies in {number.str(5, more=True)}")
