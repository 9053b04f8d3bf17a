#!/bin/bash
# A picture by a job array, from submission to the picture: render.sh PARTS OUT SCENE... OPTIONS...
# Parts that a task lost are rendered again, three times at most. Part files stay; remove them when the picture is good.
set -eu
here=$(dirname "$(readlink -f "$0")")
parts=$1 out=$2
shift 2
array=1-$parts
for round in 1 2 3; do
    # A task that fails is a part that is missing, and that is found below.
    sbatch --quiet --wait --array="$array" "$here/part.sh" "$parts" "$out" "$@" || true
    if report=$(crex merge --json "$out".*-of-"$parts".part -o "$out"); then
        echo "$out: joined from $parts parts"
        exit 0
    fi
    array=$(sed -n 's/.*"array":"\([^"]*\)".*/\1/p' <<<"$report")
    # What is double or damaged is for the user to decide; the message names the files.
    [ -n "$array" ] || exit 2
    echo "$out: again parts $array (round $round)" >&2
done
exit 1
