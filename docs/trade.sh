#!/usr/bin/env bash
# The trade of quality for time of every shipped study and scene, as SVG, CSV and JSON.
# usage: docs/trade.sh [NAME...]     all of corridor corridor_b cornell desk library unless told; files go to $OUT [docs/pictures]
set -euo pipefail
cd "$(dirname "$0")/.."
out=$(readlink -f "${OUT:-docs/pictures}")
mkdir -p "$out"
crex() { if [ -n "${CREX:-}" ]; then "$CREX" "$@"; else cargo run --quiet --release --package renderer --bin crex -- "$@"; fi; }
trade() { # NAME, then what `crex trade` is told
    local name=$1
    shift
    crex trade "$@" --filter D,G --time .25,.5,1 --spp 1,4,8 --reference-spp 32 -lr -12 -lw .2 \
        -o "$out/trade-$name.svg" -o "$out/trade-$name.csv" -o "$out/trade-$name.json" | tail -n 1 | sed "s/^/$name: /"
}

at=stimuli/corridor
corridor() { # the corridor study's layouts, whose three study files share them
    trade "$1" "$at/materials.rad" "$at/shell.rad" "$at/layout_$2.rad" -vf "$at/corridor.vf" -x 192 -y 192 \
        --importance "$at/maps/$2.png" --crex 'T{RSGM}' --exposure 1 -av "${@:3}"
}
scene() { trade "$1" "stimuli/$1/$1.rad" -vf "stimuli/$1/$1.vf" -x 160 -y 160; }

names=("$@")
[ ${#names[@]} -gt 0 ] || names=(corridor corridor_b cornell desk library)
for name in "${names[@]}"; do
    case $name in
    corridor) corridor corridor a .3213 .2833 .2225 ;;
    corridor_b) corridor corridor_b b .3206 .2829 .2221 ;;
    cornell | desk | library) scene "$name" ;;
    *) echo "no study or scene $name: there are corridor corridor_b cornell desk library" >&2; exit 2 ;;
    esac
done
