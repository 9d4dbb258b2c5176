#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The fastest level within 10 % of each of the paper's cubes and of the steak, at two budgets (docs/tune.md).
#   examples/tune/run.sh [FOLDER]      knead-tune on PATH, or KNEAD_TUNE=...; results go to FOLDER [tuned]
# Interrupted, it goes on where it was. Times are measured: nothing else should run.
set -u
here=$(cd "$(dirname "$0")" && pwd)
out=${1:-tuned}
tune=${KNEAD_TUNE:-knead-tune}
mkdir -p "$out" || exit 4
status=0
for budget in 200us 60us; do
    "$tune" "$here"/../cubes/scenario*.toml "$here"/../steak/steak.toml \
        --within 10% --budget $budget --on press,pads --cache "$out/cache" \
        --json "$out/$budget.json" >"$out/$budget.txt"
    code=$?
    [ $code -gt 1 ] && exit $code
    [ $code -gt $status ] && status=$code
    echo "== $budget"
    tail -n 10 "$out/$budget.txt"
done
exit $status
