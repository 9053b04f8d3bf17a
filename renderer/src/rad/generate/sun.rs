//! Where the sun stands.

use std::f64::consts::{PI, TAU};

/// A place on Earth and the clock that is used there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Site {
    /// Radians north of the equator.
    pub(super) latitude: f64,
    /// Radians west of Greenwich.
    pub(super) longitude: f64,
    /// Radians west of Greenwich of the meridian whose solar time the clock shows.
    pub(super) meridian: f64,
}

impl Default for Site {
    /// gensky's: near San Francisco.
    fn default() -> Self {
        Self { latitude: 0.66, longitude: 2.13, meridian: 120_f64.to_radians() }
    }
}

/// Days into a year without a leap day, from 1.
pub(super) fn day_of_year(month: usize, day: usize) -> f64 {
    const BEFORE: [usize; 12] = [0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334];
    (BEFORE[(month - 1) % 12] + day) as f64
}

/// Hours to add to the clock for solar time (the equation of time of the IES Lighting Handbook).
pub(super) fn solar_time_offset(day: f64, site: &Site) -> f64 {
    0.170 * (4.0 * PI / 373.0 * (day - 80.0)).sin() - 0.129 * (2.0 * PI / 355.0 * (day - 8.0)).sin()
        + 12.0 / PI * (site.meridian - site.longitude)
}

/// Declination in radians, by the day of the year.
pub(super) fn declination(day: f64) -> f64 {
    0.4093 * (TAU / 365.0 * (day - 81.0)).sin()
}

/// Declination in radians and solar time in hours, for the years 1950 to 2050 (Michalsky, Solar Energy 40(3), 1988).
/// `hour` is the clock's; where it shows solar time already, the time that is returned means nothing.
pub(super) fn almanac(year: i64, month: usize, day: usize, hour: f64, site: &Site) -> (f64, f64) {
    let leap = if month > 2 && year % 4 == 0 { 1.0 } else { 0.0 };
    let years = (year - 1949) as f64;
    let days = day_of_year(month, day) + leap + years * 365.0 + (years / 4.0).trunc();
    // Days since noon of 1 January 2000, Greenwich.
    let since = days + (hour + site.meridian * 12.0 / PI) / 24.0 + (2_432_916.5 - 2_451_545.0);
    let degrees = |constant: f64, daily: f64| (constant + daily * since).to_radians().rem_euclid(TAU);
    let anomaly = degrees(357.528, 0.985_600_3);
    let longitude = degrees(280.460, 0.985_647_4)
        + 1.915_f64.to_radians() * anomaly.sin()
        + 0.020_f64.to_radians() * (2.0 * anomaly).sin();
    let obliquity = (23.439 - 4e-7 * since).to_radians();
    let ascension = (longitude.sin() * obliquity.cos()).atan2(longitude.cos());
    let universal = 24.0 * (since - since.floor()) + 12.0;
    let greenwich = 6.697_375 + 0.065_709_824_2 * since + universal;
    let local = greenwich - site.longitude * 12.0 / PI;
    let solar = (local - ascension * 12.0 / PI + 12.0).rem_euclid(24.0);
    ((obliquity.sin() * longitude.sin()).asin(), solar)
}

/// Altitude above the horizon and azimuth west of south, radians, at a solar time in hours.
pub(super) fn position(declination: f64, solar_time: f64, site: &Site) -> (f64, f64) {
    let (sin_lat, cos_lat) = site.latitude.sin_cos();
    let (sin_dec, cos_dec) = declination.sin_cos();
    let (sin_hour, cos_hour) = (solar_time * PI / 12.0).sin_cos();
    let altitude = (sin_lat * sin_dec - cos_lat * cos_dec * cos_hour).asin();
    let azimuth = -(cos_dec * sin_hour).atan2(-cos_lat * sin_dec - sin_lat * cos_dec * cos_hour);
    (altitude, azimuth)
}
