//! The one table of tolerances: every number that decides "equal", "zero" or "enough", with its reason.
//!
//! The table has the thresholds at which the numerics count as resolved. [`agreement_bound`] has the differences up to which two routes
//! agree.

/// One threshold and the reason for its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Name of the threshold.
    pub name: &'static str,
    /// The threshold. The reason begins with what it is relative to, or says that it is absolute.
    pub value: f64,
    /// Reason why the threshold is not smaller, and not larger.
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
    LEAST_SIZE = 1e-75, "absolute, whatever the unit. The fourth power of this, and of its inverse, is still a \
        double, and no computation multiplies more such numbers";
    /// Difference of one-sided derivatives of the lift that counts as a corner.
    CAM_JUMP = 1e-9, "relative to the largest derivative of that order on the two segments that meet. It is a \
        thousand times what rounding leaves where two laws meet smoothly, and far below any jump that a machined cam \
        would have by design";
    /// Effect of one rounding on a number.
    ULP = f64::EPSILON, "relative to the number. Differences are rounded by this much, a smaller step leads nowhere, \
        and a bracket closes no further";
    /// Effect of rounding on a derivative of a lift law, or on a bound of one.
    JET_ROUNDING = 64.0 * f64::EPSILON, "relative to the terms of the sum, which may cancel far from where a \
        polynomial starts, plus the next derivative times a radian. The angle itself is rounded by a dozen ulps of a \
        full turn";
    /// Effect of rounding on each term of a sum of cosines.
    TERM_ROUNDING = 8.0 * f64::EPSILON, "relative to the term's largest value. Each cosine comes from the one before \
        by a rotation, with a handful of roundings each time";
    /// Margin added to the ranges of a segment's lift and derivatives.
    RANGE_ROUNDING = 16.0 * f64::EPSILON, "relative to the quantity, plus its change over a full turn. This covers a \
        dozen roundings of the quantity, and those of the angle";
    /// Smallest angle over which a corner may be rounded, degrees.
    LEAST_ROUNDING = 1e-4, "degrees, absolute. Over a smaller angle, rounding of the lifts at its ends leaves a jump \
        of the acceleration that counts as a corner";
    /// Largest mismatch of a cam that closes: its spans and 360 degrees, its rises and 0, its last row and its first.
    CAM_CLOSURE = 1e-9, "relative to the full turn, to the sum of the rises' sizes, or to the largest lift. Numbers \
        typed to ten digits leave as much";
    /// Ratio of gaps between the rows of a table below which rows count as missing.
    TABLE_GAP = 0.1, "the median gap over the widest. A gap of more than ten median gaps means that rows are \
        missing, and a spline would make up the lift there. In a table that is finer where the lift curves, the \
        widest gap is smaller";
    /// Largest part of a lobe from one row to the next; with a larger one, the rows are too few for the accelerations.
    LOBE_ROWS = 1.0 / 16.0, "the gap between two rows over the lobe. A lobe has four accelerations, up and down on \
        either side, and each needs four rows. With fewer, a steep rise of the acceleration looks like a jump";
    /// Noise above which the rows of a table count as noisy.
    NOISE_SEEN = 1e-9, "relative to the rise. Rows with nine digits or more are computed, and a spline through them \
        shows no noise";
    /// Largest distance of two rows, one turn apart, that count as one.
    TURN_CLOSED = 1e-2, "relative to the mean gap between two rows. A turn of 2 pi written to five digits is off by \
        a thousandth of a degree, and distinct rows are nowhere as close";
    /// Largest height above the base circle at which the open part of a lobe may begin or end.
    ON_BASE = 1e-3, "relative to the rise. Lifts of 10 mm are rounded to 0.01 mm at most. Where an opening is given \
        at a checking height, a twentieth of a millimetre, its ends are farther from the base circle";
    /// Error of the pieces of a contour's lift.
    ENVELOPE_LIFT = 1e-12, "relative to the height of the contour. Rows are known a thousand times less well. \
        Rounding of a lift is smaller, even on a base circle a hundred times as large as the height";
    /// Error of the second derivative of the pieces of a contour's lift.
    ENVELOPE_BEND = 1e-9, "relative to the height of the contour, per square radian. A jump of the acceleration that \
        counts as a corner is as large. Rounding of the lifts at the ends of a piece of one degree leaves a \
        thousandth of it";
    /// Distance below which a row and a knot are the same.
    SAME_KNOT = 1e-6, "relative to the mean gap between knots. A piece this short would turn roundings into \
        coefficients of 1e30. For a corner at the end of a dwell, it is absolute";
    /// Curvature that the noise of rows in a dwell may hide.
    HIDDEN_CURVATURE = 1e-2, "relative to the cam's largest curvature. A smaller acceleration matters to no \
        follower. The top of a motion turns back with the largest curvature, so it never stays level for as long";
    /// Spread of rows over a smoothing tolerance, below which the tolerance is reported as too large.
    SMOOTHED_AWAY = 1.0 / 30.0, "relative to the tolerance. Nobody measures a cam with a gauge thirty times less \
        accurate than the spread of its rows, and a spline that far from the rows leaves out parts of the cam";
    /// Spread of rows over the distance of a smoothed cam from one of them, below which no noise makes that distance.
    FAR_SMOOTHED = 1.0 / 4.5, "relative to the distance. Normal noise puts one of 100,000 rows as far away, and \
        tables have fewer rows";
    /// Least jump of the second derivative that counts as a corner in rows.
    CORNER_SHARE = 0.2, "relative to the largest second derivative. Over a few rows, a jump of the third derivative \
        also looks like a smaller jump of the second";
    /// Largest distance of rows from two cubics that meet at a corner, if the noise of the rows is less.
    CORNER_MISFIT = 0.01, "relative to the largest second derivative times the square of the gap between rows. Over \
        six rows on either side, two cubics follow a designed motion that closely. A steep rise of the acceleration \
        leaves several times as much";
    /// Inverse of the evidence from which a corner in rows is certain.
    CORNER_CERTAIN = 1.0 / 25.0, "the inverse of the evidence, in squared standard deviations: five of them. Hardly \
        any simulated cam has as much if its acceleration takes more than four rows, and four degrees, to change by \
        its largest value";
    /// Inverse of the evidence from which a corner in rows is doubtful.
    CORNER_DOUBTFUL = 1.0 / 12.0, "the inverse of the evidence, in squared standard deviations. A few of a thousand \
        smooth simulated cams have as much. With less evidence, a smooth motion fits almost as well";
    /// Inverse of the trend of rows from which a stretch is no dwell.
    DWELL_TREND = 1.0 / 25.0, "the inverse of the trend: the sum of the squares of a polynomial's four coefficients, \
        in squared standard deviations. Noise alone gives more to one dwell in 20000. A base circle with a runout of \
        three times its noise over thirty rows gives more";
    /// Inverse of the deviation of a mean square up to which a polynomial follows rows within their noise.
    DWELL_SMOOTH = 1.0 / 3.0, "the inverse of the deviation, in standard deviations of a mean square. Noise gives \
        more to one stretch of rows in 700, and that stretch stays a dwell";
    /// Width by which the ranges of a segment's lift and derivatives may exceed the true ranges.
    RANGE_WIDTH = 1e-3, "relative to the range, which is halved into pieces until the allowance for values between \
        the samples is below this. Closer ranges would save a search for contacts less time than they cost";
    /// Rounding of the gap between follower and cam.
    GAP_ROUNDING = 4.0 * f64::EPSILON, "relative to the sum of the follower's position and the cam's largest lift: a \
        handful of roundings. A deeper dip is an impact";
    /// Depth below the cam at which a follower in flight has passed through it.
    PASSED_THROUGH = 256.0 * f64::EPSILON, "relative to the sum of the follower's position and the cam's largest \
        lift. It is many times the rounding that a search for contacts allows for, and a follower that falls through \
        the cam exceeds it at once";
    /// Effect of rounding on the state at the end of a simulated stretch.
    RUN_ROUNDING = 4.0 * f64::EPSILON, "relative to the largest position and velocity on the way: a handful of \
        roundings. A step must exceed it to be distinguished from rounding";
    /// Term at which the series of the follower's responses ends.
    SERIES_END = 0.25 * f64::EPSILON, "relative to the response s', which starts at 1. A smaller term changes no \
        digit of the sum";
    /// Relative velocity after an impact that counts as zero.
    RELATIVE_VELOCITY_ROUNDING = 4.0 * f64::EPSILON, "relative to the cam's largest velocity. Below it the \
        difference of the two velocities is rounding, and a chattering follower would never stop bouncing";
    /// Last step to a contact, over the time flown.
    LAST_STEP = 1e-5, "relative to the time of flight in a window. Halley's step errs by the cube of it, below an \
        ulp of that time";
    /// Last turn to a contact, rad.
    LAST_TURN = 1e-6, "absolute, rad. The Taylor sums of follower and cam omit its fourth power";
    /// Last turn to a contact, by the cam's curvature within it.
    LAST_BEND = 1e-11, "relative to the cam's slope. The Taylor sum of the slope omits the next term, which is \
        smaller again by the turn: about an ulp";
    /// Distance between the last two impacts, rad, below which the search for the next one starts at the same angle.
    REPEATED_IMPACT = 0.05, "absolute, rad. It is only a first guess, which pays where Newton's method converges at \
        once";
    /// Turn that infinitely many impacts still take when the simulator replaces them by their sum, rad.
    CHATTER_TURN = 1e-7, "absolute, rad. The third term of the sum is its cube, far below the rounding of an angle";
    /// Least turn from an impact to a release, rad, for the impact to locate an onset of resting.
    CHATTER_LEFT = 1e-4, "absolute, rad. Its cube, which the sum of the impacts omits, is below a thousand roundings \
        of an angle. Before a smooth release, the velocity relative to the cam has the size of its square, and is \
        known to half of its digits";
    /// Square of the second term over the first, in the sum of infinitely many impacts.
    CHATTER_REMAINDER = 1e-8, "the square of the ratio, relative to the sum. In a turn of 1e-7 rad it leaves 1e-15, \
        the rounding of an angle";
    /// Difference between the slopes of a result below and above a number, beyond which the result's uncertainty is not linear.
    CURVED = 1.0 / 3.0, "relative to all slopes together. With a smaller difference, the spread of a straight line \
        is that of a parabola to three hundredths, less than the rounding of the number after ±";
    /// Least difference between the slopes of a result that counts as a curve.
    UNCERTAINTY_SEEN = 1e-6, "relative to the result, for one standard deviation of a number. The angle of a least \
        force is known to the square root of an ulp, and no smaller part of a result is shown";
    /// Accuracy of a number that must be changed, or of a speed at which a limit is exceeded, if found by runs.
    NEEDED_BY_RUNS = 1e-3, "relative to the number or the speed, where runs at some speeds decide. The speeds \
        between them justify fewer than three digits";
    /// Width to which a bracket around a root is closed.
    ROOT_WIDTH = 4.0 * f64::EPSILON, "relative to the root. T* is needed to 1e-14, and a bracket cannot close below \
        two ulps";
    /// Width at which a search reports a box as undecided, if neither a root nor its absence is certain.
    NARROWEST_BOX = 1e-9, "relative to the box that is searched. Rounding hides a double root at the square root of \
        an ulp, 1e-8. Narrower boxes would only multiply around it";
    /// Relative velocity at an impact that counts as zero.
    GRAZING = 1e-9, "relative to the velocities of cam and follower. 1/(v - c') would amplify the rounding of a \
        double to 1e-7, the last size at which five decimals mean anything";
    /// Second derivative above which the cam falls away from its top as a parabola, m/rad^2.
    FLAT_TOP = 1e-6, "relative to the cam's lift, per square radian. The top of a fourth power is located to 1e-5 \
        rad, and its second derivative there is a thousandth of this";
    /// Relative velocity of a simulated impact that may be a graze.
    GRAZE_FOUND = 1e-6, "relative to the velocities of cam and follower. A graze is found where the gap falls below \
        its rounding, so its velocity has the size of the square root of that rounding";
    /// Distance by which the located orbit may miss its own start after one simulated revolution.
    ORBIT_CLOSURE = 1e-9, "relative to the orbit's size. Rounding grows with the multipliers, to about 1e-13 for the \
        paper's orbit. A wrong orbit misses by its amplitude";
    /// Largest last correction of Newton's method to the impacts of a cycle.
    CYCLE_CLOSED = 1e-9, "relative to a radian, and to the cam's lift. The correction after one this small is \
        rounding, and only the rounding stops the iteration";
    /// Largest distance of two impacts that count as the same, rad.
    SAME_ORBIT = 1e-6, "absolute, rad. A cycle is known to ten digits, or to half of them near a graze or a fold";
    /// Angle from a touch at which a simulated flight is clear of it, before or after, rad.
    TOUCH = 1e-3, "absolute, rad. The gap there is a millionth of the cam's second derivative, far above its \
        rounding. Two contacts of one flight are this close only where the follower chatters";
    /// Ratio of the cam's lift to velocities over omega, below which velocities grow without bound along a branch.
    UNBOUNDED = 1e-5, "the cam's lift over the velocity per radian: a thousandth of what orbits of designed cams \
        have. The determinant of a matrix of such sizes keeps six digits";
    /// Turn between two impacts of a cycle, rad, below which a branch that ends does so in chattering.
    CHATTERING_TURN = 1e-3, "absolute, rad. With restitution 0.8, some 120 impacts more bring the turn down to the \
        rounding of an angle. No segment of a designed cam is as short";
    /// Distance of a multiplier from 1 at which another branch crosses.
    BRANCHING = 1e-3, "absolute. The equations are singular there, and Newton's method stops short of it. At a pole \
        of the matrix, where the sign changes too, the numbers are above 1";
    /// Distance of an impact from a corner at which a curve of the onset of resting has a kink.
    KINK = 1e-4, "absolute, rad. On a curve whose two sides at the corner are very close together, an impact comes \
        this close to the corner before differences of the curve's equation reach from one side to the other";
    /// Shortest step along a branch.
    SHORTEST_STEP = 1e-6, "relative to the longest step: twenty halvings. No step gets past an obstacle that is \
        still in the way";
    /// Shortest stretch by which a cam is continued past a corner, rad.
    LEAST_REACH = 5e-4, "absolute, rad. Perturbations are a part of it, and smaller ones would be lost in rounding";
    /// Accuracy of the point where sticking begins or ends on a branch.
    SPECIAL_POINT = 1e-14, "relative to the range of the parameter. Ten digits of its value are needed, and each \
        further digit costs three simulated periods";
    /// Distance by which a minimum of the gap may move when it is found once more by its slope.
    SAME_MINIMUM = 1e-3, "relative to a four-hundredth of the flight. Half the digits of the angle are known before. \
        A step to another minimum is as long as the whole four-hundredth";
    /// Largest distance of two orbits of one branch, from one of its points to the next, rad.
    NEIGHBOURING = 0.05, "absolute, rad. It is more than twice the longest step of a survey, and far less than the \
        distance between two branches at one speed";
    /// Accuracy with which a run must repeat for Newton's method to be tried on it.
    NEARLY_REPEATS = 1e-2, "relative to the cam's lift. It gives a guess that Newton's method and one simulated \
        period confirm or refute";
    /// Width of the bracket around the border between two basins.
    BORDER_BRACKET = 1e-12, "relative to the line on which the border is located. A run that starts nearer to the \
        border follows the saddle for hundreds of revolutions, and rounding decides its end";
    /// Largest distance of the border between two basins from the stable manifold, m.
    BORDER_ON_MANIFOLD = 1e-5, "m, absolute. The manifold is drawn as chords of up to 1e-2 m. Where it bends over \
        metres, the sagitta of a chord is an eighth of its square";
    /// Difference in revolutions between a run's departure and that of the piecewise-linear map.
    PASSAGE = 1e-2, "relative to the count, plus one revolution. At 1e-3 m from x*, the terms of second order, which \
        the map omits, are a thousandth of the first";
    /// Largest distance between the corner and the simulated impact of a located orbit, rad.
    CORNER_ANGLE = 1e-9, "absolute, rad. It is a million times the rounding of an angle, and far below any segment \
        of a cam";
    /// Distance of an eigenvalue from the boundary of Feigin's counts at which it counts as on it.
    UNIT_EIGENVALUE = 1e-9, "absolute. Nearer to the boundary, rounding would decide the count of the eigenvalue. \
        The paper's nearest is 5e-3 away";
    /// Size below which a number that should be 0 is shown as 0.
    DISPLAYED_ZERO = 1e-12, "absolute, in the model's units: a thousand times the rounding of an orbit of size one";
    /// Growth of a small deviation per revolution above which a motion counts as chaotic.
    CHAOTIC_GROWTH = 0.1, "absolute, a logarithm. Sampling over thousands of revolutions leaves an error of a few \
        hundredths";
    /// Change of a number along a branch that counts as none, per radian of an impact's angle and relative to the number's range.
    STANDING = 1e-8, "absolute. The finite differences that steer the tangent leave 1e-9. Next to a fold the change \
        is as large as the step to the fold, 1e-4 or more";
    /// Accuracy of a speed found by halving a bracket in which runs change their kind, rpm.
    SPEED_FOUND = 1e-9, "rpm, absolute. It is ten thousand ulps of a speed, and what the rounding of an angle moves \
        a contact by";
    /// Relative velocity after an impact above which it counts as perceptible, m/s.
    FELT_IMPACT = 1e-6, "m/s, absolute. A count of infinitely many impacts must end somewhere. It ends far above the \
        velocity at which the simulator sums the remaining ones";
    /// Accuracy with which the impacts before an accumulation decrease by the coefficient of restitution.
    GEOMETRIC = 1e-3, "absolute. The cam's slope changes the ratio by as much between two of the last impacts that \
        are simulated one by one";
    /// Accuracy with which the end angle of a line in a diagram agrees with a corner's angle, degrees.
    DRAWN_DEGREES = 0.02, "degrees, absolute. A line of a printed diagram is ten times as wide, and the ends of \
        lines are as steep as the square root of a speed";
    /// Accuracy with which a length of a drawing agrees with the length that it represents.
    DRAWN_LENGTH = 3e-3, "relative to the length. Drawings give three digits or more, and a line of a drawing is a \
        hundredth wide";
    /// Largest part of a difference of two runs that may be rounding where its logarithm is fitted.
    JUMP_RESOLVED = 1e-5, "relative to the difference. An exponent fitted over four octaves then keeps four digits";
    /// Accuracy with which a measured exponent agrees with its whole number.
    JUMP_EXPONENT = 1e-4, "absolute. Exponents differ by whole numbers. Rounding, and the powers that the fit omits, \
        move them by a tenth of this";
    /// Accuracy with which a measured coefficient agrees with the formula.
    JUMP_COEFFICIENT = 1e-6, "relative to the coefficient of the formula: six digits. A jump of the fourth \
        derivative leaves seven digits above rounding";
    /// Accuracy of an identity between computed matrices.
    IDENTITY = 1e-12, "relative to the terms: a few thousand roundings of a double";
    /// Size below which a divisor in a change of coordinates counts as zero.
    DEGENERATE = 1e-10, "relative to the terms of the divisor. With a smaller divisor, the quotient would keep fewer \
        than six digits";
    /// Accuracy with which the two sides of a local map agree on its border.
    CONTINUOUS = 1e-8, "relative to the terms of each minor. Two routes to the map may differ by as much";
    /// Scale of the local map over the size of a motion, below which the motion has escaped.
    ESCAPED = 1e-12, "the map's scale over the motion's size. At the smallest det(I - A) that is not refused, a \
        fixed point lies at 1e10 times the scale. Bounded motions lie within a few times that";
    /// Kick that pushes a motion off an unstable periodic orbit on which rounding has put it.
    KICK = 1e-6, "relative to the map's scale. It is far above rounding, and far below the size of the parts of a \
        chaotic motion";
    /// Standard error of a Lyapunov exponent of the local map over the exponent, below which the motion counts as chaotic.
    CHAOTIC_EXPONENT = 0.2, "the standard error over the exponent: five standard errors above 0, which chance \
        exceeds once in three million runs";
    /// Least growth over the second half of a record, over that in the first, of a motion that counts as chaotic.
    LATER_GROWTH = 0.3, "relative to the growth over the first half. Exponential growth has as much in both halves, \
        except by chance. Growth by a power of up to 3 has a fifth at most after a hundred revolutions";
    /// Margin by which the local map sends a region into its own interior.
    TRAPPED = 1e-10, "relative to the region's size: a hundred thousand roundings, so that rounding hides no way \
        out";
    /// Margin by which a region is extended beyond the points that are sent out of it.
    TAKEN_IN = 1e-4, "relative to the distance from the region's middle. With less, the region grows slowly towards \
        its bounds for hundreds of rounds. An attractor that is within this of its end is reported as undecided";
    /// Size of the set that a region was made around, over the region's own size, below which a growing region is given up.
    LEAVING = 1e-2, "relative to the region's size. Regions that close have grown by less than half";
    /// Least disturbance of an orbit of the local map that the program tries.
    LEAST_DISTURBANCE = 1e-4, "relative to the map's natural units. Orbits of the local map have the size of one \
        unit, and a basin 10,000 times as narrow is of no use to a machine";
    /// Width of the bracket around the edge of a basin of the local map.
    BASIN_EDGE = 1e-4, "relative to the distance of the edge: the three digits that are shown, and one more";
    /// Difference between the local map and the real one up to which the local map counts as valid.
    LINEAR_WITHIN = 0.1, "relative to the displacement that the local map predicts. The program reports the range up \
        to a difference of a tenth";
    /// Difference up to which a prediction with terms of second order counts as valid.
    CURVED_WITHIN = 1e-4, "relative to the displacement. Predictions with terms of second order are for those who \
        need four digits: a ten-thousandth";
    /// Start of the search for the end of the local map's range.
    LINEAR_FROM = 1e-8, "relative to T*. There the local map omits far less than a tenth, and rounding of the real \
        map is far below a tenth too";
    /// Largest change of a nonsmooth fold's speed when its corner is rounded, rpm.
    ROUNDED_AWAY = 1e-4, "rpm, absolute. It is far finer than the speed of a machine is controlled or measured, so \
        within it the corner may be taken as sharp";
    /// Width of the bracket around the end of the local map's range.
    LINEAR_BRACKET = 1e-6, "relative to dT: four digits more than the limit of a tenth justifies";
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

/// Kind of a comparison, which decides its bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// Two routes of this program.
    Routes,
    /// Eigenvalues by two routes of this program.
    Eigenvalues,
    /// The map by an integration with SciPy, against a route of this program.
    Integrated,
    /// Period and state by an integration with SciPy, against a route of this program.
    IntegratedOrbit,
    /// Period (s) and state of the located orbit, against the same orbit found by simulation alone.
    Orbit,
    /// A number that the paper prints, against the closed form.
    Printed {
        /// Digits after the decimal point in print.
        decimals: u32,
    },
    /// An estimate by simulation that the paper prints.
    PrintedEstimate,
}

/// Five decimals, half a unit in the sixth.
pub const FIVE_DECIMALS: f64 = 5e-6;

/// Returns the bound for a quantity of size `scale`: its largest entry. For a difference of two quantities, `scale` is their largest entry.
pub fn agreement_bound(comparison: Comparison, scale: f64) -> Bound {
    match comparison {
        Comparison::Routes => {
            let (relative, ceiling) = (1e-8 * scale, FIVE_DECIMALS.max(5e-10 * scale));
            if relative < ceiling {
                Bound {
                    value: relative,
                    reason: "1e-8 of the largest entry: five decimals would not test entries this small",
                }
            } else if ceiling > FIVE_DECIMALS {
                Bound {
                    value: ceiling,
                    reason: "5e-10 of the largest entry: for entries this large, an estimate in doubles cannot reach five decimals",
                }
            } else {
                Bound { value: FIVE_DECIMALS, reason: "five decimals" }
            }
        }
        Comparison::Eigenvalues => Bound {
            value: FIVE_DECIMALS * scale.max(1.0),
            reason: "five decimals: eigenvalues have no unit, and near a double eigenvalue they keep half the digits of A",
        },
        Comparison::Integrated => Bound {
            value: 1e-7 * scale,
            reason: "1e-7 of the largest entry: the integrator's steps err by 1e-13, and the fit divides this by perturbations \
                of 1e-4; sharp cams cost two more digits",
        },
        Comparison::IntegratedOrbit => Bound {
            value: 1e-9 * scale,
            reason: "1e-9 of the largest entry: the integrator's local error is 1e-13; it adds up over a revolution and is \
                divided by 1 - multiplier",
        },
        Comparison::Orbit => Bound {
            value: 1e-11 * scale,
            reason: "1e-11 of the largest entry: Newton's method on the simulated map ends at rounding, amplified by 1/(1 - multiplier)",
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
            reason: "1e-6 of the largest entry: the accuracy of a fit to simulated revolutions",
        },
    }
}
