"""The closed forms that the Rust code evaluates, as data: a straight-line program of named expressions.

Each line may use the inputs and the lines above it. The proofs of corner_map.py show that the program agrees with the derivation,
with residual exactly 0. The script derive.py writes the same lines into golden/derived/closed_forms.json, and their values at 200
points into golden/derived/points.json. The Rust code is tested against these values.

Every expression keeps to + - * / **, integers, names and brackets.
"""

INPUTS = {
    "zeta": "b/(2m), 1/s",
    "omega0_squared": "k/m, 1/s^2",
    "T": "period of the cam, s",
    "r": "restitution",
    "spring": "omega0^2 (q - rest) + g at the corner, m/s^2: the follower's deceleration there at v = 0",
    "v": "velocity before the impact, m/s",
    "c1": "cam velocity c' at the corner, m/s",
    "c2": "cam acceleration c'' at the corner, on the side asked for, m/s^2",
    "p": "step response after T/2, s^2",
    "s": "impulse response after T/2, s: e^{-zeta T/2} sin(omega_s T/2)/omega_s",
}

# eq:gff at T/2; eq:Px; eq:PT with its repairs
CLOSED_FORMS = {
    "cosine": "1 - omega0_squared*p - zeta*s",
    "F11": "cosine + zeta*s",
    "F12": "s",
    "F21": "-omega0_squared*s",
    "F22": "cosine - zeta*s",
    "S": "c2 + 2*zeta*c1 + spring",
    "alpha": "-(1 + r)*S/(v - c1)",
    "A11": "F11*(-r*F11) + F12*(alpha*F11 - r*F21)",
    "A12": "F11*(-r*F12) + F12*(alpha*F12 - r*F22)",
    "A21": "F21*(-r*F11) + F22*(alpha*F11 - r*F21)",
    "A22": "F21*(-r*F12) + F22*(alpha*F12 - r*F22)",
    "v_plus": "(1 + r)*c1 - r*v",
    "leaving": "-2*zeta*v_plus - spring",
    "arriving": "-r*(-2*zeta*v - spring) - 2*(1 + r)*c1/T",
    "shift": "(1 + r)*v/(v - c1)",
    "b1": "v_plus + v - shift*(v - c1)",
    "b2": "leaving + arriving - shift*S",
    "B1": "(F11*b1 + F12*b2)/2",
    "B2": "(F21*b1 + F22*b2)/2",
}
