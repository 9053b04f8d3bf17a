//! A surface: a shape made of something.

use super::NameId;
use crate::geometry::Shape;
use crate::material::MaterialId;

/// One surface of a scene.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Its geometry.
    pub shape: Shape,
    /// What it is made of; `None` (a chain of modifiers without a material) is invisible.
    pub material: Option<MaterialId>,
    /// Its identifier; others may have the same.
    pub name: NameId,
    /// The name of its modifier; `None` is `void`.
    pub modifier: Option<NameId>,
    /// Place of the modifier's definition: of coincident surfaces the one of the later modifier shows.
    pub precedence: u32,
}
