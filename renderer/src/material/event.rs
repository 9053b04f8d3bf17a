//! What can happen to light at a surface, and the one rule that turns an event into a component.

use crate::component::Component;

/// The scattering event that spawned a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Event {
    /// Diffuse reflection (plastic, metal, trans).
    DiffuseReflection,
    /// Diffuse transmission (trans).
    DiffuseTransmission,
    /// Reflection off a smooth plastic, metal or trans.
    SmoothReflection,
    /// Straight transmission through a smooth trans.
    SmoothTransmission,
    /// Reflection off a rough plastic, metal or trans.
    RoughReflection,
    /// Transmission through a rough trans.
    RoughTransmission,
    /// Transmission through a glass pane.
    PaneTransmission,
    /// Reflection off a glass pane.
    PaneReflection,
    /// Refraction at the boundary of a dielectric.
    Refraction,
    /// Reflection at the boundary of a dielectric, inside or outside.
    BoundaryReflection,
    /// Reflection off a mirror.
    MirrorReflection,
    /// Redirection by a prism, whichever way that is.
    PrismTransmission,
}

impl Event {
    /// Whether `-lr` counts the event: reflections count, transmissions do not (`rpict(1)`, `-lr`).
    #[must_use]
    pub const fn counts_as_reflection(self) -> bool {
        match self {
            Self::DiffuseReflection
            | Self::SmoothReflection
            | Self::RoughReflection
            | Self::PaneReflection
            | Self::BoundaryReflection
            | Self::MirrorReflection => true,
            Self::DiffuseTransmission
            | Self::SmoothTransmission
            | Self::RoughTransmission
            | Self::PaneTransmission
            | Self::Refraction
            | Self::PrismTransmission => false,
        }
    }

    /// Whether the ray leaves on the side that it did not come from.
    #[must_use]
    pub const fn is_transmission(self) -> bool {
        !self.counts_as_reflection()
    }

    /// Whether the event spreads light over a lobe that direct lighting has already sampled, so that neither the ray
    /// nor its descendants may meet a light source again (`RayPath::blind`).
    #[must_use]
    pub const fn is_spread(self) -> bool {
        matches!(
            self,
            Self::DiffuseReflection | Self::DiffuseTransmission | Self::RoughReflection | Self::RoughTransmission
        )
    }
}

impl Component {
    /// The component of a scattering event: the one place that decides in which bin a ray goes.
    #[must_use]
    pub const fn of(event: Event) -> Self {
        match event {
            Event::DiffuseReflection | Event::DiffuseTransmission => Self::Diffuse,
            Event::SmoothReflection => Self::Specular,
            Event::RoughReflection | Event::RoughTransmission => Self::Glossy,
            Event::SmoothTransmission | Event::PaneTransmission | Event::Refraction | Event::PrismTransmission => {
                Self::Transmitted
            }
            Event::PaneReflection | Event::BoundaryReflection => Self::Reflected,
            Event::MirrorReflection => Self::Mirror,
        }
    }
}
