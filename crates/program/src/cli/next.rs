//! Suggestion of the command that usually follows another.

/// Fills in the template of the next command. `{model}` becomes the words that name the model, and `{rpm}` the speed of the command line.
/// `{range}` becomes its range of speeds, or 5 % around its speed, and `{axis}` the range of another number.
pub(super) fn filled(template: &str, model: &str, rpm: Option<[f64; 2]>, axis: Option<&str>) -> String {
    let (one, range) = match rpm {
        Some([low, high]) if low < high => (low.to_string(), format!("{low}:{high}")),
        Some([rpm, _]) => (rpm.to_string(), format!("{}:{}", 0.95 * rpm, 1.05 * rpm)),
        None => ("R".into(), "LO:HI".into()),
    };
    let axis = axis.unwrap_or("NAME=LO:HI");
    template.replace("{model}", model).replace("{rpm}", &one).replace("{range}", &range).replace("{axis}", axis)
}
