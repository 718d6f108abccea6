#!/usr/bin/env bash
# Draws the frames of a recording as pictures, one range of frames per task of a job array:
#
#   sbatch --array=1-20 bench/cluster/slurm_render.sh FRAMES SIZE X.take DIR [OPTIONS]
#
# for a recording of FRAMES frames in ranges of SIZE: 20 ranges of 30 draw 600 frames. The same
# sbatch draws missing frames. Start it in a folder that all nodes share. SUNDER names the program.
#SBATCH --job-name=sunder-render
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --output=sunder-render-%A_%a.log
#SBATCH --no-requeue
set -euo pipefail
exec bench/cluster/frames.sh "$SLURM_ARRAY_TASK_ID" "$@"
