"""Impact: restitution, the matrix R, and the map that replaces an impact near t = 0 by a jump at t = 0.

Everything follows from the law of restitution, q'+ - c' = -r (q'- - c') at q = c. Proved: R; that the law is linear in the state and
leaves the position; its tangent and determinant; and eq:lmapd. This map flies back to the impact, applies it there and flies forward
again, so that the whole takes no time, for an impact at -t_i of either sign.
"""

import sympy as sp

from flight import phi
from proof import Proof, main

r = sp.Symbol("r", real=True)
q, v, c, c1 = sp.symbols("q v c c1", real=True)
t_i = sp.Symbol("t_i", real=True)

# R of eq:impactdynamics_2
R = sp.Matrix([[0, 0], [0, -(1 + r)]])


def restitution(before, cam):
    """Return the state after an impact, from the state before and the cam's (c, c'): the relative velocity is reversed, times r."""
    return sp.Matrix([before[0], cam[1] - r * (before[1] - cam[1])])


def discontinuity_map(state, cam, time):
    """Return the state after flying back from t = 0 to the impact at -time, the impact, and flying forward to t = 0.

    The state and the cam are measured from the equilibrium.
    """
    return phi(time) * restitution(phi(-time) * state, cam)


def proofs():
    state, cam = sp.Matrix([q, v]), sp.Matrix([c, c1])
    after = restitution(state, cam)
    yield Proof("q'+ = (1 + r) c' - r q'-", after[1] - ((1 + r) * c1 - r * v))
    yield Proof("(q'+ - c') = -r (q'- - c')", (after[1] - c1) + r * (v - c1))
    at_contact = {c: q}
    yield Proof("at contact the law is x + R (x - y)", (after - state - R * (state - cam)).subs(at_contact))
    yield Proof("its tangent at a fixed y is I + R, with determinant -r", [
        after.jacobian(state) - sp.eye(2) - R,
        (sp.eye(2) + R).det() + r,
    ])
    # eq:lmapd, with y_{-t_i} = (c, c') at the moment of the impact and phi_{t_i} phi_{-t_i} = I
    back, forth = phi(t_i).inv(), phi(t_i)
    composed = forth * restitution(back * state, cam)
    printed = (sp.eye(2) + forth * R * back) * state - forth * R * cam
    yield Proof("eq:lmapd is flight back, impact, flight forward", composed - printed)
    nothing = composed.subs({r: -1})
    yield Proof("with r = -1 (no impact) it is the identity", nothing - state)


if __name__ == "__main__":
    main("impact", proofs)
