//! The one table of tolerances: every number that decides "equal", "zero" or "enough", with its reason.
//!
//! Two kinds: thresholds at which the numerics count as resolved, and differences up to which two routes agree.

/// One threshold and the reason for its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Name of the threshold.
    pub name: &'static str,
    /// The threshold; relative unless the reason says otherwise.
    pub value: f64,
    /// Why the threshold is not smaller, and not larger.
    pub reason: &'static str,
}

macro_rules! table {
    ($($(#[$doc:meta])* $constant:ident = $value:expr, $reason:expr;)*) => {
        $($(#[$doc])* pub const $constant: Tolerance = Tolerance { name: stringify!($constant), value: $value, reason: $reason };)*
        /// All rows, in the order of the file.
        pub const TABLE: &[Tolerance] = &[$($constant),*];
    };
}

table! {
    /// Least size of a divisor in the computation of motions; the largest size of a number is its inverse.
    LEAST_SIZE = 1e-75, "absolute, in whatever units: its fourth power and that of its inverse are still doubles, and more are not \
        multiplied with each other";
    /// Difference of one-sided derivatives of the lift that counts as a corner.
    CAM_JUMP = 1e-9, "of the largest derivative of that order on the two segments that meet: a thousand times what rounding \
        leaves between two laws that meet smoothly, and far below any jump that a machined cam would have by design";
    /// Effect of one rounding on a number.
    ULP = f64::EPSILON, "of the number: what rounds a difference, the least step that leads on, and what a bracket closes to";
    /// Effect of rounding on a derivative of a lift law, or on a bound of one.
    JET_ROUNDING = 64.0 * f64::EPSILON, "of the terms that it is the sum of, which may cancel far from where a polynomial \
        starts, and of the next derivative times a radian: the angle itself is known to a dozen ulps of a full turn";
    /// Effect of rounding on each term of a sum of cosines.
    TERM_ROUNDING = 8.0 * f64::EPSILON, "of the term's largest value: cosines are turned on by one angle again and again, a \
        handful of roundings each time";
    /// Margin added to the ranges of a segment's lift and derivatives.
    RANGE_ROUNDING = 16.0 * f64::EPSILON, "of the quantity, and of what a full turn moves it by: a dozen roundings of it, and \
        the angle's";
    /// Smallest angle over which a corner may be rounded, degrees.
    LEAST_ROUNDING = 1e-4, "degrees, absolute: over less, rounding of the lifts at its ends leaves a jump of the acceleration that \
        counts as one";
    /// Closure of a cam: spans on 360 degrees, rises on 0, a last row on the first.
    CAM_CLOSURE = 1e-9, "of the sum of the sizes: what typing the numbers to ten digits leaves";
    /// Ratio of gaps between the rows of a table below which rows count as missing.
    TABLE_GAP = 0.1, "the median gap over the widest: ten median gaps without a row are rows that are missing, and a spline \
        would make up the lift there; a table that is finer where the lift curves stays below";
    /// Part of a lobe between two rows above which they are too few for its accelerations.
    LOBE_ROWS = 1.0 / 16.0, "of a lobe from one row to the next: four rows for each of the four accelerations of a lobe, up and down on either side, as many as tell a steep rise of the \
        acceleration from a jump";
    /// Noise above which the rows of a table count as noisy.
    NOISE_SEEN = 1e-9, "of the lift: rows with nine digits more than that are computed, and a spline through them has the noise of \
        none";
    /// Closure of the rows of a table after one turn.
    TURN_CLOSED = 1e-2, "of the mean gap between two rows: 2 pi to five digits is a thousandth of a degree off, and two rows that \
        were meant to be apart are nowhere as near";
    /// Lift above the base circle at which the open part of a lobe may begin or end.
    ON_BASE = 1e-3, "of the rise: lifts of 10 mm are rounded to 0.01 mm at most; where an opening is taken at a checking height, a twentieth of \
        a millimetre, the ends are further off";
    /// Error of the pieces of a contour's lift.
    ENVELOPE_LIFT = 1e-12, "of the height of the contour: a thousand times less than rows are known, and above the rounding of a lift on a \
        base circle a hundred times as large";
    /// Error of their second derivative.
    ENVELOPE_BEND = 1e-9, "of the height of the contour per square radian: a jump of the acceleration that counts as a corner is as large, \
        and rounding of the lifts at the ends of a piece of a degree leaves a thousandth of it";
    /// Distance below which a row and a knot are the same.
    SAME_KNOT = 1e-6, "of the mean gap: a piece as short would make coefficients of 1e30 out of roundings";
    /// Curvature that the noise of rows in a dwell may hide.
    HIDDEN_CURVATURE = 1e-2, "of the cam's largest: below that an acceleration is none for any follower, and a motion's top, which \
        turns round with its largest, never stays as long";
    /// Spread of rows over a smoothing tolerance, below which the tolerance is reported as too large.
    SMOOTHED_AWAY = 1.0 / 30.0, "of the tolerance: a gauge that is right to thirty times what its rows spread by would be used for no cam, and \
        a spline that far from them leaves out what the cam has";
    /// Spread of rows over the distance of a smoothed cam from one of them, below which no noise makes that distance.
    FAR_SMOOTHED = 1.0 / 4.5, "of the distance: normal noise leaves one of 100,000 rows as far, and a table has fewer";
    /// Least jump of the second derivative that counts as a corner in rows.
    CORNER_SHARE = 0.2, "of the largest second derivative: a smaller one is what a jump of the third derivative makes over a few rows";
    /// Largest distance of rows from two cubics that meet at a corner, for rows with less noise than that.
    CORNER_MISFIT = 0.01, "of what the largest second derivative bends from one row to the next, twice over: two cubics follow a \
        designed motion over six rows on either side that closely, and leave several times as much of a steep rise of the acceleration";
    /// Inverse of the evidence from which a corner in rows is certain.
    CORNER_CERTAIN = 1.0 / 25.0, "of the evidence, in squared standard deviations: five of them, which hardly any simulated cam has whose acceleration \
        takes more than four rows, and four degrees, to change by its largest value";
    /// Inverse of the evidence from which a corner in rows is doubtful.
    CORNER_DOUBTFUL = 1.0 / 12.0, "of the evidence, in squared standard deviations: a few of a thousand such cams have as much; below that a smooth \
        motion fits almost as well";
    /// Inverse of the trend of rows from which a stretch is no dwell.
    DWELL_TREND = 1.0 / 25.0, "of the trend, in squared standard deviations, of the four coefficients of a polynomial together: noise gives more to one \
        dwell in 20000, and a base circle that runs out by three times its noise over thirty rows gives more";
    /// Inverse of the deviation of a mean square up to which a polynomial follows rows within their noise.
    DWELL_SMOOTH = 1.0 / 3.0, "of the deviation, in standard deviations of a mean square: noise gives more to one stretch of rows in 700, and \
        that stretch stays a dwell";
    /// Width by which the ranges of a segment's lift and derivatives may exceed the true ranges.
    RANGE_WIDTH = 1e-3, "of the range, which is halved into pieces until what is added for what lies between the samples is \
        below this: closer ranges would save a search for contacts less than they cost";
    /// Rounding of the gap between follower and cam.
    GAP_ROUNDING = 4.0 * f64::EPSILON, "of the follower's position and the cam's largest lift: a handful of roundings, so that \
        a dip deeper than this is an impact";
    /// Depth below the cam at which a follower in flight has passed through it.
    PASSED_THROUGH = 256.0 * f64::EPSILON, "of the follower's position and the cam's largest lift: many times the rounding that a search for \
        contacts allows for, and at once exceeded by whatever falls through";
    /// Effect of rounding on the state at the end of a simulated stretch.
    RUN_ROUNDING = 4.0 * f64::EPSILON, "of the largest position and velocity on the way: a handful of roundings, which a step \
        to be told from them must exceed";
    /// Term at which the series of the follower's responses ends.
    SERIES_END = 0.25 * f64::EPSILON, "of the response s', which starts at 1: a smaller term changes no digit of the sum";
    /// Relative velocity after an impact that counts as zero.
    RELATIVE_VELOCITY_ROUNDING = 4.0 * f64::EPSILON, "of the cam's largest velocity: below it the difference of the two velocities \
        is rounding, and a chattering follower would go on bouncing in it";
    /// Last step to a contact, over the time flown.
    LAST_STEP = 1e-5, "of the flight over a window: Halley's step errs by the cube of it, below an ulp of that time";
    /// Last turn to a contact, rad.
    LAST_TURN = 1e-6, "absolute, rad: the Taylor sums of follower and cam leave out its fourth power";
    /// Last turn to a contact, by the bend of the cam within it.
    LAST_BEND = 1e-11, "of the cam's slope: what the slope's Taylor sum leaves out is the next term, smaller again by the \
        turn, so an ulp";
    /// Distance between the last two impacts, rad, below which the next one is looked for there first.
    REPEATED_IMPACT = 0.05, "absolute, rad: only a first guess, worth taking where Newton's method converges at once";
    /// Angle remaining for infinitely many impacts when their sum is taken, rad.
    CHATTER_TURN = 1e-7, "absolute, rad: the third term of the sum is its cube, far below the rounding of an angle";
    /// Least turn from an impact to a release, rad, for the impact to locate an onset of resting; also the longest sum that counts as one.
    CHATTER_LEFT = 1e-4, "absolute, rad: the cube of it, which a sum leaves out, is below a thousand roundings of an angle; before a \
        smooth release the velocity over the cam is of the size of its square, and known to half of its digits";
    /// Difference of the second term of the sum of infinitely many impacts from the first.
    CHATTER_REMAINDER = 1e-8, "squared, of the sum: of a turn of 1e-7 rad it leaves 1e-15, the rounding of an angle";
    /// Difference of the slopes of a result, down and up from a number, above which its uncertainty is not linear.
    CURVED = 1.0 / 3.0, "of all slopes together: with less a straight line has the spread of a parabola to three hundredths, less than the rounding of ±";
    /// Difference of the slopes of a result that counts as a curve.
    UNCERTAINTY_SEEN = 1e-6, "of the result, for one standard deviation of a number: an angle where a force is least is known to the root \
        of an ulp, and no smaller part of a result is shown";
    /// Accuracy of a number that must be changed, or of a speed at which a limit is exceeded, if found by runs.
    NEEDED_BY_RUNS = 1e-3, "of the number or the speed, where runs at some speeds tell: three digits are more than the speeds \
        that are left out allow";
    /// Width at which a bracket around a root is closed.
    ROOT_WIDTH = 4.0 * f64::EPSILON, "of the root: T* is asked for to 1e-14, and a bracket cannot close below two ulps";
    /// Width at which a box is left undecided, if neither a root nor its absence is certain.
    NARROWEST_BOX = 1e-9, "of the box that is looked through: rounding hides a double root at the root of an ulp, 1e-8, and \
        narrower boxes would only be more about it";
    /// Relative velocity at an impact that counts as zero.
    GRAZING = 1e-9, "of the velocities it is the difference of: 1/(v - c') would amplify the rounding of a double to 1e-7, \
        the last size at which five decimals mean anything";
    /// Second derivative above which the cam falls away from its top as a parabola, m/rad^2.
    FLAT_TOP = 1e-6, "of the cam's lift, times a radian: the top of a fourth power is located to 1e-5 rad, and its second derivative \
        there is a thousandth of this";
    /// Relative velocity of a simulated impact that may be a graze.
    GRAZE_FOUND = 1e-6, "of the velocities it is the difference of: a graze is found where the gap falls below its rounding, \
        so its velocity is of the size of the root of that rounding";
    /// Distance by which the located orbit may miss its own start after one simulated revolution.
    ORBIT_CLOSURE = 1e-9, "of the orbit's size: rounding grows with the multipliers, about 1e-13 for the paper's orbit; a \
        wrong orbit misses by its amplitude";
    /// Last correction of Newton's method to the impacts of a cycle.
    CYCLE_CLOSED = 1e-9, "of a radian and of the cam's lift: the correction after one this small is rounding, and only the \
        rounding stops the iteration";
    /// Distance of two impacts that count as the same, rad.
    SAME_ORBIT = 1e-6, "absolute, rad: a cycle is known to ten digits, or half of them near a graze or a fold";
    /// Angle from a touch at which a simulated flight is clear of it, before or after, rad.
    TOUCH = 1e-3, "absolute, rad: the gap there is a millionth of the cam's bend, far above its rounding, and no two contacts \
        of one flight are as near but where the follower chatters";
    /// Ratio of the cam's lift to velocities over omega, below which velocities grow without bound along a branch.
    UNBOUNDED = 1e-5, "of the velocity, times a radian: a thousandth of what orbits of designed cams have; the determinant of a \
        matrix of such sizes keeps six digits";
    /// Turn between two impacts of a cycle, rad, below which a branch that ends does so in chattering.
    CHATTERING_TURN = 1e-3, "absolute, rad: with restitution 0.8 thirty impacts more are within the rounding of an angle, and \
        no segment of a designed cam is as short";
    /// Distance of a multiplier from 1 at which another branch crosses.
    BRANCHING = 1e-3, "absolute: the equations are singular there, and Newton's method stops short of it; a pole of the matrix \
        has numbers above 1";
    /// Distance of an impact from a corner at which a curve of the onset of resting has a kink.
    KINK = 1e-4, "absolute, rad: as near to a corner an impact comes on a curve whose two sides there are so close together that \
        differences of its equation reach from the one over to the other";
    /// Shortest step along a branch.
    SHORTEST_STEP = 1e-6, "of the longest: twenty halvings, after which a change in the way is one that no step gets past";
    /// Shortest stretch by which a cam is continued past a corner, rad.
    LEAST_REACH = 5e-4, "absolute, rad: perturbations are a part of it, and smaller ones would be lost in rounding";
    /// Accuracy of the point where sticking begins or ends on a branch.
    SPECIAL_POINT = 1e-14, "of the range of the parameter: ten digits of its value are asked for, and each one more costs three \
        simulated periods";
    /// Distance by which a minimum of the gap may move when it is found once more by its slope.
    SAME_MINIMUM = 1e-3, "of a four-hundredth of the flight: half the digits of an angle are known before, and a step to \
        another minimum is as long as the whole";
    /// Largest distance of two orbits of one branch, from one of its points to the next, rad.
    NEIGHBOURING = 0.05, "absolute, rad: more than twice the longest step of a survey, and far less than what parts two branches \
        at one speed";
    /// Accuracy with which a run must repeat for Newton's method to be tried on it.
    NEARLY_REPEATS = 1e-2, "of the cam's lift: a guess, that Newton's method and one simulated period confirm or refute";
    /// Width of the bracket around the border between two basins.
    BORDER_BRACKET = 1e-12, "of the line that it is looked for on: a run that starts nearer to the border than that follows the \
        saddle for hundreds of revolutions, and rounding decides";
    /// Largest distance of the border between two basins from the stable manifold, m.
    BORDER_ON_MANIFOLD = 1e-5, "m, absolute: the manifold is drawn as chords of up to 1e-2 m, and the sagitta of one where it bends \
        over metres is an eighth of the square of that";
    /// Difference in revolutions between a run's departure and that of the piecewise-linear map.
    PASSAGE = 1e-2, "of the count, and one revolution: at 1e-3 m from x* the second order, which the map leaves out, is a \
        thousandth of the first";
    /// Largest distance between the corner and the simulated impact of a located orbit, rad.
    CORNER_ANGLE = 1e-9, "absolute, rad: twenty thousand times the rounding of an angle and far below any segment of a cam";
    /// Distance of an eigenvalue from the boundary of Feigin's counts at which it counts as on it.
    UNIT_EIGENVALUE = 1e-9, "of one: counting an eigenvalue that rounding decides would be guessing; the paper's nearest is \
        5e-3 away";
    /// Size below which a number that should be 0 is shown as 0.
    DISPLAYED_ZERO = 1e-12, "absolute, in the model's units: a thousand times the rounding of an orbit of size one";
    /// Growth of a small deviation per revolution above which a motion counts as chaotic.
    CHAOTIC_GROWTH = 0.1, "absolute, a logarithm: sampling over thousands of revolutions leaves a few hundredths";
    /// Change of a number along a branch, per radian of an impact's angle and relative to the number's range, that counts as none.
    STANDING = 1e-8, "absolute: differences that steer the tangent leave 1e-9; next to a fold it is as much as the step to there, of 1e-4 and more";
    /// Accuracy of a speed found by halving a bracket in which runs change their kind, rpm.
    SPEED_FOUND = 1e-9, "rpm, absolute: ten thousand ulps of a speed, and what the rounding of an angle moves a contact by";
    /// Relative velocity after an impact above which it counts as perceptible, m/s.
    FELT_IMPACT = 1e-6, "m/s, absolute: of infinitely many impacts a number must end somewhere, and far above where the \
        simulator takes the sum of the rest";
    /// Accuracy with which the impacts before an accumulation decrease by the coefficient of restitution.
    GEOMETRIC = 1e-3, "of one: what the cam's slope changes between two impacts, in the last that are flown one by one";
    /// Accuracy with which the end angle of a line in a diagram agrees with a corner's angle, degrees.
    DRAWN_DEGREES = 0.02, "degrees, absolute: a line of a printed diagram is ten times as wide, and the ends of lines are as \
        steep as the root of a speed";
    /// Accuracy with which a length of a drawing agrees with the length that it represents.
    DRAWN_LENGTH = 3e-3, "of the length: drawings give three digits or more, and a line of one is a hundredth wide";
    /// Part of a difference of two runs that may be rounding where its logarithm is fitted.
    JUMP_RESOLVED = 1e-5, "of the difference: an exponent fitted over four octaves then keeps four digits";
    /// Accuracy with which a measured exponent agrees with its whole number.
    JUMP_EXPONENT = 1e-4, "absolute: exponents differ by whole numbers, and what rounding and the powers that the fit leaves out \
        move them by is a tenth of this";
    /// Accuracy with which a measured coefficient agrees with the formula.
    JUMP_COEFFICIENT = 1e-6, "of the formula's: six digits, of which a jump of the fourth derivative leaves seven above rounding";
    /// Accuracy of an identity between computed matrices.
    IDENTITY = 1e-12, "of the terms: a few hundred roundings";
    /// Size below which a divisor in a change of coordinates counts as zero.
    DEGENERATE = 1e-10, "of the terms it is made of: the quotient would keep fewer than six digits";
    /// Accuracy with which the two sides of a local map agree on its border.
    CONTINUOUS = 1e-8, "of the terms of each minor: what two routes to the map may differ by";
    /// Scale of the local map over the size of a motion, below which the motion has escaped.
    ESCAPED = 1e-12, "the map's scale over the motion's size: a fixed point lies at 1e10 times the scale where det(I - A) is as \
        small as is not refused, and bounded motions within a few times that";
    /// Kick that pushes a motion off an unstable periodic orbit on which rounding has put it.
    KICK = 1e-6, "of the map's scale: far above rounding, and far below the parts of a chaotic motion";
    /// Standard error of a Lyapunov exponent of the local map over the exponent, below which the motion counts as chaotic.
    CHAOTIC_EXPONENT = 0.2, "the standard error over the exponent: five standard errors above 0, which chance exceeds once in \
        three million runs";
    /// Least growth over the second half of a record, over that in the first, of a motion that counts as chaotic.
    LATER_GROWTH = 0.3, "of the growth over the first half: exponential growth has as much but for chance, and that of a power of up to 3 a \
        fifth at most after a hundred revolutions";
    /// Margin by which the local map sends a region into its own interior.
    TRAPPED = 1e-10, "of the region's size: a hundred thousand roundings, so that rounding hides no way out";
    /// Margin by which a region is extended beyond the points that are sent out of it.
    TAKEN_IN = 1e-4, "of the distance from its middle: with less, the region creeps towards its bounds for hundreds of rounds; \
        attractors within that of their end are left undecided";
    /// Size of the set that a region was made around, over the region's own size, below which a growing region is given up.
    LEAVING = 1e-2, "of its size: regions that close up have grown by less than half";
    /// Least disturbance of an orbit of the local map that is tried.
    LEAST_DISTURBANCE = 1e-4, "of the map's natural units: orbits of the local map are of the size of one of them, and a basin that is \
        10,000 times as narrow is none for any machine";
    /// Width of the bracket around the edge of a basin of the local map.
    BASIN_EDGE = 1e-4, "of its distance: the three digits that are shown, and one more";
    /// Difference between the local map and the real one up to which the local map counts as valid.
    LINEAR_WITHIN = 0.1, "of the displacement that the local map predicts: the tenth that its range is asked for at";
    /// Difference up to which a prediction with terms of second order counts as valid.
    CURVED_WITHIN = 1e-4, "of the displacement: a ten-thousandth, four digits of it, is what such a prediction is for";
    /// Start of the search for the end of the local map's range.
    LINEAR_FROM = 1e-8, "of T*: there what the local map leaves out is far below a tenth, and rounding of the real one still \
        is";
    /// Largest change of a nonsmooth fold's speed when its corner is rounded, rpm.
    ROUNDED_AWAY = 1e-4, "rpm, absolute: far finer than a machine's speed is held or measured, so that within it the corner may be \
        taken as sharp";
    /// Width of the bracket around the end of the local map's range.
    LINEAR_BRACKET = 1e-6, "of dT: four digits more than the tenth means";
}

/// Largest difference at which two routes agree on a quantity, and the reason.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Bound {
    /// Largest absolute difference of any entry.
    #[serde(rename = "tolerance")]
    pub value: f64,
    /// Reason for the value.
    pub reason: &'static str,
}

/// Comparison for which a bound is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// Two routes of this program.
    Routes,
    /// Eigenvalues by two routes of this program.
    Eigenvalues,
    /// An integration by SciPy against a route of this program: the map.
    Integrated,
    /// An integration by SciPy against a route of this program: period and state.
    IntegratedOrbit,
    /// The located orbit against the same orbit found by simulation alone: period in s and state.
    Orbit,
    /// A number that the paper prints against the closed form; `decimals` are those printed.
    Printed {
        /// Digits after the decimal point in print.
        decimals: u32,
    },
    /// An estimate by simulation that the paper prints.
    PrintedEstimate,
}

/// Five decimals, half a unit in the sixth.
pub const FIVE_DECIMALS: f64 = 5e-6;

/// Bound for a quantity of size `scale`: its largest entry, or that of the quantities whose difference it is.
pub fn agreement_bound(comparison: Comparison, scale: f64) -> Bound {
    match comparison {
        Comparison::Routes => {
            let (relative, ceiling) = (1e-8 * scale, FIVE_DECIMALS.max(5e-10 * scale));
            if relative < ceiling {
                Bound {
                    value: relative,
                    reason: "1e-8 of the largest entry: five decimals would be no test of entries this small",
                }
            } else if ceiling > FIVE_DECIMALS {
                Bound {
                    value: ceiling,
                    reason: "5e-10 of the largest entry: with entries this large five decimals are beyond a double's estimate",
                }
            } else {
                Bound { value: FIVE_DECIMALS, reason: "five decimals" }
            }
        }
        Comparison::Eigenvalues => Bound {
            value: FIVE_DECIMALS * scale.max(1.0),
            reason: "five decimals: eigenvalues have no unit, and near a double one they keep half the digits of A",
        },
        Comparison::Integrated => Bound {
            value: 1e-7 * scale,
            reason: "1e-7 of the largest entry: the integrator's steps end at 1e-13 and the fit divides them by perturbations \
                of 1e-4; sharp cams take two digits more",
        },
        Comparison::IntegratedOrbit => Bound {
            value: 1e-9 * scale,
            reason: "1e-9 of the largest entry: the integrator's local error of 1e-13, over a revolution and divided by what \
                the multipliers leave",
        },
        Comparison::Orbit => Bound {
            value: 1e-11 * scale,
            reason: "1e-11 of the largest entry: Newton on the simulated map ends at its rounding, amplified by 1/(1 - multiplier)",
        },
        Comparison::Printed { decimals } => {
            let half_unit = 0.5 * 10f64.powi(-(decimals.min(300) as i32));
            let round_off = 2e-13 * scale.max(1.0);
            if half_unit >= round_off {
                Bound { value: half_unit, reason: "half a unit in the last printed place" }
            } else {
                Bound {
                    value: round_off,
                    reason: "2e-13: the last two of fourteen printed digits are round-off of the authors' computation",
                }
            }
        }
        Comparison::PrintedEstimate => Bound {
            value: 1e-6 * scale,
            reason: "1e-6 of the largest entry: what a fit to simulated revolutions is good for",
        },
    }
}
