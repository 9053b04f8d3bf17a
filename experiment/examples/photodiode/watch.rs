//! The observer: asks the X server for one pixel again and again and notes when it turns white and when it turns grey.

use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use experiment::draw::Draws;
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{ConnectionExt, ImageFormat};

/// What was seen: pictures coming and going.
#[derive(Default)]
pub(crate) struct Seen {
    /// When a picture was first seen, microseconds since the start of 1970.
    pub(crate) on_us: Vec<f64>,
    /// When it was gone.
    pub(crate) off_us: Vec<f64>,
    /// Which intervals were stalled, from 0.
    pub(crate) stalled: Vec<usize>,
    /// Mean time between two looks, milliseconds.
    pub(crate) look_ms: f64,
}

/// Stops the session for a while within every second interval.
pub(crate) struct Stalls {
    pub(crate) pid: u32,
    pub(crate) seed: u64,
    pub(crate) seconds: f64,
}

impl Stalls {
    /// From 60 ms, well over two frames of 1/60 s, to 300 ms, at a random moment that leaves the interval's end alone.
    fn inject(&self, draws: &mut Draws) {
        let stall_s = 0.06 + 0.24 * draws.unit();
        let wait_s = 0.1 + (self.seconds - stall_s - 0.4).max(0.0) * draws.unit();
        let pid = self.pid.to_string();
        std::thread::spawn(move || {
            let signal = |name: &str| Command::new("kill").args([name, &pid]).status();
            std::thread::sleep(Duration::from_secs_f64(wait_s));
            let _stopped = signal("-STOP");
            std::thread::sleep(Duration::from_secs_f64(stall_s));
            let _goes_on = signal("-CONT");
        });
    }
}

/// Watches until told to stop.
pub(crate) fn watch(display: &str, stop: &AtomicBool, stalls: Option<Stalls>) -> crate::Result<Seen> {
    let (connection, screen) = x11rb::rust_connection::RustConnection::connect(Some(display))?;
    let root = connection.setup().roots[screen].root;
    let mut draws = Draws::new(stalls.as_ref().map_or(0, |stalls| stalls.seed), "stalls");
    let anchor = (Instant::now(), SystemTime::now().duration_since(UNIX_EPOCH)?.as_secs_f64() * 1e6);
    let unix_us = |at: Instant| anchor.1 + at.duration_since(anchor.0).as_secs_f64() * 1e6;
    let (mut seen, mut looks) = (Seen::default(), 0_u32);
    let (mut white, mut before) = (false, anchor.0);
    while !stop.load(Ordering::Relaxed) {
        let asked = Instant::now();
        // The server may be gone a moment before the session is known to be over.
        let Ok(image) = connection.get_image(ImageFormat::Z_PIXMAP, root, 16, 16, 1, 1, !0)?.reply() else { break };
        let now = asked + asked.elapsed() / 2;
        let is_white = image.data.first().is_some_and(|&value| value > 200);
        if is_white != white {
            // It changed between the last look and this one.
            let at = unix_us(before + now.duration_since(before) / 2);
            if is_white {
                if let (Some(stalls), 1) = (&stalls, seen.on_us.len() % 2) {
                    seen.stalled.push(seen.on_us.len());
                    stalls.inject(&mut draws);
                }
                seen.on_us.push(at);
            } else {
                seen.off_us.push(at);
            }
            white = is_white;
        }
        before = now;
        looks += 1;
        std::thread::sleep(Duration::from_micros(200));
    }
    seen.look_ms = anchor.0.elapsed().as_secs_f64() * 1e3 / f64::from(looks.max(1));
    Ok(seen)
}
