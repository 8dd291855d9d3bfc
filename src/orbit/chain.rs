//! Linear equations that link each impact of a cycle with the next, solved in one pass around it.
//!
//! Impact i has two unknowns `x_i`, and the flight from it two equations
//!
//! ```text
//! L_i x_i + N_i x_{i+1} = r_i        the last is followed by the first
//! ```
//!
//! The pass around the cycle keeps two equations `F x_0 + G x_i = h`. Together with the equations of the next flight these
//! are four, and two reflections (Householder 1958) leave two of them without `x_i`. They are orthogonal, so that no number grows over an
//! unstable orbit. The work is proportional to the number of impacts.

use nalgebra::{DVector, Matrix2, Vector2};

/// The equations of one flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// L: derivative by the impact that the flight leaves.
    pub leaving: Matrix2<f64>,
    /// N: derivative by the impact at which the flight arrives.
    pub coming: Matrix2<f64>,
}

/// Two equations with an upper triangle in `x_i`, and two without it: columns of `x_i`, `x_0` and `x_{i+1}`, and the right sides.
type Reflected = [[f64; 4]; 7];

/// The equations after the pass: a block for each impact but the first, and `last x_0 = left`.
struct Eliminated {
    rows: Vec<Reflected>,
    last: Matrix2<f64>,
    left: Vector2<f64>,
}

/// Reflects the equations from `first` on (Householder), so that of these only equation `first` keeps an entry in column `first`.
fn reflect(columns: &mut Reflected, first: usize) {
    let dot = |one: &[f64; 4], other: &[f64; 4]| {
        one[0] * other[0] + one[1] * other[1] + (one[2] * other[2] + one[3] * other[3])
    };
    let mut normal = columns[first];
    normal[..first].fill(0.0);
    // This sign avoids cancellation in the next line.
    let kept = -dot(&normal, &normal).sqrt().copysign(normal[first]);
    normal[first] -= kept;
    let half_square = -kept * normal[first];
    if half_square > 0.0 {
        for column in &mut columns[first..] {
            let along = dot(column, &normal) / half_square;
            for (entry, normal) in column.iter_mut().zip(normal) {
                *entry -= along * normal;
            }
        }
    }
}

fn eliminate(links: &[Link], right: &DVector<f64>) -> Option<Eliminated> {
    let of = |index: usize| Vector2::new(right[2 * index], right[2 * index + 1]);
    let Link { mut leaving, mut coming } = *links.first()?;
    let mut left = of(0);
    let mut rows = Vec::with_capacity(links.len() - 1);
    let none = Matrix2::zeros();
    for (index, link) in links.iter().enumerate().skip(1) {
        let two = |kept: Matrix2<f64>, flight: Matrix2<f64>, column: usize| {
            [kept[(0, column)], kept[(1, column)], flight[(0, column)], flight[(1, column)]]
        };
        let right = of(index);
        let mut columns = [
            two(coming, link.leaving, 0),
            two(coming, link.leaving, 1),
            two(leaving, none, 0),
            two(leaving, none, 1),
            two(none, link.coming, 0),
            two(none, link.coming, 1),
            [left[0], left[1], right[0], right[1]],
        ];
        reflect(&mut columns, 0);
        reflect(&mut columns, 1);
        let block = |column: usize| {
            let [one, other] = [columns[column], columns[column + 1]];
            Matrix2::new(one[2], other[2], one[3], other[3])
        };
        (leaving, coming, left) = (block(2), block(4), Vector2::new(columns[6][2], columns[6][3]));
        rows.push(columns);
    }
    Some(Eliminated { rows, last: leaving + coming, left })
}

/// Determinant of the equations; 1 if there are none.
pub fn determinant(links: &[Link]) -> f64 {
    let Some(Eliminated { rows, last, .. }) = eliminate(links, &DVector::zeros(2 * links.len())) else { return 1.0 };
    // Two reflections have determinant 1. Moving the two columns of x_0 to the end keeps the sign, since both pass the same columns.
    rows.iter().map(|columns| columns[0][0] * columns[1][1]).product::<f64>() * last.determinant()
}

/// Solves for the unknowns, two for each impact in turn. If the equations do not determine them, returns `None` or values that are not
/// finite.
pub fn solve(links: &[Link], right: &DVector<f64>) -> Option<DVector<f64>> {
    let Eliminated { rows, last, left } = eliminate(links, right)?;
    let first = last.try_inverse()? * left;
    let mut unknowns = DVector::zeros(2 * links.len());
    unknowns.fixed_rows_mut::<2>(0).copy_from(&first);
    let mut next = first;
    for (index, [one, other, known @ .., right]) in rows.iter().enumerate().rev() {
        let values = [first[0], first[1], next[0], next[1]];
        let left = |row: usize| known.iter().zip(values).fold(right[row], |left, (by, value)| left - by[row] * value);
        next[1] = left(1) / other[1];
        next[0] = (left(0) - other[0] * next[1]) / one[0];
        unknowns.fixed_rows_mut::<2>(2 * (index + 1)).copy_from(&next);
    }
    Some(unknowns)
}
