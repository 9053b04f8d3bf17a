#!/usr/bin/env bash
# Prints, for four scenes, what HQ, CBQ and SEL cost in one run and what people would see of the difference.
# usage: [CREX=PROGRAM] docs/selective.sh [WIDTH [SPP]]     640 pixels across and 8 samples unless told; builds target/release/crex
#        unless a program is given
#
# Times are CPU seconds (user + system) on one thread. A picture of any width fills the paper's display: 17 inches at
# 60 cm. JOD by ColorVideoVDP and FLIP against HQ, over the picture and over the fovea about the task objects; the last
# column is HQ against HQ of another seed: HQ's own noise, twice.
set -euo pipefail
cd "$(dirname "$0")/.."
width=${1:-640} spp=${2:-8}
crex=${CREX:-target/release/crex}
[ -n "${CREX:-}" ] || cargo build --quiet --release --package renderer --bin crex
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
TIMEFORMAT='%U %S'
printf 'peak_cd_m2 = 250\nblack_cd_m2 = 0.5\nambient_lux = 50\nwidth_px = %d\nheight_px = %d\nwidth_m = 0.3372\ndistance_m = 0.6\n' \
    "$width" $((width * 4 / 5)) >"$dir/display.toml"

# CPU seconds of a rendering: timed NAME WORDS...
timed() {
    local name=$1
    shift
    { time "$crex" render "${scene[@]}" --spp "$spp" --threads 1 -o "$dir/$name.exr" "$@" >/dev/null 2>&1; } 2>&1 |
        awk '{ print $1 + $2 }'
}

# The row of a quality: name, seconds, percent of HQ's, mean / HQ's, JOD and FLIP overall, JOD and FLIP in the fovea.
row() {
    "$crex" compare "$dir/hq.exr" "$dir/$2.exr" --display "$dir/display.toml" --map "$dir/map.png" |
        awk -v scene="$1" -v name="$2" -v seconds="$3" -v hq="$4" '
            /^mean ratio/ { mean = $3 }
            /^FLIP/ { flip[n++] = $2 }
            /^JOD/ { jod[m++] = $2 }
            END { printf "%-10s %-4s %7.2f s %5.1f %%  mean %.3f  JOD loss %.3f FLIP %.4f  fovea: JOD loss %.3f FLIP %.4f\n",
                  scene, name, seconds, 100 * seconds / hq, mean, 10 - jod[0], flip[0], 10 - jod[1], flip[1] }'
}

# judge NAME TASK-OBJECTS
judge() {
    "$crex" importance "${scene[@]}" --task "$2" -o "$dir/map.png" 2>/dev/null
    local hq cbq sel again
    hq=$(timed hq --crex '(TRSGMD)*' -ad 6 --seed 1)
    cbq=$(timed cbq --crex 'T{RSGM}' --importance "$dir/map.png" --seed 1)
    sel=$(timed sel --crex '(TRSGM{D})*' -ad 6 --thresholds 1 --importance "$dir/map.png" --seed 1)
    again=$(timed again --crex '(TRSGMD)*' -ad 6 --seed 2)
    row "$1" hq "$hq" "$hq"
    row "$1" cbq "$cbq" "$hq"
    row "$1" sel "$sel" "$hq"
    row "$1" again "$again" "$hq"
}

at=stimuli/corridor
limits=(-lr -12 -lw .2 -x "$width" -y "$width")
items='extinguisher.*,hose_reel.*,blanket.*,call_point.*,exit_sign.*,hydrant_sign.*,detector.*,sprinkler.*'
for layout in a b; do
    # The layout's ambient value, from the study file.
    av=$(awk -v id="id = \"$layout\"" '$0 == id { on = 1 } on && /^ambient/ { gsub(/[^0-9. ]/, ""); print; exit }' $at/study.toml)
    # shellcheck disable=SC2206
    scene=($at/materials.rad $at/shell.rad $at/layout_$layout.rad -vf $at/corridor.vf "${limits[@]}" -av $av)
    judge "corridor $layout" "$items"
done
# Fitted by the example fit_ambient, as the corridor's.
scene=(stimuli/cornell/cornell.rad -vf stimuli/cornell/cornell.vf "${limits[@]}" -av .2533 .2147 .1171)
judge cornell ball,crystal_ball
scene=(tests/data/scenes/room_a.rad -vf tests/data/scenes/room_a.vf "${limits[@]}" -av .3289 .2848 .1992)
judge room_a s_plas,s_met,d_ball
