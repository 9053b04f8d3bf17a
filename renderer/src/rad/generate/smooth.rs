//! Normals interpolated over squares and triangles, as the generators write them for their function files.

use glam::{DMat3, DMat4, DVec3, DVec4};

use super::gensurf::Vertex;

/// Solves for the vectors that, weighted with (uv, u, v, 1), give the normals at the four corners; u and v are the two
/// coordinates after `axis`, the one along which the normals mostly point. `None` if the corners do not determine them.
pub(super) fn interpolation(corners: &[Vertex; 4]) -> Option<(usize, [DVec3; 4])> {
    let sum = corners.iter().fold(DVec3::ZERO, |sum, corner| sum + corner.normal).abs();
    let first = if sum.x > sum.y { 0 } else { 1 };
    let axis = if sum[first] > sum.z { first } else { 2 };
    let weights = corners.map(|corner| {
        let (u, v) = (corner.position[(axis + 1) % 3], corner.position[(axis + 2) % 3]);
        DVec4::new(u * v, u, v, 1.0)
    });
    // A row for each corner: weights times vectors is normals.
    let inverse = DMat4::from_cols_array_2d(&weights.map(|row| row.to_array())).transpose().try_inverse()?;
    let solved: [DVec3; 4] = std::array::from_fn(|row| {
        let row = inverse.row(row);
        (0..4).fold(DVec3::ZERO, |sum, corner| sum + row[corner] * corners[corner].normal)
    });
    solved.iter().all(|vector| vector.is_finite()).then_some((axis, solved))
}

/// Solves for what tmesh.cal wants of a triangle: the axis along which it mostly faces, and for each component of the
/// normal its coefficients for u, v (the two coordinates after the axis) and 1. `None` if the triangle has no area.
pub(super) fn over_triangle(points: [DVec3; 3], normals: [DVec3; 3]) -> Option<(usize, [DVec3; 3])> {
    let facing = (points[1] - points[0]).cross(points[2] - points[0]).abs();
    let first = if facing.x > facing.y { 0 } else { 1 };
    let axis = if facing[first] > facing.z { first } else { 2 };
    let rows = points.map(|point| DVec3::new(point[(axis + 1) % 3], point[(axis + 2) % 3], 1.0));
    let inverse = DMat3::from_cols(rows[0], rows[1], rows[2]).transpose().try_inverse()?;
    let component = |axis: usize| inverse * DVec3::from_array(normals.map(|normal| normal[axis]));
    let solved = [component(0), component(1), component(2)];
    solved.iter().all(|row| row.is_finite()).then_some((axis, solved))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_have_their_normals_at_their_corners() {
        for turn in 0..3 {
            let turned = |v: DVec3| DVec3::from_array(std::array::from_fn(|axis| v[(axis + turn) % 3]));
            let points = [DVec3::ZERO, DVec3::new(2.0, 0.1, 0.3), DVec3::new(0.4, 1.5, -0.2)].map(turned);
            let normals = [DVec3::X, DVec3::new(0.6, 0.0, 0.8), DVec3::new(0.0, -0.28, 0.96)].map(turned);
            let (axis, rows) = over_triangle(points, normals).unwrap();
            for (point, normal) in points.into_iter().zip(normals) {
                let place = DVec3::new(point[(axis + 1) % 3], point[(axis + 2) % 3], 1.0);
                let found = DVec3::from_array(rows.map(|row| row.dot(place)));
                assert!((found - normal).length() < 1e-14);
            }
        }
        assert!(over_triangle([DVec3::ZERO, DVec3::X, DVec3::X * 2.0], [DVec3::Z; 3]).is_none());
    }
}
