"""Two impact oscillators whose one-impact orbits are known in closed form, solved from their equations of motion.

The oscillator of Shaw and Holmes (1983) and Budd and Dux (1994), x >= sigma, wall at sigma, restitution r:

    x'' + x = F cos w t

Let gamma = F/(1 - w^2). Less its particular solution gamma cos w t, the oscillator is a free follower, y'' + y = 0, above the cam
sigma - gamma cos(theta), theta = w t. An orbit with one impact in T = 2 pi n/w hits the wall at -U. With T = 2 h, P = (1+r)/(2 tan h)
and Q = (1-r)/(2w), and phi the angle of the impact,

    gamma cos phi = sigma - P U      gamma sin phi = Q U      (P^2 + Q^2) U^2 - 2 sigma P U + sigma^2 - gamma^2 = 0

    trace = -2 r cos T - (1+r) (cos phi F - sigma)/U sin T      determinant = r^2

    graze  U = 0                      sigma = -|gamma|
    fold   both roots are one         sigma^2 = gamma^2 (P^2 + Q^2)/Q^2
    flip   U = L sigma                sigma^2 = gamma^2/((1 - P L)^2 + Q^2 L^2)
           L = -(1+r) w^2 sin T/(1 + r^2 - 2 r cos T + (1+r)^2 (1 - w^2) (1 + cos T)/2)

The ball on a table at a cos(theta), theta = omega t, under gravity g (Holmes 1982, without his approximation of high bounces). The
table's velocity at an impact is b = g T (1-r)/(2 (1+r)):

    -a omega sin phi = b      v- = -g T/2      trace = 1 + r^2 - (1+r)^2 a omega^2 cos phi/g      determinant = r^2

    fold   a omega^2 = pi n g (1-r)/(1+r)
    flip   (a omega^2)^2 = (pi n g (1-r)/(1+r))^2 + (2 g (1+r^2)/(1+r)^2)^2

The traces come from the map of one impact to the next in its instant and speed, differentiated implicitly: no saltation matrix
enters. It is not proved that a flight hits nothing on the way: `clears` samples it.
"""

import sympy as sp
from mpmath import mp, mpf

from proof import Proof, main

DIGITS = 40
# Samples of a flight, to check that it stays above the wall.
SAMPLES = 2000

r, w, gamma, sigma, U, t0, g, a, omega = sp.symbols("r w gamma sigma U t0 g a omega", positive=True)
tangent = sp.Symbol("tan_h", real=True)
phi, t = sp.symbols("phi t", real=True)
n = sp.Symbol("n", positive=True, integer=True)

# cos T and sin T by tan h, T = 2 h
cos_T, sin_T = (1 - tangent**2) / (1 + tangent**2), 2 * tangent / (1 + tangent**2)
F = gamma * (1 - w**2)
P, Q = (1 + r) / (2 * tangent), (1 - r) / (2 * w)
cos_phi, sin_phi = (sigma - P * U) / gamma, Q * U / gamma
TRACE = -2 * r * cos_T - (1 + r) * (cos_phi * F - sigma) / U * sin_T
L = -(1 + r) * w**2 * sin_T / (1 + r**2 - 2 * r * cos_T + (1 + r) ** 2 * (1 - w**2) * (1 + cos_T) / 2)


def map_tangent(x, at_return):
    """Return trace and determinant of the map (t0, U0) -> (t1, U1) at a fixed point, for a flight x(t; t0, U0) above the level z(t).
    The argument `x` is x - z. It is 0 at t1, and its rate there is -U1."""
    speed = sp.diff(x, t)
    entries = []
    for start in (t0, U):
        # x(t1) = 0:  x' dt1 + x_s ds = 0;  dU1 = -(x'' dt1 + x'_s ds)
        delay = -sp.diff(x, start) / speed
        entries.append((delay, -(sp.diff(speed, t) * delay + sp.diff(speed, start))))
    entries = [[at_return(entry) for entry in column] for column in entries]
    (dt_dt, du_dt), (dt_du, du_du) = entries
    return dt_dt + du_du, dt_dt * du_du - dt_du * du_dt


def oscillator_proofs():
    x = sp.Function("x")
    forced = gamma * sp.cos(w * t)
    yield Proof("gamma cos w t solves x'' + x = F cos w t", sp.diff(forced, t, 2) + forced - F * sp.cos(w * t))
    y = x(t) - forced
    yield Proof(
        "x - gamma cos w t is a free flight",
        sp.diff(y, t, 2) + y - (sp.diff(x(t), t, 2) + x(t) - F * sp.cos(w * t)),
    )
    # Above the wall, after an impact at t0 = phi/w with r U
    flight = (
        (sigma - gamma * sp.cos(w * t0)) * sp.cos(t - t0)
        + (r * U + gamma * w * sp.sin(w * t0)) * sp.sin(t - t0)
        + gamma * sp.cos(w * t)
        - sigma
    )
    yield Proof("the flight starts at the wall with r U", [
        flight.subs(t, t0), sp.diff(flight, t).subs(t, t0) - r * U,
        sp.diff(flight, t, 2) + flight + sigma - F * sp.cos(w * t),
    ])  # fmt: skip

    def at_return(expression):
        turned = {sp.cos(w * t): cos_phi, sp.sin(w * t): sin_phi, sp.cos(w * t0): cos_phi, sp.sin(w * t0): sin_phi}
        expression = sp.expand(expression).subs({sp.cos(t - t0): cos_T, sp.sin(t - t0): sin_T})
        return sp.together(expression.subs(turned))

    yield Proof("it is back at the wall after T, at -U", [
        at_return(flight), at_return(sp.diff(flight, t)) + U,
    ])  # fmt: skip
    quadratic = (P**2 + Q**2) * U**2 - 2 * sigma * P * U + sigma**2 - gamma**2
    yield Proof("cos^2 phi + sin^2 phi = 1 is the quadratic for U", gamma**2 * (cos_phi**2 + sin_phi**2 - 1) - quadratic)
    trace, determinant = map_tangent(flight, at_return)
    yield Proof("trace of the map of impacts", trace - TRACE)
    yield Proof("its determinant is r^2", determinant - r**2)
    yield Proof("U = 0 at sigma^2 = gamma^2", quadratic.subs({U: 0, sigma: -gamma}))
    yield Proof(
        "a multiplier is 1 where the roots for U meet", (1 - TRACE + r**2).subs(sigma, (P**2 + Q**2) * U / P)
    )
    yield Proof("they meet at sigma^2 = gamma^2 (P^2 + Q^2)/Q^2", (
        sp.discriminant(quadratic, U).subs(sigma, gamma * sp.sqrt(P**2 + Q**2) / Q)
    ))  # fmt: skip
    yield Proof("a multiplier is -1 at U = L sigma", (1 + TRACE + r**2).subs(U, L * sigma))
    yield Proof("which is sigma^2 = gamma^2/((1 - P L)^2 + Q^2 L^2)", (
        quadratic.subs(U, L * sigma) - (sigma**2 * ((1 - P * L) ** 2 + Q**2 * L**2) - gamma**2)
    ))  # fmt: skip


def table_proofs():
    T = 2 * sp.pi * n / omega
    cos_table, sin_table = sp.symbols("cos_phi sin_phi", real=True)
    b = g * T * (1 - r) / (2 * (1 + r))
    speed = g * T / (1 + r)
    table = a * sp.cos(omega * t)
    yield Proof("with v- = -g T/2 a flight of T ends where it began", (g * T / 2) * T - g * T**2 / 2)
    yield Proof("and the law of restitution asks for b", (g * T / 2 - b) + r * (-g * T / 2 - b))
    yield Proof("the impact is at -U, U = g T/(1+r)", -g * T / 2 - b + speed)
    # Above the table, after an impact at t0 with r U
    flight = (
        a * sp.cos(omega * t0)
        + (r * U - a * omega * sp.sin(omega * t0)) * (t - t0)
        - g * (t - t0) ** 2 / 2
        - table
    )  # fmt: skip
    yield Proof("the flight starts at the table with r U", [
        flight.subs(t, t0), sp.diff(flight, t).subs(t, t0) - r * U, sp.diff(flight + table, t, 2) + g,
    ])  # fmt: skip

    def at_return(expression):
        turned = {
            sp.cos(omega * t): cos_table, sp.sin(omega * t): -b / (a * omega),
            sp.cos(omega * t0): cos_table, sp.sin(omega * t0): -b / (a * omega),
        }  # fmt: skip
        return sp.together(sp.expand(expression).subs(turned).subs(t, t0 + T).subs(U, speed))

    trace, determinant = map_tangent(flight, at_return)
    derived = 1 + r**2 - (1 + r) ** 2 * a * omega**2 * cos_table / g
    yield Proof("it is back at the table after T, at -U", [at_return(flight), at_return(sp.diff(flight, t)) + speed])
    yield Proof("trace of the map of bounces", trace - derived)
    yield Proof("its determinant is r^2", determinant - r**2)
    yield Proof("a multiplier is 1 where cos phi = 0: the table is just fast enough", [
        (1 - derived + r**2).subs(cos_table, 0),
        (a * omega - b).subs(a, sp.pi * n * g * (1 - r) / (1 + r) / omega**2),
    ])  # fmt: skip
    yield Proof("a multiplier is -1 where a omega^2 cos phi = 2 g (1 + r^2)/(1+r)^2", (
        (1 + derived + r**2).subs(cos_table, 2 * g * (1 + r**2) / (1 + r) ** 2 / (a * omega**2))
    ))  # fmt: skip


def proofs():
    yield from oscillator_proofs()
    yield from table_proofs()


# Cases (n, r, w, sigma) and (n, r, a, g, rpm): two orbits each, and a fold, a flip and a graze that the branch reaches. The
# oscillator has a guess besides: sigma, and the time in parts of T, where the flight of the orbit with the larger U touches the wall.
OSCILLATORS = [
    (1, "0.8", "1.3", "-3.0", (0.204, 0.468)),
    (2, "0.8", "2.8", "-0.35", (-0.062, 0.17)),
    (3, "0.8", "4.2", "-0.14", (-0.07, 0.11)),
]
TABLES = [(1, "0.8", "0.01", "9.81", "270"), (2, "0.8", "0.01", "9.81", "300"), (3, "0.8", "0.01", "9.81", "340")]


def multipliers(trace, determinant):
    root = mp.sqrt(mp.mpc(trace**2 - 4 * determinant))
    return [(trace + root) / 2, (trace - root) / 2]


def clears(height, period):
    """Return True if a flight is above 0 at every sample between its ends."""
    return all(height(period * k / SAMPLES) > 0 for k in range(1, SAMPLES))


def entry(phase, before, state, trace, determinant):
    show = lambda value: mp.nstr(value, 30)  # noqa: E731
    return {
        "cam_angle": show(phase % (2 * mp.pi)),
        "velocity_before": show(before),
        "state": [show(value) for value in state],
        "multipliers": [{"re": show(mp.re(m)), "im": show(mp.im(m))} for m in multipliers(trace, determinant)],
    }


def oscillator(turns, restitution, frequency, wall, touch):
    """Return both orbits at one position of the wall, as those of a follower above the cam, and the special positions of the wall."""
    r, w = mpf(restitution), mpf(frequency)
    gamma, T = 1 / (1 - w**2), 2 * mp.pi * turns / w
    P, Q = (1 + r) / (2 * mp.tan(T / 2)), (1 - r) / (2 * w)
    C, S = mp.cos(T), mp.sin(T)

    def impacts(sigma):
        half, product = sigma * P / (P**2 + Q**2), (sigma**2 - gamma**2) / (P**2 + Q**2)
        root = mp.sqrt(half**2 - product)
        return half - root, half + root

    def flight(sigma, U):
        """Return phi, and (y, y') and (x - sigma, x') as functions of the time since the impact."""
        phi = mp.atan2(Q * U / gamma, (sigma - P * U) / gamma) % (2 * mp.pi)
        A, B = sigma - gamma * mp.cos(phi), r * U + gamma * w * mp.sin(phi)

        def free(t):
            return A * mp.cos(t) + B * mp.sin(t), B * mp.cos(t) - A * mp.sin(t)

        def above(t):
            y, rate = free(t)
            return y + gamma * mp.cos(w * t + phi) - sigma, rate - gamma * w * mp.sin(w * t + phi)

        return phi, free, above

    sigma, orbits = mpf(wall), []
    for U in impacts(sigma):
        phi, free, above = flight(sigma, U)
        assert U > 0 and clears(lambda t: above(t)[0], T)  # noqa: B023
        trace = -2 * r * C - (1 + r) * (mp.cos(phi) - sigma) / U * S
        # The cam's velocity is gamma w sin phi.
        orbits.append(entry(phi, gamma * w * mp.sin(phi) - U, free(T - phi / w), trace, r**2))
    L = -(1 + r) * w**2 * S / (1 + r**2 - 2 * r * C + (1 + r) ** 2 * (1 - w**2) * (1 + C) / 2)
    fold = mp.sign(P) * abs(gamma) * mp.sqrt(P**2 + Q**2) / Q
    flip = mp.sign(L) * abs(gamma) / mp.sqrt((1 - P * L) ** 2 + Q**2 * L**2)
    touched = mp.findroot(lambda sigma, part: flight(sigma, impacts(sigma)[1])[2](part * T), touch)
    show = lambda value: mp.nstr(value, 30)  # noqa: E731
    return {
        "revolutions": turns, "restitution": restitution, "frequency": frequency, "wall": wall, "amplitude": show(gamma),
        "orbits": orbits, "fold": show(fold), "flip": show(flip), "graze": show(-abs(gamma)), "touch": show(touched[0]),
    }  # fmt: skip


def ball(turns, restitution, amplitude, gravity, rpm):
    """Return both orbits at one speed, and the special speeds and restitutions."""
    r, a, g, omega = mpf(restitution), mpf(amplitude), mpf(gravity), mpf(rpm) * mp.pi / 30
    T = 2 * mp.pi * turns / omega
    b = g * T * (1 - r) / (2 * (1 + r))
    orbits = []
    for side in (1, -1):
        sine = -b / (a * omega)
        cosine = side * mp.sqrt(1 - sine**2)
        phi = mp.atan2(sine, cosine) % (2 * mp.pi)
        height = lambda t: (  # noqa: E731
            a * cosine + g * T / 2 * t - g * t**2 / 2 - a * mp.cos(omega * t + phi)  # noqa: B023
        )
        assert clears(height, T)
        before, since = -g * T / 2, phi / omega
        state = a * cosine - (before + g * since) * since + g * since**2 / 2, before + g * since
        orbits.append(entry(phi, before, state, 1 + r**2 - (1 + r) ** 2 * a * omega**2 * cosine / g, r**2))
    least = mp.pi * turns * g * (1 - r) / (1 + r)
    flip = mp.sqrt(least**2 + (2 * g * (1 + r**2) / (1 + r) ** 2) ** 2)
    part = a * omega**2 / (mp.pi * turns * g)
    show = lambda value: mp.nstr(value, 30)  # noqa: E731
    speed = lambda acceleration: show(mp.sqrt(acceleration / a) * 30 / mp.pi)  # noqa: E731
    return {
        "revolutions": turns, "restitution": restitution, "amplitude": amplitude, "gravity": gravity, "rpm": rpm,
        "orbits": orbits, "fold_rpm": speed(least), "flip_rpm": speed(flip),
        "fold_restitution": show((1 - part) / (1 + part)),
    }  # fmt: skip


def document():
    with mp.workdps(DIGITS):
        return {
            "oscillator": [oscillator(*case) for case in OSCILLATORS],
            "table": [ball(*case) for case in TABLES],
        }


if __name__ == "__main__":
    main("impact oscillator", proofs)
