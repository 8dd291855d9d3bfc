"""Dual numbers over balls: a value and its derivatives by a few variables, carried along by the rules of calculus."""

from flint import arb


class Dual:
    """Ball of values, with a ball of derivatives by each variable."""

    __slots__ = ("value", "slopes")

    def __init__(self, value, slopes):
        self.value, self.slopes = value, slopes

    @classmethod
    def varied(cls, values):
        """Return the variables themselves as duals: each has derivative 1 by itself."""
        return [cls(value, [arb(int(one == other)) for other in range(len(values))]) for one, value in enumerate(values)]

    def constant(self, value):
        """Return a number that depends on no variable."""
        return Dual(value, [arb(0)] * len(self.slopes))

    def through(self, value, rate):
        """Return f of this number, from the value of f and its derivative there."""
        return Dual(value, [rate * slope for slope in self.slopes])

    def __add__(self, other):
        if not isinstance(other, Dual):
            return Dual(self.value + other, self.slopes)
        return Dual(self.value + other.value, [a + b for a, b in zip(self.slopes, other.slopes)])

    def __neg__(self):
        return Dual(-self.value, [-a for a in self.slopes])

    def __sub__(self, other):
        return self + -other

    def __rsub__(self, other):
        return -self + other

    def __mul__(self, other):
        if not isinstance(other, Dual):
            return Dual(self.value * other, [a * other for a in self.slopes])
        return Dual(self.value * other.value, [self.value * b + other.value * a for a, b in zip(self.slopes, other.slopes)])

    def __truediv__(self, other):
        if not isinstance(other, Dual):
            return self * (1 / arb(other))
        return self * other.through(1 / other.value, -1 / other.value**2)

    def __rtruediv__(self, other):
        return self.constant(arb(other)) / self

    __radd__, __rmul__ = __add__, __mul__


def response(follower, time):
    """Return (p, s, s') of the follower after a dual time: p' = s, s'' = -w0^2 s - 2 zeta s'."""
    p, s, s1 = follower.response(time.value)
    s2 = -follower.omega0_squared * s - 2 * follower.zeta * s1
    return time.through(p, s), time.through(s, s1), time.through(s1, s2)


def lift(law, angle):
    """Return (c, dc/dtheta) of a law at a dual angle."""
    c, c1, c2, _ = law.derivatives(angle.value)
    return angle.through(c, c1), angle.through(c1, c2)
