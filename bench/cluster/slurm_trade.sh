#!/usr/bin/env bash
# Runs a study on the nodes of a Slurm cluster, one share per task of a job array:
#
#   sbatch --array=1-8 bench/cluster/slurm_trade.sh SCENE... -o DIR [OPTIONS OF sunder trade]
#
# in a folder that all nodes share and that contains DIR. When the array is done:
#
#   build/sunder trade --merge SCENE... -o DIR [THE SAME OPTIONS]
#
# which lists missing runs; the same sbatch does them. SUNDER names the program.
#SBATCH --job-name=sunder-trade
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --output=sunder-trade-%A_%a.log
#SBATCH --no-requeue
set -euo pipefail
exec "${SUNDER:-build/sunder}" trade --quiet \
  --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" "$@"
