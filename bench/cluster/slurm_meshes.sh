#!/usr/bin/env bash
# Makes a data set of broken meshes on the nodes of a Slurm cluster, one share per task of a job
# array:
#
#   sbatch --array=1-8 bench/cluster/slurm_meshes.sh MESH... -o DIR [OPTIONS OF broken_meshes.py]
#
# in a folder that all nodes share and that contains DIR. When the array is done, the same command
# with --missing, in a shell, lists missing meshes:
#
#   python3 examples/python/broken_meshes.py MESH... -o DIR [THE SAME OPTIONS] --missing
#
# and the same sbatch makes them. PYTHON names the interpreter, which must find the module sunder.
#SBATCH --job-name=sunder-meshes
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --output=sunder-meshes-%A_%a.log
#SBATCH --no-requeue
set -euo pipefail
exec "${PYTHON:-python3}" examples/python/broken_meshes.py \
  --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" "$@"
