"""SUNDIALS' CVODE through scikit-sundae: root finding with a direction, restarted after every impact."""

from sksundae.cvode import CVODE

import problem as common

# The documentation's defaults (BDF, rtol 1e-5, atol 1e-6, 500 steps); and the method for problems that are not stiff, at the smallest
# tolerances at which it still steps.
OPTIONS = {
    "default": {},
    "tightest": {"method": "Adams", "rtol": 1e-14, "atol": 1e-15, "max_num_steps": 1_000_000},
}
# Status of a stop at a root. The result's list of events also has those of earlier flights.
ROOT_FOUND = 2


class Peer:
    # A root at the start of a flight is skipped, as the documentation says.
    above = 0.0

    def __init__(self, problem, tolerance):
        def gap(t, state, events):
            events[0] = problem.gap(t, state[0], self.arc)

        gap.terminal, gap.direction = [True], [-1]
        self.problem, self.arc = problem, None
        self.solver = CVODE(self.motion, eventsfn=gap, num_events=1, **OPTIONS[tolerance])

    def motion(self, _, state, rate):
        rate[0], rate[1] = state[1], self.problem.acceleration(state[0])

    def fly(self, t, state, end, arc):
        if not end > t:
            return end, state, False
        self.arc = arc
        flight = self.solver.solve([t, end], state)
        if not flight.success:
            raise RuntimeError(flight.message)
        if flight.status == ROOT_FOUND:
            return float(flight.t_events[-1]), flight.y_events[-1].tolist(), True
        return float(flight.t[-1]), flight.y[-1].tolist(), False


if __name__ == "__main__":
    common.main(Peer)
