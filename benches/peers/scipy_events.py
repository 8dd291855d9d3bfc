"""SciPy: `solve_ivp` with a directed terminal event and dense output, restarted after every impact."""

import sys

from scipy.integrate import solve_ivp

import problem as common

# The documentation's defaults; and the eighth-order method at the smallest rtol that SciPy does not replace, 100 eps.
OPTIONS = {"default": {}, "tightest": {"method": "DOP853", "rtol": 2.221e-14, "atol": 1e-15}}


class Peer:
    # With a gap of exactly 0, the root that it finds for a hop of one step is the start of the hop.
    above = sys.float_info.epsilon

    def __init__(self, problem, tolerance):
        self.problem, self.options = problem, OPTIONS[tolerance]

    def motion(self, _, state):
        return state[1], self.problem.acceleration(state[0])

    def fly(self, t, state, end, arc):
        def gap(t, state):
            return self.problem.gap(t, state[0], arc)

        gap.terminal, gap.direction = True, -1
        flight = solve_ivp(self.motion, (t, end), state, events=gap, dense_output=True, **self.options)
        if flight.status < 0:
            raise RuntimeError(flight.message)
        return float(flight.t[-1]), flight.y[:, -1].tolist(), flight.status == 1


if __name__ == "__main__":
    common.main(Peer)
