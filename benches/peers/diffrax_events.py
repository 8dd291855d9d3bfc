"""Diffrax: an adaptive Runge-Kutta method compiled by JAX, with the gap as its event and Newton's method for the event's root.

The circle is an argument of the compiled function, so that one compilation serves all flights. Across corners, the circle follows
from the angle. Times and states are doubles.
"""

import jax

jax.config.update("jax_enable_x64", True)

import diffrax
import jax.numpy as jnp
import optimistix

import problem as common

# The options with which its documentation starts; and the eighth-order method with tolerances that its steps still meet.
OPTIONS = {"default": (diffrax.Tsit5, 1e-6, 1e-9), "tightest": (diffrax.Dopri8, 1e-12, 1e-14)}
MOST_STEPS = 100_000


class Peer:
    # A gap that starts at exactly 0 does not change its sign.
    above = 1e-15

    def __init__(self, problem, tolerance):
        method, rtol, atol = OPTIONS[tolerance]
        starts = jnp.array(problem.starts)
        outline = jnp.array([[arc.distance, arc.direction, arc.radius] for arc in problem.arcs])

        def gap(t, y, args, **_):
            theta = problem.start_angle + problem.omega * t
            here = jnp.searchsorted(starts, theta % common.math.tau, side="right") - 1
            distance, direction, radius = jnp.where(args < 0, outline[here], outline[args])
            phi = theta - direction
            across = distance * jnp.sin(phi)
            return y[0] - (distance * jnp.cos(phi) + jnp.sqrt((radius - across) * (radius + across)))

        def motion(t, state, arc):
            return jnp.array([state[1], -problem.omega0_squared * (state[0] - problem.equilibrium)])

        event = diffrax.Event(gap, optimistix.Newton(rtol, atol), direction=False)

        @jax.jit
        def fly(t, state, end, arc):
            control = diffrax.PIDController(rtol, atol)
            term = diffrax.ODETerm(motion)
            options = {"stepsize_controller": control, "event": event, "max_steps": MOST_STEPS, "throw": False}
            flight = diffrax.diffeqsolve(term, method(), t, end, None, state, arc, **options)
            return flight.ts[-1], flight.ys[-1], flight.event_mask, diffrax.is_okay(flight.result)

        self.numbers = {id(arc): index for index, arc in enumerate(problem.arcs)} | {id(None): -1}
        self.flight = fly
        # Compile before the time that is measured.
        self.fly(0.0, problem.state, 1e-6, problem.arcs[0])

    def fly(self, t, state, end, arc):
        t, state, hit, is_okay = self.flight(float(t), jnp.array(state), float(end), self.numbers[id(arc)])
        if not is_okay:
            raise RuntimeError(f"more than {MOST_STEPS} steps, or a step that its controller refuses")
        return float(t), state.tolist(), bool(hit)


if __name__ == "__main__":
    common.main(Peer)
