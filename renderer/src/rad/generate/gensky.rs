//! gensky(1): the CIE standard skies, and the sun. Zenith is z, east is x, north is y; radiance in W/(sr m2).

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use super::super::command::Word;
use super::super::document::Span;
use super::super::kind::Kind;
use super::super::number::real;
use super::super::statement::Draft;
use super::super::xform::BadWords;
use super::Output;
use super::arguments::Arguments;
use super::sun::{self, Site};

/// Lumens per watt of skylight and of sunlight (Radiance's color.h).
const SKY_EFFICACY: f64 = 203.0;
const SUN_EFFICACY: f64 = 208.0;

/// The sun's diameter, degrees; its solid angle over its radiance times the sine of its altitude is irradiance.
const SUN_DIAMETER_DEG: f64 = 0.5;
const SUN_SOLID_ANGLE: f64 = 5.98e-5;

/// Function file of the sky's brightness.
const BRIGHTNESS: &str = "skybright.cal";

/// The numbers by which the function file knows the skies.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sky {
    Clear = 1,
    Overcast = 2,
    Uniform = 3,
    Intermediate = 4,
}

/// How a brightness is given.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Given {
    Computed,
    Radiance(f64),
    /// On the horizontal.
    Irradiance(f64),
}

struct Request {
    /// Of the sun, radians.
    altitude: f64,
    azimuth: f64,
    sky: Sky,
    sun: bool,
    zenith: Given,
    solar: Given,
    turbidity: f64,
    ground_reflectance: f64,
}

/// `gensky month day time [options]` or `gensky -ang altitude azimuth [options]`
pub(super) fn run(words: &[Word], span: Span) -> Result<Vec<Draft>, BadWords> {
    let request = request(words)?;
    let overcast = matches!(request.sky, Sky::Overcast | Sky::Uniform);
    // The skies' formulas fail with the sun at the zenith.
    let altitude = if overcast { request.altitude } else { request.altitude.min(87_f64.to_radians()) };
    let (sin, cos) = altitude.sin_cos();
    let sun = [-request.azimuth.sin() * cos, -request.azimuth.cos() * cos, sin];
    let (normalization, level) = match request.sky {
        Sky::Uniform => (0.0, 1.0),
        Sky::Overcast => (0.0, 0.777_778),
        Sky::Clear => {
            let at_zenith = 0.274 * (0.91 + 10.0 * (-3.0 * (FRAC_PI_2 - altitude)).exp() + 0.45 * sin * sin);
            (at_zenith, horizontal(altitude, request.sky) / at_zenith / PI)
        }
        Sky::Intermediate => {
            let at_zenith = (2.739 + 0.9891 * (0.3119 + 2.6 * altitude).sin())
                * (-(FRAC_PI_2 - altitude) * (0.4441 + 1.48 * altitude)).exp();
            (at_zenith, horizontal(altitude, request.sky) / at_zenith / PI)
        }
    };
    let zenith = match request.zenith {
        Given::Radiance(radiance) => radiance,
        Given::Irradiance(irradiance) => irradiance / (level * PI),
        Given::Computed => {
            let cloudy = 8.6 * sin + 0.123;
            let clear = (1.376 * request.turbidity - 1.81) * altitude.tan() + 0.38;
            let kilo_luminance = match request.sky {
                Sky::Overcast | Sky::Uniform => cloudy,
                Sky::Clear => clear,
                Sky::Intermediate => (clear + cloudy) / 2.0,
            };
            kilo_luminance.max(0.0) * 1000.0 / SKY_EFFICACY
        }
    };
    let mut ground = zenith * level;
    let mut solar = None;
    let shines = match request.solar {
        Given::Computed => true,
        Given::Radiance(value) | Given::Irradiance(value) => value > 0.0,
    };
    if !overcast && sin > 0.0 && shines {
        let radiance = match request.solar {
            Given::Radiance(radiance) => radiance,
            Given::Irradiance(irradiance) => irradiance / (SUN_SOLID_ANGLE * sin),
            Given::Computed => {
                let clear = 1.5e9 / SUN_EFFICACY * (1.147 - 0.147 / sin.max(0.16));
                // Haze: a rule of thumb of the program.
                if request.sky == Sky::Intermediate { 0.15 * clear } else { clear }
            }
        };
        ground += 6e-5 / PI * radiance * sin;
        solar = request.sun.then_some(radiance);
    }
    ground *= request.ground_reflectance;
    let mut out = Output::new("void", "", span);
    if let Some(radiance) = solar {
        out.named("void", Kind::Light, "solar", &[], vec![radiance; 3]);
        out.named("solar", Kind::Source, "sun", &[], vec![sun[0], sun[1], sun[2], SUN_DIAMETER_DEG]);
    }
    let mut reals = vec![f64::from(request.sky as u8), zenith, ground];
    if !overcast {
        reals.extend([normalization, sun[0], sun[1], sun[2]]);
    }
    out.named("void", Kind::Brightfunc, "skyfunc", &["skybr", BRIGHTNESS], reals);
    out.finish()
}

/// Horizontal irradiance over zenith radiance times normalization: a fit to the integral over the sky, in the sun's
/// altitude.
fn horizontal(altitude: f64, sky: Sky) -> f64 {
    let coefficients = match sky {
        Sky::Intermediate => [3.5556, -2.7152, -1.3081, 1.0660, 0.60227],
        _ => [2.766521, 0.547665, -0.369832, 0.009237, 0.059229],
    };
    let x = (altitude - FRAC_PI_4) / FRAC_PI_4;
    coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient)
}

/// When the sun is asked for.
enum Moment {
    Angles { altitude: f64, azimuth: f64 },
    Date { month: usize, day: usize, hour: f64, solar: bool },
}

fn request(words: &[Word]) -> Result<Request, BadWords> {
    let mut arguments = Arguments::new(words);
    let mut site = Site::default();
    let mut zoned = false;
    let moment = if words.first().is_some_and(|word| word.text == "-ang") {
        arguments.next();
        let altitude = arguments.real("the sun's altitude in degrees")?.to_radians();
        let azimuth = arguments.real("the sun's azimuth in degrees west of south")?.to_radians();
        Moment::Angles { altitude, azimuth }
    } else {
        let month = arguments.count("the month", 1, 12)?;
        let day = arguments.count("the day", 1, 31)?;
        let time = time(arguments.word("the time")?)?;
        if let Some(zone) = time.zone_deg {
            (site.meridian, zoned) = (zone.to_radians(), true);
        }
        Moment::Date { month, day, hour: time.hour, solar: time.solar }
    };
    let mut year = None;
    let mut request = Request {
        altitude: 0.0,
        azimuth: 0.0,
        sky: Sky::Clear,
        sun: true,
        zenith: Given::Computed,
        solar: Given::Computed,
        turbidity: 2.45,
        ground_reflectance: 0.2,
    };
    while let Some(option) = arguments.next() {
        match option.text.as_str() {
            "-s" | "+s" => (request.sky, request.sun) = (Sky::Clear, option.text == "+s"),
            "-i" | "+i" => (request.sky, request.sun) = (Sky::Intermediate, option.text == "+i"),
            "-c" => request.sky = Sky::Overcast,
            "-u" => request.sky = Sky::Uniform,
            "-y" => year = Some(arguments.count("the year", 1950, 2050)? as i64),
            "-g" => request.ground_reflectance = arguments.real("the ground's reflectance")?,
            "-b" => request.zenith = Given::Radiance(arguments.real("the zenith's radiance")?),
            "-B" => request.zenith = Given::Irradiance(arguments.real("the sky's horizontal irradiance")?),
            "-r" => request.solar = Given::Radiance(arguments.real("the sun's radiance")?),
            "-R" => request.solar = Given::Irradiance(arguments.real("the sun's horizontal irradiance")?),
            "-t" => request.turbidity = arguments.real("the turbidity")?,
            "-a" => site.latitude = arguments.real("the latitude in degrees north")?.to_radians(),
            "-o" => site.longitude = arguments.real("the longitude in degrees west")?.to_radians(),
            "-m" => {
                let meridian = arguments.real("the standard meridian in degrees west")?.to_radians();
                if !zoned {
                    site.meridian = meridian;
                }
            }
            _ => return Err(arguments.unknown("-s +s -i +i -c -u -y -g -b -B -r -R -t -a -o -m")),
        }
    }
    (request.altitude, request.azimuth) = match moment {
        Moment::Angles { altitude, azimuth } => (altitude, azimuth),
        Moment::Date { month, day, hour, solar } => {
            let of_year = sun::day_of_year(month, day);
            let (declination, local) = match year {
                Some(year) => sun::almanac(year, month, day, hour, &site),
                None => (sun::declination(of_year), hour + sun::solar_time_offset(of_year, &site)),
            };
            sun::position(declination, if solar { hour } else { local }, &site)
        }
    };
    Ok(request)
}

struct Time {
    hour: f64,
    /// `+`: by the sun, not by a clock.
    solar: bool,
    /// Standard meridian of a time zone, degrees west.
    zone_deg: Option<f64>,
}

/// `[+]hours`, `[+]hours:minutes`, a time zone appended.
fn time(word: &Word) -> Result<Time, BadWords> {
    let bad = || {
        let message = format!("expected a time like 14, 14.5, 14:30, 14:30CET or +14:30, found `{}`", word.text);
        BadWords::at(Some(word), message)
    };
    let solar = word.text.starts_with('+');
    let text = word.text.strip_prefix('+').unwrap_or(&word.text);
    let digits =
        text.len() - text.trim_start_matches(|letter: char| letter.is_ascii_digit() || ":.".contains(letter)).len();
    let (clock, zone) = text.split_at(digits);
    let hour = match clock.split_once(':') {
        Some((hours, minutes)) => {
            let minutes = if minutes.is_empty() { 0.0 } else { real(minutes).map_err(|_| bad())? };
            real(hours).map_err(|_| bad())? + minutes / 60.0
        }
        None => real(clock).map_err(|_| bad())?,
    };
    let zone_deg = match zone {
        "" => None,
        _ if solar => return Err(bad()),
        zone => Some(zone_meridian(zone).ok_or_else(|| {
            let message = format!("`{zone}` is no known time zone: give the standard meridian with -m");
            BadWords::at(Some(word), message)
        })?),
    };
    Ok(Time { hour, solar, zone_deg })
}

/// Degrees west of a time zone's meridian (gensky(1)). Where two zones share letters, America's is meant.
fn zone_meridian(zone: &str) -> Option<f64> {
    const ZONES: [(&str, f64); 28] = [
        ("YST", 135.0),
        ("YDT", 120.0),
        ("PST", 120.0),
        ("PDT", 105.0),
        ("MST", 105.0),
        ("MDT", 90.0),
        ("CST", 90.0),
        ("CDT", 75.0),
        ("EST", 75.0),
        ("EDT", 60.0),
        ("AST", 60.0),
        ("ADT", 45.0),
        ("NST", 52.5),
        ("NDT", 37.5),
        ("GMT", 0.0),
        ("BST", -15.0),
        ("CET", -15.0),
        ("CEST", -30.0),
        ("EET", -30.0),
        ("EEST", -45.0),
        ("GST", -60.0),
        ("GDT", -75.0),
        ("IST", -82.5),
        ("IDT", -97.5),
        ("JST", -135.0),
        ("JDT", -150.0),
        ("NZST", -180.0),
        ("NZDT", -195.0),
    ];
    ZONES.iter().find(|(name, _)| name.eq_ignore_ascii_case(zone)).map(|&(_, meridian)| meridian)
}
