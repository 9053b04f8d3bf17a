#!/usr/bin/env bash
# Renders Radiance's own scenes with rpict and with crex, twice each, and prints how far they lie apart and how far they
# should, by their noise.
#
# usage: SCENES=folder RADIANCE_BIN=folder RADIANCE_LIB=folder CREX=crex docs/real_scenes.sh [name ..]
#
# SCENES holds Radiance's object library and its render suite in the folders cabin, office, texture, virtual, misc, renders and lib.
# Needs a copy that may be written to: `.pic` names of pictures that are there as `.hdr`, and a picture of a sky as renders/sunset.hdr, which
# the suite's mirrors leave out. RAYS (a side, 12 unless given) and SPP (256) are the rays a pixel of each of the two runs.
set -euo pipefail
export PATH=$PATH:$RADIANCE_BIN RAYPATH=.:$SCENES/lib:$RADIANCE_LIB
work=${KEEP:-$(mktemp -d)}
[[ ${KEEP:-} ]] || trap 'rm -r "$work"' EXIT
rays=${RAYS:-12} spp=${SPP:-256}
wanted=" ${*:-all} "

is_wanted() { [[ $wanted == *" all "* || $wanted == *" $1 "* ]]; }

# octree, picture, options: a run's seed is the second in which it starts.
by_rpict() {
    local octree=$1 picture=$2
    shift 2
    sleep 1
    rpict "$@" -pa 0 -x $((rays * 96)) -y $((rays * 64)) -u+ -ps 1 -pt 0 -pj 1 -dt 0 -dc 1 -st 0 -ss 1 \
        -aa 0 -as 0 -ar 0 -av 0 0 0 -aw 0 -lr 12 -lw 1e-5 -ab 0 "$octree" 2>> "$work/log" |
        pfilt -1 -x /"$rays" -y /"$rays" > "$picture"
}

# files, picture, seed, options
by_crex() {
    local files=$1 picture=$2 seed=$3
    shift 3
    eval "\"$CREX\" render $files $*" -pa 0 -x 96 -y 64 --crex "'(TRSGM)*'" -lr 12 -lw 1e-5 \
        --spp "$spp" --seed "$seed" -o "$picture" 2>> "$work/log"
}

# name, pictures 1 and 2 of the reference, pictures 1 and 2 compared with it; all of 96 x 64 pixels
measure() {
    local name=$1 which
    for which in 2 3 4 5; do pvalue -h -H -b -o "${!which}" | awk '{ print $NF }' > "$work/$which.txt"; done
    paste "$work"/[2-5].txt | awk -v name="$name" '
        {
            # The pixels of two runs are independent: half their difference, squared, is the variance of their mean.
            block = int((NR - 1) / 96 / 4) * 16 + int((NR - 1) % 96 / 6)
            a[block] += ($1 + $2) / 2; va[block] += ($1 - $2) ^ 2 / 4
            b[block] += ($3 + $4) / 2; vb[block] += ($3 - $4) ^ 2 / 4
        }
        END {
            for (k in a) { A += a[k]; B += b[k]; V += va[k] + vb[k] }
            for (k in a) if (a[k] > 1e-3 * A / 256) {
                d = b[k] - a[k]; v = va[k] + vb[k]
                near = d * d < (.03 * a[k]) ^ 2
                within += near; explained += near || d * d < 9 * v
                if (v > 0) { squares += d * d / v; counted++ }
                ratios[++n] = b[k] / a[k]
            }
            # Insertion sort: the median.
            for (i = 2; i <= n; i++) {
                for (j = i; j > 1 && ratios[j - 1] > ratios[j]; j--) { t = ratios[j]; ratios[j] = ratios[j - 1]; ratios[j - 1] = t }
            }
            printf "%s: mean %.4f +- %.4f, median block %.4f, of %d blocks %.1f %% within 3 %%, %.1f %% within that or 3 sigma, mean z^2 %.2f\n",
                name, B / A, sqrt(V) / A, ratios[int((n + 1) / 2)], n, 100 * within / n, 100 * explained / n, squares / counted
        }'
}

# name, folder, files for oconv, view, files for crex, further options of both, further options of rpict
compare() {
    is_wanted "$1" || return 0
    cd "$SCENES/$2"
    local pictures=("$work/$1".{rpict1,rpict2,crex1,crex2}.hdr)
    # shellcheck disable=SC2086
    eval "oconv $3" > "$work/$1.oct" 2> "$work/log" &&
        by_rpict "$work/$1.oct" "${pictures[0]}" $4 -dj 1 -ds .15 -dp 4096 ${6:--dr 1} ${7:-} &&
        by_rpict "$work/$1.oct" "${pictures[1]}" $4 -dj 1 -ds .15 -dp 4096 ${6:--dr 1} ${7:-} &&
        by_crex "$5" "${pictures[2]}" 1 $4 ${6:-} &&
        by_crex "$5" "${pictures[3]}" 2 $4 ${6:-} &&
        measure "$1" "${pictures[@]}" || { echo "$1 fails:"; tail -n 3 "$work/log"; }
}

suite="diorama_walls.rad closed_end.rad front_cap.rad"
open="diorama_walls.rad rect_opening.rad front_cap.rad"
women="'!xform -n plainclothes -s 1.5 -rx 90 -rz -80 -t 1 0 0 -a 9 -rz 40 -i 1 -t -5 2.5 0 ./woman.rad'"
women="$women '!xform -m chrome -n shiny -s 1.5 -rx 90 -rz -105 -t 1 0 0 -rz 20 -a 9 -rz 40 -i 1 -t -5 2.5 0 ./woman.rad'"
view="-vf inside.vf"
fish="-vf fish.vf"
prism="-vts -vp -4.25514 3.89431 1.97742 -vd -0.700687 -1.28443 -0.21925 -vh 140 -vv 140"
def="-vta -vp -0.2 3.07 2.78 -vd -2.64 -0.48 -1.25 -vh 66.6667 -vv 37.5"
plan="-vtl -vp -4 2.5 2.5 -vd 0 0 -1 -vu -1 0 0 -vh 5 -vv 5"
desk="-vp 8 36 -27 -vd -0.560723 -0.233635 0.794358 -vu 0 1 0 -vh 39.9 -vv 27.5"
living="-vp 15 9 5 -vd 0.986588 0.0507496 -0.155139 -vu 0 0 1 -vh 60 -vv 45"
cabin="pattmats cabin bathroom winpanes.rad furniture"

compare patterns renders "basic.mat patterns.mat $suite disks.rad rect_fixture.rad" "$def" patterns.rif
compare patterns_plan renders "basic.mat patterns.mat $suite disks.rad rect_fixture.rad" "$plan" patterns.rif
compare glass renders "basic.mat $open torus.rad sunset_sky.rad glass_ill.rad" "$view" glass.rif
compare inst renders "basic.mat $suite porsches.rad spotlights.rad rect_fixture.rad glowbulb.rad" "$view" inst.rif
# What makes inst differ is the glow of limited reach: without it, and by it alone, unhidden and sampled at its middle.
files="basic.mat $suite porsches.rad spotlights.rad rect_fixture.rad"
compare inst_dark renders "$files" "$view" "$files"
compare inst_glow renders "basic.mat $suite glowbulb.rad" "$view" "basic.mat $suite glowbulb.rad" "" "-dj 0 -ds 0"
compare trans renders "basic.mat $open ballcompare.rad spotlights.rad rect_fixture.rad trans_pane.rad sunset_sky.rad" "$view" trans.rif
compare mesh renders "basic.mat chrome.mat $suite $women rect_fixture.rad" "$view" mesh.rif
compare mirror renders "basic.mat $suite glass_pane.rad antimatter_portal.rad bubble_in_cube.rad mirror.rad sunset_sky.rad" "$fish" mirror.rif
# Without mkillum, for rpict too: the pane itself shows, and the pane that mkillum would make an illum is invisible.
for name in tfunc:ball_in_cube trans2:gymbal; do
    files="basic.mat $open ${name#*:}.rad sunset_sky.rad illum_${name%:*}.rad"
    compare "${name%:*}" renders "$files" "$view" "$files"
done
# The same sun of a fiftieth the width: rpict widens what trans2 passes by the light's solid angle.
if is_wanted trans2_star; then
    sed 's/2.5e4/6.25e7/g; s/1e-03 1$/1e-03 .02/' "$SCENES/renders/sunset_sky.rad" > "$work/star_sky.rad"
    files="basic.mat $open gymbal.rad $work/star_sky.rad illum_trans2.rad"
    compare trans2_star renders "$files" "$view" "$files"
fi
# Without the vase, whose mesh is absent.
files="basic.mat $open rect_fixture.rad sunset_sky.rad dielectric_pane.rad"
compare dielectric renders "$files" "$view" "$files"

# At the -dj 1 of all others rpict loses samples of the sun behind the prisms (agreement.md).
for name in prism1 prism2; do
    files="basic.mat $open sunset_sky.rad $name.rad"
    compare "$name" renders "$files" "$prism" "$files" "" "-dj .3 -ds 0"
done
# The edge of a spotlight's cone, by a ring of radius .2 at height 3: irradiance at some distances from its axis.
if is_wanted cone_edge; then
    echo "void spotlight sp 0 0 7 1000 1000 1000 30 0 0 -1 sp ring r 0 0 8 0 0 3 0 0 -1 0 .2" | oconv - > "$work/cone.oct"
    for x in .7 .9 .95; do
        awk -v x=$x 'BEGIN { for (i = 0; i < 60000; i++) print x, 0, 0, 0, 0, 1 }' |
            rtrace -I -h -ab 0 -dj 1 -ds 0 -dt 0 -u+ "$work/cone.oct" |
            awk -v x=$x '{ sum += $1; square += $1 * $1 } END { m = sum / NR; print "cone_edge " x ":", m, "+-", sqrt((square / NR - m * m) / NR) }'
    done
fi

# What rpict loses of a sun behind a sheet of prisms: the irradiance of a wall behind it, by jitter, with the share of points without any.
if is_wanted prism_jitter; then
    cd "$SCENES/renders"
    sun="void light sol 0 0 3 25000 25000 25000 sol source sun 0 0 4 -.9338 -.35 .001 1"
    place="p polygon w 0 0 12 -8.1 -50 -50 -8.1 50 -50 -8.1 50 50 -8.1 -50 50"
    for sheet in "7 coef1 dx1 dy1 dz1 prism.cal -rz 90 0 4 1.52 .2 .1 .2" "7 coef2 dx2 dy2 dz2 prism.cal -rz 90 0 4 1.52 .2 .1 .2" \
        "5 .8 Dx Dy Dz+if(Dx,-1,1)*.8*Dx . 0 0"; do
        echo "$sun void prism1 p $sheet $place" | oconv - > "$work/sheet.oct"
        for jitter in 0 .3 .7 .9 1; do
            awk 'BEGIN { srand(1); for (i = 0; i < 4000; i++) print -4, 4 * rand() - 2, 4 * rand() - 2, -1, 0, 0 }' |
                rtrace -I -h -ab 0 -dr 1 -dj $jitter -ds 0 -dp 0 -dt 0 -u+ "$work/sheet.oct" 2>> "$work/log" |
                awk -v name="${sheet:0:7} at -dj $jitter" '{ sum += $1; dark += $1 == 0 } END { print name ":", sum / NR, dark / NR }'
        done
    done
fi

# Without the front cap, which rpict sees through by -bv-.
files="basic.mat diorama_walls.rad closed_end.rad gymbal.rad mist.rad spotlights.rad spotcones.rad"
compare mist renders "$files" "-vp 0.1 3.2 2.8 -vd -2.7336 -0.482008 -1.02483 -vh 45 -vv 45" "$files"
compare wgmdf renders "basic.mat $suite ringlight.rad gymbal2.rad" \
    "-vp -2.60899 4.62728 2.52391 -vd -1.11057 -1.64932 -1.10768 -vh 46.6777 -vv 46.6777" wgmdf.rif

# A bulb of 200 facets with a ball's surface in place of the last sphere of a file, whose name, centre, radius and radiance follow. The facets
# light and a glow inside shows, since rpict draws small flat lights over its pictures by itself.
facets() {
    local file=$1 name=$2 x=$3 y=$4 z=$5 radius=$6 light="$7 $8 $9"
    awk -v RS= -v ORS='\n\n' -v centre="$x $y $z" '
        { numbers = $0; gsub(/[ \t\n]+/, " ", numbers) }
        $2 != "sphere" || index(numbers, centre) == 0' "$file"
    echo "void illum $name.f 0 0 3 $light void glow $name.g 0 0 4 $light 0 $name.g sphere $name.b 0 0 4 $x $y $z $(awk "BEGIN { print .98 * $radius }")"
    gensurf "$name.f" "$name" "$x+1.0104*$radius*sin(PI*s)*cos(2*PI*t)" "$y+1.0104*$radius*sin(PI*s)*sin(2*PI*t)" \
        "$z+1.0104*$radius*cos(PI*s)" 10 20
}

lamp="model.b90 desk misc window blinds lamp picture"
compare office office "${lamp/lamp/lights lamp}" "$desk" office.rif
compare officelamp office "$lamp" "$desk" officelamp.rif
if is_wanted officelamp_facets; then
    cd "$SCENES/office"
    facets lamp bulb -24.9348093976 29.2873855725 4.38769767309 0.416625 500 500 500 > "$work/lamp_facets"
    rays=$((rays / 2)) compare officelamp_facets office "${lamp/lamp/$work/lamp_facets}" "$desk" officelamp.rif "" "-dj 0 -ds 0"
fi
if is_wanted officeday_facets; then
    cd "$SCENES/office"
    facets lamp bulb -24.9348093976 29.2873855725 4.38769767309 0.416625 500 500 500 > "$work/lamp_facets"
    files="'!gensky 7 12 17 | xform -rx -90 -ry 90' sky ${lamp/lamp/$work/lamp_facets}"
    rays=$((rays / 2)) compare officeday_facets office "$files" "$desk" officeday2.rif "" "-dj .5 -ds 0"
fi
compare officeday office "'!gensky 7 12 17 | xform -rx -90 -ry 90' sky $lamp" "$desk" officeday2.rif

compare virtual virtual "plainoff.rad environ.rad furniture.rad" "-vf back.vp" plain.rif "-dr 2"
compare outside virtual "plainoff.rad environ.rad" "-vf outside.vp" outside.rif "-dr 2"
compare daf misc daf.rad "-vp 50 60 40 -vd 0 -1 -1 -vu 0 1 0 -vh 20 -vv 20" daf.rif

# Without the tennis balls, whose file is absent.
if is_wanted texture; then
    grep -v '^!zcat' "$SCENES/texture/scene" > "$SCENES/texture/scene.cut"
    compare texture texture "room scene.cut" "-vp 52.5 6 58 -vd .05 -.6 -.8 -vu 0 1 0 -vh 35 -vv 35" "room scene.cut"
fi

# The files of the cabin are not listed with it; these make it whole.
for name in living:"$living" living2:"-vf vf/living2" bed:"-vf vf/bed" bath:"-vf vf/bath"; do
    compare "night_${name%%:*}" cabin "$cabin lights mirrors.rad" "${name#*:}" "$cabin lights mirrors.rad"
done
if is_wanted night_bath_facets; then
    cd "$SCENES/cabin"
    facets lights left_globe 2.7 17.4 6.75 .29 14.5 14.5 14.5 > "$work/lights_one"
    facets "$work/lights_one" right_globe 5.7 17.4 6.75 .29 14.5 14.5 14.5 > "$work/lights_two"
    facets "$work/lights_two" living_globe 19.6 12 8.5 .5 10 10 10 > "$work/lights_facets"
    rays=$((rays / 4)) compare night_bath_facets cabin "$cabin $work/lights_facets mirrors.rad" "-vf vf/bath" \
        "$cabin lights mirrors.rad" "" "-dj 0 -ds 0"
fi
compare day_living cabin "$cabin lights.off mirrors.rad summerday landscape" "$living" "$cabin lights.off mirrors.rad summerday landscape"
