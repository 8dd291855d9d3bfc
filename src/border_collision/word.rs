//! Words: the sides that an orbit of a piecewise-linear map visits, in order.

use std::fmt;

use crate::cam::Side;

/// Finite word over the sides, written with L for minus and R for plus.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Word(Vec<Side>);

impl Word {
    /// Parses a word of the letters L and R; `None` if it is empty or has another letter.
    pub fn read(text: &str) -> Option<Self> {
        let letters: Option<Vec<Side>> = text.chars().map(side).collect();
        letters.filter(|letters| !letters.is_empty()).map(Self)
    }

    /// Sides, in order.
    pub fn sides(&self) -> &[Side] {
        &self.0
    }

    /// Rotation of the word that starts `by` letters later, cyclically.
    pub fn turned(&self, by: usize) -> Self {
        let mut sides = self.0.clone();
        sides.rotate_left(by % self.0.len());
        Self(sides)
    }

    /// First of its rotations in the order of letters, L before R, and the number of letters by which it is rotated.
    pub fn least_rotation(&self) -> (Self, usize) {
        let spelled = |by: &usize| self.turned(*by).0.iter().map(|side| *side as u8).collect::<Vec<_>>();
        let by = (0..self.0.len()).min_by_key(spelled).unwrap_or(0);
        (self.turned(by), by)
    }

    /// All words of at most `longest` letters that do not repeat a shorter one, one rotation of each (Lyndon words, by Duval's algorithm),
    /// the short ones first.
    pub fn primitive(longest: usize) -> Vec<Self> {
        let mut words = Vec::new();
        let mut word = vec![Side::Minus];
        while longest > 0 && !word.is_empty() {
            words.push(Self(word.clone()));
            let length = word.len();
            while word.len() < longest {
                word.push(word[word.len() - length]);
            }
            while word.last() == Some(&Side::Plus) {
                word.pop();
            }
            if let Some(last) = word.last_mut() {
                *last = Side::Plus;
            }
        }
        words.sort_by_key(|word| word.0.len());
        words
    }

    /// Shortest word whose repetition ends with `sides`, if it fits at least `times` times, in the order in which the sequence continues.
    pub fn repeated(sides: &[Side], times: usize) -> Option<Self> {
        // Length of the longest end of each prefix that is also its beginning (Knuth, Morris, Pratt), on the letters read backwards.
        let at = |index: usize| sides[sides.len() - 1 - index];
        let mut overlap = vec![0; sides.len()];
        for index in 1..sides.len() {
            let mut length: usize = overlap[index - 1];
            while length > 0 && at(index) != at(length) {
                length = overlap[length - 1];
            }
            overlap[index] = if at(index) == at(length) { length + 1 } else { 0 };
        }
        let period = sides.len() - overlap.last()?;
        (period * times <= sides.len()).then(|| Self(sides[sides.len() - period..].to_vec()))
    }
}

fn side(letter: char) -> Option<Side> {
    match letter {
        'L' => Some(Side::Minus),
        'R' => Some(Side::Plus),
        _ => None,
    }
}

impl fmt::Display for Word {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|side| f.write_str(if *side == Side::Minus { "L" } else { "R" }))
    }
}
