"""Proofs: each is a statement and a residual that computer algebra reduces to exactly 0.

No tolerance enters. A residual is first cleared of denominators and expanded; the rest is left to sympy's simplifiers. A residual
that still does not reduce counts as not proved, even if it is 0. A comparison of digits is a measurement, and is marked as one.

A check that accepts everything would prove everything. So five false identities are planted, each for another way through `vanishes`.
No stage is complete unless all five are refused.
"""

import sys
from dataclasses import dataclass

import sympy as sp


@dataclass(frozen=True)
class Proof:
    """Statement that is true if `residual` is 0."""

    statement: str
    residual: object

    def holds(self):
        return vanishes(self.residual)


@dataclass(frozen=True)
class Measurement:
    """Statement that numbers confirm to a stated number of digits. It is no proof."""

    statement: str
    within: bool

    def holds(self):
        return bool(self.within)


def vanishes(residual):
    """Return True if an expression, or each entry of a matrix or list, is proved to be exactly 0."""
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


_a, _b, _t = sp.symbols("a b t", real=True)
# False identities, each nearly true: one kind of residual for each step of `vanishes`.
PLANTED = (
    Proof("(a + b)^2 = a^2 + b^2: a polynomial", (_a + _b) ** 2 - _a**2 - _b**2),
    Proof("1/(a - b) - 1/(a + b) = 2 a/(a^2 - b^2): denominators to be cleared", 1 / (_a - _b) - 1 / (_a + _b) - 2 * _a / (_a**2 - _b**2)),
    Proof("sin(a + b) = sin a cos b - cos a sin b: left to the simplifiers", sp.sin(_a + _b) - sp.sin(_a) * sp.cos(_b) + sp.cos(_a) * sp.sin(_b)),
    Proof("sqrt(a^2) = a: true of half of all numbers", sp.sqrt(_a**2) - _a),
    Proof("the flow of [[0, 1], [-1, 0]] is [[cos t, sin t], [sin t, cos t]]: one entry of four",
          [sp.Matrix([[sp.cos(_t), sp.sin(_t)], [sp.sin(_t), sp.cos(_t)]]) - sp.Matrix([[sp.cos(_t), sp.sin(_t)], [-sp.sin(_t), sp.cos(_t)]]), 0]),
)  # fmt: skip


def refuses():
    """Return True if every planted identity is refused. Print those that are not."""
    passed = [planted for planted in PLANTED if planted.holds()]
    for planted in passed:
        print(f"PASSED, though it is false: {planted.statement}", flush=True)
    return not passed


def show(title, proofs):
    """Print each proof and each measurement on one line. Return True if all hold."""
    complete = True
    for proof in proofs:
        good = proof.holds()
        complete = complete and good
        word = "measured" if isinstance(proof, Measurement) else "proved"
        print(f"{word if good else 'NOT ' + word.upper():<12}  {title}: {proof.statement}", flush=True)
    return complete


def main(title, proofs):
    """Run a stage by itself. The exit code is 0 if all of it holds."""
    complete = refuses()
    sys.exit(0 if show(title, proofs()) and complete else 1)
