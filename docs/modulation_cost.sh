#!/usr/bin/env bash
# Prints what an importance map costs by itself, in instructions (valgrind's count; no clock is involved): a map of ones
# against no map, and a map of zeros against the crex without its { }.
# usage: docs/modulation_cost.sh [CREX-PROGRAM]     target/release/crex unless told; one thread, 96 x 77 pixels, 4 samples
set -euo pipefail
cd "$(dirname "$0")/.."
crex=${1:-target/release/crex}
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
at=stimuli/corridor
scene=("$at/materials.rad" "$at/shell.rad" "$at/layout_a.rad" -vf "$at/corridor.vf" -x 96 -y 77 -lr -12 -lw .2)
# Grey maps of one value: of an object behind the eye, and of everything.
"$crex" importance "${scene[@]}" --task 'door_start*' -o "$dir/zeros.exr" 2>/dev/null
"$crex" importance "${scene[@]}" --task '*' --px-per-deg 1e-6 --fovea 900000 -o "$dir/ones.exr" 2>/dev/null

# Instructions of a rendering.
count() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$crex" render "${scene[@]}" --spp 4 --threads 1 -o "$dir/a.exr" "$@" \
        2>&1 | awk '/Collected/ { print $NF }'
}

plain=$(count --crex 'T{RSGMD}')
ones=$(count --crex 'T{RSGMD}' --importance "$dir/ones.exr")
without=$(count --crex 'T')
zeros=$(count --crex 'T{RSGMD}' --importance "$dir/zeros.exr")
awk -v plain="$plain" -v ones="$ones" -v without="$without" -v zeros="$zeros" 'BEGIN {
    printf "no map   %d\nones     %d   %+.3f %%\n", plain, ones, 100 * (ones / plain - 1)
    printf "without  %d\nzeros    %d   x %.4f\n", without, zeros, zeros / without }'
