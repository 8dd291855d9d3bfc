//! The command that usually follows another.

/// What follows a command, in words: `{model}` stands for the words that name the model, `{rpm}` for the speed that was asked for, `{range}` for
/// the range of speeds, or the one around that speed.
pub(super) fn filled(template: &str, model: &str, rpm: Option<[f64; 2]>) -> String {
    let (one, range) = match rpm {
        Some([low, high]) if low < high => (low.to_string(), format!("{low}:{high}")),
        Some([rpm, _]) => (rpm.to_string(), format!("{}:{}", 0.95 * rpm, 1.05 * rpm)),
        None => ("R".into(), "LO:HI".into()),
    };
    template.replace("{model}", model).replace("{rpm}", &one).replace("{range}", &range)
}
