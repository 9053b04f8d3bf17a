//! From a film to picture files, and what an interruption leaves of them.

use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use glam::Vec3;
use renderer::component::Component;
use renderer::film::Film;
use renderer::picture::{
    AtomicFile, Band, Compression, Error, Format, HdrStream, Header, PictureFile, Pixel, Provenance,
};
use renderer::raster::Raster;

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
        check_folder(path)?;
        Ok(Self::File(path.to_owned()))
    }

    /// The path, if it is a file.
    pub(crate) fn path(&self) -> Option<&Path> {
        match self {
            Self::File(path) => Some(path),
            Self::Stream => None,
        }
    }

    /// Writes a film; an EXR is packed by `compression`.
    pub(crate) fn write(
        &self,
        film: &Film,
        exposure: f64,
        provenance: &Provenance,
        compression: Compression,
    ) -> Result<(), Failure> {
        match self {
            Self::File(path) => pack_film(path, film, exposure, provenance, compression).map_err(Failure::from),
            Self::Stream => {
                let header = header(film, exposure, provenance);
                let stdout = BufWriter::new(std::io::stdout().lock());
                stream(stdout, &header, film).map_err(Failure::from)
            }
        }
    }
}

/// Says early that a file's folder is missing or is none.
pub(crate) fn check_folder(path: &Path) -> Result<(), Failure> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    match folder {
        Some(folder) if !folder.is_dir() => {
            Err(Failure::Cannot(format!("{}: there is no folder {}", path.display(), folder.display())))
        }
        _ => Ok(()),
    }
}

/// Writes a film in the format of the name; EXR has a layer for everything that was reached.
pub(crate) fn write_film(path: &Path, film: &Film, exposure: f64, provenance: &Provenance) -> Result<(), Error> {
    pack_film(path, film, exposure, provenance, Compression::Zip)
}

fn pack_film(
    path: &Path,
    film: &Film,
    exposure: f64,
    provenance: &Provenance,
    compression: Compression,
) -> Result<(), Error> {
    let mut header = header(film, exposure, provenance);
    let layers: Vec<(String, &Raster<Vec3>)> = match Format::of_name(path) {
        Some(Format::Exr) => layers(film),
        _ => Vec::new(),
    };
    header.layers = layers.iter().map(|(name, _)| name.clone()).collect();
    header.compression = compression;
    let mut file = PictureFile::create(path, &header)?;
    for (rows, beauty) in bands(&film.beauty()) {
        let planes: Vec<Vec<Pixel>> = layers.iter().map(|(_, plane)| pixels(&plane.values()[rows.clone()])).collect();
        let planes: Vec<&[Pixel]> = planes.iter().map(Vec::as_slice).collect();
        file.write(Band { beauty: &beauty, layers: &planes })?;
    }
    file.finish()
}

/// Writes each part that adds up to the film, `direct`, `D`, `S` and so on, as a picture of its own into a folder.
pub(crate) fn write_parts(
    folder: &Path,
    extension: &str,
    film: &Film,
    exposure: f64,
    provenance: &Provenance,
) -> Result<(), Failure> {
    std::fs::create_dir_all(folder)
        .map_err(|error| Failure::Cannot(format!("--parts {}: {error}", folder.display())))?;
    for (name, part) in layers(film) {
        let mut file =
            PictureFile::create(&folder.join(format!("{name}.{extension}")), &header(film, exposure, provenance))?;
        for (_, pixels) in bands(part) {
            file.write(Band { beauty: &pixels, layers: &[] })?;
        }
        file.finish()?;
    }
    Ok(())
}

fn stream(stdout: impl Write, header: &Header, film: &Film) -> Result<(), Error> {
    let mut stream = HdrStream::start(stdout, header)?;
    for (_, beauty) in bands(&film.beauty()) {
        stream.write(Band { beauty: &beauty, layers: &[] })?;
    }
    stream.finish()
}

fn header(film: &Film, exposure: f64, provenance: &Provenance) -> Header {
    let mut header = Header::new(film.width(), film.height(), provenance.clone());
    header.exposure = exposure;
    header
}

/// The parts that add up to the beauty.
fn layers(film: &Film) -> Vec<(String, &Raster<Vec3>)> {
    let components = Component::ALL.into_iter();
    let components = components.filter_map(|component| Some((component.to_string(), film.layer(component)?)));
    let ambient = film.ambient().map(|plane| ("ambient".to_owned(), plane));
    std::iter::once(("direct".to_owned(), film.direct())).chain(components).chain(ambient).collect()
}

/// Some rows at a time, with the places of their values.
fn bands(raster: &Raster<Vec3>) -> impl Iterator<Item = (std::ops::Range<usize>, Vec<Pixel>)> {
    let (all, step) = (raster.values().len(), raster.width() * BAND_ROWS);
    (0..all).step_by(step).map(move |start| {
        let range = start..all.min(start + step);
        (range.clone(), pixels(&raster.values()[range]))
    })
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
