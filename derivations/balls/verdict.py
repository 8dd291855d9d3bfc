"""Feigin's verdict on a border collision, from balls: every condition with its value and its proved sign.

Up to terms of second order, the orbit's map is x -> A- x + B- dT where e x + f dT < 0, and A+ x + B+ dT elsewhere. Each side's map is
analytic, with the cam's law of that side continued past the corner. If det(I - A) is not 0, the implicit function theorem gives each
map one fixed point near x* for every dT near 0. This fixed point is an orbit of the machine exactly if it lies on its own side. If
the sign of e x + f dT there does not vanish to first order, the verdict of the linear map is that of the machine.
"""

from dataclasses import dataclass

from flint import arb, arb_mat

from .corner_impact import eigenvalues
from .numbers import sign

SIDES = ("minus", "plus")


@dataclass(frozen=True)
class Condition:
    """Number that must not be 0, with its proved sign."""

    name: str
    value: arb
    sign: int


class Verdict:
    """Verdict from the maps of both sides, {side: 2 x 3 [A | B]}, and the border (e, f). Raise Undecided if a sign is not proved."""

    def __init__(self, maps, border):
        self.maps, self.border = maps, border
        self.a = {side: arb_mat([[whole[i, j] for j in range(2)] for i in range(2)]) for side, whole in maps.items()}
        self.b = {side: [whole[0, 2], whole[1, 2]] for side, whole in maps.items()}
        jump = [maps["plus"][0, column] - maps["minus"][0, column] for column in range(3)]
        # C = e1^T (A+ - A-), D = e1^T (B+ - B-)
        self.c, self.d = jump[:2], jump[2]
        self.eigenvalues = {side: eigenvalues(a) for side, a in self.a.items()}
        self.conditions = [Condition(name, value, sign(value, name)) for name, value in self._numbers()]
        self.scenario = self._scenario()

    def _numbers(self):
        one = arb_mat([[1, 0], [0, 1]])
        for side, mark in zip(SIDES, "-+"):
            yield f"det(I - A{mark})", (one - self.a[side]).det()
        for side, mark in zip(SIDES, "-+"):
            yield f"det(I + A{mark})", (one + self.a[side]).det()
        yield "det(I - A+ A-)", (one - self.a["plus"] * self.a["minus"]).det()
        e, f = self.border[:2], self.border[2]
        whole, (b1, b2) = one - self.a["minus"], self.b["minus"]
        # Divided by det(I - A) of a side, e adj(I - A-) B- + f det(I - A-) is the distance of its fixed point from the border at dT = 1.
        across = e[0] * (whole[1, 1] * b1 - whole[0, 1] * b2) + e[1] * (whole[0, 0] * b2 - whole[1, 0] * b1)
        yield "e adj(I - A-) B- + f det(I - A-)", across + f * whole.det()
        for side, mark in zip(SIDES, "-+"):
            moduli = [(re * re + im * im).sqrt() for re, im in self.eigenvalues[side]]
            yield f"|first eigenvalue| - 1 of A{mark}", moduli[0] - 1
            yield f"|second eigenvalue| - 1 of A{mark}", moduli[1] - 1

    def stable(self, side):
        """Return True if both eigenvalues of a side are proved to lie inside the unit circle. An undecided modulus has raised
        Undecided before."""
        mark = "-" if side == "minus" else "+"
        return all(self.signs()[f"|{which} eigenvalue| - 1 of A{mark}"] < 0 for which in ("first", "second"))

    def signs(self):
        """Return the sign of each condition, by its name."""
        return {condition.name: condition.sign for condition in self.conditions}

    def _scenario(self):
        """Return the verdict. The real eigenvalues of both sides decide it together. An odd number of them is above 1 exactly if
        det(I - A-) det(I - A+) < 0. An odd number is below -1 exactly if det(I + A-) det(I + A+) < 0."""
        signs = self.signs()
        if signs["det(I - A-)"] * signs["det(I - A+)"] < 0:
            return "nonsmooth-fold"
        return "nonsmooth-flip" if self.period_two_orbit() else "persistence"

    def period_two_orbit(self):
        """Return True if an orbit of period two exists on one side of omega*; False if it exists on neither.

        The distances of its two points from the border are in the ratio det(I + A+) : det(I + A-). So they lie on different sides
        exactly where these determinants have different signs.
        """
        signs = self.signs()
        return signs["det(I + A-)"] * signs["det(I + A+)"] < 0

    def exists_for(self, side):
        """Return on which side of T* the fixed point of a side is an orbit of the machine: "slower" (dT > 0) or "faster"."""
        signs, mark = self.signs(), "-" if side == "minus" else "+"
        towards = signs["e adj(I - A-) B- + f det(I - A-)"] * signs[f"det(I - A{mark})"]
        return "slower" if towards == (-1 if side == "minus" else 1) else "faster"
