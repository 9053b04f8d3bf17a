//! Every primitive type of the scene format, by its keyword.

use std::fmt;

/// What a primitive is, as far as names and modifiers go.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Class {
    /// A surface, or a group of them (instance, mesh): not named by anything's modifier.
    Surface,
    /// Decides how light scatters or is emitted.
    Material,
    /// Changes a material's colour.
    Pattern,
    /// Changes a surface's normal.
    Texture,
    /// Blends two modifiers.
    Mixture,
}

macro_rules! kinds {
    ($($variant:ident $keyword:literal $class:ident,)*) => {
        /// A primitive's type: all of the reference manual's, whether the renderer can draw it or not.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[allow(missing_docs, reason = "each is the manual's type of that keyword")]
        pub enum Kind { $($variant,)* }

        impl Kind {
            /// Every type.
            pub const ALL: &[Self] = &[$(Self::$variant,)*];

            /// The keyword in scene text.
            #[must_use]
            pub const fn keyword(self) -> &'static str {
                match self { $(Self::$variant => $keyword,)* }
            }

            /// The type of a keyword; keywords are case-sensitive.
            #[must_use]
            pub fn from_keyword(keyword: &str) -> Option<Self> {
                match keyword { $($keyword => Some(Self::$variant),)* _ => None }
            }

            /// Surface or what sort of modifier.
            #[must_use]
            pub const fn class(self) -> Class {
                match self { $(Self::$variant => Class::$class,)* }
            }
        }
    };
}

kinds! {
    Polygon "polygon" Surface,
    Sphere "sphere" Surface,
    Bubble "bubble" Surface,
    Cone "cone" Surface,
    Cup "cup" Surface,
    Cylinder "cylinder" Surface,
    Tube "tube" Surface,
    Ring "ring" Surface,
    Source "source" Surface,
    Instance "instance" Surface,
    Mesh "mesh" Surface,
    Light "light" Material,
    Illum "illum" Material,
    Glow "glow" Material,
    Spotlight "spotlight" Material,
    Mirror "mirror" Material,
    Prism1 "prism1" Material,
    Prism2 "prism2" Material,
    Plastic "plastic" Material,
    Metal "metal" Material,
    Trans "trans" Material,
    Plastic2 "plastic2" Material,
    Metal2 "metal2" Material,
    Trans2 "trans2" Material,
    Ashik2 "ashik2" Material,
    Dielectric "dielectric" Material,
    Interface "interface" Material,
    Glass "glass" Material,
    Plasfunc "plasfunc" Material,
    Metfunc "metfunc" Material,
    Transfunc "transfunc" Material,
    BrtdFunc "BRTDfunc" Material,
    Plasdata "plasdata" Material,
    Metdata "metdata" Material,
    Transdata "transdata" Material,
    Bsdf "BSDF" Material,
    ApertureBsdf "aBSDF" Material,
    WgmdFunc "WGMDfunc" Material,
    Antimatter "antimatter" Material,
    Mist "mist" Material,
    Texfunc "texfunc" Texture,
    Texdata "texdata" Texture,
    Colorfunc "colorfunc" Pattern,
    Brightfunc "brightfunc" Pattern,
    Colordata "colordata" Pattern,
    Brightdata "brightdata" Pattern,
    Colorpict "colorpict" Pattern,
    Colortext "colortext" Pattern,
    Brighttext "brighttext" Pattern,
    Spectrum "spectrum" Pattern,
    Specfile "specfile" Pattern,
    Specfunc "specfunc" Pattern,
    Specdata "specdata" Pattern,
    Specpict "specpict" Pattern,
    Mixfunc "mixfunc" Mixture,
    Mixdata "mixdata" Mixture,
    Mixpict "mixpict" Mixture,
    Mixtext "mixtext" Mixture,
}

impl Kind {
    /// Whether other primitives can name it as their modifier.
    #[must_use]
    pub const fn is_modifier(self) -> bool {
        !matches!(self.class(), Class::Surface)
    }

    /// Whether its string arguments end in a transform that maps local coordinates to the scene's (patterns and
    /// materials with function files, instances, meshes).
    #[must_use]
    pub const fn takes_transform(self) -> bool {
        matches!(
            self,
            Self::Instance
                | Self::Mesh
                | Self::Prism1
                | Self::Prism2
                | Self::Plastic2
                | Self::Metal2
                | Self::Trans2
                | Self::Ashik2
                | Self::Plasfunc
                | Self::Metfunc
                | Self::Transfunc
                | Self::BrtdFunc
                | Self::Plasdata
                | Self::Metdata
                | Self::Transdata
                | Self::Bsdf
                | Self::ApertureBsdf
                | Self::WgmdFunc
                | Self::Texfunc
                | Self::Texdata
                | Self::Colorfunc
                | Self::Brightfunc
                | Self::Colordata
                | Self::Brightdata
                | Self::Colorpict
                | Self::Specfunc
                | Self::Specdata
                | Self::Specpict
                | Self::Mixfunc
                | Self::Mixdata
                | Self::Mixpict
        )
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.keyword())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keywords_round_trip() {
        for &kind in Kind::ALL {
            assert_eq!(Kind::from_keyword(kind.keyword()), Some(kind));
        }
        // The reference manual's types (alias is no type of its own here).
        assert_eq!(Kind::ALL.len(), 58);
        assert_eq!(Kind::from_keyword("Plastic"), None);
    }
}
