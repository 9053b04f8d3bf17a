//! What a hit gives to function files, by name and by channel number (reference manual, "Function Files").

/// Names of the channels `$1`, `$2`, ... The last ten have a value for materials with their own reflection function, or
/// for prisms, only.
pub const CHANNELS: [&str; 37] = [
    "Dx", "Dy", "Dz", // ray direction
    "Nx", "Ny", "Nz", // surface normal
    "Px", "Py", "Pz",   // intersection point
    "T",    // distance from the eye
    "Rdot", // cosine between ray and normal
    "S",    // scale
    "Tx", "Ty", "Tz", // origin
    "Ix", "Iy", "Iz", "Jx", "Jy", "Jz", "Kx", "Ky", "Kz", // unit vectors
    "Ts", // distance along a shadow ray
    "Lu", "Lv", // coordinates on a mesh
    "NxP", "NyP", "NzP",   // perturbed normal
    "RdotP", // cosine between ray and perturbed normal
    "CrP", "CgP", "CbP", // colour so far
    "DxA", "DyA", "DzA", // direction to the light that a prism is asked for
];

/// How a channel is called in a message.
pub(super) fn name(n: u32) -> String {
    let index = (n as usize).checked_sub(1);
    index.and_then(|index| CHANNELS.get(index)).map_or_else(|| format!("channel ${n}"), |name| format!("`{name}`"))
}
