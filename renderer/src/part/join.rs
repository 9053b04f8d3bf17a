//! Parts joined to a picture, a band of rows at a time.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;

use super::error::PartError;
use super::read::Part;
use super::record::Head;
use crate::component::ComponentSet;
use crate::film::{Film, Plane};
use crate::render::{Account, TILE, tile_count};

/// Rows of tiles that are read at a time.
const TILES_DEEP: usize = 4;

/// All parts of a picture.
#[derive(Debug)]
pub struct Joined {
    /// In the order of their numbers.
    parts: Vec<Part>,
    /// For each part, where its tiles begin.
    offsets: Vec<Vec<u64>>,
    account: Account,
}

/// Checks that parts are of one picture, and that each is there once.
///
/// # Errors
/// If they are not; what is missing or double is said of all parts at once.
pub fn join(mut parts: Vec<Part>) -> Result<Joined, PartError> {
    let Some(first) = parts.first() else {
        return Err(PartError::Incomplete { all: 1, missing: vec![1], double: Vec::new() });
    };
    for other in &parts[1..] {
        if let Some(what) = first.head().difference(other.head()) {
            let (first, other) = (first.path().to_owned(), other.path().to_owned());
            return Err(PartError::Different { first, other, what });
        }
    }
    let all = first.shard().all();
    let mut there: BTreeMap<u32, Vec<PathBuf>> = BTreeMap::new();
    for part in &parts {
        there.entry(part.shard().number()).or_default().push(part.path().to_owned());
    }
    let missing: Vec<u32> = (1..=all).filter(|number| !there.contains_key(number)).collect();
    let double: Vec<_> = there.into_iter().filter(|(_, files)| files.len() > 1).collect();
    if !(missing.is_empty() && double.is_empty()) {
        return Err(PartError::Incomplete { all, missing, double });
    }
    parts.sort_by_key(|part| part.shard().number());
    let offsets = parts.iter().map(Part::offsets).collect();
    let account = Account::sum(parts.iter().map(|part| part.account().clone()));
    Ok(Joined { parts, offsets, account })
}

impl Joined {
    /// The parts, in the order of their numbers.
    #[must_use]
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// What the picture is of; its shard is the first part's.
    #[must_use]
    pub fn head(&self) -> &Head {
        self.parts[0].head()
    }

    /// What was done in all.
    #[must_use]
    pub fn account(&self) -> &Account {
        &self.account
    }

    /// The planes of the picture: those of the parts but for components that no ray reached.
    #[must_use]
    pub fn planes(&self) -> Vec<Plane> {
        let reached = self.account.reached();
        let planes = self.parts[0].planes().iter().copied();
        planes.filter(|plane| !matches!(plane, Plane::Layer(component) if !reached.contains(*component))).collect()
    }

    /// The picture's rows from the top, some at a time, each with what of the whole is read.
    pub fn bands(&self) -> impl Iterator<Item = Result<Film, PartError>> {
        let rows = TILES_DEEP * TILE;
        (0..self.head().height).step_by(rows).map(move |y| self.band(y..self.head().height.min(y + rows)))
    }

    fn band(&self, rows: Range<usize>) -> Result<Film, PartError> {
        let Head { width, .. } = *self.head();
        let planes = self.planes();
        let components: ComponentSet = planes
            .iter()
            .filter_map(|plane| match plane {
                Plane::Layer(component) => Some(*component),
                _ => None,
            })
            .collect();
        let mut film = Film::new(width, rows.len(), components, planes.contains(&Plane::Ambient));
        let across = width.div_ceil(TILE);
        let tiles = rows.start / TILE * across..tile_count(width, rows.end);
        for (part, offsets) in self.parts.iter().zip(&self.offsets) {
            part.read(tiles.clone(), offsets, &mut film, rows.start)?;
        }
        Ok(film)
    }
}
