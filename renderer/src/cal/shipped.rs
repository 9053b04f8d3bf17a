//! Function files that scenes and generators take for granted.

/// The text of a function file of the standard library, for a scene whose own folders do not have it.
#[must_use]
pub fn shipped(file: &str) -> Option<&'static str> {
    Some(match file {
        "rev.cal" => include_str!("shipped/rev.cal"),
        "surf.cal" => include_str!("shipped/surf.cal"),
        "tmesh.cal" => include_str!("shipped/tmesh.cal"),
        "skybright.cal" => include_str!("shipped/skybright.cal"),
        "source.cal" => include_str!("shipped/source.cal"),
        "illum.cal" => include_str!("shipped/illum.cal"),
        _ => return None,
    })
}
