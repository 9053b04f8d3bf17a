//! rpict's spellings, good and bad.

use super::*;

/// A command with an option that takes a value, as `crex render` has.
fn own() -> clap::Command {
    clap::Command::new("render")
        .arg(clap::Arg::new("output").short('o').long("output").action(clap::ArgAction::Append))
        .arg(clap::Arg::new("threads").long("threads"))
        .arg(clap::Arg::new("json").long("json").action(clap::ArgAction::SetTrue))
}

fn read(text: &str) -> Result<(Vec<String>, RadianceOptions), String> {
    let words = ["crex", "render"].into_iter().chain(text.split(' ')).map(OsString::from).collect();
    let (left, options) = take(words, &own())?;
    Ok((left.into_iter().skip(2).map(|word| word.into_string().unwrap()).collect(), options))
}

#[test]
fn a_usual_rpict_command_line_is_taken() {
    let (left, options) = read(
        "-vtv -vp -1 -2.5 3e0 -vd 0 1 0 -vu 0 0 1 -vh 60 -vv 40 -vo 0.1 -va 9 -vs -.5 -vl .25 -x 640 -y 480 -pa 0 -ps 4 -pt .05 \
         -pj .67 -pd 0 -ab 2 -ad 512 -aa .2 -ar 64 -as 128 -av .1 .2 .3 -aw 0 -lr -12 -lw 1e-5 -st .15 -ss 16 -bv- -dv+ -dj 0.7 \
         -ds .15 -dt 0 -dc 1 -dr 2 -dp 4096 -i- -u+ -n 3 --json -o -out.hdr --threads -1 scene.rad -",
    )
    .unwrap();
    assert_eq!(left, ["--json", "-o", "-out.hdr", "--threads", "-1", "scene.rad", "-"]);
    assert_eq!((options.view.point, options.view.horizontal), ([-1.0, -2.5, 3.0], 60.0));
    assert_eq!((options.view.shift, options.view.lift), (-0.5, 0.25));
    assert_eq!((options.size, options.pixel_aspect, options.pixel_jitter), ([640, 480], 0.0, 0.67));
    assert_eq!((options.diffuse, options.diffuse_rays, options.ambient), (Some(2), 512, [0.1, 0.2, 0.3]));
    assert_eq!((options.reflections, options.least_weight), (-12, 1e-5));
    assert_eq!((options.glossy_threshold, options.glossy_rays), (0.15, 16.0));
    assert_eq!((options.lights_visible, options.relays, options.threads), (true, 2, Some(3)));
    // Some ask for what is not done; -pd 0, -aw 0, -dt 0, -dc 1 and -i- ask for what is.
    let told: Vec<&str> = options.without_effect.iter().filter_map(|text| text.split(' ').next()).collect();
    assert_eq!(told, ["-ps", "-pt", "-aa", "-ar", "-as", "-bv-", "-dj", "-ds", "-dp", "-u+"]);
}

#[test]
fn nothing_given_changes_nothing() {
    let (left, options) = read("scene.rad").unwrap();
    assert_eq!(left, ["scene.rad"]);
    assert_eq!(options, RadianceOptions::default());
}

#[test]
fn switches_are_read_as_rpict_reads_them() {
    for (text, on) in [("-dv", false), ("-dv+", true), ("-dv-", false), ("-dvy", true), ("-dv0", false), ("-dvT", true)]
    {
        assert_eq!(read(text).unwrap().1.lights_visible, on, "{text}");
    }
    assert_eq!(read("-i").unwrap().1.without_effect, ["-i changes nothing here: pictures hold radiance"]);
    assert!(read("-i-").unwrap().1.without_effect.is_empty());
}

#[test]
fn what_shapes_the_picture_is_kept_as_spelled() {
    let (_, options) = read("-ab 2 -vtv -n 4 -dt .05 -av 1 2 3").unwrap();
    assert_eq!(options.spelled, "-ab 2 -av 1 2 3");
}

#[test]
fn mistakes_are_told_with_advice() {
    for (text, words) in [
        ("-vp 1 2", "wants 3 values"),
        ("-vp 1 2 up", "`up`"),
        ("-vtq", "no projection"),
        ("-x 0", "`0`"),
        ("-x 1.5", "`1.5`"),
        ("-x -3", "`-3`"),
        ("-lw nan", "`nan`"),
        ("-av 1 -1 1", "negative"),
        ("-lw -1", "at least 0"),
        ("-abb 2", "did you mean `-ab`"),
        ("-threads 2", "did you mean `--threads`"),
        ("-q", "there is no option `-q`"),
        ("-vf /no/such/file.vf", "cannot be read"),
        ("@/no/such/file", "cannot be read"),
    ] {
        let error = read(text).unwrap_err();
        assert!(error.contains(words), "{text}: {error}");
    }
}

#[test]
fn options_files_stand_for_their_words() {
    let folder = tempfile::tempdir().unwrap();
    let (inner, outer, view) = (folder.path().join("inner"), folder.path().join("outer"), folder.path().join("a b.vf"));
    std::fs::write(&view, "rvu -vtv -vp 1 2 3\n").unwrap();
    std::fs::write(&inner, format!("-ab\n  7 -vf \"{}\"\n", view.display())).unwrap();
    std::fs::write(&outer, format!("-ad 3 @{} 'my scene.rad'", inner.display())).unwrap();
    let (left, options) = read(&format!("-ab 1 @{} -lr 4", outer.display())).unwrap();
    assert_eq!(left, ["my scene.rad"]);
    assert_eq!((options.diffuse, options.diffuse_rays, options.reflections), (Some(7), 3, 4));
    assert_eq!(options.view.point, [1.0, 2.0, 3.0]);
    std::fs::write(&inner, format!("@{}", inner.display())).unwrap();
    assert!(read(&format!("@{}", inner.display())).unwrap_err().contains("circle"));
    std::fs::write(&inner, "-vf \"a").unwrap();
    assert!(read(&format!("@{}", inner.display())).unwrap_err().contains("never ends"));
}

#[test]
fn everything_after_two_dashes_is_a_name() {
    assert_eq!(read("-ab 1 -- -vp @x").unwrap().0, ["--", "-vp", "@x"]);
}

#[test]
fn the_help_lists_every_option_once() {
    let text = crate::spellings::help();
    for spelling in SPELLINGS {
        let lines = text.lines().filter(|line| {
            line.trim_start().strip_prefix(spelling.name).is_some_and(|rest| rest.starts_with([' ', '[', 'L']))
        });
        assert_eq!(lines.count(), 1, "{}", spelling.name);
    }
}
