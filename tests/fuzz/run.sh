#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the libFuzzer programs of a build made with the preset fuzz, one line for each.
#   tests/fuzz/run.sh [-s SECONDS] [-n RUNS] [-r SEED] [-j JOBS] [-c CORPORA] BUILD [TARGET...]
#   -s  seconds for each target [30]         -n  stop a target after so many runs [none]
#   -r  of the mutations [0: another each time]; with it a run repeats itself as far as its time allows: it begins
#       with the seeds alone, and does without what libFuzzer takes from comparisons, which depends on addresses
#   -j  targets at a time [1]                -c  where corpora are kept and grow [BUILD/corpora; with -r, anew each
#                                                time, BUILD/corpora-SEED]
# An input that crashes, takes more than a second of the processor (entry.cpp) or more than 512 MB ends its
# target; it is printed and kept in CORPORA/<target>.found, and the script fails. Put it into
# tests/fuzz/crashers/<target>/ once it is mended.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
seconds=30 runs=-1 seed=0 jobs=1 corpora=
while getopts s:n:r:j:c: option; do
    case $option in
        s) seconds=$OPTARG ;; n) runs=$OPTARG ;; r) seed=$OPTARG ;; j) jobs=$OPTARG ;; c) corpora=$OPTARG ;; *) exit 2 ;;
    esac
done
shift $((OPTIND - 1))
build=${1:?usage: run.sh [options] BUILD [TARGET...]}
shift
repeat='' run=''
if [ "$seed" -ne 0 ]; then
    repeat="-seed=$seed -reload=0 -use_cmp=0"
    # Where the system allows it: addresses are the same each time.
    setarch -R true 2>/dev/null && run="setarch -R"
    [ -n "$corpora" ] || rm -rf "$build/corpora-$seed"
    corpora=${corpora:-$build/corpora-$seed}
fi
corpora=${corpora:-$build/corpora}
targets=${*:-$(cd "$here/targets" && ls | sed 's/\.cpp$//')}
"$build/tests/fuzz_write_seeds" "$here/../.." "$corpora"

one() {
    target=$1
    mkdir -p "$corpora/$target" "$corpora/$target.found"
    kept=("$corpora/$target")
    [ -d "$here/crashers/$target" ] && kept+=("$here/crashers/$target")
    log=$corpora/$target.log
    status=0
    # HDF5 itself forgets memory when it refuses a damaged file (lsan.supp): its targets do without that check.
    leaks=1
    case $target in asset | session | stage) leaks=0 ;; esac
    # shellcheck disable=SC2086
    ASAN_OPTIONS=quarantine_size_mb=16:malloc_context_size=5:detect_leaks=$leaks UBSAN_OPTIONS=print_stacktrace=1 \
        $run "$build/tests/fuzz_$target" $repeat -max_total_time="$seconds" -runs="$runs" -timeout=30 -rss_limit_mb=512 \
        -malloc_limit_mb=512 -detect_leaks=$leaks -print_final_stats=1 -artifact_prefix="$corpora/$target.found/" \
        "${kept[@]}" >"$log" 2>&1 || status=$?
    executed=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log" | tail -1)
    peak=$(sed -n 's/^stat::peak_rss_mb: *//p' "$log" | tail -1)
    covered=$(grep -o 'cov: [0-9]*' "$log" | tail -1 || true)
    printf '%-12s %9s runs  %4s MB  %-11s %s\n' "$target" "${executed:-?}" "${peak:-?}" "${covered:-}" \
        "$([ $status -eq 0 ] && echo ok || echo "FAILED, see $log")"
    [ $status -eq 0 ] || tell_failure
    return $status
}

# What is needed to mend it, even where the folder will be gone.
tell_failure() {
    grep -n -m 1 -A 12 'runtime error:\|ERROR: \|deadly signal\|expectation failed' "$log" || tail -n 20 "$log"
    for found in "$corpora/$target.found"/*; do
        [ -f "$found" ] || continue
        echo "base64 -d > $(basename "$found") <<END"
        head -c 65536 "$found" | base64
        echo END
    done
}
export -f one tell_failure
export here build corpora seconds runs repeat run
# shellcheck disable=SC2086
printf '%s\n' $targets | xargs -P "$jobs" -I{} bash -c 'one {}'
