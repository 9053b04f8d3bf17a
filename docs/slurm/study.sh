#!/bin/bash
#SBATCH --job-name=crex-study
#SBATCH --ntasks=1
# A part of each picture of a study, as a task of a job array:
#   crex stimuli STUDY --maps
#   sbatch --wait --array=1-PARTS study.sh PARTS STUDY
#   crex stimuli STUDY --merge
# Parts that are there are kept, so the same line again makes what was lost.
set -eu
exec crex stimuli "$2" --threads "${SLURM_CPUS_PER_TASK:-1}" --shard "$SLURM_ARRAY_TASK_ID/$1"
