//! A part of the inputs, for several runs or machines that do not know each other.

use crate::failure::note;
use std::fmt;
use std::str::FromStr;

/// The `index`th of `count` parts, from 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shard {
    pub(crate) index: usize,
    pub(crate) count: usize,
}

impl Shard {
    /// Its items: every `count`th one, so that all parts are as long and as hard.
    fn of<T>(self, items: Vec<T>) -> Vec<T> {
        items.into_iter().skip(self.index - 1).step_by(self.count).collect()
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/').and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)));
        match parts {
            Some((index, count)) if (1..=count).contains(&index) => Ok(Shard { index, count }),
            _ => Err("accepted: I/N, the Ith of N parts, such as 1/4 to 4/4".into()),
        }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

/// The part of the inputs that this run works on, which is empty where there are fewer inputs than parts.
pub(crate) fn part<T>(shard: Shard, inputs: Vec<T>) -> Vec<T> {
    let count = inputs.len();
    let part = shard.of(inputs);
    if part.is_empty() {
        note(&format!("--shard {shard}: there are {count} inputs, and none for this part"));
    }
    part
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_item_is_in_one_part() {
        for count in [1, 2, 3, 7, 20] {
            let mut all: Vec<usize> =
                (1..=count).flat_map(|index| Shard { index, count }.of((0..10).collect())).collect();
            all.sort_unstable();
            assert_eq!(all, (0..10).collect::<Vec<_>>(), "{count}");
        }
    }

    #[test]
    fn what_is_no_part_is_refused() {
        assert_eq!("3/7".parse(), Ok(Shard { index: 3, count: 7 }));
        for wrong in ["0/3", "4/3", "1", "1/", "/2", "a/b", "-1/2", "1/0", ""] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
    }
}
