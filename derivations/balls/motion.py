"""One flight over the cam, from a ball of starts: its gap, its first contact, the impact map and its derivative.

A start is (theta, u, omega): the follower leaves the cam at the angle theta with the velocity u relative to it, while the cam turns
at omega. The gap after a time t is

    g(t; theta, u, omega) = q(t) - c(theta + omega t),   q(0) = c(theta), q'(0) = c'(theta) omega + u,

so that g(0) = 0 and g'(0) = u. The gap is enclosed by the mean value form in the start, about the ball's centre, and by Taylor's
formula of second order in t, about the middle of the times.
"""

from dataclasses import dataclass

from flint import arb, arb_mat

from .cam import Cam
from .flight import Follower
from .numbers import Excluded, Refused, Undecided, between, overlap

# Steps of the proof that no contact comes earlier: the first step, as a part of a revolution, and how often it is halved.
FIRST_STEP = 1 / 16
HALVINGS = 24
# Most steps of Newton's method. Each step doubles the digits.
NEWTON = 12


class Machine:
    """Follower on a cam."""

    def __init__(self, document):
        for name in ("follower", "cam"):
            if not isinstance(document.get(name), dict):
                raise Refused(f"the model has no [{name}]")
        self.cam = Cam(document["cam"])
        self.follower = Follower(document["follower"], self.cam.lowest)


@dataclass(frozen=True)
class Start:
    """Ball of starts: cam angle, rad, velocity relative to the cam, m/s, and cam speed, rad/s."""

    angle: arb
    velocity: arb
    speed: arb

    def __iter__(self):
        return iter((self.angle, self.velocity, self.speed))

    def centre(self):
        """Return the start at the centre of the ball."""
        return Start(*(number.mid() for number in self))

    def offsets(self):
        """Return the offsets of the starts in the ball from its centre, as balls."""
        return [number - number.mid() for number in self]


class Flight:
    """Flights from a ball of starts. `law` is the law of the piece on which all of them start; by default the cam gives the law."""

    def __init__(self, machine, start, law=None):
        self.machine, self.start, self.law = machine, start, law
        if law is None:
            (lift, slope, curvature, _), self.starts_smoothly = machine.cam.seen(start.angle)
        else:
            (lift, slope, curvature, _), self.starts_smoothly = law.derivatives(start.angle), True
        self.slope, self.curvature, self.position = slope, curvature, lift
        self.velocity = slope * start.speed + start.velocity
        offsets = start.offsets()
        self.is_point = all(offset == 0 for offset in offsets)
        self.offsets = offsets
        self.centre = self if self.is_point else Flight(machine, start.centre(), law)

    def angle(self, time):
        """Return the cam angle, theta + omega t."""
        return self.start.angle + self.start.speed * time

    def state(self, time):
        """Return (q, v) at a ball of times, by direct evaluation."""
        return self.machine.follower.fly(self.machine.follower.response(time), self.position, self.velocity)

    def _kinematics(self, time):
        """Return the numbers that every enclosure needs at a ball of times: response, state, (c, c', c'', c''') under the follower,
        and True if Taylor's formula holds."""
        follower = self.machine.follower
        response = follower.response(time)
        lifts, smooth = self.machine.cam.seen(self.angle(time))
        return response, follower.fly(response, self.position, self.velocity), lifts, smooth and self.starts_smoothly

    def gap_by_start(self, time, seen=None):
        """Return (g_theta, g_u, g_omega) over the ball."""
        (p, s, _), _, (_, slope, _, _), _ = seen or self._kinematics(time)
        omega0_squared, speed = self.machine.follower.omega0_squared, self.start.speed
        # q_theta = (1 - w0^2 p) c'(theta) + s c''(theta) omega, q_u = s, q_omega = s c'(theta)
        of_angle = (1 - omega0_squared * p) * self.slope + s * self.curvature * speed - slope
        return of_angle, s, s * self.slope - slope * time

    def rate_by_start(self, time, seen=None):
        """Return (g'_theta, g'_u, g'_omega) over the ball, where ' is by time."""
        (_, s, s1), _, (_, slope, curvature, _), _ = seen or self._kinematics(time)
        omega0_squared, speed = self.machine.follower.omega0_squared, self.start.speed
        # v_theta = -w0^2 s c'(theta) + s' c''(theta) omega, v_u = s', v_omega = s' c'(theta)
        of_angle = -omega0_squared * s * self.slope + s1 * self.curvature * speed - curvature * speed
        return of_angle, s1, s1 * self.slope - slope - curvature * speed * time

    def _rate_rate(self, seen):
        """Return g'' = q'' - c'' omega^2 over the ball."""
        _, (position, velocity), (_, _, curvature, _), _ = seen
        return self.machine.follower.acceleration(position, velocity) - curvature * self.start.speed**2

    def _at(self, time, seen=None):
        """Return (g, g') by direct evaluation, without a form that narrows them."""
        _, (position, velocity), (lift, slope, _, _), _ = seen or self._kinematics(time)
        return position - lift, velocity - slope * self.start.speed

    def gap(self, time):
        """Return g over a ball of times and all starts."""
        seen, middle = self._kinematics(time), time.mid()
        if not seen[-1]:
            return self._at(time, seen)[0]
        gap, rate = self.centre._at(middle)
        later = time - middle
        gap += (rate + self._rate_rate(seen) * later / 2) * later
        return gap if self.is_point else gap + _along(self.gap_by_start(time, seen), self.offsets)

    def gap_rate(self, time):
        """Return g' over a ball of times and all starts."""
        seen, middle = self._kinematics(time), time.mid()
        if not seen[-1]:
            return self._at(time, seen)[1]
        rate = self.centre._at(middle)[1] + self._rate_rate(seen) * (time - middle)
        return rate if self.is_point else rate + _along(self.rate_by_start(time, seen), self.offsets)

    def contact_near(self, time, known=False):
        """Return a ball that holds a contact of each flight, the only one within `time`, by interval Newton; None if that is not
        proved.

        The result is None also if the lift or its slope may jump under the ball. With `known`, each flight is known to have a contact
        within `time`.
        """
        if not (self.starts_smoothly and self.machine.cam.is_smooth(self.angle(time))):
            return None
        for _ in range(NEWTON):
            rate, middle = self.gap_rate(time), time.mid()
            if not rate < 0:
                return None
            # If N(T) = m - g(m)/g'(T) lies in T, each start has one contact in T, and this contact lies in N(T).
            step = middle - self.gap(middle) / rate
            known = known or time.contains(step)
            step = overlap(time, step) if known else None
            if step is None or not step.rad() < time.rad() * 0.75:
                return step
            time = step
        return time

    def lowest(self, time):
        """Return a ball of times in which each flight is lowest over `time`, by interval Newton. Return None unless it is proved that
        the gap falls at the beginning of `time`, rises at its end, and has g'' > 0 in between."""
        seen = self._kinematics(time)
        if not (seen[-1] and self._rate_rate(seen) > 0 and self.gap_rate(time.lower()) < 0 < self.gap_rate(time.upper())):
            return None
        for _ in range(NEWTON):
            middle = time.mid()
            step = overlap(time, middle - self.gap_rate(middle) / self._rate_rate(self._kinematics(time)))
            if step is None or not step.rad() < time.rad() * 0.75:
                break
            time = step
        return time

    def first_contact(self, horizon, contact=None, skipped=None, clear=None):
        """Return the time of the first contact of each flight, proved to be the first: g > 0 before it, and g' < 0 at it.

        The contact is sought up to `horizon`, s. If `contact` is given, it is a ball in which g is known to be 0. Times between the
        ends of `skipped` are not examined. Up to `clear` the follower is known to be above the cam. Raise Refused if the flight may
        touch the cam, or if the steps of the proof become too short. Raise Excluded if the flight is proved to meet the cam
        elsewhere.
        """
        revolution = 2 * arb.pi() / self.start.speed.mid()
        shortest = float(revolution.mid()) * FIRST_STEP / 2**HALVINGS
        step = self._launched(revolution, shortest) if clear is None else float(clear)
        reached, landing = step, contact and float(contact)
        while reached < horizon:
            if skipped is not None and reached <= skipped[0] < reached + step:
                if not (reached == skipped[0] or self.gap(between(reached, skipped[0])) > 0):
                    step = (skipped[0] - reached) * 0.75
                else:
                    reached = skipped[1]
                continue
            if landing is None and not self.centre._at(arb(reached + step))[0] > 0:
                landing = self.centre._closed(reached, reached + step)
            if landing is not None and reached + 2 * step >= landing:
                if contact is None:
                    contact = self._contact_about(landing)
                if contact > reached and self.gap_rate(between(reached, contact)) < 0:
                    return contact
            if self.gap(between(reached, reached + step)) > 0:
                reached += step
                step *= 1.5
                continue
            if contact is not None and contact > reached + step and self.gap(arb(reached + step)) < 0:
                raise Excluded(f"the flight meets the cam elsewhere, within {reached + step:.6g} s after it began")
            step /= 2
            if step < shortest:
                raise Refused(f"the flight is not proved to be clear of the cam {reached:.6g} s after its start: it may touch the cam")
        raise Refused(f"no contact within {horizon:.6g} s")

    def _launched(self, revolution, shortest):
        """Return a time up to which g' > 0, so that g > 0 except at t = 0."""
        if not self.start.velocity > 0:
            raise Undecided("the follower is not proved to leave the cam")
        step = float(revolution.mid()) * FIRST_STEP
        while not self.gap_rate(between(0, step)) > 0:
            step /= 2
            if step < shortest:
                raise Undecided("the follower is not proved to get clear of the cam")
        return step

    def _closed(self, low, high):
        """Return a guess of the time at which the flight from the centre lands, by halving."""
        for _ in range(50):
            middle = (low + high) / 2
            low, high = (middle, high) if self._at(arb(middle))[0] > 0 else (low, middle)
        return (low + high) / 2

    def _contact_about(self, landing):
        """Return the contact near a guess, proved to be one. Raise Undecided if it is not proved."""
        # The ball is as wide as the starts make it, plus more than the error of the guess.
        rate = self.centre._at(arb(landing))[1]
        if not rate < 0:
            raise Undecided(f"the flight is not proved to land about {landing:.6g} s after it began: it may touch")
        spread = abs(_along(self.gap_by_start(arb(landing)), self.offsets) / rate).upper() if not self.is_point else arb(0)
        reach = 2 * spread + abs(self.centre._at(arb(landing))[0] / rate).upper() * 2 + arb(landing) * 2**-40
        contact = self.contact_near(arb(landing) + arb(0, reach))
        if contact is None:
            raise Undecided(f"the flight is not proved to land once about {landing:.6g} s after it began")
        return contact


def _along(gradient, offsets):
    return sum((slope * offset for slope, offset in zip(gradient, offsets)), arb(0))


@dataclass(frozen=True)
class Impact:
    """Image of a ball of starts under the impact map: the next starts, the next start of the centre, the derivative, and the flight's
    time."""

    start: Start
    centre: Start
    derivative: arb_mat
    time: arb


def derivative(flight, time):
    """Return d(theta', u')/d(theta, u, omega), 2 x 3, over all starts whose contact is within `time`. Across corners, c'' is the hull."""
    machine, (_, _, speed) = flight.machine, flight.start
    seen = flight._kinematics(time)
    (_, s, s1), (position, velocity), (_, slope, curvature, _), _ = seen
    follower = machine.follower
    rate, acceleration = velocity - slope * speed, follower.acceleration(position, velocity)
    at_start = flight.slope, flight.curvature * speed
    # Derivatives of (q0, v0) by theta, u and omega.
    starts = ((at_start[0], at_start[1]), (arb(0), arb(1)), (arb(0), flight.slope))
    rows = [[], []]
    for index, (gap_by, (q_by, v_by)) in enumerate(zip(flight.gap_by_start(time, seen), starts)):
        # g(t; x) = 0 gives t_x = -g_x/g'; theta' = theta + omega t; u' = r (c'(theta') omega - v)
        time_by = -gap_by / rate
        angle_by = speed * time_by + (1 if index == 0 else time if index == 2 else 0)
        cam_by = curvature * speed * angle_by + (slope if index == 2 else 0)
        velocity_by = -follower.omega0_squared * s * q_by + s1 * v_by + acceleration * time_by
        rows[0].append(angle_by)
        rows[1].append(follower.restitution * (cam_by - velocity_by))
    return arb_mat(rows)


def impact_map(machine, start, horizon):
    """Return the image of a ball under f: (theta, u, omega) to (theta', u') after the first contact, proved to be the first of every
    start.

    The image is the image of the centre plus the derivative times the offsets. Where c'' jumps under the ball, f is Lipschitz with
    the hull of its derivatives, so that the mean value form still holds.
    """
    flight = Flight(machine, start)
    return impact(flight, flight.first_contact(horizon))


def impact(flight, time):
    """Return the image of the flights under the impact map. `time` must be proved to hold one contact of each flight, its first."""
    jacobian, centre, follower = derivative(flight, time), flight.centre, flight.machine.follower
    at_centre = centre.contact_near(time, known=True) or time
    angle, (_, velocity), speed = centre.angle(at_centre), centre.state(at_centre), centre.start.speed
    slope = flight.machine.cam.derivatives(angle)[1]
    image = angle, follower.restitution * (slope * speed - velocity)
    whole = [value + _along([jacobian[row, k] for k in range(3)], flight.offsets) for row, value in enumerate(image)]
    return Impact(Start(*whole, flight.start.speed), Start(*image, speed), jacobian, time)
