#!/usr/bin/env bash
# Shares a study among the nodes of a Slurm cluster, a task of the array a share:
#
#   sbatch --array=1-8 bench/cluster/slurm_trade.sh SCENE... -o DIR [OPTIONS OF sunder trade]
#
# from a folder that all nodes see; DIR lies there too. Then, once the array is done:
#
#   build/sunder trade --merge SCENE... -o DIR [THE SAME OPTIONS]
#
# which names what is missing; the same sbatch does it. SUNDER names the program.
#SBATCH --job-name=sunder-trade
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --output=sunder-trade-%A_%a.log
#SBATCH --no-requeue
set -euo pipefail
exec "${SUNDER:-build/sunder}" trade --quiet \
  --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" "$@"
