//! Suggestions for "did you mean": the allowed name nearest to an unknown one.

/// Returns the name nearest to `word`, if it differs by one or two typing errors, more in a long word. Case, hyphens and underscores make
/// no difference.
#[doc(hidden)]
pub fn nearest<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let plain = |word: &str| word.to_lowercase().replace('-', "_");
    let word = plain(word);
    let distances = names.into_iter().map(|name| {
        let plain = plain(name);
        // A table name that both share does not count for the similarity.
        let (one, other) = match (word.rsplit_once('.'), plain.rsplit_once('.')) {
            (Some((table, one)), Some((its, other))) if table == its => (one, other),
            _ => (&word[..], &plain[..]),
        };
        let most = 1.max(one.chars().count().min(other.chars().count()) / 3);
        (strsim::osa_distance(one, other), most, name)
    });
    let near = distances.filter(|(distance, most, _)| distance <= most).map(|(distance, _, name)| (distance, name));
    near.min_by_key(|(distance, _)| *distance).map(|(_, name)| name)
}
