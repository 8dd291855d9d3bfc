//! "Did you mean": the name that is allowed and nearest to one that is not.

/// The one of `names` nearest to `word`, if it is near: a slip or two, more in a long word; upper case, hyphens and
/// underscores are no difference.
pub fn nearest<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let plain = |word: &str| word.to_lowercase().replace('-', "_");
    let word = plain(word);
    let length = word.chars().count();
    let distances = names.into_iter().map(|name| (strsim::osa_distance(&word, &plain(name)), name));
    let near = distances.filter(|(distance, name)| *distance <= 1.max(length.min(name.chars().count()) / 3));
    near.min_by_key(|(distance, _)| *distance).map(|(_, name)| name)
}
