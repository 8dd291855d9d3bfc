"""Numbers to many digits: exact input, expression text, and the responses of free flight for any damping.

Uses mpmath alone, so that a script that only evaluates starts without computer algebra.
"""

import ast
import operator

from mpmath import mp, mpf

# Digits carried, and digits written for a result that a reader may rely on.
WORKING = 80
mp.dps = WORKING

OPERATORS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.USub: operator.neg,
}


def exact(value):
    """Return a decimal, given as text or as an integer, at working precision. Raise ValueError for anything that is no finite number."""
    if isinstance(value, bool) or not isinstance(value, (str, int)):
        raise ValueError(f"{value!r} is not a number")
    try:
        number = mpf(value)
    except (ValueError, TypeError) as error:
        raise ValueError(f"{value!r} is not a number") from error
    if not mp.isfinite(number):
        raise ValueError(f"{value!r} is not finite")
    return number


def text(value, digits):
    """Return a number as text with that many significant digits; "0" if the number is 0."""
    return mp.nstr(value, digits, strip_zeros=False, min_fixed=-6, max_fixed=16) if value else "0"


def evaluate(source, names):
    """Return the value of an expression in + - * / **, integers and names. Nothing else is allowed in the expression."""

    def value(node):
        if isinstance(node, ast.BinOp):
            return OPERATORS[type(node.op)](value(node.left), value(node.right))
        if isinstance(node, ast.UnaryOp):
            return OPERATORS[type(node.op)](value(node.operand))
        if isinstance(node, ast.Name):
            return names[node.id]
        if isinstance(node, ast.Constant) and isinstance(node.value, int):
            # an exponent stays an integer
            return node.value
        raise ValueError(f"{ast.dump(node)} has no place in {source}")

    return value(ast.parse(source, mode="eval").body)


def responses(zeta, omega0_squared, time):
    """Return (p, s) after `time`, where p' = s and s' = 1 - omega0^2 p - 2 zeta s, by power series and doubling.

    No formula is specific to one kind of damping, so the stiffness and the damping may be 0 or near 0.
    """
    halvings, size = 0, (2 * abs(zeta) + mp.sqrt(abs(omega0_squared))) * abs(time)
    while size > mpf(1) / 4:
        halvings, size = halvings + 1, size / 2
    short = time / 2**halvings
    # d_n = p^(n)(0): d_(n+1) = -2 zeta d_n - omega0^2 d_(n-1)
    before, now, power, n = mpf(0), mpf(1), short, 1
    p, s = mpf(0), short
    while power and n < 10 * mp.dps:
        # d_n t^n/n! = before, d_(n+1) t^n/n! = now
        before, now = now, -2 * zeta * now - omega0_squared * before
        n += 1
        p += before * power * short / n
        power *= short / n
        s += now * power
        if abs(now * power) + abs(before * power) <= mp.eps * abs(short) / 10**6:
            break
    for _ in range(halvings):
        p, s = later(zeta, omega0_squared, (p, s), (p, s))
    return p, s


def later(zeta, omega0_squared, first, second):
    """Return the responses after the sum of two times, from the responses after each: F_b (p, s)_a + (p, s)_b."""
    (p, s), (pb, sb) = first, second
    fb = 1 - omega0_squared * pb
    return fb * p + sb * s + pb, -omega0_squared * sb * p + (fb - 2 * zeta * sb) * s + sb


def flow(zeta, omega0_squared, response, state, force):
    """Return the state after a flight. `force` is the acceleration at the start position with v = 0."""
    p, s = response
    position, velocity = state
    return position + s * velocity + p * force, (1 - omega0_squared * p - 2 * zeta * s) * velocity + s * force
