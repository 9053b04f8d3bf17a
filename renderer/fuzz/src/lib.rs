//! What the fuzzer does with bytes, one function for each reader. A function returns whatever its input: an error is an
//! answer, a panic is not, and neither is a result that breaks what its reader promises.
//!
//! `renderer/tests/fuzz_regressions.rs` includes this file and replays what once broke.

use renderer::cal::{Dialect, Evaluator, Functions, Nowhere};
use renderer::component::ComponentSet;
use renderer::crex::{self, Cursor};
use renderer::film::{Block, Planes};
use renderer::geometry::Aggregate;
use renderer::picture;
use renderer::rad::{self, Document, Limits, MemoryFiles, Options, Rif, Source, ViewSpec};
use renderer::scene::{Scene, View};
use renderer::transport::{Parcel, Samples, Tracer, Workspace};
use renderer::work::Work;

/// Small enough that a scene which reaches a limit is still read in milliseconds.
const LIMITS: Limits = Limits { primitives: 5_000, values: 50_000, files: 50, depth: 16 };

/// Surfaces up to which a scene is also looked at.
const MOST_SURFACES: usize = 200;

/// Stages of a crex that are walked.
const MOST_STAGES: usize = 2_000;

/// Scene text: read, given a meaning, and looked at.
pub fn rad(data: &[u8]) {
    let itself = MemoryFiles::new().with("self", data);
    let options = Options { limits: LIMITS, ..Options::default() };
    let Ok(document) = rad::read(&[Source::new("scene.rad", data)], &itself, &options) else { return };
    check_document(&document);
    look_at(&document);
}

/// A function file: read, and everything that it defines evaluated.
pub fn cal(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    for dialect in [Dialect::Generator, Dialect::Ray] {
        let mut functions = Functions::new(dialect);
        if functions.define_file("any.cal", &text).is_err() {
            continue;
        }
        let names: Vec<String> =
            functions.names().map(|name| name.split('`').next().unwrap_or(name).to_owned()).collect();
        for name in names.iter().take(20) {
            for call in [name.clone(), format!("{name}(.5,2)")] {
                let Ok(expression) = functions.expression("any.cal", &call) else { continue };
                let whole = functions.check(expression).is_none();
                let mut evaluator = Evaluator::new(&functions);
                let value = evaluator.value(expression, &Nowhere);
                assert!(
                    !whole || !matches!(value, Err(renderer::cal::EvaluationError::Undefined(_))),
                    "{call}: {value:?}"
                );
            }
        }
    }
    let mut functions = Functions::new(Dialect::Generator);
    if let Ok(lambda) = functions.lambda(&["s", "t"], &text) {
        let _ = functions.check_lambda(lambda);
        let _ = Evaluator::new(&functions).apply(lambda, &[0.25, -1e300]);
    }
}

/// A view file: read, and looked through.
pub fn view(data: &[u8]) {
    let mut spec = ViewSpec::default();
    if spec.take_header("any.vf", &String::from_utf8_lossy(data)).is_err() {
        return;
    }
    let mut again = ViewSpec::default();
    let written = format!("VIEW= {spec}\n");
    assert!(again.take_header("again.vf", &written).is_ok() && again == spec, "{written}");
    let Ok(view) = View::new(spec) else { return };
    for (x, y) in [(0.5, 0.5), (0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (0.25, 0.9)] {
        let Some(ray) = view.ray(x, y) else { continue };
        assert!(ray.origin.is_finite() && (ray.dir.length() - 1.0).abs() < 1e-9, "{written} {ray:?}");
        assert!(!ray.t_max.is_nan(), "{written} {ray:?}");
    }
    let (width, height) = view.resolution(512, 512, 1.0);
    assert!((1..=512).contains(&width) && (1..=512).contains(&height), "{written} {width} {height}");
}

/// An octree.
pub fn octree(data: &[u8]) {
    let options = Options { limits: LIMITS, ..Options::default() };
    let source = Source::new("any.oct", with_header(data, b"#?RADIANCE\nFORMAT=Radiance_octree\n\n"));
    if let Ok(document) = rad::read_octree(&source, &MemoryFiles::new(), &options) {
        check_document(&document);
        look_at(&document);
    }
}

/// A compiled mesh.
pub fn mesh(data: &[u8]) {
    let source = Source::new("any.rtm", with_header(data, b"#?RADIANCE\nFORMAT=Radiance_tmesh\n\n"));
    let Ok(mesh) = rad::read_mesh(&source) else { return };
    check_document(&mesh.materials);
    for triangle in &mesh.triangles {
        assert!(triangle.vertices.iter().all(|&vertex| (vertex as usize) < mesh.vertices.len()));
        assert!(triangle.material.is_none_or(|material| material < mesh.materials.primitives.len()));
    }
}

/// A Wavefront object: read, and looked at as a mesh of a scene.
pub fn obj(data: &[u8]) {
    let source = Source::new("any.obj", data);
    let Ok(obj) = rad::read_obj(&source) else { return };
    for face in &obj.faces {
        assert!(face.vertices.len() >= 3 && face.material.is_none_or(|material| material < obj.materials.len()));
        assert!(face.vertices.iter().all(|&vertex| (vertex as usize) < obj.vertices.len()));
    }
    let files = MemoryFiles::new().with("any.obj", data);
    let text = "void plastic m 0 0 5 .5 .5 .5 .1 .1\nm mesh any 1 any.obj 0 0\nvoid light l 0 0 3 9 9 9\nl sphere s 0 0 4 0 0 9 1\n";
    let Ok(document) = rad::read(&[Source::new("scene.rad", text)], &files, &Options::default()) else { return };
    if obj.faces.iter().map(|face| face.vertices.len()).sum::<usize>() <= 10 * MOST_SURFACES {
        look_with(&document, &files);
    }
}

/// A crex: read, printed, read again, explained and walked.
pub fn crex(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    let ast = match crex::parse(&text) {
        Ok(ast) => ast,
        Err(errors) => {
            for error in errors {
                assert!(!error.render(&text).is_empty());
            }
            return;
        }
    };
    let printed = ast.to_string();
    let again = crex::parse(&printed).map(|ast| ast.to_string());
    assert_eq!(again.as_ref(), Ok(&printed));
    let _ = crex::explain(&ast);
    let program = crex::Program::new(&ast);
    let mut cursor = Cursor::new(&program);
    for step in 0..MOST_STAGES {
        match cursor.next() {
            None => break,
            Some(Work::Run(_)) => cursor.report(u64::from(step % 7 != 0)),
            Some(Work::Release) => {}
        }
    }
}

/// A rad input file.
pub fn rif(data: &[u8]) {
    let Ok(rif) = Rif::read(&Source::new("any.rif", data)) else { return };
    for view in rif.views() {
        let mut spec = ViewSpec::default();
        let _ = spec.take_option(&view.options);
    }
    let _ = rif.scene(&MemoryFiles::new().with("self", ""), "");
}

/// A picture: HDR, EXR or PNG.
pub fn picture(data: &[u8]) {
    if let Ok(picture) = picture::read_bytes(data) {
        let (width, height) = (picture.beauty.width(), picture.beauty.height());
        assert!(picture.layers.iter().all(|layer| (layer.pixels.width(), layer.pixels.height()) == (width, height)));
    }
}

/// Spares the fuzzer the invention of a header.
fn with_header(data: &[u8], header: &[u8]) -> Vec<u8> {
    if data.starts_with(b"#?") { data.to_vec() } else { [header, data].concat() }
}

/// What a document promises.
fn check_document(document: &Document) {
    for (index, primitive) in document.primitives.iter().enumerate() {
        assert!(primitive.modifier.is_none_or(|modifier| modifier < index));
        assert!(primitive.reals.iter().all(|value| value.is_finite()), "{primitive:?}");
    }
}

/// Renders a few pixels of a document: no NaN and no infinity in any plane.
fn look_at(document: &Document) {
    look_with(document, &MemoryFiles::new());
}

fn look_with(document: &Document, files: &MemoryFiles) {
    let Ok(scene) = Scene::from_rad_with(document, files) else { return };
    if scene.surfaces.len() > MOST_SURFACES {
        return;
    }
    let aggregate = scene.aggregate();
    for direction in [[0.1, 1.0, -0.2], [0.0, 0.0, -1.0]] {
        let spec = ViewSpec {
            point: [0.5, -3.0, 1.0],
            direction,
            up: [0.0, 0.3, 1.0],
            horizontal: 120.0,
            ..ViewSpec::default()
        };
        if let Ok(view) = View::new(spec) {
            look_through(&scene, &aggregate, &view);
        }
    }
}

fn look_through(scene: &Scene, aggregate: &Aggregate, view: &View) {
    const EDGE: usize = 3;
    let ambient = renderer::color::Rgb::ONE;
    let tracer = Tracer { ambient, ..Tracer::new(scene, aggregate) };
    let block = Block { x: 0, y: 0, width: EDGE, height: EDGE };
    let mut parcel = Parcel::new(block, 0..1, ComponentSet::ALL, true);
    let mut workspace = Workspace::default();
    parcel.trace_primary(
        &tracer,
        &Samples { view, width: EDGE, height: EDGE, jitter: 1.0, aperture: 0.0 },
        &mut workspace,
    );
    let Ok(program) = crex::compile("(DSGTRM)3") else { return };
    let mut cursor = Cursor::new(&program);
    while let Some(work) = cursor.next() {
        match work {
            Work::Run(stage) => cursor.report(parcel.run(&tracer, &stage, &mut workspace).rays),
            Work::Release => parcel.release(),
        }
    }
    let mut sums = Planes::default();
    sums.clear(block.pixels(), ComponentSet::ALL, true);
    parcel.add_to(&mut sums, tracer.ambient);
    let mut film = renderer::film::Film::new(EDGE, EDGE, ComponentSet::ALL, true);
    film.store(block, &sums, 1);
    let planes = ComponentSet::ALL.iter().filter_map(|component| film.layer(component));
    for plane in planes.chain([film.direct(), &film.beauty()]).chain(film.ambient()) {
        assert!(plane.values().iter().all(|pixel| pixel.is_finite() && pixel.min_element() >= 0.0), "{plane:?}");
    }
}
