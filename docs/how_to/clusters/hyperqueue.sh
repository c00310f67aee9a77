#!/bin/bash
# The same by HyperQueue: `hq server start` and workers first; afterwards, once: voussoir merge results/arch
set -euo pipefail
hq submit --array 1-100 --cpus 4 --wait -- \
    bash -c 'voussoir run arch.toml --out results/arch --resume --quiet --shard "$HQ_TASK_ID/100" --jobs 4'
