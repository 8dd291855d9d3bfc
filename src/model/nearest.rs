//! "Did you mean": the name that is allowed and nearest to one that is not.

/// The one of `names` nearest to `word`, if it is near: a slip or two, more in a long word; upper case, hyphens and
/// underscores are no difference.
pub fn nearest<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let plain = |word: &str| word.to_lowercase().replace('-', "_");
    let word = plain(word);
    let distances = names.into_iter().map(|name| {
        let plain = plain(name);
        // That both are in one table says nothing about their names.
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
