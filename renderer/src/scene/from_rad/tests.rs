use glam::DVec3;

use crate::geometry::{Passage, Ray, Shape, SurfaceId};
use crate::material::{Alternate, EmitterKind, Material};
use crate::rad::{self, MemoryFiles, Options, Source};
use crate::scene::{FarId, Scene};

fn build(text: &str) -> Result<Scene, String> {
    let document = rad::read(&[Source::new("test.rad", text)], &MemoryFiles::new(), &Options::default())
        .map_err(|errors| format!("not even text: {errors:?}"))?;
    Scene::from_rad(&document).map_err(|errors| errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))
}

fn warnings(scene: &Scene) -> Vec<String> {
    scene.warnings.iter().map(|warning| format!("{}:{} {}", warning.line, warning.column, warning.message)).collect()
}

const GREY: &str = "void plastic grey 0 0 5 .5 .5 .5 0 0\n";
const LAMP: &str = "void light lamp 0 0 3 1 2 3\n";

#[test]
fn every_surface_type_becomes_its_shape() {
    let scene = build(&format!(
        "{GREY}
        grey polygon square 0 0 12 0 0 0  1 0 0  1 1 0  0 1 0
        grey polygon three 0 0 12 0 0 0  1 0 0  1 1 0  0 0 0
        grey sphere ball 0 0 4 0 0 0 2
        grey sphere hollow 0 0 4 0 0 0 -2
        grey bubble hollow2 0 0 4 0 0 0 2
        grey cone frustum 0 0 8 0 0 0 0 0 1 1 .5
        grey cup frustum2 0 0 8 0 0 0 0 0 1 1 .5
        grey cone swapped 0 0 8 0 0 0 0 0 1 -1 -.5
        grey cylinder rod 0 0 7 0 0 0 0 0 1 1
        grey tube pipe 0 0 7 0 0 0 0 0 1 1
        grey ring disc 0 0 8 0 0 0 0 0 2 1 0
        void polygon unseen 0 0 9 0 0 5 1 0 5 0 1 5"
    ))
    .unwrap();
    assert!(scene.warnings.is_empty());
    let shape = |index: usize| &scene.surfaces[index].shape;
    let is_bubble = |index| matches!(shape(index), Shape::Sphere(sphere) if sphere.is_bubble());
    let is_inward = |index| matches!(shape(index), Shape::Cone(cone) if cone.is_inward());
    assert!(matches!(shape(0), Shape::Polygon(polygon) if polygon.vertices().len() == 4));
    assert!(matches!(shape(1), Shape::Triangle(_)));
    assert_eq!([2, 3, 4].map(is_bubble), [false, true, true]);
    assert_eq!([5, 6, 7, 8, 9].map(is_inward), [false, true, true, false, true]);
    assert!(matches!(shape(10), Shape::Ring(ring) if ring.radii() == [0.0, 1.0] && ring.normal() == DVec3::Z));
    // Surfaces without a material are not there for rays.
    assert_eq!((scene.surfaces.len(), scene.aggregate().len()), (12, 11));
    assert_eq!(
        (scene.name(scene.surfaces[8].name), scene.surfaces[8].modifier.map(|id| scene.name(id))),
        ("rod", Some("grey"))
    );
    assert_eq!((scene.surfaces[11].modifier, scene.materials.len()), (None, 1));
}

#[test]
fn what_covers_nothing_is_left_out_with_a_warning() {
    let scene = build(&format!(
        "{GREY}grey sphere point 0 0 4 0 0 0 0\ngrey polygon line 0 0 9 0 0 0 1 1 1 2 2 2
grey cylinder stub 0 0 7 1 2 3 1 2 3 1\n  grey ring gap 0 0 8 0 0 0 0 0 1 1 1\ngrey polygon bent 0 0 12 0 0 0 1 0 0 1 1 .3 0 1 0
{LAMP}lamp source nowhere 0 0 4 0 0 1 0\ngrey source dull 0 0 4 0 0 1 5"
    ))
    .unwrap();
    assert_eq!(
        warnings(&scene),
        [
            "2:6 sphere `point` is left out: its radius is zero",
            "3:6 polygon `line` is left out: it has no area",
            "4:6 cylinder `stub` is left out: its ends coincide",
            "5:8 ring `gap` is left out: it has no area",
            "6:6 polygon `bent` is not flat: a vertex is off its plane by 5.07 % of its extent",
            "8:33 source `nowhere` is left out: with an angle of 0 it covers nothing",
            "9:1 source `dull` does not show: its material does not emit; use light, glow or illum",
        ]
    );
    assert_eq!(scene.surfaces.len(), 1);
    // A thousand of them are not listed.
    let many = format!("{GREY}{}", "grey sphere point 0 0 4 0 0 0 0\n".repeat(1000));
    let warnings = warnings(&build(&many).unwrap());
    assert_eq!((warnings.len(), warnings[20].as_str()), (21, "0:0 980 more warnings like these"));
}

#[test]
fn errors_have_places() {
    let table = [
        ("void BSDF b 6 0 b.xml 0 0 1 . 0 0\nb sphere s 0 0 4 0 0 0 1", "1:6", "`BSDF` is not supported yet"),
        ("void mist fog 0 0 6 1 1 1 2 1 1\nfog sphere s 0 0 4 0 0 0 1", "1:27", "fraction from 0 to 1"),
        (
            "void mist fog 0 0 0\nvoid brightfunc f 2 Px . 0 0\nf mist fog 0 0 0\nfog sphere s 0 0 4 0 0 0 1",
            "3:3",
            "not supported",
        ),
        ("void prism1 p 5 a Dx Dy Dz . 0 0\np sphere s 0 0 4 0 0 0 1", "1:17", "variable `a` is not defined"),
        (
            "void WGMDfunc w 13 nix 1 1 1 void 0 0 0 void 0 0 1 . 0 9 0 0 0 0 0 0 0 0 0\nw sphere s 0 0 4 0 0 0 1",
            "1:20",
            "`nix`",
        ),
        (
            "void spectrum s 0 0 5 400 700 1 -1 1\ns plastic p 0 0 5 1 1 1 0 0\np sphere b 0 0 4 0 0 0 1",
            "1:6",
            "a value is -1",
        ),
        ("void plastic2 p 4 1 0 0 . 0 6 1 1 1 0 .1 0\np sphere s 0 0 4 0 0 0 1", "1:42", "v-roughness"),
        (
            "void brightfunc dots 2 dots . 0 0\ndots plastic p 0 0 5 1 1 1 0 0\np sphere s 0 0 4 0 0 0 1",
            "1:24",
            "variable `dots` is not defined",
        ),
        (
            "void plastic q 0 0 5 1 1 1 0 0\nq plastic p 0 0 5 1 1 1 0 0\np sphere s 0 0 4 0 0 0 1",
            "2:3",
            "its modifier `q` is another",
        ),
        ("void plastic p 0 0 5 1 -1 1 0 0\np sphere s 0 0 4 0 0 0 1", "1:24", "green"),
        ("void plastic p 0 0 5 1 1 1 2 0\np sphere s 0 0 4 0 0 0 1", "1:28", "specularity"),
        ("void plastic p 0 0 5 1 1 1 0 0\np ring r 0 0 8 0 0 0 0 0 1 -1 2", "2:28", "the radius is -1"),
        ("void plastic p 0 0 5 1 1 1 0 0\np cone c 0 0 8 0 0 0 0 0 1 -1 2", "2:31", "different signs"),
        ("void plastic p 0 0 5 1 1 1 0 0\np sphere s 0 0 4 1e200 0 0 1", "2:18", "too large"),
        ("void light l 0 0 3 1 1 1\nl source s 0 0 4 0 0 0 1", "2:18", "0 0 0"),
        ("void light l 0 0 3 1 1 1\nl source s 0 0 4 0 0 1 361", "2:24", "0 to 360"),
        ("void illum i 1 none 0 3 1 1 1\ni sphere s 0 0 4 0 0 0 1", "1:16", "`none` is no material defined before"),
        ("void plastic p 0 0 5 1 1 1 0 0\np instance i 1 x.oct 0 0", "2:16", "the file `x.oct` is not found"),
    ];
    for (text, place, message) in table {
        let error = build(text).unwrap_err();
        assert!(error.starts_with(&format!("test.rad:{place}")), "{text}\n{error}");
        assert!(error.contains(message), "{text}\n{error}");
        assert!(!error.contains("test.rad:0"), "{error}");
    }
    // What nothing uses is not looked at.
    assert!(build("void mist fog 0 0 0\nvoid brightfunc b 2 f . 0 0\nb plastic p 0 0 5 1 1 1 0 0").is_ok());
    // Each material is reported once, whoever uses it; errors end at a number that one reads.
    let twice = "void plastic p 0 0 5 1 -1 1 0 0\np sphere s 0 0 4 0 0 0 1\np sphere t 0 0 4 0 0 0 1";
    assert_eq!(build(twice).unwrap_err().matches("test.rad").count(), 1);
    let many = format!("void light l 0 0 3 1 1 1\n{}", "l source s 0 0 4 0 0 0 1\n".repeat(100));
    assert_eq!(build(&many).unwrap_err().matches("test.rad").count(), rad::MAX_ERRORS);
}

#[test]
fn emitters_light_as_radiance_says() {
    let scene = build(
        "void light lamp 0 0 3 1 1 1
        void light dark 0 0 3 0 0 0
        void glow near 0 0 4 1 1 1 2
        void glow sky 0 0 4 1 1 1 0
        void glow dead 0 0 4 1 1 1 -1
        void spotlight spot 0 0 7 1 1 1 20 0 0 -1
        void glass pane 0 0 3 .9 .9 .9
        void illum window 1 pane 0 3 1 1 1
        void illum open 1 void 0 3 1 1 1
        lamp sphere s0 0 0 4 0 0 0 1
        dark sphere s1 0 0 4 3 0 0 1
        near sphere s2 0 0 4 6 0 0 1
        sky sphere s3 0 0 4 9 0 0 1
        dead sphere s4 0 0 4 12 0 0 1
        spot ring s5 0 0 8 0 0 5 0 0 -1 0 1
        window polygon s6 0 0 9 0 5 0 1 5 0 1 5 1
        open polygon s7 0 0 9 0 6 0 1 6 0 1 6 1
        near source f0 0 0 4 0 0 1 180
        lamp source f1 0 0 4 0 0 1 .5
        sky source f2 0 0 4 0 0 -1 180",
    )
    .unwrap();
    let lit_by: Vec<String> = scene.lights.iter().map(|light| format!("{:?}", light.source())).collect();
    let expected = ["0", "2", "5", "6", "7"].map(|id| format!("Surface(SurfaceId({id}))"));
    assert_eq!(lit_by[..5], expected);
    // A distant glow is sky, not sun.
    assert_eq!(lit_by[5..], ["Far(FarId(1))"]);
    assert_eq!(scene.far[1].axis(), DVec3::Z);
    assert!((scene.far[1].versine() - (1.0 - 0.25_f64.to_radians().cos())).abs() < 1e-15);
    // The sun shows before the sky around it; below the horizon is the other sky.
    assert_eq!(scene.escaped(DVec3::Z), Some(FarId(1)));
    assert_eq!(scene.escaped(DVec3::new(0.6, 0.0, 0.8)), Some(FarId(0)));
    assert_eq!(scene.escaped(-DVec3::Z), Some(FarId(2)));
    // The alternate is built though no surface names it, and before the illum.
    let illum = scene.material(SurfaceId(6)).unwrap();
    let Material::Emitter(emitter) = illum else { panic!("an emitter") };
    let EmitterKind::Illum(Alternate::Material(pane)) = emitter.kind() else { panic!("an alternate") };
    assert!(matches!(scene.materials[pane.index()], Material::Glass(_)));
}

#[test]
fn shadow_rays_pass_what_is_clear() {
    let materials = "void glass clear 0 0 3 .9 .9 .9
        void glass black 0 0 3 0 0 0
        void trans smooth 0 0 7 1 1 1 0 0 .5 .5
        void trans rough 0 0 7 1 1 1 0 .1 .5 .5
        void trans diffuse 0 0 7 1 1 1 0 0 .5 0
        void dielectric water 0 0 5 1 1 1 1.33 0
        void mirror m 0 0 3 1 1 1
        void illum open 0 0 3 1 1 1
        void illum wet 1 water 0 3 1 1 1
        void illum shut 1 m 0 3 1 1 1\n";
    let names = ["clear", "black", "smooth", "rough", "diffuse", "water", "m", "open", "wet", "shut"];
    let spheres: String = names.iter().map(|name| format!("{name} sphere s 0 0 4 0 0 0 1\n")).collect();
    let scene = build(&format!("{materials}{spheres}")).unwrap();
    use Passage::{Opaque, Refracting, Straight};
    let found: Vec<Passage> =
        scene.surfaces.iter().filter_map(|surface| Some(scene.passage(surface.material?))).collect();
    assert_eq!(found, [Straight, Opaque, Straight, Opaque, Opaque, Refracting, Opaque, Straight, Refracting, Opaque]);
}

/// Names bind to the latest definition before them; of coincident surfaces the one of the later modifier shows.
#[test]
fn redefined_materials_and_coincident_surfaces() {
    let scene = build(
        "void plastic a 0 0 5 .1 .1 .1 0 0
        a polygon first 0 0 12 0 0 0 1 0 0 1 1 0 0 1 0
        void plastic a 0 0 5 .2 .2 .2 0 0
        a polygon second 0 0 12 0 0 0 1 0 0 1 1 0 0 1 0
        void plastic b 0 0 5 .3 .3 .3 0 0
        b polygon back 0 0 12 0 0 0 0 1 0 1 1 0 1 0 0",
    )
    .unwrap();
    assert_eq!(scene.materials.len(), 3);
    let above = Ray::new(DVec3::new(0.4, 0.3, 1.0), -DVec3::Z);
    let hit = scene.aggregate().closest(&above).unwrap();
    assert_eq!(scene.name(scene.surface(hit.surface).name), "second");
}

#[test]
fn an_empty_scene_is_a_scene() {
    let scene = build("# nothing\n").unwrap();
    assert!(scene.aggregate().is_empty() && scene.lights.is_empty() && scene.escaped(DVec3::X).is_none());
}

#[test]
fn mirrors_relay_once_unless_told_otherwise() {
    let text = format!(
        "{LAMP}void mirror m 0 0 3 1 1 1
        lamp ring l 0 0 8 0 0 3 0 0 -1 0 .1
        m polygon left 0 0 12 -2 -2 0 -2 2 0 -2 2 4 -2 -2 4
        m polygon right 0 0 12 2 -2 0 2 -2 4 2 2 4 2 2 0
        m sphere ball 0 0 4 0 9 0 1"
    );
    let mut scene = build(&text).unwrap();
    assert_eq!(
        warnings(&scene),
        [
            "6:11 mirror or prism `ball` is curved, so it shows what is behind it but relays no light; only polygons and rings do"
        ]
    );
    let relays = |scene: &Scene| scene.lights.iter().map(|light| light.relay().len()).collect::<Vec<_>>();
    assert_eq!(relays(&scene), [0, 1, 1]);
    scene.set_relays(2);
    assert_eq!(relays(&scene), [0, 1, 1, 2, 2]);
}

/// Of a scene in memory beside files, what it is or the errors.
fn build_with(text: &str, files: &MemoryFiles) -> Result<Scene, String> {
    let document = rad::read(&[Source::new("test.rad", text)], files, &Options::default()).unwrap();
    Scene::from_rad_with(&document, files)
        .map_err(|errors| errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))
}

/// A ball of radius 1/2 at (1, 0, 0), twice the size and further along x with every instance around it.
#[test]
fn instances_within_instances_are_placed_and_covered() {
    let files = MemoryFiles::new()
        .with("ball.rad", "void plastic red 0 0 5 .5 0 0 0 0\nred sphere ball 0 0 4 1 0 0 .5\nvoid sphere bare 0 0 4 1 3 0 .5")
        .with("pair.rad", "void plastic blue 0 0 5 0 0 .5 0 0\nvoid instance i 7 ball.rad -s 2 -t 1 0 0 0 0\nblue instance j 5 ball.rad -t 0 0 20 0 0");
    let text = "void plastic green 0 0 5 0 .5 0 0 0
        void instance outer 7 pair.rad -s 2 -t 1 0 0 0 0
        green instance over 5 pair.rad -t 0 100 0 0 0";
    let scene = build_with(text, &files).unwrap();
    let aggregate = scene.aggregate();
    let color = |x: f64, y: f64, z: f64| {
        let ray = Ray::new(DVec3::new(x, y, z + 9.0), -DVec3::Z).up_to(12.0);
        let hit = aggregate.closest(&ray)?;
        let name = scene.name(scene.surface(hit.surface).name).to_owned();
        let Some(Material::Plastic(plastic)) = scene.material(hit.surface) else { return Some((name, hit.t, None)) };
        Some((name, hit.t, Some(format!("{plastic:?}"))))
    };
    let of = |scene: &Scene, index: usize| format!("{:?}", scene.materials[index]);
    let (name, t, found) = color(7.0, 0.0, 0.0).unwrap();
    // At 2 (2 x + 1) + 1 = 7 with a radius of 2.
    assert_eq!((name.as_str(), t), ("ball", 7.0));
    let materials: Vec<String> = (0..scene.materials.len()).map(|index| of(&scene, index)).collect();
    let named = |found: Option<String>| materials.iter().position(|text| text.contains(&found.clone().unwrap()));
    let red = named(found);
    // The inner instance's material covers what it places, the outer one's covers all.
    let blue = named(color(3.0, 0.0, 40.0).unwrap().2);
    let green = named(color(3.0, 100.0, 0.0).unwrap().2);
    assert_eq!(green, named(color(1.0, 100.0, 20.0).unwrap().2));
    assert!(red.is_some() && blue.is_some() && green.is_some());
    assert!(red != blue && blue != green && green != red);
    // What has no material is nothing by itself and takes the material of an instance.
    assert_eq!(color(7.0, 12.0, 0.0).map(|(name, _, material)| (name, material)), Some(("bare".to_owned(), None)));
    assert_eq!(named(color(3.0, 106.0, 0.0).unwrap().2), green);
    // The numbers of two places never meet.
    assert_eq!(color(5.0, 50.0, 0.0), None);
}

#[test]
fn an_octree_that_holds_itself_is_an_error() {
    let files =
        MemoryFiles::new().with("a.rad", "void instance x 1 b.rad 0 0").with("b.rad", "void instance y 1 a.rad 0 0");
    let error = build_with("void instance i 1 a.rad 0 0", &files).unwrap_err();
    assert!(error.contains("a.rad -> b.rad -> a.rad: an octree cannot hold an instance of itself"), "{error}");
    let mut files = MemoryFiles::new().with("d9.rad", "");
    for depth in 0..9 {
        let next = depth + 1;
        files = files.with(format!("d{depth}.rad"), format!("void instance i 1 d{next}.rad 0 0\n").repeat(2));
    }
    assert!(build_with("void instance i 1 d2.rad 0 0", &files).is_ok());
    let error = build_with("void instance i 1 d1.rad 0 0", &files).unwrap_err();
    assert!(error.contains("more than 8 deep"), "{error}");
}

/// What a scene does not use is neither read nor held; what it uses is held once.
#[test]
fn scenes_hold_what_they_use() {
    use crate::scene::Holdings;
    // None of the files that unused primitives name is there.
    let plain = "void light lamp 0 0 3 1 1 1
        void brightfunc dots 2 dots none.cal 0 0
        void colorpict photo 7 red green blue none.hdr none.cal u v 0 0
        dots plasfunc strange 2 f none.cal 0 4 1 1 1 .5
        void antimatter hole 1 grey 0 0
        void plastic grey 0 0 5 .5 .5 .5 0 0
        grey sphere ball 0 0 4 0 0 0 1
        lamp sphere l 0 0 4 0 0 3 .1";
    let expected = Holdings { surfaces: 2, materials: 2, lights: 1, ..Holdings::default() };
    assert_eq!(build(plain).unwrap().holdings(), expected);
    let files = MemoryFiles::new()
        .with("ramp.dat", "1 0 1 3 .2 .5 .9")
        .with("pair.rad", "void plastic red 0 0 5 .5 0 0 0 0\nred sphere a 0 0 4 0 0 0 1\nred sphere b 0 0 4 3 0 0 1")
        .with("two.rad", "void instance i 1 pair.rad 0 0\nvoid instance j 5 pair.rad -t 0 9 0 0 0");
    let dressed = "void brightdata ramp 4 noop ramp.dat . Px 0 0
        ramp plastic grey 0 0 5 .5 .5 .5 0 0
        ramp plastic dark 0 0 5 .1 .1 .1 0 0
        grey sphere ball 0 0 4 0 0 0 1
        dark sphere other 0 0 4 5 0 0 1
        void instance first 1 two.rad 0 0
        void instance second 5 two.rad -t 50 0 0 0 0";
    let holds = build_with(dressed, &files).unwrap().holdings();
    // The numbers of one table; two instances of a file that holds two of another with two spheres.
    assert_eq!((holds.surfaces, holds.dresses, holds.table_bytes), (4, 2, 12));
    assert_eq!((holds.function_texts > 0, holds.instances, holds.instanced), (true, 2, 4));
}
