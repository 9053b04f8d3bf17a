//! Octrees and meshes as Radiance's programs write them (`data/make_compiled.py`), and damaged ones.

use proptest::prelude::*;

use super::super::{DiskFiles, Document, MemoryFiles, Options, Source, read, read_mesh, read_octree};

const OCTREE: &[u8] = include_bytes!("../data/compiled.oct");
const NAMED: &[u8] = include_bytes!("../data/named.oct");
const MESH: &[u8] = include_bytes!("../data/compiled.rtm");
const SCENE: &str = include_str!("../data/compiled.rad");

fn files() -> MemoryFiles {
    MemoryFiles::new().with("compiled.rad", SCENE)
}

fn octree(bytes: &[u8]) -> Result<Document, String> {
    let read = read_octree(&Source::new("a.oct", bytes), &files(), &Options::default());
    read.map_err(|errors| errors[0].to_string())
}

fn scene() -> Document {
    read(&[Source::new("compiled.rad", SCENE)], &files(), &Options::default()).unwrap()
}

#[test]
fn a_frozen_octree_holds_its_scene() {
    let (found, written) = (octree(OCTREE).unwrap(), scene());
    assert_eq!(found.primitives.len(), written.primitives.len());
    for (found, written) in found.primitives.iter().zip(&written.primitives) {
        assert_eq!((found.kind, &found.name, found.modifier), (written.kind, &written.name, written.modifier));
        assert_eq!(found.strings, written.strings);
        assert_eq!(found.reals.len(), written.reals.len());
        for (found, written) in found.reals.iter().zip(&written.reals) {
            // A mantissa of 31 bits.
            assert!((found - written).abs() <= 1e-9 * written.abs(), "{found} is not {written}");
        }
    }
    assert_eq!(found.modifier_named("same", 5), written.modifier_named("same", 5));
    assert!(found.error(found.primitives[0].span, "nothing").to_string().starts_with("a.oct: nothing"));
}

#[test]
fn another_octree_names_its_files() {
    let found = octree(NAMED).unwrap();
    assert_eq!(found.primitives, scene().primitives);
    let missing = read_octree(&Source::new("a.oct", NAMED), &MemoryFiles::new(), &Options::default()).unwrap_err();
    assert!(missing[0].message.contains("not frozen") && missing[0].message.contains("`compiled.rad` is not found"));
}

#[test]
fn a_mesh_is_the_surface_that_it_was_made_of() {
    let mesh = read_mesh(&Source::new("a.rtm", MESH)).unwrap();
    assert_eq!((mesh.vertices.len(), mesh.triangles.len()), (19 * 19, 2 * 18 * 18));
    for vertex in &mesh.vertices {
        let [x, y, z] = vertex.position;
        assert!((z - (3.0 * x).sin() * (2.0 * y).cos() / 4.0).abs() < 1e-8);
        let [u, v] = vertex.uv.unwrap();
        assert!((u - x).abs() < 1e-6 && (v - y).abs() < 1e-6);
        let slopes = [0.75 * (3.0 * x).cos() * (2.0 * y).cos(), -0.5 * (3.0 * x).sin() * (2.0 * y).sin()];
        let length = (slopes[0].powi(2) + slopes[1].powi(2) + 1.0).sqrt();
        let normal = vertex.normal.unwrap();
        for (found, wanted) in normal.into_iter().zip([-slopes[0] / length, -slopes[1] / length, 1.0 / length]) {
            // A code of 32 bits: up to 0.0058 degrees off.
            assert!((found - wanted).abs() < 1.1e-4, "{found} is not {wanted}");
        }
    }
    let (mut area, mut gold) = (0.0, 0);
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.vertices.map(|vertex| mesh.vertices[vertex as usize].position);
        area += ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])) / 2.0;
        let name = &mesh.materials.primitives[triangle.material.unwrap()].name;
        assert!(name == "gold" || name == "red", "{name}");
        gold += usize::from(name == "gold");
        let row = (a[1].min(b[1]).min(c[1]) * 18.0).round() as usize;
        assert_eq!(name == "gold", row % 2 == 1);
    }
    // Seen from above, and every triangle once.
    assert!((area - 1.0).abs() < 1e-7);
    assert_eq!(gold, 18 * 18);
}

#[test]
fn other_files_are_refused() {
    for bytes in [&b""[..], b"void plastic", b"#?RADIANCE\n\n", b"#?RADIANCE\nFORMAT=Radiance_octree\n\n\x01", MESH] {
        assert!(octree(bytes).is_err());
    }
    assert!(read_mesh(&Source::new("a", OCTREE)).unwrap_err().message.contains("no Radiance_tmesh file"));
    let disk = DiskFiles::default();
    assert!(read_octree(&Source::new("a", &b"\n"[..]), &disk, &Options::default()).is_err());
}

proptest! {
    #[test]
    fn damaged_files_are_read_or_refused(place in 0.0..1.0f64, byte in any::<u8>(), cut in any::<bool>()) {
        for whole in [OCTREE, MESH, NAMED] {
            let mut bytes = whole.to_vec();
            let at = (place * bytes.len() as f64) as usize;
            if cut { bytes.truncate(at) } else { bytes[at] = byte }
            let _ = octree(&bytes);
            let _ = read_mesh(&Source::new("a.rtm", bytes));
        }
    }
}
