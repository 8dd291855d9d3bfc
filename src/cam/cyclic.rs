//! Solver for symmetric positive definite systems in which every unknown is coupled to its two neighbours on a circle.
//!
//! `N_{i-1}^T x_{i-1} + D_i x_i + N_i x_{i+1} = r_i`, indices modulo n, with blocks of size K. Block Cholesky elimination starts from the
//! first unknown; the last one, which is coupled to the first, is carried along as a border. O(n).

use nalgebra::{Cholesky, Const, SMatrix, SVector};

/// System of equations under construction, one equation per knot.
#[derive(Clone, Debug)]
pub(super) struct Cyclic<const K: usize> {
    pub diagonal: Vec<SMatrix<f64, K, K>>,
    /// N_i, coupling of i and i + 1.
    pub next: Vec<SMatrix<f64, K, K>>,
    pub right: Vec<SVector<f64, K>>,
}

/// Blocks (i, i) and (i, i + 1) of the inverse, for each i.
pub(super) type Blocks<const K: usize> = Vec<[SMatrix<f64, K, K>; 2]>;

/// Eliminated unknown: `x_i = y - N x_{i+1} - W x_last`, with all terms divided by its pivot.
struct Eliminated<const K: usize> {
    y: SVector<f64, K>,
    next: SMatrix<f64, K, K>,
    last: SMatrix<f64, K, K>,
    /// Inverse of its pivot.
    inverse: SMatrix<f64, K, K>,
}

impl<const K: usize> Cyclic<K> {
    pub fn new(count: usize) -> Self {
        let (block, column) = (SMatrix::zeros(), SVector::zeros());
        Self { diagonal: vec![block; count], next: vec![block; count], right: vec![column; count] }
    }

    /// Returns the solution; `None` if the system is not positive definite or has fewer than three unknowns.
    pub fn solve(self) -> Option<Vec<SVector<f64, K>>> {
        self.factored().map(|(solution, _)| solution)
    }

    /// Returns the solution, and the blocks (i, i) and (i, i + 1) of the inverse, for each i.
    pub fn solve_and_invert(self) -> Option<(Vec<SVector<f64, K>>, Blocks<K>)> {
        let (solution, (eliminated, corner)) = self.factored()?;
        let last = eliminated.len();
        // Without the last unknown the inverse is T^-1, computed from the last row back. With it, z S^-1 z^T is added: z = T^-1 times the
        // border, and S is the remainder of the last equation. The block between an unknown and the last one is -z S^-1.
        let mut blocks = vec![[SMatrix::zeros(); 2]; last + 1];
        let (mut inner, mut z) = (SMatrix::zeros(), SMatrix::zeros());
        for (index, row) in eliminated.iter().enumerate().rev() {
            let is_neighbour = index + 1 == last;
            let (below, z_below) = (inner, z);
            z = row.last - row.next * z_below;
            inner = row.inverse + row.next * below * row.next.transpose();
            let beyond = match is_neighbour {
                true => -z * corner,
                false => z * corner * z_below.transpose() - row.next * below,
            };
            blocks[index] = [inner + z * corner * z.transpose(), beyond];
        }
        blocks[last] = [corner, -(z * corner).transpose()];
        Some((solution, blocks))
    }

    /// Returns the solution, the eliminated unknowns, and the inverse of the remainder of the last equation.
    #[expect(clippy::type_complexity, reason = "its two users take it apart at once")]
    fn factored(self) -> Option<(Vec<SVector<f64, K>>, (Vec<Eliminated<K>>, SMatrix<f64, K, K>))> {
        let Self { diagonal, next, right } = self;
        let count = diagonal.len();
        if count < 3 {
            return None;
        }
        let last = count - 1;
        // The last equation, reduced as the unknowns before it are eliminated.
        let (mut corner, mut corner_right) = (diagonal[last], right[last]);
        // Unknown 0 is coupled to the last one through N_last^T; the last but one is coupled to it through its own N.
        let (mut pivot, mut y, mut border) = (diagonal[0], right[0], next[last].transpose());
        let mut eliminated: Vec<Eliminated<K>> = Vec::with_capacity(last);
        for index in 0..last {
            let is_neighbour = index + 1 == last;
            if is_neighbour {
                border += next[index];
            }
            let to_next = if is_neighbour { SMatrix::zeros() } else { next[index] };
            let factor: Cholesky<f64, Const<K>> = pivot.cholesky()?;
            let row = Eliminated {
                y: factor.solve(&y),
                next: factor.solve(&to_next),
                last: factor.solve(&border),
                inverse: factor.inverse(),
            };
            // Schur complement: the remainder of the next equation and of the last one.
            corner -= border.transpose() * row.last;
            corner_right -= border.transpose() * row.y;
            if !is_neighbour {
                pivot = diagonal[index + 1] - to_next.transpose() * row.next;
                y = right[index + 1] - to_next.transpose() * row.y;
                border = -to_next.transpose() * row.last;
            }
            eliminated.push(row);
        }
        let corner = corner.cholesky()?;
        let x_last = corner.solve(&corner_right);
        let mut solution = vec![x_last; count];
        for (index, row) in eliminated.iter().enumerate().rev() {
            solution[index] = row.y - row.next * solution[index + 1] - row.last * x_last;
        }
        Some((solution, (eliminated, corner.inverse())))
    }
}
