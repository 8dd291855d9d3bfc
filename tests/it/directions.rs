//! Are the directions in which motions diverge at the corner impact those of closed forms, in any coordinates?

use corner_impact::border_collision::directions::Homogeneous;
use corner_impact::interval::Interval;
use nalgebra::{Matrix2, RowVector2, Vector2};

/// The sectors of the thorough search.
const SECTORS: f64 = 8192.0;

/// `x' = A x` with the matrix of the side, minus where `e x < 0`.
#[derive(Clone, Copy, Debug)]
struct Rays {
    minus: Matrix2<f64>,
    plus: Matrix2<f64>,
    e: RowVector2<f64>,
}

impl Rays {
    /// Minus where x < 0.
    fn new(minus: Matrix2<f64>, plus: Matrix2<f64>) -> Self {
        Self { minus, plus, e: RowVector2::new(1.0, 0.0) }
    }

    /// The same map of `y = m x`.
    fn seen(self, m: Matrix2<f64>) -> Self {
        let inverse = m.try_inverse().unwrap();
        Self { minus: m * self.minus * inverse, plus: m * self.plus * inverse, e: self.e * inverse }
    }

    fn share_in(self, units: Vector2<f64>, is_likely: bool) -> f64 {
        let rows = |a: Matrix2<f64>| [0, 1].map(|row| [0, 1].map(|column| Interval::from(a[(row, column)])));
        let border = [self.e[0], self.e[1]].map(Interval::from);
        Homogeneous::new([rows(self.minus), rows(self.plus)], border, units).diverging(is_likely)
    }

    fn share(self) -> f64 {
        self.share_in(Vector2::new(1.0, 1.0), true)
    }
}

/// The eight symmetries of a square.
fn symmetries() -> Vec<Matrix2<f64>> {
    let signs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
    signs.iter().flat_map(|[a, b]| [Matrix2::new(*a, 0.0, 0.0, *b), Matrix2::new(0.0, *a, *b, 0.0)]).collect()
}

/// Where x < 0, the border's upper ray turns inwards and its lower one outwards; between the two the ray `x/y = 0.2/1.1` shrinks, and what is
/// above it grows along x.
const MINUS: Matrix2<f64> = Matrix2::new(1.5, -0.2, 0.0, 0.4);

/// Of the square's edge, 8 long, diverges what lies between the rays that do not: each sector that has none of these on it, however the
/// square is turned.
#[test]
fn the_share_of_directions_is_that_between_the_rays_that_shrink() {
    let lost = |lengths: f64| (1024.0 * lengths).ceil();
    let of_minus = 4.0 * 1024.0 - lost(0.2 / 1.1);
    for (plus, sectors, uncertain, of_border) in [
        // All shrinks, and the border with it, which is not on the minus side.
        (Matrix2::new(0.5, 0.0, 0.0, 0.5), of_minus - 1.0, 0.0, 1.0),
        // The ratio r = y/x becomes 0.45 r/(1 - r), which rises from 0.55 on until it goes over the border, and falls to 0 below. Of a sector next to
        // 0.55 it is not certain.
        (Matrix2::new(0.8, -0.8, 0.0, 0.36), of_minus + 2.0 * 1024.0 - lost(0.55), 1.0, 0.0),
    ] {
        for m in symmetries() {
            let seen = Rays::new(MINUS, plus).seen(m);
            assert_eq!(seen.share() * SECTORS, sectors - uncertain, "{seen:?}");
            let exchanged = Rays { minus: seen.plus, plus: seen.minus, e: -seen.e };
            assert_eq!(exchanged.share() * SECTORS, sectors - uncertain + of_border, "{exchanged:?}");
            // A quick search goes on where it has found some.
            assert_eq!(seen.share_in(Vector2::new(1.0, 1.0), false), seen.share(), "{seen:?}");
        }
    }
}

/// In coordinates that are stretched by powers of two, and told so, every number is the same to the last bit; in those that are not told, another
/// part of the square's edge is between the rays.
#[test]
fn the_share_of_directions_is_one_in_stretched_coordinates() {
    let rays = Rays::new(MINUS, Matrix2::new(0.8, -0.8, 0.0, 0.36));
    for tilt in [0.0, 0.25, -3.0] {
        let rays = Rays { e: RowVector2::new(1.0, tilt), ..rays };
        for [one, two] in [[8.0, 0.5], [0.25, 0.25], [1.0, 1024.0]] {
            let stretched = rays.seen(Matrix2::new(one, 0.0, 0.0, two));
            for off in [0.8, 1.0, 1.3] {
                assert_eq!(
                    stretched.share_in(Vector2::new(off * one, two / off), true),
                    rays.share(),
                    "{tilt} {one} {two}"
                );
            }
        }
    }
}

/// Turned by an angle and stretched a little, every motion grows. By a quarter of a turn sectors go to sectors, so that the least growth is seen; by
/// another angle the growth along a sector is only known to its width, so that sectors have to be narrow.
#[test]
fn a_small_growth_takes_narrow_sectors() {
    let turn = |cos: f64, sin: f64, stretch: f64| {
        let a = Matrix2::new(cos, -sin, sin, cos) * stretch;
        let units = Vector2::new(1.0, 1.0);
        [true, false].map(|is_likely| Rays::new(a, a).share_in(units, is_likely))
    };
    for sin in [1.0, -1.0] {
        assert_eq!(turn(0.0, sin, 1.0 + 1e-5), [1.0, 1.0]);
        assert_eq!(turn(0.0, sin, 1.0), [0.0, 0.0]);
        for cos in [0.6, 0.28, 0.8, -0.352] {
            let sin = sin * f64::sqrt(1.0 - cos * cos);
            assert_eq!(turn(cos, sin, 1.0 + 1.0 / 64.0), [1.0, 1.0], "{cos} {sin}");
            assert_eq!(turn(cos, sin, 1.002), [1.0, 0.0], "{cos} {sin}");
            assert_eq!(turn(cos, sin, 1.0 - 1e-9), [0.0, 0.0], "{cos} {sin}");
        }
    }
}

/// Turned and doubled every motion grows, in sectors of whatever width, and with whichever of the matrices that are as near as a part of a wide
/// sector: wide ones are all that is looked at.
#[test]
fn matrices_that_are_known_to_a_part_of_a_sector_are_enough() {
    let around = |entry: f64| Interval::new(entry - 0.002, entry + 0.002);
    for [cos, sin] in [[0.6, 0.8], [0.6, -0.8], [-0.28, 0.96], [0.8, 0.6], [-0.96, -0.28]] {
        let rows = [[cos, -sin], [sin, cos]].map(|row| row.map(|entry| around(2.0 * entry)));
        let border = [1.0, 0.3].map(Interval::from);
        for is_likely in [true, false] {
            let share = Homogeneous::new([rows, rows], border, Vector2::new(1.0, 1.0)).diverging(is_likely);
            assert_eq!(share, 1.0, "{cos} {sin} {is_likely}");
        }
    }
}
