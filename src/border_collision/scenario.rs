//! What happens to the fixed point, from the two matrices alone.

use nalgebra::Matrix2;

use super::feigin::Scenario;
use crate::orbit::eigenvalues;
use crate::tolerance;

/// Feigin's scenario for A- and A+, 2x2; `None` where an eigenvalue is 1 or -1 as far as can be told, or the matrices are
/// not finite.
pub fn scenario([minus, plus]: &[Matrix2<f64>; 2]) -> Option<Scenario> {
    let both = [eigenvalues(minus), eigenvalues(plus)];
    let all = || both.iter().flatten();
    let doubtful = |value: &&crate::orbit::Eigenvalue| {
        value.im == 0.0 && (value.re.abs() - 1.0).abs() <= tolerance::UNIT_EIGENVALUE.value
    };
    if all().any(|value| !value.re.is_finite()) || all().any(|value| doubtful(&value)) {
        return None;
    }
    let odd = |beyond: fn(f64) -> bool| all().filter(|value| value.im == 0.0 && beyond(value.re)).count() % 2 == 1;
    Some(match (odd(|re| re > 1.0), odd(|re| re < -1.0)) {
        (true, _) => Scenario::NonsmoothFold,
        (false, true) => Scenario::NonsmoothFlip,
        (false, false) => Scenario::Persistence,
    })
}
