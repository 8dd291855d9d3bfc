"""heyoka.py: a Taylor integrator compiled for the follower over one circle, with the gap as its terminal event.

The event's equation must be analytic over a step, so that flights cannot be integrated across corners. The circle is given by
parameters, and the run is restarted where the circle changes. The cooldown after an event is the library's own.
"""

import heyoka as hy

import problem as common

# The default is already machine precision.
OPTIONS = {"default": {}, "tightest": {"high_accuracy": True}}


class Peer:
    # The cooldown skips the root at the start of a flight.
    above = 0.0

    def __init__(self, problem, tolerance):
        self.problem = problem
        q, v = hy.make_vars("q", "v")
        omega, start, distance, direction, radius = (hy.par[k] for k in range(5))
        phi = start + omega * hy.time - direction
        across = distance * hy.sin(phi)
        gap = q - (distance * hy.cos(phi) + hy.sqrt(radius * radius - across * across))
        motion = [(q, v), (v, -problem.omega0_squared * (q - problem.equilibrium))]
        event = hy.t_event(gap, direction=hy.event_direction.negative)
        options = {"t_events": [event], "pars": [0.0] * 5, **OPTIONS[tolerance]}
        self.integrator = hy.taylor_adaptive(motion, list(problem.state), **options)

    def fly(self, t, state, end, arc):
        if arc is None:
            raise ValueError("the event's equation must be analytic over a step")
        integrator = self.integrator
        integrator.pars[:] = self.problem.omega, self.problem.start_angle, arc.distance, arc.direction, arc.radius
        integrator.time, integrator.state[:] = t, state
        outcome = integrator.propagate_until(end)[0]
        if outcome == hy.taylor_outcome.time_limit:
            return end, integrator.state.tolist(), False
        if int(outcome) != -1:
            raise RuntimeError(str(outcome))
        return integrator.time, integrator.state.tolist(), True


if __name__ == "__main__":
    common.main(Peer)
