#!/usr/bin/env bash
# Makes the counterparts of the paper's Figures 1 to 5, on this project's Cornell box and corridor.
# usage: docs/figures.sh [FIGURE...]     all of 1 2 3 4 5 unless told; pictures go to docs/pictures/
set -euo pipefail
cd "$(dirname "$0")/.."
out=docs/pictures
mkdir -p "$out"
crex() { if [ -n "${CREX:-}" ]; then "$CREX" "$@"; else cargo run --quiet --release --package renderer --bin crex -- "$@"; fi; }
box=(stimuli/cornell/cornell.rad -vf stimuli/cornell/cornell.vf -x 320 -y 320 -lr -8 -lw .1)

figure_1() { # the components of one picture, each for itself, and the full solution
    crex render "${box[@]}" --crex '(TRSGMD)*' --spp 32 -o "$out/figure1.png" --parts "$out/figure1"
}

figure_2() { # what a crex leaves out
    crex render "${box[@]}" --crex 'T*' --spp 32 -o "$out/figure2_T.png"
    crex render "${box[@]}" --crex '(TRS)*' --spp 32 -o "$out/figure2_TRS.png"
    crex render "${box[@]}" --crex '(TD)*' --spp 32 -o "$out/figure2_TD.png"
    crex render "${box[@]}" --crex '(TRSGD)*' --spp 32 -o "$out/figure2_TRSGD.png"
}

figure_3() { # one bounce of everything, two, and all
    crex render "${box[@]}" --crex '<MRSGD>T*' --spp 32 -o "$out/figure3_once.png"
    crex render "${box[@]}" --crex '(<MRSGD>T*)2' --spp 32 -o "$out/figure3_twice.png"
    crex render "${box[@]}" --crex '(<MRSGD>T*)*' --spp 32 -o "$out/figure3_all.png"
}

at=stimuli/corridor
corridor=("$at/materials.rad" "$at/shell.rad" "$at/layout_a.rad" -vf "$at/corridor.vf" -x 640 -y 512)
items='extinguisher.*,hose_reel.*,blanket.*,call_point.*,exit_sign.*,hydrant_sign.*,detector.*,sprinkler.*'

figure_4() { # the corridor of the experiment: full solution, component-based qualities, and where people see the difference
    # Half the study's size and more; its own pictures are those of `cargo stimuli`.
    local size=(-x 480 -y 384 --spp 8 --seed 1 -lr -12 -lw .2 -av .3213 .2833 .2225)
    local map; map=$(mktemp --suffix .exr)
    local display; display=$(mktemp --suffix .toml)
    sed 's/1280/480/; s/1024/384/' docs/display.toml >"$display"
    crex importance "${corridor[@]}" -x 480 -y 384 --task "$items" -o "$map"
    crex render "${corridor[@]}" "${size[@]}" --crex '(TRSGMD)*' -ad 6 -o "$out/figure4_hq.png"
    crex render "${corridor[@]}" "${size[@]}" --crex 'T{RSGM}' --importance "$map" -o "$out/figure4_cbq.png"
    crex render "${corridor[@]}" "${size[@]}" --crex '(TRSGM{D})*' -ad 6 --importance "$map" --thresholds 1 -o "$out/figure4_sel.png"
    for quality in cbq sel; do
        crex compare "$out/figure4_hq.png" "$out/figure4_$quality.png" --display "$display" --map "$map" \
            --difference "$out/figure4_${quality}_differs.png"
    done
    rm "$map" "$display"
}

figure_5() { # the task objects, the map with the fovea's gradient, what ran where for T{RSGM}, and the map over the picture
    # A pixel a million degrees wide: nothing beyond the objects themselves matters.
    crex importance "${corridor[@]}" --task "$items" --fovea 0 --px-per-deg .000001 --bits 8 -o "$out/figure5_task.png"
    crex importance "${corridor[@]}" --task "$items" --bits 8 -o "$out/figure5_fovea.png" --overlay "$out/figure5_overlay.png"
    crex importance "${corridor[@]}" --saliency --bits 8 -o "$out/figure5_saliency.png"
    crex render "${corridor[@]}" --crex 'T{RSGM}' --importance "$out/figure5_fovea.png" \
        --ran "$out/figure5_ran.png" -o "$out/figure5_picture.png"
    rm "$out/figure5_picture.png"
}

for figure in "${@:-1 2 3 4 5}"; do
    for number in $figure; do "figure_$number"; done
done
