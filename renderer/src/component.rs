//! The six light-transport components of the paper (Table 1), their letters, and small containers keyed by them.

use std::fmt;
use std::ops::{Index, IndexMut};

/// What spawned a ray: the scattering event, not the material's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u8)]
pub enum Component {
    /// `D`: indirect diffuse, reflected or transmitted.
    Diffuse,
    /// `S`: smooth specular reflection of plastic, metal and trans.
    Specular,
    /// `G`: rough specular reflection or transmission.
    Glossy,
    /// `T`: ideal transmission.
    Transmitted,
    /// `R`: reflection off glass, dielectric or interface.
    Reflected,
    /// `M`: reflection off a mirror.
    Mirror,
}

impl Component {
    /// All six, in the order in which files and tables list them.
    pub const ALL: [Self; 6] =
        [Self::Diffuse, Self::Specular, Self::Glossy, Self::Transmitted, Self::Reflected, Self::Mirror];

    /// The letter of the crex language.
    #[must_use]
    pub const fn letter(self) -> char {
        match self {
            Self::Diffuse => 'D',
            Self::Specular => 'S',
            Self::Glossy => 'G',
            Self::Transmitted => 'T',
            Self::Reflected => 'R',
            Self::Mirror => 'M',
        }
    }

    /// The component of an upper-case letter.
    #[must_use]
    pub const fn from_letter(letter: char) -> Option<Self> {
        Some(match letter {
            'D' => Self::Diffuse,
            'S' => Self::Specular,
            'G' => Self::Glossy,
            'T' => Self::Transmitted,
            'R' => Self::Reflected,
            'M' => Self::Mirror,
            _ => return None,
        })
    }
}

impl fmt::Display for Component {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.letter())
    }
}

/// A set of components.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ComponentSet(u8);

impl ComponentSet {
    /// No component.
    pub const EMPTY: Self = Self(0);
    /// All six.
    pub const ALL: Self = Self(0b11_1111);

    /// The same set with `component` in it.
    #[must_use]
    pub const fn with(self, component: Component) -> Self {
        Self(self.0 | 1 << component as u8)
    }

    /// Whether `component` is in the set.
    #[must_use]
    pub const fn contains(self, component: Component) -> bool {
        self.0 & (1 << component as u8) != 0
    }

    /// Whether nothing is in the set.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Everything that is in either set.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// The members, in the order of [`Component::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Component> {
        Component::ALL.into_iter().filter(move |&component| self.contains(component))
    }
}

impl FromIterator<Component> for ComponentSet {
    fn from_iter<I: IntoIterator<Item = Component>>(components: I) -> Self {
        components.into_iter().fold(Self::EMPTY, Self::with)
    }
}

/// One value for each component.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PerComponent<T>([T; 6]);

impl<T> PerComponent<T> {
    /// Makes each value from its component.
    pub fn from_fn(make: impl FnMut(Component) -> T) -> Self {
        Self(Component::ALL.map(make))
    }

    /// Each component with its value, in the order of [`Component::ALL`].
    pub fn iter(&self) -> impl Iterator<Item = (Component, &T)> {
        Component::ALL.into_iter().zip(&self.0)
    }

    /// Each component with its value, to change.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = (Component, &mut T)> {
        Component::ALL.into_iter().zip(&mut self.0)
    }
}

impl<T> Index<Component> for PerComponent<T> {
    type Output = T;

    fn index(&self, component: Component) -> &T {
        &self.0[component as usize]
    }
}

impl<T> IndexMut<Component> for PerComponent<T> {
    fn index_mut(&mut self, component: Component) -> &mut T {
        &mut self.0[component as usize]
    }
}
