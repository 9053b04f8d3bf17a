//! Triangle meshes that obj2mesh(1) has made.

use super::Source;
use super::binary::Bytes;
use super::document::Document;
use crate::diagnostic::Error;

/// First value of the file, less the bytes of an object number.
const MAGIC: i64 = 319;

/// Vertices of a patch, at most.
const PATCH: usize = 256;

/// Vertices have normals; texture coordinates. (They always have positions: 1.)
const NORMALS: i64 = 2;
const TEXTURE: i64 = 4;

/// A vertex of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MeshVertex {
    /// Where it is.
    pub position: [f64; 3],
    /// Unit normal, if the mesh gives one.
    pub normal: Option<[f64; 3]>,
    /// Texture coordinates, if the mesh gives them.
    pub uv: Option<[f64; 2]>,
}

/// A triangle of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshTriangle {
    /// Indices of its vertices, counter-clockwise as seen from its front.
    pub vertices: [u32; 3],
    /// Its material, an index into the primitives of [`Mesh::materials`].
    pub material: Option<usize>,
}

/// A triangle mesh.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// What the triangles name as their materials.
    pub materials: Document,
    /// The vertices.
    pub vertices: Vec<MeshVertex>,
    /// The triangles.
    pub triangles: Vec<MeshTriangle>,
}

/// Reads a compiled mesh.
///
/// # Errors
/// A file that is no mesh or is damaged.
pub fn read_mesh(source: &Source) -> Result<Mesh, Error> {
    let mut bytes = Bytes::after_header(source, "Radiance_tmesh")?;
    let size = bytes.integer(2)? - MAGIC;
    let Some(size) = usize::try_from(size).ok().filter(|size| (1..=8).contains(size)) else {
        return Err(bytes.wrong("this is a mesh of an unknown version"));
    };
    let origin = [bytes.written_real()?, bytes.written_real()?, bytes.written_real()?];
    let side = bytes.written_real()?;
    let (u0, u1) = (bytes.real()?, bytes.real()?);
    let (v0, v1) = (bytes.real()?, bytes.real()?);
    bytes.skip_tree(size)?;
    let scene = bytes.scene(size)?;
    let mut reader = Reader {
        bytes,
        cube: Cube { origin, side },
        uv: [[u0, u1], [v0, v1]],
        objects: &scene.objects,
        mesh: Mesh::default(),
        patches: Vec::new(),
        far: Vec::new(),
    };
    // A patch takes at least its flags and counts.
    let patches = reader.bytes.count(4, 9, usize::MAX, "patches")?;
    for _ in 0..patches {
        reader.patch()?;
    }
    let mut mesh = reader.finish()?;
    mesh.materials = scene.into_document(source);
    Ok(mesh)
}

/// Positions are fractions of this.
struct Cube {
    origin: [f64; 3],
    side: f64,
}

/// The middle of the n-th of 2^32 parts of 0..1.
fn part(n: u32) -> f64 {
    (f64::from(n) + 0.5) / 4_294_967_296.0
}

struct Reader<'a> {
    bytes: Bytes<'a>,
    cube: Cube,
    uv: [[f64; 2]; 2],
    objects: &'a [Option<usize>],
    mesh: Mesh,
    /// Where each patch's vertices start, and how many they are.
    patches: Vec<(usize, usize)>,
    /// Triangles of which some vertices are given by patch and number, perhaps of patches that come later.
    far: Vec<(usize, [Option<u32>; 3])>,
}

impl Reader<'_> {
    fn patch(&mut self) -> Result<(), Error> {
        let flags = self.bytes.integer(1)?;
        if flags & 1 == 0 || flags & !7 != 0 {
            return Err(self.bytes.wrong("a patch has unknown flags"));
        }
        let count = self.bytes.count(2, 12, PATCH, "vertices in a patch")?;
        let first = self.mesh.vertices.len();
        for _ in 0..count {
            let [x, y, z] = [self.bytes.unsigned()?, self.bytes.unsigned()?, self.bytes.unsigned()?];
            let place = |axis: usize, n: u32| self.cube.origin[axis] + self.cube.side * part(n);
            let position = [place(0, x), place(1, y), place(2, z)];
            self.mesh.vertices.push(MeshVertex { position, normal: None, uv: None });
        }
        if flags & NORMALS != 0 {
            for index in first..first + count {
                self.mesh.vertices[index].normal = direction(self.bytes.unsigned()?);
            }
        }
        if flags & TEXTURE != 0 {
            for index in first..first + count {
                let (u, v) = (self.bytes.unsigned()?, self.bytes.unsigned()?);
                let place = |[from, to]: [f64; 2], n: u32| from + (to - from) * part(n);
                // The coordinates' limits leave 0 to mean none.
                self.mesh.vertices[index].uv = (u != 0).then(|| [place(self.uv[0], u), place(self.uv[1], v)]);
            }
        }
        self.patches.push((first, count));
        let triangles = self.mesh.triangles.len();
        let count = self.bytes.count(2, 3, 2 * PATCH, "triangles in a patch")?;
        for _ in 0..count {
            let vertices = [self.near()?, self.near()?, self.near()?];
            self.mesh.triangles.push(MeshTriangle { vertices, material: None });
        }
        // One material for all, or one each.
        if self.bytes.integer(2)? > 1 {
            for index in triangles..triangles + count {
                self.mesh.triangles[index].material = self.material()?;
            }
        } else {
            let material = self.material()?;
            self.mesh.triangles[triangles..].iter_mut().for_each(|triangle| triangle.material = material);
        }
        for far in [1, 2] {
            let count = self.bytes.count(2, 8, PATCH, "joining triangles in a patch")?;
            for _ in 0..count {
                let first = Some(self.bytes.unsigned()?);
                let second = if far == 2 { Some(self.bytes.unsigned()?) } else { None };
                let second_near = if far == 1 { self.near()? } else { 0 };
                let third = self.near()?;
                let material = self.material()?;
                self.far.push((self.mesh.triangles.len(), [first, second, None]));
                self.mesh.triangles.push(MeshTriangle { vertices: [0, second_near, third], material });
            }
        }
        Ok(())
    }

    /// A vertex of this patch.
    fn near(&mut self) -> Result<u32, Error> {
        let number = usize::from(self.bytes.take(1)?[0]);
        let &(first, count) = self.patches.last().unwrap_or(&(0, 0));
        if number >= count {
            return Err(self.bytes.wrong("a triangle names a vertex that its patch does not have"));
        }
        Ok((first + number) as u32)
    }

    fn material(&mut self) -> Result<Option<usize>, Error> {
        let object = self.bytes.integer(2)?;
        if object == -1 {
            return Ok(None);
        }
        let material = usize::try_from(object).ok().and_then(|object| self.objects.get(object));
        material.copied().ok_or_else(|| self.bytes.wrong("a triangle names a material that the mesh does not have"))
    }

    fn finish(mut self) -> Result<Mesh, Error> {
        for (triangle, far) in std::mem::take(&mut self.far) {
            for (corner, vertex) in far.into_iter().enumerate() {
                let Some(vertex) = vertex else { continue };
                let (patch, number) = ((vertex >> 8) as usize, (vertex & 255) as usize);
                let place = self.patches.get(patch).filter(|&&(_, count)| number < count);
                let Some(&(first, _)) = place else {
                    return Err(self.bytes.wrong("a triangle names a vertex that no patch has"));
                };
                self.mesh.triangles[triangle].vertices[corner] = (first + number) as u32;
            }
        }
        Ok(self.mesh)
    }
}

/// A direction from its code: two components of 13 bits, the larger of x and y or z left out, signs, and which are
/// given (dircode.c).
fn direction(code: u32) -> Option<[f64; 3]> {
    /// (2^13 - 1/2) sqrt 2
    const SCALE: f64 = 11584.5;
    if code == 0 {
        return None;
    }
    let first = f64::from(code >> 5 & 0x1fff) / SCALE;
    let second = f64::from(code >> 18 & 0x1fff) / SCALE;
    let rest = (1.0 - first * first - second * second).max(0.0).sqrt();
    let (first_is_x, second_is_z) = (code & 8 != 0, code & 16 != 0);
    let mut direction = match (first_is_x, second_is_z) {
        (true, true) => [first, rest, second],
        (true, false) => [first, second, rest],
        (false, true) => [rest, first, second],
        (false, false) => [second, first, rest],
    };
    for (axis, value) in direction.iter_mut().enumerate() {
        if code >> axis & 1 == 1 {
            *value = -*value;
        }
    }
    Some(direction)
}
