"""What a proof is here: a statement and a residual that computer algebra reduces to exactly 0.

No tolerance enters. A residual is first cleared of denominators and expanded; what that leaves is handed to sympy's
simplifiers. A residual that still does not reduce counts as not proved, even if it were 0.
"""

import sys
from dataclasses import dataclass

import sympy as sp


@dataclass(frozen=True)
class Proof:
    """`residual = 0` makes `statement` true."""

    statement: str
    residual: object

    def holds(self):
        return vanishes(self.residual)


def vanishes(residual):
    """Whether an expression, or each entry of a matrix or list, is exactly 0."""
    if isinstance(residual, (list, tuple)):
        return all(vanishes(entry) for entry in residual)
    if isinstance(residual, sp.MatrixBase):
        return all(vanishes(entry) for entry in residual)
    residual = sp.sympify(residual)
    numerator = sp.expand(sp.numer(sp.together(residual)))
    if numerator == 0:
        return True
    if numerator.is_polynomial(*numerator.free_symbols):
        return False
    return sp.simplify(sp.expand(numerator.rewrite(sp.exp), power_exp=True)) == 0


def show(title, proofs):
    """Print each proof on one line; True if all hold."""
    complete = True
    for proof in proofs:
        good = proof.holds()
        complete = complete and good
        print(f"{'proved    ' if good else 'NOT PROVED'}  {title}: {proof.statement}", flush=True)
    return complete


def main(title, proofs):
    """A stage run by itself."""
    sys.exit(0 if show(title, proofs()) else 1)
