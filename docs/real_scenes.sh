#!/usr/bin/env bash
# Renders Radiance's own scenes with rpict and with crex, and prints how far they lie apart.
#
# usage: SCENES=folder RADIANCE_BIN=folder RADIANCE_LIB=folder CREX=crex docs/real_scenes.sh [name ..]
#
# SCENES holds Radiance's object library and its render suite in the folders office, texture, virtual, misc, renders and lib. Needs a copy
# that may be written to: `.pic` names of pictures that are there as `.hdr`, and a picture of a sky as renders/sunset.hdr, which
# the suite's mirrors leave out.
set -euo pipefail
export PATH=$PATH:$RADIANCE_BIN RAYPATH=.:$SCENES/lib:$RADIANCE_LIB
work=$(mktemp -d)
room="diorama_walls.rad"
view="-vp -0.2 3.0728 2.77765 -vd -2.7336 -0.482008 -1.02483 -vh 45 -vv 45"
desk="-vp 8 36 -27 -vd -0.560723 -0.233635 0.794358 -vu 0 1 0 -vh 39.9 -vv 27.5"
women="'!xform -n plainclothes -s 1.5 -rx 90 -rz -80 -t 1 0 0 -a 9 -rz 40 -i 1 -t -5 2.5 0 ./woman.rad'"
women="$women '!xform -m chrome -n shiny -s 1.5 -rx 90 -rz -105 -t 1 0 0 -rz 20 -a 9 -rz 40 -i 1 -t -5 2.5 0 ./woman.rad'"
wanted=" ${*:-all} "

# name, folder, files for oconv, view, pixels, files for crex
compare() {
    [[ $wanted == *" all "* || $wanted == *" $1 "* ]] || return 0
    cd "$SCENES/$2"
    eval "oconv $3" > "$work/$1.oct"
    rpict $4 -x $((5 * $5)) -y $((5 * $5)) -u+ -ps 1 -pt 0 -pj 1 -dj 1 -ds .15 -dt 0 -dc 1 -dr 1 -dp 4096 -st 0 -ss 1 \
        -aa 0 -as 0 -ar 0 -av 0 0 0 -aw 0 -lr 12 -lw 1e-5 -ab 0 "$work/$1.oct" | pfilt -1 -x /5 -y /5 > "$work/$1.rpict.hdr"
    "$CREX" render $6 $4 -x "$5" -y "$5" --crex '(TRSGM)*' -lr 12 -lw 1e-5 --spp 100 -o "$work/$1.crex.hdr"
    # Columns: x, y, brightness, from the top.
    for who in rpict crex; do pvalue -h -b "$work/$1.$who.hdr" > "$work/$1.$who.txt"; done
    paste "$work/$1.rpict.txt" "$work/$1.crex.txt" | awk -v name="$1" '
        NR == 1 { height = $2; width = $4; next }
        { block = int($2 * 16 / height) * 16 + int($1 * 16 / width); a[block] += $3; b[block] += $6; A += $3; B += $6 }
        END {
            for (k in a) if (a[k] > 1e-3 * A / 256) { n++; d = b[k] / a[k] - 1; if (d < .03 && d > -.03) close_++ }
            printf "%s: mean %.4f, %.1f %% of blocks within 3 %%\n", name, B / A, 100 * close_ / n
        }'
}

suite="$room closed_end.rad front_cap.rad"
open="$room rect_opening.rad front_cap.rad"
compare patterns renders "basic.mat patterns.mat $suite disks.rad rect_fixture.rad" \
    "-vta -vp -0.2 3.07 2.78 -vd -2.64 -0.48 -1.25 -vh 66.6667 -vv 37.5" 160 patterns.rif
compare patterns_plan renders "basic.mat patterns.mat $suite disks.rad rect_fixture.rad" \
    "-vtl -vp -4 2.5 2.5 -vd 0 0 -1 -vu -1 0 0 -vh 5 -vv 5" 128 patterns.rif
compare office office "model.b90 desk misc window blinds lights lamp picture" "$desk" 160 office.rif
compare officelamp office "model.b90 desk misc window blinds lamp picture" "$desk" 160 officelamp.rif
compare glass renders "basic.mat $open torus.rad sunset_sky.rad glass_ill.rad" "$view" 128 glass.rif
compare inst renders "basic.mat $suite porsches.rad spotlights.rad rect_fixture.rad glowbulb.rad" "$view" 128 inst.rif
compare trans renders \
    "basic.mat $open ballcompare.rad spotlights.rad rect_fixture.rad trans_pane.rad sunset_sky.rad" "$view" 128 trans.rif
compare mesh renders "basic.mat chrome.mat $suite $women rect_fixture.rad" "$view" 96 mesh.rif
compare virtual virtual "plainoff.rad environ.rad furniture.rad" "-vf back.vp" 128 plain.rif
compare daf misc "daf.rad" "-vp 50 60 40 -vd 0 -1 -1 -vu 0 1 0 -vh 20 -vv 20" 64 daf.rif
