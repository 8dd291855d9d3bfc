"""A and B at the corner impact from simulated revolutions alone: an independent check with SciPy.

Reads one JSON document from stdin, the numbers of a model file ("follower", "cam", "study"), and writes one to stdout. It uses
nothing else: no formula of the flow, of A or of B, and no result of the program that starts it. The inputs are the equation of
motion, Newton's impact and the cam's laws; the rest is integrated.

  1. The cam: its stretches, and the angles where two of them meet with different curvature (the corners).
  2. The corner impact: leave a corner with v+, fly for T, and return to the corner with the v- that Newton's law turns into
     v+. These are two conditions for v+ and T. A flight counts if it stays above the cam for the whole revolution.
  3. The map of either side: the cam's law of that side is continued past the corner, and one revolution is simulated from
     perturbed (x1, x2, T). A and B are the linear coefficients of a polynomial fitted to the ends of the revolutions.

Limits, measured against the closed forms (largest error of an entry: absolute for A, relative for B):

  - Size of the perturbations. With all monomials up to the fourth degree, the bias is of the fifth degree and falls with the
    fourth power of the width. For the paper's cam it is 6e-7 and 4e-7 at 0.2 of the reach, 4e-8 and 2e-8 at 0.1, and so on
    down to 2e-10 at 0.025. From 0.0125 on rounding dominates, 2e-11 and 5e-12. It grows with the inverse width: 6e-11 at 0.003.
  - Tolerance of the integrator, hardly: 2e-9 and 4e-9 at 1e-8, 1e-9 at 1e-9, and no difference from 1e-11 down.
  - The event, hardly: its state comes from the last step's interpolant. Flying there again from before that step, with
    Newton's correction, makes no visible difference. Only at strong damping (100 N s/m) is A then 1e-11 off instead of 8e-11.

The bias is what remains where the cam's law bends fast: 3e-9 and 2e-10 without a spring, at a gravity of 300 m/s^2. The standard
errors include it, estimated from a second, wider fit. They do not include the error that the integrator makes alike each time, 1e-10.
"""

import json
import math
import sys
from itertools import product

try:
    import numpy as np
    from scipy import linalg, optimize
    from scipy.integrate import solve_ivp
except ImportError as missing:
    sys.exit(f"this check needs numpy and scipy: {missing}")

from scipy_cams import NOISE, Cam, CannotCheck, number

METHOD = "DOP853"
# Error allowed per step, relative, and absolute in units of the base radius (for velocities: base radius times omega).
RTOL = ATOL = 1e-13

# Least number of periods tried per corner, and more for each swing of the follower on its spring, before roots are refined.
SCAN, SCAN_PER_SWING = 4000, 40
# Points at which a revolution is compared with the cam, before minima are refined.
LOOKS = 2000
# Furthest continuation of a law past its corner, rad.
REACH = 0.05
# Approximate shift of the impact by each perturbation, relative to the reach. The bias of the wider fit is 2^DEGREE times the other's.
WIDTHS = 0.025, 0.0125
# Degree of the fitted polynomial. It is even: the first degree left out is odd, so that the bias falls with the width to the DEGREE.
DEGREE = 4
LIMITS = (
    "bias of the fit, of the fifth degree in the perturbations, above some hundredths of the reach, and rounding below a "
    "hundredth; at the width used either leaves about 1e-11 to 1e-9 in A and B, the integrator's tolerance less"
)


class Follower:
    """Mass on its spring, flying or hit by the cam."""

    def __init__(self, numbers):
        self.mass = number(numbers, "mass", least=0.0)
        self.damping, self.stiffness, self.gravity, self.rest, self.restitution = (
            number(numbers, key) for key in ("damping", "stiffness", "gravity", "rest_position", "restitution")
        )
        unknown = sorted(set(numbers) - {"mass", "damping", "stiffness", "gravity", "rest_position", "restitution"})
        if unknown:
            raise CannotCheck(f"follower.{unknown[0]}: the laws of flight and impact of this route do not contain it")
        if self.stiffness < 0.0 or self.damping < 0.0 or not 0.0 <= self.restitution <= 1.0:
            raise CannotCheck("stiffness and damping must be at least 0, restitution from 0 to 1")

    def origin(self):
        """Return the position from which x1 is measured: the spring's equilibrium, or the rest position without stiffness."""
        return self.rest - self.gravity * self.mass / self.stiffness if self.stiffness > 0.0 else self.rest

    def motion(self, _, state):
        """Return the rates of q and v, from m q'' + b q' + k (q - rest) = -m g."""
        q, v = state
        return v, -self.gravity - (self.damping * v + self.stiffness * (q - self.rest)) / self.mass

    def fly(self, state, start, end, units, **options):
        """Return the free flight from `start` to `end`. `units` are a length and a velocity for the absolute tolerance."""
        atol = [ATOL * unit for unit in units]
        flight = solve_ivp(self.motion, (start, end), state, method=METHOD, rtol=RTOL, atol=atol, **options)
        if not flight.success or not np.all(np.isfinite(flight.y)):
            raise CannotCheck(f"the integration of the follower's flight failed: {flight.message}")
        return flight

    def rebound(self, cam_velocity, velocity):
        return (1.0 + self.restitution) * cam_velocity - self.restitution * velocity


# ---------------------------------------------------------------------------------------------------- 2. The corner impact


class CornerImpact:
    """Flight of one period from a corner to the same corner, found by shooting."""

    def __init__(self, follower, cam, corner, guess):
        self.cam, self.follower = cam, follower
        self.angle, self.before, self.after, self.room = corner
        self.height, self.slope, _ = self.after.law(self.angle)

        def misses(unknowns):
            period = unknowns[1] * guess[1]
            leaves = unknowns[0] * speed
            q, v = follower.fly((self.height, leaves), 0.0, period, self.units(period)).y[:, -1]
            rebound = follower.rebound(self.cam_velocity(period), v)
            return (q - self.height) / cam.base, (rebound - leaves) / speed

        # v+ and T in units of their guesses. A flight is smooth in both, so that the solver stops at rounding.
        speed = max(abs(guess[0]), cam.base / guess[1])
        found = optimize.root(misses, (guess[0] / speed, 1.0), method="hybr", options={"xtol": 1e-15})
        self.residual = float(np.max(np.abs(found.fun)))
        self.leaves, self.period = float(found.x[0] * speed), float(found.x[1] * guess[1])
        corner, units = (self.height, self.leaves), self.units(self.period)
        orbit = follower.fly(corner, 0.0, self.period, units, dense_output=True)
        self.arrives, self.orbit = float(orbit.y[1, -1]), orbit.sol
        self.closing_speed = self.cam_velocity(self.period) - self.arrives
        # A flight to x* needs no interpolation.
        self.start = follower.fly(corner, 0.0, 0.5 * self.period, units).y[:, -1]

    def units(self, period):
        return self.cam.base, self.cam.base * math.tau / period

    def cam_velocity(self, period):
        return self.slope * math.tau / period

    def admissible(self):
        """Return True if the flight hits the cam at the corner and stays above it for the rest of the revolution."""
        if not (self.residual < NOISE and self.closing_speed > NOISE * self.units(self.period)[1]):
            return False

        def gap(t):
            theta = self.angle + math.tau * t / self.period
            return float(self.orbit(t)[0]) - self.cam.law(theta)[0]

        times = np.linspace(0.0, self.period, LOOKS + 1)[1:-1]
        gaps = [gap(t) for t in times]
        # A minimum between two samples may be lower than both.
        lows = [times[i - 1 : i + 2 : 2] for i in range(1, len(gaps) - 1) if gaps[i] <= min(gaps[i - 1], gaps[i + 1])]
        lowest = (optimize.minimize_scalar(gap, bounds=between, method="bounded").fun for between in lows)
        return min(gaps) > 0.0 and all(height > 0.0 for height in lowest)


def guesses(follower, cam, corner, periods):
    """Yield (v+, T) near each solution, where the miss changes its sign over the study's periods."""
    height, slope, _ = corner[2].law(corner[0])
    units = cam.base, cam.base * math.tau / periods[-1]
    # The equation of motion is linear, so that two flights over the longest period give the ends of all others.
    flights = (follower.fly((height, v), 0.0, periods[-1], units, dense_output=True) for v in (0.0, units[1]))
    rest, moving = (flight.sol for flight in flights)

    def ends(period):
        """Return the end of the flight that leaves at rest, and what each unit of v+ adds to it."""
        return *rest(period), *(moving(period) - rest(period)) / units[1]

    def terms(period):
        """Return (v+ - rebound) times q1, in two parts. The factor q1 removes the poles, at periods for which a flight cannot be aimed."""
        q0, v0, q1, v1 = ends(period)
        r = follower.restitution
        return (height - q0) * (1.0 + r * v1), q1 * (r * v0 - (1.0 + r) * slope * math.tau / period)

    values = sum(terms(periods))
    # If every period solves the equation, as for a follower at rest on a dwell, no speed is singled out.
    if np.max(np.abs(values)) <= NOISE * np.max(np.abs(terms(periods))):
        return
    for i in np.flatnonzero((values[:-1] < 0.0) != (values[1:] < 0.0)):
        period = optimize.brentq(lambda period: sum(terms(period)), *periods[i : i + 2])
        q0, _, q1, v1 = ends(period)
        # In resonance no v+ is singled out.
        if abs(q1) > NOISE * period * abs(v1):
            yield (height - q0) / q1, period


def corner_impact(follower, cam, study):
    rpm_min, rpm_max = number(study, "rpm_min", least=0.0), number(study, "rpm_max", least=0.0)
    if not rpm_min < rpm_max:
        raise CannotCheck("study.rpm_min must be below study.rpm_max")
    swings = 60.0 / rpm_min * math.sqrt(follower.stiffness / follower.mass) / math.tau
    tries = SCAN + SCAN_PER_SWING * swings * math.log(rpm_max / rpm_min)
    if not (tries < 1e6 and 60.0 / rpm_min * follower.damping / follower.mass < 1e5):
        raise CannotCheck("at study.rpm_min the follower swings or settles too often in a revolution to be integrated")
    periods = np.geomspace(60.0 / rpm_max, 60.0 / rpm_min, int(tries))
    candidates = [(corner, guess) for corner in cam.corners() for guess in guesses(follower, cam, corner, periods)]
    # The slowest one is taken.
    for corner, guess in sorted(candidates, key=lambda candidate: -candidate[1][1]):
        impact = CornerImpact(follower, cam, corner, guess)
        if impact.admissible():
            return impact
    words = f"from {rpm_min} to {rpm_max} rpm {len(candidates)} flights return to a corner, but each meets the cam on the way"
    raise CannotCheck(f"no corner impact of a one-impact, one-revolution orbit: {words}")


# ------------------------------------------------------------------------------------------------ 3. The map of either side


class OneSidedMap:
    """One revolution over a cam with one circle continued past the corner, in deviations from x* and T*."""

    def __init__(self, impact, circle):
        self.impact, self.circle = impact, circle
        omega, u, v = math.tau / impact.period, impact.closing_speed, abs(impact.arrives)
        jump = abs(impact.after.law(impact.angle)[2] - impact.before.law(impact.angle)[2])
        # Half of the way to a neighbour excludes the next corner, and a quarter of the way to the last ray keeps the law well
        # analytic. Up to u/(omega jump) the approach stays above the step at the end of a continued law.
        self.reach = min(REACH, 0.5 * impact.room, 0.25 * circle.last_ray(impact.angle), u / (omega * jump))
        if not self.reach > 1e-4:
            raise CannotCheck(f"the cam's law cannot be continued past the corner at {impact.angle} rad")
        # Perturbations of x1, x2 and T that move the impact by comparable angles.
        self.scales = self.reach * np.array([u / omega, u / math.pi, 2.0 * u / (omega * (u + v))])

    def revolution(self, perturbation):
        """Return (perturbation that survives rounding, end of the revolution), both as deviations. The third number of the end is the
        height of the follower above the corner when it passes."""
        impact, follower = self.impact, self.impact.follower
        start, period = impact.start + perturbation[:2], impact.period + perturbation[2]
        omega, units = math.tau / period, impact.units(period)

        def gap(t, state):
            angle = omega * t
            law = self.circle.law if abs(angle) <= self.reach else impact.cam.law
            return state[0] - law(impact.angle + angle)[0]

        gap.terminal, gap.direction = True, -1
        approach = follower.fly(start, -0.5 * period, self.reach / omega, units, events=gap)
        if approach.status != 1 or abs(approach.t[-1]) * omega >= self.reach:
            raise CannotCheck("a perturbed revolution does not hit the cam near the corner")
        t, velocity = approach.t[-1], approach.y[1, -1]
        height, slope, _ = self.circle.law(impact.angle + omega * t)
        departure = follower.fly((height, follower.rebound(omega * slope, velocity)), t, 0.5 * period, units, events=gap)
        if departure.status == 1:
            raise CannotCheck("a perturbed revolution hits the cam twice")
        survives = np.array([*(start - impact.start), period - impact.period])
        # Height of the follower above the corner at t = 0: it closes at closing_speed until t.
        return survives, np.array([*(departure.y[:, -1] - impact.start), t * impact.closing_speed])

    def fit(self, width):
        """Return the 2 x 3 matrix [A | B] above the row (e, f), its standard errors from the residual, and the design's condition number."""
        scales = width * self.scales
        # One Chebyshev node more than the degree, in each direction, determines the polynomial.
        nodes = np.cos(np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))
        samples = [self.revolution(scales * z) for z in product(nodes, repeat=3)]
        z = np.array([perturbation for perturbation, _ in samples]) / scales
        ends = np.array([end for _, end in samples])
        # All monomials up to the degree, so that the map's curvature does not enter the linear ones.
        exponents = sorted((e for e in product(range(DEGREE + 1), repeat=3) if sum(e) <= DEGREE), key=sum)
        design = np.column_stack([np.prod(z**e, axis=1) for e in exponents])
        values, _, _, singular = linalg.lstsq(design, ends)
        variance = np.sum((ends - design @ values) ** 2, axis=0) / (len(z) - len(exponents))
        errors = np.sqrt(np.outer(np.diag(linalg.inv(design.T @ design)), variance))
        linear = [exponents.index(e) for e in ((1, 0, 0), (0, 1, 0), (0, 0, 1))]
        per_unit = [(table[linear] / scales[:, None]).T for table in (values, errors)]
        return *per_unit, float(singular[0] / singular[-1])

    def estimate(self):
        """Return the narrower fit, its standard errors including the bias that the wider fit shows, and the condition number."""
        wide, _, _ = self.fit(WIDTHS[0])
        values, errors, condition = self.fit(WIDTHS[1])
        bias = (wide - values) / ((WIDTHS[0] / WIDTHS[1]) ** DEGREE - 1.0)
        return values, np.hypot(errors, bias), condition


# ------------------------------------------------------------------------------------------------------------- In and out


def entries(matrix):
    return {"A": matrix[:2, :2].tolist(), "B": matrix[:2, 2].tolist()}


def eigenvalues(matrix):
    values = sorted(linalg.eig(matrix[:2, :2], right=False), key=lambda value: (-value.real, -value.imag))
    return [{"re": float(value.real), "im": float(value.imag)} for value in values]


def check(model):
    model = model if isinstance(model, dict) else {}
    for name in ("follower", "cam", "study"):
        if not isinstance(model.get(name), dict):
            raise CannotCheck(f"the input has no table \"{name}\"")
    follower, cam = Follower(model["follower"]), Cam(model["cam"])
    impact = corner_impact(follower, cam, model["study"])
    sides = {"minus": impact.before, "plus": impact.after}
    maps = {side: OneSidedMap(impact, circle).estimate() for side, circle in sides.items()}
    return {
        "period_s": impact.period,
        "speed_rpm": 60.0 / impact.period,
        "cam_angle_rad": impact.angle,
        "x_star": [float(impact.start[0]) - follower.origin(), float(impact.start[1])],
        **{side: entries(values) for side, (values, _, _) in maps.items()},
        "standard_error": {side: entries(errors) for side, (_, errors, _) in maps.items()},
        "condition_number": max(condition for _, _, condition in maps.values()),
        "eigenvalues": {side: eigenvalues(values) for side, (values, _, _) in maps.items()},
        # The border is in both fits, since c'' does not enter.
        "border": ((maps["minus"][0][2] + maps["plus"][0][2]) / 2).tolist(),
        "tolerances": {"rtol": RTOL, "atol": ATOL, "method": METHOD},
        "limits": LIMITS,
    }


def main():
    try:
        print(json.dumps(check(json.load(sys.stdin)), indent=2, allow_nan=False))
    except json.JSONDecodeError as error:
        sys.exit(f"the input is not JSON: {error}")
    except (CannotCheck, linalg.LinAlgError, ArithmeticError, ValueError) as error:
        sys.exit(f"no result for this model: {error}")


if __name__ == "__main__":
    main()
