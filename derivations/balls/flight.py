"""Free flight in balls, for any damping: m q'' + b q' + k (q - rest) = -m g.

    p'' + 2 zeta p' + w0^2 p = 1, p(0) = p'(0) = 0, s = p':  the responses p to a unit step and s to a unit impulse after a time.
"""

from flint import arb

from .numbers import Refused, decimal

FIELDS = ("mass", "damping", "stiffness", "gravity", "restitution")


class Follower:
    """The [follower] table. Its numbers are the exact rationals of its decimals, so that the kind of damping is decided.

    `lowest` returns the lowest lift of the cam, at which the spring presses with its preload: k (lowest - rest) = preload.
    """

    def __init__(self, table, lowest):
        spring = "preload" if "preload" in table else "rest_position"
        missing = [name for name in (*FIELDS, spring) if name not in table]
        if missing:
            raise Refused(f"the model has no follower.{missing[0]}")
        unknown = sorted(set(table) - {*FIELDS, spring})
        if unknown:
            raise Refused(f"follower.{unknown[0]}: the laws of flight and impact of the proofs do not contain it")
        mass, damping, stiffness, gravity, restitution, rest = (decimal(table[name]) for name in (*FIELDS, spring))
        if not (mass > 0 and damping >= 0 and stiffness >= 0 and 0 <= restitution <= 1):
            raise Refused("follower: mass must be above 0, damping and stiffness at least 0, and restitution from 0 to 1")
        if spring == "preload":
            if not stiffness > 0:
                raise Refused("follower.preload needs a spring")
            rest = lowest() - arb(rest / stiffness)
        zeta, omega0_squared = damping / (2 * mass), stiffness / mass
        # Positive below critical damping, negative above it.
        discriminant = omega0_squared - zeta * zeta
        self.oscillates, self.is_critical = discriminant > 0, discriminant == 0
        self.has_spring = stiffness > 0
        self.zeta, self.omega0_squared, self.gravity = arb(zeta), arb(omega0_squared), arb(gravity)
        self.rate = arb(abs(discriminant)).sqrt()
        self.rest, self.restitution = arb(rest), arb(restitution)
        # The paper's x is measured from the spring's equilibrium. Without stiffness it is measured from the rest position.
        self.origin = arb(rest - gravity / omega0_squared if stiffness > 0 else rest)

    def response(self, time):
        """Return (p, s, s') after a ball of times."""
        zeta, rate = self.zeta, self.rate
        if self.is_critical:
            # s = t e^{-zeta t}, s' = (1 - zeta t) e^{-zeta t}
            decay = (-zeta * time).exp()
            s, s1 = time * decay, (1 - zeta * time) * decay
        elif self.oscillates:
            # s = e^{-zeta t} sin(w t)/w, s' = e^{-zeta t} (cos(w t) - zeta sin(w t)/w)
            sin, cos = (rate * time).sin_cos()
            s, s1 = sin / rate, cos
            if zeta != 0:
                decay = (-zeta * time).exp()
                s, s1 = decay * s, decay * (s1 - zeta * s)
        else:
            # s = e^{-zeta t} sinh(l t)/l, s' = e^{-zeta t} (cosh(l t) - zeta sinh(l t)/l)
            sinh, cosh = (rate * time).sinh_cosh()
            decay = (-zeta * time).exp()
            s, s1 = decay * sinh / rate, decay * (cosh - zeta * sinh / rate)
        if self.has_spring:
            # w0^2 p = 1 - s' - 2 zeta s
            p = (1 - s1 - 2 * zeta * s) / self.omega0_squared
        elif zeta != 0:
            # p' = s = (1 - e^{-2 zeta t})/(2 zeta)
            p = (time - s) / (2 * zeta)
        else:
            p = time * time / 2
        return p, s, s1

    def force(self, position):
        """Return the acceleration at a position with no velocity: -w0^2 (q - rest) - g."""
        return -self.omega0_squared * (position - self.rest) - self.gravity

    def fly(self, response, position, velocity):
        """Return (q, v) after the time of a response: q = q0 + s v0 + p f0, v = s' v0 + s f0."""
        p, s, s1 = response
        force = self.force(position)
        return position + s * velocity + p * force, s1 * velocity + s * force

    def acceleration(self, position, velocity):
        """Return q'' = f(q) - 2 zeta v."""
        return self.force(position) - 2 * self.zeta * velocity

    def rebound(self, cam_velocity, velocity):
        """Return the velocity after an impact, by Newton's law: v+ = (1 + r) c' - r v-."""
        return (1 + self.restitution) * cam_velocity - self.restitution * velocity
