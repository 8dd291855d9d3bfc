"""Orbits beside a corner impact: the range about it in which the fixed point of each side is proved to exist.

Let theta be the angle of the impact at the corner, and take the law of one side of the corner, continued past it. The equations of
the orbit are F(w; theta) = 0, where w is the period and the velocities and the other angles of the impacts. Krawczyk's operator over
a ball of angles about the corner shows that each theta has one root w in a box. Then dw/dtheta = -(dF/dw)^-1 dF/dtheta is enclosed
over the box. If dT/dtheta has one sign, there is one fixed point for every period about T*. If every flight is clear of the cam, this
fixed point is an orbit of the machine for the angles on the side of the law, and not for the angles on the other side.
"""

from dataclasses import dataclass

from flint import arb, arb_mat

from .duals import Dual, lift, response
from .krawczyk import inverse
from .motion import Flight, Start
from .numbers import Refused, Undecided, between, sign, within

# Distances from the corner, rad, within which the fixed points are sought, the widest first.
REACHES = tuple(mantissa * 10.0**-exponent for exponent in range(1, 12) for mantissa in (5, 2, 1))
# Factor by which boxes are wider than the derivative at the corner suggests.
WIDER = 1.5


@dataclass(frozen=True)
class Followed:
    """Range in which a side has one fixed point: every period within `period` of T*, s. The impact of the fixed point lies within
    `reach` of the corner, rad, and its state within `state` of x*. The fixed point is an orbit of the machine for the periods on one
    side of T*, "slower" or "faster"."""

    period: float
    reach: float
    state: list
    exists_for: str


def followed(orbit, side):
    """Return the widest range in which the fixed point of a side, "before" or "after", is proved to exist; None if there is none."""
    for reach in REACHES:
        try:
            return _within(orbit, side, reach)
        except (Refused, ZeroDivisionError):
            continue
    return None


def _within(orbit, side, reach):
    machine, count = orbit.machine, 2 * len(orbit.impacts)
    laws = [getattr(orbit.corner, side)] + [impact.law for impact in orbit.impacts[1:]]
    # w in the order of the equations of the corner impact: T and v, then angle and velocity of each other impact.
    at = [orbit.period, orbit.impacts[0].velocity] + [x for impact in orbit.impacts[1:] for x in (impact.angle, impact.velocity)]
    angles = orbit.corner.angle + arb(0, reach)

    def over(places, angle):
        """Return F, dF/dw and dF/dtheta."""
        *w, theta = Dual.varied([*places, angle])
        found = orbit.closing(laws, w[0], [theta, *w[2::2]], [w[1], *w[3::2]])
        return tuple(arb_mat(rows) for rows in zip(*(([one.value], one.slopes[:count], one.slopes[count:]) for one in found)))

    centre = [one.mid() for one in at]
    value, jacobian, by_angle = over(centre, orbit.corner.angle)
    near = inverse(jacobian)
    steps = near * by_angle
    box = [one + arb(0, (abs(steps[row, 0]).upper() * reach + one.rad()) * WIDER) for row, one in enumerate(at)]
    # Y F(c; theta) = Y F(c; corner) + Y dF/dtheta (theta - corner)
    there = near * value + near * over(centre, angles)[2] * arb(0, reach)
    _, jacobian, by_angle = over(box, angles)
    off = arb_mat([[int(i == j) for j in range(count)] for i in range(count)]) - near * jacobian
    image = arb_mat([[c] for c in centre]) - there + off * arb_mat([[one - c] for one, c in zip(box, centre)])
    if not all(within(image[row, 0], one) for row, one in enumerate(box)):
        raise Undecided("the fixed point is not proved to be alone")
    rates = -(near * jacobian).solve(near * by_angle)
    later = sign(rates[0, 0], "the period by the impact's angle") * (-1 if side == "before" else 1)
    # From the corner to the end of the ball on the side where the law holds.
    shift = between(0, arb(-reach if side == "before" else reach))
    _prove_flights(orbit, laws, orbit.corner.angle + shift, [one + rates[row, 0] * shift for row, one in enumerate(at)])
    *w, theta = Dual.varied([*box, angles])
    leaving = orbit.longest
    angle, velocity = (theta, w[1]) if leaving == 0 else (w[2 * leaving], w[2 * leaving + 1])
    flown = response(machine.follower, (orbit.section - angle) * w[0] / machine.cam.turn)
    state = machine.follower.fly(flown, lift(laws[leaving], angle)[0], velocity)
    moved = [sum((slope * rates[row, 0] for row, slope in enumerate(one.slopes[:count])), one.slopes[count]) for one in state]
    # Two digits, rounded to the safe side: the period down, the state up.
    period = float(f"{float(abs(rates[0, 0]).lower() * reach) * 0.95:.1e}")
    states = [float(f"{float(abs(one).upper() * reach) * 1.06:.1e}") for one in moved]
    return Followed(period, reach, states, "slower" if later > 0 else "faster")


def _prove_flights(orbit, laws, angle, w):
    """Prove that each flight leaves the cam, stays clear of it and lands, from balls of impacts on the sides where their laws hold."""
    cam, speed = orbit.machine.cam, orbit.machine.cam.turn / w[0]
    angles, velocities = [angle, *w[2::2], angle + orbit.revolutions * cam.turn], [w[1], *w[3::2]]
    # The piece of the first impact reaches from the corner to beyond the end of the ball that is farther from the corner.
    far = angle.lower() if _piece(laws[0]) is _piece(orbit.corner.before) else angle.upper()
    stays = _piece(cam.piece_of(arb(far)).law) is _piece(laws[0])
    if not (stays and all(piece.holds(other) for piece, other in zip(orbit.pieces, angles[1:]))):
        raise Undecided("an impact is not proved to stay on its piece of the cam")
    for k, law in enumerate(laws):
        relative = velocities[k] - law.derivatives(angles[k])[1] * speed
        time = (angles[k + 1] - angles[k]) / speed
        Flight(orbit.machine, Start(angles[k], relative, speed), law).first_contact(float(time) * 2, time)


def _piece(law):
    """Return the innermost law of a piece of the cam, without its turn or its lever."""
    while hasattr(law, "law"):
        law = law.law
    return law
