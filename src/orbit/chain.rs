//! Linear equations that link each impact of a cycle with the next, solved in one pass around it.
//!
//! Impact i has two unknowns `x_i`, and the flight from it two equations
//!
//! ```text
//! L_i x_i + N_i x_{i+1} = r_i        the last is followed by the first
//! ```
//!
//! The pass around the cycle keeps two equations `F x_0 + G x_i = h`. Together with the equations of the next flight these
//! are four, and rotations of two of them at a time leave two without `x_i`. They are orthogonal, so that no number grows over an
//! unstable orbit. The work is proportional to the number of impacts.

use nalgebra::linalg::givens::GivensRotation;
use nalgebra::{DVector, Matrix2, SMatrix, Vector2};

/// The equations of one flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Link {
    /// L, by the impact that the flight leaves.
    pub leaving: Matrix2<f64>,
    /// N, by the impact that it comes to.
    pub coming: Matrix2<f64>,
}

/// `R x_i + A x_0 + B x_{i+1} = h`, with R upper triangular.
struct Row {
    upper: Matrix2<f64>,
    first: Matrix2<f64>,
    next: Matrix2<f64>,
    right: Vector2<f64>,
}

/// The equations after the pass: of each impact but the first, and `last x_0 = left`.
struct Eliminated {
    rows: Vec<Row>,
    last: Matrix2<f64>,
    left: Vector2<f64>,
}

fn eliminate(links: &[Link], right: &DVector<f64>) -> Option<Eliminated> {
    let of = |index: usize| Vector2::new(right[2 * index], right[2 * index + 1]);
    let Link { mut leaving, mut coming } = *links.first()?;
    let mut left = of(0);
    let mut rows = Vec::with_capacity(links.len() - 1);
    for (index, link) in links.iter().enumerate().skip(1) {
        // Of x_i, x_0, x_{i+1}, and the right sides.
        let mut four = SMatrix::<f64, 4, 7>::zeros();
        four.fixed_view_mut::<2, 2>(0, 0).copy_from(&coming);
        four.fixed_view_mut::<2, 2>(2, 0).copy_from(&link.leaving);
        four.fixed_view_mut::<2, 2>(0, 2).copy_from(&leaving);
        four.fixed_view_mut::<2, 2>(2, 4).copy_from(&link.coming);
        four.fixed_view_mut::<2, 1>(0, 6).copy_from(&left);
        four.fixed_view_mut::<2, 1>(2, 6).copy_from(&of(index));
        for (column, row) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3)] {
            let pair = Vector2::new(four[(column, column)], four[(row, column)]);
            if let Some((rotation, _)) = GivensRotation::cancel_y(&pair) {
                rotation.rotate(&mut four.fixed_rows_with_step_mut::<2>(column, row - column - 1));
            }
        }
        rows.push(Row {
            upper: four.fixed_view::<2, 2>(0, 0).upper_triangle(),
            first: four.fixed_view::<2, 2>(0, 2).into(),
            next: four.fixed_view::<2, 2>(0, 4).into(),
            right: four.fixed_view::<2, 1>(0, 6).into(),
        });
        leaving = four.fixed_view::<2, 2>(2, 2).into();
        coming = four.fixed_view::<2, 2>(2, 4).into();
        left = four.fixed_view::<2, 1>(2, 6).into();
    }
    Some(Eliminated { rows, last: leaving + coming, left })
}

/// The determinant of the equations; of none at all 1.
pub(super) fn determinant(links: &[Link]) -> f64 {
    let Some(Eliminated { rows, last, .. }) = eliminate(links, &DVector::zeros(2 * links.len())) else { return 1.0 };
    // Rotations have the determinant 1, and to bring x_0 to the end moves two columns past pairs of others.
    rows.iter().map(|row| row.upper[(0, 0)] * row.upper[(1, 1)]).product::<f64>() * last.determinant()
}

/// The unknowns, two for each impact in turn; `None` where the equations do not determine them.
pub(super) fn solve(links: &[Link], right: &DVector<f64>) -> Option<DVector<f64>> {
    let Eliminated { rows, last, left } = eliminate(links, right)?;
    let first = last.lu().solve(&left)?;
    let mut unknowns = DVector::zeros(2 * links.len());
    unknowns.fixed_rows_mut::<2>(0).copy_from(&first);
    let mut next = first;
    for (index, row) in rows.iter().enumerate().rev() {
        next = row.upper.solve_upper_triangular(&(row.right - row.first * first - row.next * next))?;
        unknowns.fixed_rows_mut::<2>(2 * (index + 1)).copy_from(&next);
    }
    Some(unknowns)
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;

    /// Against the dense matrix, from one impact to many; each flight amplifies a hundredfold in one direction.
    #[test]
    fn one_pass_comes_to_what_the_dense_matrix_does() {
        for count in [1, 2, 3, 7, 40] {
            let at = |seed: usize| ((seed * 7919 + 13) % 97) as f64 / 97.0 - 0.4;
            let block = |seed: usize, grown: f64| {
                Matrix2::new(grown + at(seed), at(seed + 1), at(seed + 2), 1.0 + at(seed + 3))
            };
            let links: Vec<Link> =
                (0..count).map(|i| Link { leaving: block(5 * i, 100.0), coming: block(11 * i + 3, -1.0) }).collect();
            let mut dense = DMatrix::zeros(2 * count, 2 * count);
            for (i, link) in links.iter().enumerate() {
                let next = (i + 1) % count;
                for (column, by) in [(i, link.leaving), (next, link.coming)] {
                    let mut view = dense.fixed_view_mut::<2, 2>(2 * i, 2 * column);
                    view += by;
                }
            }
            let (size, found) = (dense.determinant(), determinant(&links));
            assert!((found - size).abs() <= 1e-12 * size.abs(), "{count}: {found} {size}");
            let right = DVector::from_fn(2 * count, |row, _| at(3 * row));
            let expected = dense.lu().solve(&right).map_or(DVector::zeros(0), |found| found);
            let found = solve(&links, &right).unwrap_or(DVector::zeros(0));
            assert!(
                found.len() == 2 * count && (&found - &expected).norm() <= 1e-12 * expected.norm(),
                "{count}: {found}"
            );
        }
    }

    #[test]
    fn equations_that_determine_nothing_are_refused() {
        let nothing = Link { leaving: Matrix2::zeros(), coming: Matrix2::zeros() };
        assert_eq!(solve(&[nothing, nothing], &DVector::zeros(4)), None);
        assert_eq!(solve(&[], &DVector::zeros(0)), None);
    }
}
