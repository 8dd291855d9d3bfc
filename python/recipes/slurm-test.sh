#!/usr/bin/env bash
# Tests the recipes for Slurm on a node of this machine (see slurm-node.sh): a job array without Python, and Dask's workers as jobs. Each
# is stopped in the middle and submitted again. The store must then equal the one that a single process fills.
set -euo pipefail
cd "$(dirname "$0")/../.."
recipes=$PWD/python/recipes
model=$PWD/models/osorio-2008.toml
export CORNER_IMPACT=$PWD/target/release/corner-impact
export PATH="$PWD/.venv/bin:$PATH"

eval "$("$recipes/slurm-node.sh")"
folder=$(mktemp -d)
trap 'scancel --quiet --user="$(id -un)" || true; rm -rf "$folder"' EXIT
cd "$folder"

echo "== a job array, without Python"
chart=(chart "$model" --x rpm=600:760:300 --y restitution=0.5:0.95:200)
sbatch --array=1-2 "$recipes/slurm-array.sh" "${chart[@]}" --out array.zarr
until ls array.zarr/class/c/*/* >/dev/null 2>&1; do sleep 0.2; done
scancel --user="$(id -un)"
while squeue --noheader | grep -q .; do sleep 0.2; done
"$CORNER_IMPACT" chart --status array.zarr
sbatch --wait --array=1-2 "$recipes/slurm-array.sh" "${chart[@]}" --out array.zarr
"$CORNER_IMPACT" "${chart[@]}" --out alone.zarr >/dev/null
diff -r array.zarr alone.zarr

echo "== Dask's workers as jobs"
timeout --signal=KILL 15 python "$recipes/dask_slurm.py" "$model" dask.zarr 300 2 || echo "client and scheduler killed"
scancel --user="$(id -un)"
python "$recipes/dask_slurm.py" "$model" dask.zarr 300 2
python "$recipes/processes.py" "$model" processes.zarr 300 2
diff -r dask.zarr processes.zarr

trap 'rm -rf "$folder"' EXIT
"$recipes/slurm-node.sh" stop
echo "both recipes fill what one process fills"
