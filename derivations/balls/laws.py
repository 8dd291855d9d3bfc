"""Lift laws c(theta), with derivatives by the angle, over a ball of angles."""

from flint import arb


class Circle:
    """Circle about the polar point (distance kappa, direction), seen from the axis: c = kappa cos(phi) + sqrt(rho^2 - kappa^2 sin^2(phi))."""

    def __init__(self, distance, direction, radius):
        self.distance, self.direction, self.radius = distance, direction, radius

    def derivatives(self, angle):
        """(c, c', c'', c''') over the ball."""
        sin, cos = (angle - self.direction).sin_cos()
        # a = kappa sin(phi), b = kappa cos(phi), w^2 = rho^2 - a^2; a' = b, b' = -a.
        a, b = self.distance * sin, self.distance * cos
        w = ((self.radius - a) * (self.radius + a)).sqrt()
        # w w' = -a b,  w'^2 + w w'' = a^2 - b^2,  3 w' w'' + w w''' = 4 a b
        w1 = -(a * b) / w
        w2 = ((a - b) * (a + b) - w1 * w1) / w
        w3 = (4 * a * b - 3 * w1 * w2) / w
        return b + w, w1 - a, w2 - b, w3 + a


class OffsetCircle:
    """Circle about the polar point (distance kappa, direction), met by a line at an offset e to the left of the axis.

        c = kappa cos(phi) + sqrt(rho^2 - (kappa sin(phi) + e)^2)
    """

    def __init__(self, distance, direction, radius, offset):
        self.distance, self.direction, self.radius, self.offset = distance, direction, radius, offset

    def derivatives(self, angle):
        """(c, c', c'', c''') over the ball."""
        sin, cos = (angle - self.direction).sin_cos()
        # a = kappa sin(phi), b = kappa cos(phi), s = a + e, w^2 = rho^2 - s^2; a' = s' = b, b' = -a.
        a, b = self.distance * sin, self.distance * cos
        s = a + self.offset
        w = ((self.radius - s) * (self.radius + s)).sqrt()
        # w w' = -s b,  w'^2 + w w'' = s a - b^2,  3 w' w'' + w w''' = (3 a + s) b
        w1 = -(s * b) / w
        w2 = (s * a - b * b - w1 * w1) / w
        w3 = ((3 * a + s) * b - 3 * w1 * w2) / w
        return b + w, w1 - a, w2 - b, w3 + a


class Waves:
    """c = sum a_k u^k + sum amplitude cos(frequency u + phase), u = theta - start."""

    def __init__(self, start, coefficients, waves=()):
        self.start, self.coefficients, self.waves = start, [arb(a) for a in coefficients], waves

    def derivatives(self, angle):
        """(c, c', c'', c''') over the ball."""
        u = angle - self.start
        c, c1, c2, c3 = arb(0), arb(0), arb(0), arb(0)
        # Horner's scheme, differentiated three times.
        for a in reversed(self.coefficients):
            c3, c2, c1, c = c3 * u + 3 * c2, c2 * u + 2 * c1, c1 * u + c, c * u + a
        for amplitude, frequency, phase in self.waves:
            sin, cos = (frequency * u + phase).sin_cos()
            along, across = amplitude * cos, amplitude * frequency * sin
            c, c1, c2, c3 = c + along, c1 - across, c2 - frequency**2 * along, c3 + frequency**2 * across
        return c, c1, c2, c3


class Levered:
    """Law behind a lever: every lift is multiplied by the lever's ratio."""

    def __init__(self, law, ratio):
        self.law, self.ratio = law, ratio

    def derivatives(self, angle):
        """(c, c', c'', c''') over the ball."""
        return tuple(self.ratio * part for part in self.law.derivatives(angle))
