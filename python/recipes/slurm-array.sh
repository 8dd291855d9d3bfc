#!/bin/sh
# A chart by a job array, without Python: every task computes its part of the blocks and writes into one folder that all nodes see.
#
#     sbatch --array=1-16 slurm-array.sh chart machine.toml --x rpm=600:760:1000 --y restitution=0.5:0.95:1000 --out c.zarr
#
# Finished blocks are kept. After a time limit or a lost node, the same line again computes the missing blocks.
# `corner-impact chart --status c.zarr` says how many are missing.
#SBATCH --job-name=chart
#SBATCH --cpus-per-task=1
#SBATCH --output=chart-%a.log
exec "${CORNER_IMPACT:-corner-impact}" "$@" --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" --threads "$SLURM_CPUS_PER_TASK"
