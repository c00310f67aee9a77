#!/bin/bash
#SBATCH --job-name=voussoir
#SBATCH --array=1-100
#SBATCH --cpus-per-task=4
#SBATCH --time=01:00:00
# One part of the sweep a task; afterwards, once: voussoir merge results/arch
set -euo pipefail
voussoir run arch.toml --out results/arch --resume --quiet \
    --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" --jobs "$SLURM_CPUS_PER_TASK"
