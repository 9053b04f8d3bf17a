//! Noise functions of three coordinates.

/// Step of the differences that stand for a slope, and the finest cell of the fractal.
const EPSILON: f64 = 0.0005;

/// The permutation of Perlin's reference implementation ("Improving Noise", SIGGRAPH 2002).
const PERMUTATION: [u8; 256] = [
    151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225, 140, 36, 103, 30, 69, 142, 8, 99, 37, 240,
    21, 10, 23, 190, 6, 148, 247, 120, 234, 75, 0, 26, 197, 62, 94, 252, 219, 203, 117, 35, 11, 32, 57, 177, 33, 88,
    237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175, 74, 165, 71, 134, 139, 48, 27, 166, 77, 146, 158, 231, 83,
    111, 229, 122, 60, 211, 133, 230, 220, 105, 92, 41, 55, 46, 245, 40, 244, 102, 143, 54, 65, 25, 63, 161, 1, 216,
    80, 73, 209, 76, 132, 187, 208, 89, 18, 169, 200, 196, 135, 130, 116, 188, 159, 86, 164, 100, 109, 198, 173, 186,
    3, 64, 52, 217, 226, 250, 124, 123, 5, 202, 38, 147, 118, 126, 255, 82, 85, 212, 207, 206, 59, 227, 47, 16, 58, 17,
    182, 189, 28, 42, 223, 183, 170, 213, 119, 248, 152, 2, 44, 154, 163, 70, 221, 153, 101, 155, 167, 43, 172, 9, 129,
    22, 39, 253, 19, 98, 108, 110, 79, 113, 224, 232, 178, 185, 112, 104, 218, 246, 97, 228, 251, 34, 242, 193, 238,
    210, 144, 12, 191, 179, 162, 241, 81, 51, 145, 235, 249, 14, 239, 107, 49, 192, 214, 31, 181, 199, 106, 157, 184,
    84, 204, 176, 115, 121, 50, 45, 127, 4, 150, 254, 138, 236, 205, 93, 222, 114, 67, 29, 24, 72, 243, 141, 128, 195,
    78, 66, 215, 61, 156, 180,
];

fn hash(value: usize) -> usize {
    usize::from(PERMUTATION[value & 255])
}

/// Perlin's improved gradient noise, in [-1, 1]; 0 at integers. Coordinates beyond 2^52 are integers.
pub(super) fn noise3(point: [f64; 3]) -> f64 {
    let cell = point.map(f64::floor);
    let [x, y, z] = [0, 1, 2].map(|axis| point[axis] - cell[axis]);
    // The pattern repeats after 256; not-a-number falls into cell 0.
    let [i, j, k] = cell.map(|coordinate| coordinate.rem_euclid(256.0) as usize);
    let [u, v, w] = [x, y, z].map(|t| t * t * t * (t * (t * 6.0 - 15.0) + 10.0));
    let corner = |dx: usize, dy: usize, dz: usize| {
        let code = hash(hash(hash(i + dx) + j + dy) + k + dz);
        gradient(code, x - dx as f64, y - dy as f64, z - dz as f64)
    };
    let mix = |t: f64, from: f64, to: f64| from + t * (to - from);
    let edge = |dy, dz| mix(u, corner(0, dy, dz), corner(1, dy, dz));
    let face = |dz| mix(v, edge(0, dz), edge(1, dz));
    mix(w, face(0), face(1))
}

/// The dot product with one of the twelve directions to the middles of a cube's edges (four of them twice).
fn gradient(code: usize, x: f64, y: f64, z: f64) -> f64 {
    let code = code & 15;
    let first = if code < 8 { x } else { y };
    let second = match code {
        0..4 => y,
        12 | 14 => x,
        _ => z,
    };
    let signed = |bit: usize, value: f64| if code & bit == 0 { value } else { -value };
    signed(1, first) + signed(2, second)
}

/// The slope of [`noise3`] along an axis, by a backward difference.
pub(super) fn slope(point: [f64; 3], axis: usize) -> f64 {
    let mut before = point;
    before[axis] -= EPSILON;
    (noise3(point) - noise3(before)) / EPSILON
}

/// A number in (-1, 1] for a corner of the fractal's lattice.
fn lattice([x, y, z]: [i64; 3]) -> f64 {
    let seed = x.wrapping_mul(17).wrapping_add(y.wrapping_mul(23)).wrapping_add(z.wrapping_mul(29));
    let s = (seed << 13) ^ seed;
    let mixed =
        s.wrapping_mul(s.wrapping_mul(s).wrapping_mul(15_731).wrapping_add(789_221)).wrapping_add(1_376_312_589);
    1.0 - (mixed & 0x7fff_ffff) as f64 / 1_073_741_824.0
}

/// Fractal noise by midpoint displacement: the cube around the point is halved eleven times; the value at each new
/// middle (of the cube, of its faces, of its edges) is the mean of the corners around it, displaced by a hash in
/// proportion to the cube's size; the last cube's mean is the value.
pub(super) fn fnoise3(point: [f64; 3]) -> f64 {
    let mut size = (1.0 / EPSILON) as i64;
    let target = point.map(|coordinate| (size as f64 * coordinate) as i64);
    let mut origin = point.map(|coordinate| (size as f64 * coordinate.floor()) as i64);
    let shifted = |origin: [i64; 3], by: [i64; 3]| [0, 1, 2].map(|axis| origin[axis].wrapping_add(by[axis]));
    let bit = |corner: usize, axis: usize| i64::from(corner >> axis & 1 == 1);
    // Corner values; bit `axis` of the index is set at the cube's far end on that axis.
    let mut values: [f64; 8] =
        std::array::from_fn(|corner| lattice(shifted(origin, [0, 1, 2].map(|axis| size * bit(corner, axis)))));
    loop {
        let mean = values.iter().sum::<f64>() * 0.125;
        size >>= 1;
        if size == 0 {
            return mean;
        }
        let displacement = size as f64 * EPSILON;
        let middle = shifted(origin, [size; 3]);
        // Which eighth holds the point: the new cube keeps that corner of the old one.
        let branch = (0..3).filter(|&axis| target[axis] > middle[axis]).fold(0, |branch, axis| branch | 1 << axis);
        let towards = |axis: usize| if branch >> axis & 1 == 1 { size } else { -size };
        values[!branch & 7] = mean + displacement * lattice(middle);
        for axis in 0..3 {
            // The face of the old cube on the branch's side of this axis.
            let on_face = (0..8).filter(|corner| (corner ^ branch) >> axis & 1 == 0);
            let mean = on_face.map(|corner| values[corner]).sum::<f64>() * 0.25;
            let mut place = middle;
            place[axis] = place[axis].wrapping_add(towards(axis));
            values[!(branch ^ 1 << axis) & 7] = mean + displacement * lattice(place);
        }
        for axis in 0..3 {
            // The edge along this axis at the kept corner.
            let mean = (values[branch & !(1 << axis)] + values[branch | 1 << axis]) * 0.5;
            let mut place = middle;
            for other in [(axis + 1) % 3, (axis + 2) % 3] {
                place[other] = place[other].wrapping_add(towards(other));
            }
            values[branch ^ 1 << axis] = mean + displacement * lattice(place);
        }
        origin = shifted(origin, [0, 1, 2].map(|axis| size * bit(branch, axis)));
    }
}
