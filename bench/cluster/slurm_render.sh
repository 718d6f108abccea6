#!/usr/bin/env bash
# Draws a take as pictures, a range of its frames a task of the array:
#
#   sbatch --array=1-20 bench/cluster/slurm_render.sh FRAMES SIZE X.take DIR [OPTIONS]
#
# for a take of FRAMES frames in ranges of SIZE: 20 ranges of 30 draw 600 frames. The same sbatch
# draws what is missing. Start it from a folder that all nodes see. SUNDER names the program.
#SBATCH --job-name=sunder-render
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --output=sunder-render-%A_%a.log
#SBATCH --no-requeue
set -euo pipefail
exec bench/cluster/frames.sh "$SLURM_ARRAY_TASK_ID" "$@"
