//! A real window on a screen of its own.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use x11rb::connection::Connection;
use x11rb::protocol::xproto::{AtomEnum, ConnectionExt, CreateWindowAux, ImageFormat, InputFocus, WindowClass};
use x11rb::rust_connection::RustConnection;

/// Ends its process with itself.
pub(crate) struct Kept(pub(crate) Child);

impl Drop for Kept {
    fn drop(&mut self) {
        let _gone = self.0.kill();
        let _status = self.0.wait();
    }
}

/// A window that is there before its manager gets no keyboard: waits until the manager has said that it manages.
fn wait_for_manager(display: &str) {
    let (connection, screen) = RustConnection::connect(Some(display)).unwrap();
    let root = connection.setup().roots[screen].root;
    let name = connection.intern_atom(false, b"_NET_SUPPORTING_WM_CHECK").unwrap().reply().unwrap().atom;
    for _ in 0..600 {
        let asked = connection.get_property(false, root, name, AtomEnum::WINDOW, 0, 1).unwrap();
        if asked.reply().unwrap().length > 0 {
            return;
        }
        std::thread::sleep(Duration::from_millis(100));
    }
    panic!("the window manager does not come up");
}

/// An X server with a window manager; without one a window cannot fill the screen.
pub(crate) struct Screen {
    pub(crate) name: String,
    _manager: Kept,
    _server: Kept,
}

impl Screen {
    pub(crate) fn new(size: &str) -> Self {
        // The server finds a free number and tells it.
        let mut server = Command::new("Xvfb");
        server.args(["-displayfd", "1", "-screen", "0", &format!("{size}x24"), "-nolisten", "tcp"]);
        let mut server = Kept(server.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap());
        let mut line = String::new();
        BufReader::new(server.0.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let name = format!(":{}", line.trim());
        let mut manager = Command::new("openbox");
        manager.env("DISPLAY", &name).stdout(Stdio::null()).stderr(Stdio::null());
        let manager = Kept(manager.spawn().unwrap());
        wait_for_manager(&name);
        Self { name, _manager: manager, _server: server }
    }

    /// A session with a person.
    pub(crate) fn session(&self, study: &Path, data: &Path) -> Kept {
        self.program(study, data, &["--participant", "P01"])
    }

    /// The program with other arguments.
    pub(crate) fn program(&self, study: &Path, data: &Path, arguments: &[&str]) -> Kept {
        self.scaled("1", study, data, arguments)
    }

    /// The program where the system asks for another scale.
    pub(crate) fn scaled(&self, scale: &str, study: &Path, data: &Path, arguments: &[&str]) -> Kept {
        let mut program = Command::new(env!("CARGO_BIN_EXE_crex-session"));
        program.arg(study).args(arguments).arg("--data").arg(data).stdout(Stdio::null());
        program.env("DISPLAY", &self.name).env_remove("WAYLAND_DISPLAY").stderr(Stdio::piped());
        program.env("WINIT_X11_SCALE_FACTOR", scale);
        Kept(program.spawn().unwrap())
    }

    pub(crate) fn xdotool(&self, arguments: &[&str]) {
        let mut command = Command::new("xdotool");
        assert!(command.env("DISPLAY", &self.name).args(arguments).status().unwrap().success());
    }

    pub(crate) fn key(&self, key: &str) {
        self.xdotool(&["key", key]);
    }

    /// Everything that is on the screen: red, green, blue for each pixel, row 0 at the top.
    pub(crate) fn capture(&self) -> image::RgbImage {
        let (connection, screen) = RustConnection::connect(Some(&self.name)).unwrap();
        let root = connection.setup().roots[screen].clone();
        let (width, height) = (root.width_in_pixels, root.height_in_pixels);
        let asked = connection.get_image(ImageFormat::Z_PIXMAP, root.root, 0, 0, width, height, !0).unwrap();
        let data = asked.reply().unwrap().data; // blue, green, red, nothing
        image::RgbImage::from_fn(width.into(), height.into(), |x, y| {
            let at = 4 * (y as usize * usize::from(width) + x as usize);
            image::Rgb([data[at + 2], data[at + 1], data[at]])
        })
    }

    /// Another window takes the keyboard for a moment, and gives it back.
    pub(crate) fn steal_focus(&self) {
        let (connection, screen) = RustConnection::connect(Some(&self.name)).unwrap();
        let root = &connection.setup().roots[screen];
        let before = connection.get_input_focus().unwrap().reply().unwrap().focus;
        let window = connection.generate_id().unwrap();
        let unmanaged = CreateWindowAux::new().override_redirect(1);
        let (class, visual) = (WindowClass::INPUT_OUTPUT, root.root_visual);
        connection.create_window(root.root_depth, window, root.root, 0, 0, 8, 8, 0, class, visual, &unmanaged).unwrap();
        connection.map_window(window).unwrap();
        connection.set_input_focus(InputFocus::NONE, window, x11rb::CURRENT_TIME).unwrap();
        connection.flush().unwrap();
        std::thread::sleep(Duration::from_millis(150));
        connection.set_input_focus(InputFocus::PARENT, before, x11rb::CURRENT_TIME).unwrap();
        connection.flush().unwrap();
        std::thread::sleep(Duration::from_millis(50));
    }
}
