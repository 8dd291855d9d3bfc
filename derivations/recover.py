"""The model's constants from the published matrices alone, and how many digits of each they fix.

The paper prints A-+, B-+, C, D, x* and T* but no mass, spring or cam. With

    A = F [[-r, 0], [alpha, -r]] F,   F = phi_{T/2},   C = h (A+ - A-) = d12 h F,  D = d12 v/2,

and d12 = phi12 (alpha+ - alpha-), the constants follow one after the other (corner_map.py and normal_form.py prove each relation):

    det A = (r e^{-zeta T})^2;   (A+ - A-)_11 - (A+ - A-)_22 = 2 zeta (A+ - A-)_12, so equal diagonals are zeta = 0;
    A11 - A12/tau = r with tau = phi12/phi11 = C2/C1, a second way to r;
    D = C2 v/(2 phi12) with v = -omega0^2 x1* phi12 gives omega0^2 = -2 D/(C2 x1*), and picks the branch on which
    tan(omega0 T/2)/omega0 = tau gives it again;
    q = x1* cos, v = -x1* omega0 sin, c' = -v (1 - r)/(1 + r), c'' from alpha, all at omega0 T/2;
    slope and curvature by angle from c', c'' and omega = 2 pi/T.

A, B, T* and x* contain nothing more: three numbers of the cam at one point, on two sides. The cam's circles need one more length,
here the base circle's radius, and an orientation, here R at 90 degrees. The flank and nose circles, P, Q and the spring's rest
position follow.

Uncertainty: each printed number is known to half a unit of its last digit or 1e-13 of its size, whichever is more. The shifts that
each one makes in the result are added up.
"""

import argparse
import json
from pathlib import Path

from mpmath import findroot, matrix, mp, mpf

import arithmetic
import evaluate
from proof import Measurement, main

PUBLISHED = Path(__file__).resolve().parent.parent / "golden" / "published" / "osorio-2008.json"
ROUND_OFF = mpf(10) ** -13
# The authors' own cam-follower example: siconos/siconos-tutorials, examples/mechanics/CamFollower.
AUTHORS = {
    "follower": {"mass": "1.221", "damping": "0", "stiffness": "1430.8", "gravity": "0", "rest_position": "0.3", "restitution": "0.8"},
    "cam": {"law": "arcs", "base_radius": "0.40", "flank_radius": "0.85", "nose_radius": "0.15", "flank_start_deg": "90", "nose_end_deg": "160"},
    "study": {"rpm_min": "600", "rpm_max": "760"},
}  # fmt: skip
BASE_RADIUS, FLANK_START = mpf("0.4"), mp.pi / 2


def published():
    """Return each printed number, and the uncertainty of each."""
    values, known = {}, {}
    for entry in json.loads(PUBLISHED.read_text())["numbers"]:
        for index, printed in enumerate(entry["printed"]):
            decimal = printed.replace(",", ".")
            places = len(decimal.partition(".")[2])
            key = (entry["quantity"], index)
            values[key] = mpf(decimal)
            known[key] = max(mpf(10) ** -places / 2, ROUND_OFF * abs(values[key]))
    # The second entry of x* is printed as 0: a velocity that is exactly 0.
    known["x_star", 1] = mpf(0)
    return values, known


def sources(values):
    """Return the keys of the printed numbers from which the constants are computed."""
    names = ("T_star", "x_star", "A_minus", "A_plus", "B_minus", "B_plus", "C", "D")
    return [key for key in values if key[0] in names]


def two_by_two(values, name):
    """Return a printed matrix."""
    return matrix([[values[name, 0], values[name, 1]], [values[name, 2], values[name, 3]]])


def constants(values):
    """Return every constant, computed from the printed numbers."""
    period, x1, D = values["T_star", 0], values["x_star", 0], values["D", 0]
    A_minus, A_plus = two_by_two(values, "A_minus"), two_by_two(values, "A_plus")
    C1, C2 = values["C", 0], values["C", 1]
    found = {}
    decayed = mp.sqrt((mp.det(A_minus) + mp.det(A_plus)) / 2)
    found["r_exp_minus_zeta_T"] = decayed
    difference = A_plus - A_minus
    zeta = (difference[0, 0] - difference[1, 1]) / (2 * difference[0, 1])
    found["zeta"] = zeta
    tau = C2 / C1
    found["r_from_entries"] = A_minus[0, 0] - A_minus[0, 1] / tau
    # From here zeta is 0, so r is the root of the determinant.
    r = found["r"] = decayed

    by_D = -2 * D / (C2 * x1)
    found["omega0_squared_from_D"] = by_D
    # tan(y)/y = 2 tau/T on the branch that holds sqrt(by_D) T/2, with cos(y) and sin(y) on one side
    equation = lambda y: mp.sin(y) - 2 * tau / period * y * mp.cos(y)
    angle = findroot(equation, mp.sqrt(by_D) * period / 2)
    omega0 = 2 * angle / period
    w2 = found["omega0_squared"] = omega0**2
    cosine, sine = mp.cos(angle), mp.sin(angle) / omega0

    q, v = x1 * cosine, -w2 * sine * x1
    c1 = -v * (1 - r) / (1 + r)
    found["position_at_corner"], found["velocity_before"], found["cam_velocity"] = q, v, c1
    omega = 2 * mp.pi / period
    found["cam_slope"] = c1 / omega
    for side, A in (("minus", A_minus), ("plus", A_plus)):
        alpha = (A[0, 1] / sine + 2 * r * cosine) / sine
        found[f"cam_curvature_{side}"] = (-alpha * (v - c1) / (1 + r) - w2 * q) / omega**2
    found |= circles(found["cam_slope"], found["cam_curvature_minus"], found["cam_curvature_plus"], q)
    return found


def circles(slope, curvature_minus, curvature_plus, position):
    """Return the cam's circles from its slope and two curvatures at P, its base radius, and the angle where the flank starts.

    The flank circle has radius rho1, and its centre is rho1 - rho0 behind the axis as seen from R. One rho1 and one angle give both
    the slope and the curvature. The nose has the same point and normal, so its curvature fixes its radius.
    """
    def flank(radius, turn):
        return evaluate.Arc(radius - BASE_RADIUS, mp.pi, radius).lift(turn)

    def misses(radius, turn):
        lift = flank(radius, turn)
        return [lift[1] - slope, lift[2] - curvature_minus]

    radius, turn = findroot(misses, (mpf("0.9"), mpf(1)))
    lift = flank(radius, turn)[0]
    # P and the outward normal there, with R at angle 0.
    point = lift * mp.expj(turn)
    normal = (point + (radius - BASE_RADIUS)) / radius

    def nose(nose_radius):
        centre = point - nose_radius * normal
        return abs(centre), mp.arg(centre)

    def bent(nose_radius):
        distance, direction = nose(nose_radius)
        return evaluate.Arc(distance, direction, nose_radius).lift(turn)[2] - curvature_plus

    nose_radius = findroot(bent, mpf("0.2"))
    distance, direction = nose(nose_radius)
    return {
        "flank_radius": radius,
        "flank_distance": radius - BASE_RADIUS,
        "corner_angle": FLANK_START + turn,
        "nose_radius": nose_radius,
        "nose_distance": distance,
        "nose_end_deg": (FLANK_START + direction) * 180 / mp.pi,
        "rest_position": lift - position,
    }


def authors():
    """Return the same constants from the authors' published example."""
    follower, orbit = evaluate.locate(AUTHORS)
    corner, omega = orbit["corner"], 2 * mp.pi / orbit["period"]
    laws = evaluate.arcs(AUTHORS["cam"])
    return {
        "r_exp_minus_zeta_T": follower.r,
        "zeta": follower.zeta,
        "r_from_entries": follower.r,
        "r": follower.r,
        "omega0_squared_from_D": follower.omega0_squared,
        "omega0_squared": follower.omega0_squared,
        "position_at_corner": corner.position - follower.origin,
        "velocity_before": orbit["arriving"],
        "cam_velocity": omega * corner.slope,
        "cam_slope": corner.slope,
        "cam_curvature_minus": corner.left[2],
        "cam_curvature_plus": corner.right[2],
        "flank_radius": mpf("0.85"),
        "flank_distance": mpf("0.45"),
        "corner_angle": corner.angle,
        "nose_radius": mpf("0.15"),
        "nose_distance": laws[2][1].distance,
        "nose_end_deg": mpf(160),
        "rest_position": follower.rest,
    }


def recovery():
    """Return value, uncertainty, digits and the authors' value of each constant."""
    values, known = published()
    found, own = constants(values), authors()
    spread = dict.fromkeys(found, mpf(0))
    for key in sources(values):
        if not known[key]:
            continue
        # Mean of both directions: the shift to first order.
        up, down = (constants({**values, key: values[key] + sign * known[key]}) for sign in (1, -1))
        for name in found:
            spread[name] += abs(up[name] - down[name]) / 2
    rows = []
    for name, value in found.items():
        difference = value - own[name]
        # None for a value of 0, which has only an uncertainty.
        digits = int(mp.floor(-mp.log10(spread[name] / abs(own[name])))) if own[name] else None
        rows.append({
            "constant": name,
            "recovered": arithmetic.text(value, 20),
            "uncertainty": arithmetic.text(spread[name], 3),
            "digits": digits,
            "authors": arithmetic.text(own[name], 20),
            "difference": arithmetic.text(difference, 3),
            "agrees": bool(abs(difference) <= spread[name]),
        })
    return rows


def units(found, printed, places):
    """Return the distance between two numbers, in units of the printed one's last digit."""
    return abs(found - printed) * mpf(10) ** places


def rounded(value):
    """Return 15 digits of a number, or one digit of the remainder of a cancellation."""
    if abs(value) < mpf(10) ** -30:
        return "0"
    return arithmetic.text(value, 15 if abs(value) > mpf(10) ** -9 else 1)


def cross_checks():
    """Return published numbers computed from other published numbers, by the named rule."""
    values, _ = published()
    A_minus, A_plus = two_by_two(values, "A_minus"), two_by_two(values, "A_plus")
    B = matrix([values["B_minus", 0], values["B_minus", 1]])
    C, D = matrix([[values["C", 0], values["C", 1]]]), values["D", 0]
    e1, one = matrix([1, 0]), matrix([[1, 0], [0, 1]])
    trace = A_minus[0, 0] + A_minus[1, 1]
    lower = C * A_minus - trace * C
    W = matrix([[C[0], C[1]], [lower[0], lower[1]]])
    printed_tilde = B - A_minus * e1 * D / C[0]
    right_tilde = B - (A_minus - one) * e1 * D / C[0]
    rules = [
        ("B_tilde", "B- - A- e1 D/C1, as printed", printed_tilde),
        ("B_tilde", "B- - (A- - I) e1 D/C1, repaired", right_tilde),
        ("B_bar", "-W (B- - A- e1 D/C1): the printed B~ and the sign reversed", -W * printed_tilde),
        ("B_bar", "W (B- - A- e1 D/C1): the printed B~", W * printed_tilde),
        ("B_bar", "W (B- - (A- - I) e1 D/C1), repaired", W * right_tilde),
        ("A_bar_minus", "W A- W^-1", W * A_minus * W**-1),
        ("A_bar_plus", "W A+ W^-1", W * A_plus * W**-1),
    ]
    printed = {entry["quantity"]: entry["printed"] for entry in json.loads(PUBLISHED.read_text())["numbers"]}
    rows = []
    for quantity, rule, found in rules:
        entries = []
        for index, number in enumerate(printed[quantity]):
            places = len(number.replace(",", ".").partition(".")[2])
            entries.append(units(found[index // found.cols, index % found.cols], values[quantity, index], places))
        rows.append({
            "quantity": quantity,
            "rule": rule,
            "found": [rounded(found[i, j]) for i in range(found.rows) for j in range(found.cols)],
            "printed": printed[quantity],
            "last_digits_off": [arithmetic.text(mp.nint(100 * entry) / 100, 3) for entry in entries],
        })
    return rows


def document():
    return {
        "assumed": {"base_radius": "0.4", "flank_start_deg": "90", "zeta": "0 once the diagonals agree"},
        "uncertainty_of_a_printed_number": "the larger of half a unit of its last digit and 1e-13 of its size, all added",
        "constants": recovery(),
        "published_from_published": cross_checks(),
    }


def proofs():
    """Yield measurements, not proofs: each recovered constant is within its uncertainty of the authors'."""
    for row in recovery():
        words = f"{row['constant']} = {row['recovered']} +- {row['uncertainty']} is the authors' {row['authors']}"
        yield Measurement(words, row["agrees"])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="The model's constants from the published matrices alone.")
    parser.add_argument("--json", action="store_true", help="write the constants as JSON")
    if parser.parse_args().json:
        print(json.dumps(document(), indent=2))
    else:
        main("recovered", proofs)
