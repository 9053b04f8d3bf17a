#!/bin/bash
#SBATCH --job-name=crex-part
#SBATCH --ntasks=1
# A part of a picture, as a task of a job array; the part's number is the task's:
#   sbatch --array=1-PARTS part.sh PARTS OUT SCENE... OPTIONS...
# writes OUT.1-of-PARTS.part and so on, for `crex merge`. Give --cpus-per-task for more threads.
set -eu
parts=$1 out=$2
shift 2
i=$SLURM_ARRAY_TASK_ID
exec crex render "$@" --threads "${SLURM_CPUS_PER_TASK:-1}" --shard "$i/$parts" -o "$out.$i-of-$parts.part"
