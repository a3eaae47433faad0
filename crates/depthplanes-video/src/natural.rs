//! Natural order of names: `frame9` before `frame10`.

use std::cmp::Ordering;

/// Compares names piece by piece, runs of digits as numbers.
pub fn compare(a: &str, b: &str) -> Ordering {
    pieces(a).cmp(pieces(b)).then_with(|| a.cmp(b))
}

/// One character other than a digit, or the start of a run of digits, which counts as `0` among
/// characters; then that run without leading zeros, the longer the larger.
type Piece<'a> = (char, usize, &'a str);

fn pieces(mut rest: &str) -> impl Iterator<Item = Piece<'_>> {
    std::iter::from_fn(move || {
        let first = rest.chars().next()?;
        let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
        if end == 0 {
            rest = &rest[first.len_utf8()..];
            return Some((first, 0, ""));
        }
        let digits = rest[..end].trim_start_matches('0');
        rest = &rest[end..];
        Some(('0', digits.len(), digits))
    })
}

#[cfg(test)]
mod tests {
    #[test]
    fn numbers_within_names_are_compared_as_numbers() {
        let mut names = ["b1", "a.png", "a10.png", "a9.png", "a010b", "a", "a99999999999999999999999", "10", "9"];
        names.sort_by(|a, b| super::compare(a, b));
        assert_eq!(names, ["9", "10", "a", "a.png", "a9.png", "a10.png", "a010b", "a99999999999999999999999", "b1"]);
    }
}
