"""The problem that every peer is given: the follower, the cam, and the loop around its flights.

A peer is a class with a constructor `Peer(problem, tolerance)`. Its `above` is the height above the cam, m, at which flights start
after an impact: 0, or an ulp or two if the peer does not accept a gap of exactly 0. It has a method

    fly(t, state, end, arc) -> (t, state, hit)

The method integrates the free flight from `t` to `end` at the latest, s since the start of the run, and stops where the gap between
follower and cam turns negative. With an `arc` the cam is that circle alone: the run is restarted at corners, as by a careful user.
With None it is the whole cam: flights are integrated across corners, as a user would do at first. `main` reads a task from stdin and
writes the results to stdout. The peer is built outside the time that is measured.
"""

import json
import math
import sys
import time
from bisect import bisect_right

# A flight that is deeper than this below the cam has passed through it, m.
THROUGH = 1e-9
# Impacts in a row at one instant after which a run counts as standing still.
STANDSTILL = 1000
# Most impacts that are returned; the rest is only counted.
KEPT = 10_000
# Points at which a flight is checked afterwards, in closed form, for having passed through the cam.
LOOKS = 100


class Arc:
    """Circle of the cam's outline about (distance, direction): `c = kappa cos phi + sqrt(rho^2 - kappa^2 sin^2 phi)`."""

    def __init__(self, distance, direction, radius):
        self.distance, self.direction, self.radius = distance, direction, radius

    def lift(self, theta):
        phi = theta - self.direction
        across = self.distance * math.sin(phi)
        return self.distance * math.cos(phi) + math.sqrt((self.radius - across) * (self.radius + across))

    def slope(self, theta):
        phi = theta - self.direction
        across = self.distance * math.sin(phi)
        return -across - across * self.distance * math.cos(phi) / math.sqrt((self.radius - across) * (self.radius + across))


class Problem:
    """Undamped follower over a turning cam, from a start."""

    def __init__(self, task, start):
        self.omega0_squared, self.equilibrium, self.restitution, self.omega = (
            task["problem"][name] for name in ("omega0_squared", "equilibrium", "restitution", "omega")
        )
        self.starts = [arc[0] for arc in task["problem"]["arcs"]]
        self.arcs = [Arc(*arc[1:]) for arc in task["problem"]["arcs"]]
        self.start_angle, *self.state = start
        self.end = task["turn"] / self.omega

    def angle(self, t):
        return self.start_angle + self.omega * t

    def arc_at(self, theta):
        return self.arcs[bisect_right(self.starts, theta % math.tau) - 1]

    def gap(self, t, q, arc=None):
        """Return the height of the follower above the cam, m: the event function."""
        theta = self.angle(t)
        return q - (arc or self.arc_at(theta)).lift(theta)

    def acceleration(self, q):
        return -self.omega0_squared * (q - self.equilibrium)

    def stretches(self):
        """Yield (arc, time when it ends) for one arc after the other, from the start of the run on."""
        index = bisect_right(self.starts, self.start_angle) - 1
        for turn in range(sys.maxsize):
            for k in range(index if turn == 0 else 0, len(self.arcs)):
                ends = (self.starts + [math.tau])[k + 1] + math.tau * turn
                yield self.arcs[k], (ends - self.start_angle) / self.omega

    def passed_through(self, t, state, end):
        """Return (t, depth) of the first sample at which a flight, in closed form, is below the cam; None if there is none."""
        omega0, (q, v) = math.sqrt(self.omega0_squared), state
        for k in range(1, LOOKS):
            s = (end - t) * k / LOOKS
            position = self.equilibrium + (q - self.equilibrium) * math.cos(omega0 * s) + v / omega0 * math.sin(omega0 * s)
            depth = -self.gap(t + s, position)
            if depth > THROUGH:
                return t + s, depth
        return None


def run(problem, peer, restart, look, seconds):
    """Run flights and Newton's impacts to the end of the turn, or as far as the peer gets, and return the results."""
    impacts, count, standing, t, state = [], 0, 0, 0.0, list(problem.state)
    stretches = problem.stretches() if restart else iter([(None, problem.end)])
    arc, ends = next(stretches)
    took_off, looked = (t, state), 0.0
    ended, started = "done", time.perf_counter()
    while True:
        if time.perf_counter() - looked > started + seconds:
            ended = "time limit"
            break
        before = t
        try:
            t, state, hit = peer.fly(t, state, min(ends, problem.end), arc)
        except Exception as error:  # whatever a library raises is its answer
            ended = f"error: {type(error).__name__}: {error}"
            break
        if not (math.isfinite(t) and math.isfinite(state[0])):
            ended = "error: not a number"
            break
        over = t >= problem.end
        if look and (hit or over):
            began = time.perf_counter()
            through = problem.passed_through(*took_off, t)
            looked += time.perf_counter() - began
            if through:
                ended, t = "through the cam", through[0]
                break
        if hit:
            theta = problem.angle(t)
            circle = arc or problem.arc_at(theta)
            cam_velocity = problem.omega * circle.slope(theta)
            after = cam_velocity + problem.restitution * (cam_velocity - state[1])
            count += 1
            if count <= KEPT:
                impacts.append((problem.omega * t, theta % math.tau, state[1], after))
            state = [circle.lift(theta) + peer.above, after]
            took_off = t, state
            standing = standing + 1 if t == before else 0
            if standing > STANDSTILL:
                ended = "stands still"
                break
        elif over:
            break
        else:
            arc, ends = next(stretches)
    wall = time.perf_counter() - started - looked
    return {"impacts": impacts, "count": count, "turned": problem.omega * t, "ended": ended, "wall_s": wall}


def main(peer_class):
    task = json.load(sys.stdin)
    results = []
    for start in task["starts"]:
        problem, walls = Problem(task, start), []
        for _ in range(task["repeats"]):
            began = time.perf_counter()
            peer = peer_class(problem, task["tolerance"])
            built = time.perf_counter() - began
            result = run(problem, peer, task["restart"], task["look"], task["seconds"])
            walls.append(result["wall_s"])
        results.append({**result, "wall_s": walls, "setup_s": built})
    json.dump(results, sys.stdout)
