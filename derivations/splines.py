"""Periodic splines through the rows of a table, or near them, by B-splines whose pieces are polynomials from the start.

A B-spline of degree d on knots t follows from those of degree 0 by the recursion of Cox and de Boor, piece by piece,

    B_{j,d} = (x - t_j)/(t_{j+d} - t_j) B_{j,d-1} + (t_{j+d+1} - x)/(t_{j+d+1} - t_{j+1}) B_{j+1,d-1},

so that derivatives and integrals are those of polynomials. A spline is a sum of B-splines. The minimum of

    integral of c'''^2 + weight sum over rows of (c(row) - lift)^2

is one symmetric system for the factors in that sum. Where three knots coincide, lift, slope and curvature are continuous. The minimum
then has continuous third and fourth derivatives as well, unless rows lie between the knots. At a corner four knots coincide, and only
lift and slope are continuous. On a piece all B-splines sum to 1, so that the curve is constant where all B-splines that are not 0
have one factor.
"""

from bisect import bisect_right

from mpmath import mp, mpf

QUINTIC = 5


def times(one, two):
    """Return the product of two polynomials."""
    product = [mpf(0)] * (len(one) + len(two) - 1)
    for i, a in enumerate(one):
        for j, b in enumerate(two):
            product[i + j] += a * b
    return product


def derived(powers, order):
    """Return a derivative of a polynomial."""
    for _ in range(order):
        powers = [k * power for k, power in enumerate(powers)][1:]
    return powers


class Splines:
    """All splines of a degree on the knots of a turn, which may coincide. One number for each column gives a spline."""

    def __init__(self, degree, knots, dwells=()):
        self.degree, self.knots = degree, knots
        self.pieces = [piece for piece in range(len(knots)) if self.at(piece) < self.at(piece + 1)]
        self.starts = [self.at(piece) for piece in self.pieces]
        columns = list(range(len(knots)))
        for dwell in dwells:
            still = [index % len(knots) for index in self.over(self.place(dwell))]
            columns = [min(still) if column in still else column for column in columns]
        places = {column: place for place, column in enumerate(sorted(set(columns)))}
        self.columns, self.count = [places[column] for column in columns], len(places)
        self.basis = {piece: self.polynomials(piece) for piece in self.pieces}

    def at(self, index):
        turns, inside = divmod(index, len(self.knots))
        return self.knots[inside] + turns * 2 * mp.pi

    def over(self, piece):
        """Return the indices of the B-splines that are not 0 on a piece."""
        return range(piece - self.degree, piece + 1)

    def place(self, angle):
        """Return the piece that holds an angle of a turn. Before the first knot it is the last piece."""
        return self.pieces[bisect_right(self.starts, angle) - 1]

    def polynomials(self, piece):
        """Return the columns that are not 0 on a piece, each with its polynomial in the angle from the start of the piece."""
        start, found = self.at(piece), {piece: [mpf(1)]}
        for degree in range(1, self.degree + 1):
            taken_up = {}
            for index in range(piece - degree, piece + 1):
                total = [mpf(0)] * (degree + 1)
                # x - t_j rises from its left knot, and t_{j+d+1} - x falls to its right one.
                for below, knot, sign in ((index, index, 1), (index + 1, index + degree + 1, -1)):
                    width = self.at(below + degree) - self.at(below)
                    if width and below in found:
                        rising = [sign * (start - self.at(knot)) / width, sign / width]
                        total = [a + b for a, b in zip(total, times(found[below], rising))]
                taken_up[index] = total
            found = taken_up
        columns = {}
        for index, polynomial in found.items():
            column = self.columns[index % len(self.knots)]
            columns[column] = [a + b for a, b in zip(columns.get(column, [mpf(0)] * len(polynomial)), polynomial)]
        return columns

    def values(self, angle, order=0):
        """Return a derivative, at an angle of a turn, of each column that is not 0 there."""
        piece = self.place(angle)
        x = angle - self.at(piece)
        x += 2 * mp.pi if x < 0 else 0
        return {column: mp.polyval(derived(powers, order)[::-1], x) for column, powers in self.basis[piece].items()}

    def bending(self):
        """Return the integral of the product of the third derivatives of every two columns, row by row."""
        form = [{} for _ in range(self.count)]
        for piece in self.pieces:
            width = self.at(piece + 1) - self.at(piece)
            third = {column: derived(powers, 3) for column, powers in self.basis[piece].items()}
            for one, left in third.items():
                for two, right in third.items():
                    product = times(left, right)
                    area = sum(power * width ** (k + 1) / (k + 1) for k, power in enumerate(product))
                    form[one][two] = form[one].get(two, mpf(0)) + area
        return form

    def near(self, angles, weight):
        """Return the solved system for the minimum of the integral and the weighted sum, and the rows. Lifts are given later, any
        number of times. If the weight is None, only the sum is minimised."""
        system = self.bending() if weight is not None else [{} for _ in range(self.count)]
        rows = [self.values(angle) for angle in angles]
        for row in rows:
            add(system, row, 1 if weight is None else weight)
        return Solved(system), rows

    def through(self, angles, lifts):
        """Return the numbers of the spline through these lifts, if there are as many knots as rows: then the least squares are 0."""
        return self.fitted(angles, lifts, None)

    def fitted(self, angles, lifts, weight):
        """Return the numbers of the spline of a weight near these lifts."""
        solved, rows = self.near(angles, weight)
        return solved.solve(seen(rows, lifts, 1 if weight is None else weight, self.count))

    def powers(self, numbers):
        """Yield the pieces of one spline: (angle where the piece starts, powers of the angle from there)."""
        for piece, start in zip(self.pieces, self.starts):
            total = [mpf(0)] * (self.degree + 1)
            for column, powers in self.basis[piece].items():
                total = [a + numbers[column] * b for a, b in zip(total, powers)]
            yield start, total


def add(system, row, weight):
    """Add weight times the product of every two entries of a row to a system."""
    for one, left in row.items():
        for two, right in row.items():
            system[one][two] = system[one].get(two, mpf(0)) + weight * left * right


def seen(rows, lifts, weight, count):
    """Return weight times the transposed rows times the lifts."""
    right = [mpf(0)] * count
    for row, lift in zip(rows, lifts):
        for column, value in row.items():
            right[column] += weight * value * lift
    return right


class Solved:
    """Symmetric positive system, eliminated once. Most of its entries are 0 and stay 0."""

    def __init__(self, system):
        self.pivots, self.below = [], []
        for index, row in enumerate(system):
            pivot = row[index]
            later = {column: entry for column, entry in row.items() if column > index}
            for one, left in later.items():
                for two, right in later.items():
                    system[one][two] = system[one].get(two, mpf(0)) - left * right / pivot
            self.pivots.append(pivot)
            self.below.append(later)

    def solve(self, right):
        right = list(right)
        for index, (pivot, later) in enumerate(zip(self.pivots, self.below)):
            for column, entry in later.items():
                right[column] -= entry * right[index] / pivot
        for index in reversed(range(len(right))):
            known = sum(entry * right[column] for column, entry in self.below[index].items())
            right[index] = (right[index] - known) / self.pivots[index]
        return right


def knots(angles, corners):
    """Return the knots of a quintic, three at each of these angles, and four at a corner."""
    return [angle for angle in sorted(set(angles)) for _ in range(4 if angle in corners else 3)]
