//! From a film to picture files, and what an interruption leaves of them.

use std::borrow::Borrow;
use std::io::{BufWriter, StdoutLock};
use std::ops::Range;
use std::path::{Path, PathBuf};

use glam::Vec3;
use renderer::component::ComponentSet;
use renderer::film::{Film, Plane};
use renderer::picture::{
    AtomicFile, Band, Compression, Error, Format, HdrStream, Header, PictureFile, Pixel, Provenance,
};

use crate::console::Failure;

/// Rows handed to a writer at a time.
const BAND_ROWS: usize = 64;

/// Where pictures go.
#[derive(Clone, Debug)]
pub(crate) enum Output {
    /// A file in the format of its name.
    File(PathBuf),
    /// Radiance HDR on standard output.
    Stream,
}

impl Output {
    /// Checks, before anything is rendered, that a picture can be written there.
    pub(crate) fn new(path: &Path) -> Result<Self, Failure> {
        if path == Path::new("-") {
            return Ok(Self::Stream);
        }
        if Format::of_name(path).is_none() {
            let advice = "says no picture format: end its name in .exr, .hdr (or .pic) or .png";
            return Err(Failure::input(format!("-o {}: {advice}", path.display())));
        }
        check_place(path)?;
        Ok(Self::File(path.to_owned()))
    }

    /// The path, if it is a file.
    pub(crate) fn path(&self) -> Option<&Path> {
        match self {
            Self::File(path) => Some(path),
            Self::Stream => None,
        }
    }

    /// Writes a film.
    pub(crate) fn write(
        &self,
        film: &Film,
        exposure: f64,
        provenance: &Provenance,
        packing: Packing,
    ) -> Result<(), Failure> {
        let pictures = Pictures { packing, ..Pictures::of_film(film, exposure, provenance) };
        pictures.write(std::slice::from_ref(self), None, [Ok(film)])
    }
}

/// The places for pictures, each checked.
pub(crate) fn checked(paths: &[PathBuf]) -> Result<Vec<Output>, Failure> {
    let outputs = paths.iter().map(|path| Output::new(path)).collect::<Result<Vec<_>, _>>()?;
    if outputs.iter().filter(|output| output.path().is_none()).count() > 1 {
        return Err(Failure::input("`-o -` is given twice: standard output holds one picture"));
    }
    Ok(outputs)
}

/// How a picture is put on disk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Packing {
    /// How an EXR is packed.
    pub(crate) compression: Compression,
    /// Whether to wait until the disk has it.
    pub(crate) durable: bool,
}

impl Packing {
    /// Small, and waited for.
    pub(crate) const CAREFUL: Self = Self { compression: Compression::Zip, durable: true };
}

/// Says early that a file cannot be written: its folder is missing or closed, or its name is a folder's.
pub(crate) fn check_place(path: &Path) -> Result<(), Failure> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    match folder {
        Some(folder) if !folder.is_dir() => {
            Err(Failure::Cannot(format!("{}: there is no folder {}", path.display(), folder.display())))
        }
        _ if path.is_dir() => Err(Failure::Cannot(format!("{}: is a folder: name a file", path.display()))),
        // What is begun and not committed is removed again.
        _ => AtomicFile::create(path)
            .map(drop)
            .map_err(|error| Failure::Cannot(format!("{}: cannot be written: {error}", path.display()))),
    }
}

/// Writes a film in the format of the name; EXR has a layer for everything that was reached.
pub(crate) fn write_film(path: &Path, film: &Film, exposure: f64, provenance: &Provenance) -> Result<(), Failure> {
    Output::File(path.to_owned()).write(film, exposure, provenance, Packing::CAREFUL)
}

/// What is known of a picture before its rows come.
pub(crate) struct Pictures<'a> {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// The parts that add up to the beauty.
    pub(crate) planes: Vec<Plane>,
    pub(crate) exposure: f64,
    pub(crate) provenance: &'a Provenance,
    pub(crate) packing: Packing,
}

/// A picture being written.
struct Sink {
    target: Target,
    shows: Shows,
}

enum Target {
    File(Box<PictureFile>),
    Stream(Box<HdrStream<BufWriter<StdoutLock<'static>>>>),
}

#[derive(Clone, Copy)]
enum Shows {
    Beauty,
    BeautyAndLayers,
    One(Plane),
}

impl<'a> Pictures<'a> {
    /// A film of which every plane is shown.
    pub(crate) fn of_film(film: &Film, exposure: f64, provenance: &'a Provenance) -> Self {
        let planes = film.planes().map(|(plane, _)| plane).collect();
        let (width, height) = (film.width(), film.height());
        Self { width, height, planes, exposure, provenance, packing: Packing::CAREFUL }
    }

    /// Writes a picture, whose rows come in bands from the top, to all `outputs` at once, and with `parts` each plane as a picture
    /// of its own into that folder, with that extension.
    pub(crate) fn write<F: Borrow<Film>>(
        &self,
        outputs: &[Output],
        parts: Option<(&Path, &str)>,
        bands: impl IntoIterator<Item = Result<F, Failure>>,
    ) -> Result<(), Failure> {
        let mut sinks = outputs.iter().map(|output| self.begin(output)).collect::<Result<Vec<_>, _>>()?;
        if let Some((folder, extension)) = parts {
            std::fs::create_dir_all(folder)
                .map_err(|error| Failure::Cannot(format!("--parts {}: {error}", folder.display())))?;
            for &plane in &self.planes {
                let path = folder.join(format!("{plane}.{extension}"));
                let file = PictureFile::create(&path, &self.header(Vec::new()))?;
                sinks.push(Sink { target: Target::File(Box::new(file)), shows: Shows::One(plane) });
            }
        }
        for band in bands {
            let band = band?;
            let band = band.borrow();
            for start in (0..band.height()).step_by(BAND_ROWS) {
                let rows = start..band.height().min(start + BAND_ROWS);
                let beauty = pixels(&band.develop_rows(ComponentSet::ALL, rows.clone()));
                sinks.iter_mut().try_for_each(|sink| self.put(sink, band, rows.clone(), &beauty))?;
            }
        }
        for Sink { target, .. } in sinks {
            match target {
                Target::File(file) => file.finish()?,
                Target::Stream(stream) => stream.finish()?,
            }
        }
        Ok(())
    }

    fn begin(&self, output: &Output) -> Result<Sink, Error> {
        Ok(match output {
            Output::File(path) if Format::of_name(path) == Some(Format::Exr) => {
                let names = self.planes.iter().map(ToString::to_string).collect();
                let file = PictureFile::create(path, &self.header(names))?;
                Sink { target: Target::File(Box::new(file)), shows: Shows::BeautyAndLayers }
            }
            Output::File(path) => {
                let file = PictureFile::create(path, &self.header(Vec::new()))?;
                Sink { target: Target::File(Box::new(file)), shows: Shows::Beauty }
            }
            Output::Stream => {
                let stdout = BufWriter::new(std::io::stdout().lock());
                let stream = HdrStream::start(stdout, &self.header(Vec::new()))?;
                Sink { target: Target::Stream(Box::new(stream)), shows: Shows::Beauty }
            }
        })
    }

    fn header(&self, layers: Vec<String>) -> Header {
        let (exposure, Packing { compression, durable }) = (self.exposure, self.packing);
        Header {
            layers,
            exposure,
            compression,
            durable,
            ..Header::new(self.width, self.height, self.provenance.clone())
        }
    }

    fn put(&self, sink: &mut Sink, band: &Film, rows: Range<usize>, beauty: &[Pixel]) -> Result<(), Error> {
        let range = rows.start * self.width..rows.end * self.width;
        // A plane that a band has not is black.
        let plane = |plane| match band.plane(plane) {
            Some(plane) => pixels(&plane.values()[range.clone()]),
            None => vec![[0.0; 3]; range.len()],
        };
        let layers: Vec<Vec<Pixel>> = match sink.shows {
            Shows::Beauty => Vec::new(),
            Shows::BeautyAndLayers => self.planes.iter().map(|&one| plane(one)).collect(),
            Shows::One(one) => vec![plane(one)],
        };
        let layers: Vec<&[Pixel]> = layers.iter().map(Vec::as_slice).collect();
        let rows = match sink.shows {
            Shows::One(_) => Band { beauty: layers[0], layers: &[] },
            _ => Band { beauty, layers: &layers },
        };
        match &mut sink.target {
            Target::File(file) => file.write(rows),
            Target::Stream(stream) => stream.write(rows),
        }
    }
}

fn pixels(values: &[Vec3]) -> Vec<Pixel> {
    values.iter().map(|value| value.to_array()).collect()
}

/// From here on an interruption (Ctrl-C) ends the program at once with exit code 130 and without traces: files are written beside
/// their names, and what is begun of them is removed.
pub(crate) fn clean_up_when_interrupted(paths: Vec<PathBuf>) {
    let result = ctrlc::set_handler(move || {
        for path in &paths {
            // Whatever has not been begun cannot be removed.
            let _ = std::fs::remove_file(AtomicFile::temporary(path));
        }
        std::process::exit(130);
    });
    // A second handler cannot be set, and there is only this one; without it an interruption just ends the program.
    drop(result);
}
