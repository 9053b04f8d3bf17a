#!/usr/bin/env bash
# Makes the counterparts of the paper's Figures 1 to 3 on this project's Cornell box.
# usage: docs/figures.sh [FIGURE...]     all of 1 2 3 unless told; pictures go to docs/pictures/
set -euo pipefail
cd "$(dirname "$0")/.."
out=docs/pictures
mkdir -p "$out"
crex() { cargo run --quiet --release --package renderer --bin crex -- "$@"; }
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

for figure in "${@:-1 2 3}"; do
    for number in $figure; do "figure_$number"; done
done
