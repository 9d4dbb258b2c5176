#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Line coverage of formats and runtime by the tests, and the error paths that no test walks.
#   tests/coverage/run.sh [BUILD [CTEST OPTION...]]     BUILD: build/coverage
# Fails when a test fails or less than 90 % of the lines of either are covered. Needs g++, gcov, gcovr.
#   KNEAD_COVERAGE_TARGETS   build these only [everything]
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source=$(cd "$here/../.." && pwd)
build=${1:-$source/build/coverage}
shift $(($# > 0 ? 1 : 0))

cmake -S "$source" --preset coverage -B "$build" >/dev/null
# shellcheck disable=SC2086
cmake --build "$build" --parallel "$(nproc)" ${KNEAD_COVERAGE_TARGETS:+--target $KNEAD_COVERAGE_TARGETS} >/dev/null
find "$build" -name '*.gcda' -delete
status=0
ctest --test-dir "$build" --parallel "$(nproc)" --output-on-failure "$@" | tail -n 8 || status=$?
gcovr --root "$source" --filter "$source/formats/" --filter "$source/runtime/" --exclude-throw-branches \
    --gcov-ignore-parse-errors --json "$build/coverage.json" "$build" >/dev/null
python3 "$here/summary.py" "$source" "$build/coverage.json" --least 90 || status=$?
exit "$status"
