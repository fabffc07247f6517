#!/usr/bin/env bash
# libFuzzer with AddressSanitizer and UndefinedBehaviorSanitizer on the message decoders, from seeds of every type.
#   tools/gates/fuzz.sh [seconds]      default 60, of all cores together; a find is kept in build/fuzz/found, its stack is printed
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

seconds=${1:-60}
jobs=$(nproc)
programs=build/fuzz/tests/fuzz
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --parallel "$jobs" --target fuzz_decode fuzz_seeds
mkdir -p build/fuzz/corpus build/fuzz/found
"$programs/fuzz_seeds" build/fuzz/corpus
rm -f build/fuzz/log.*.txt

fuzz() { # number: one process; all share the corpus
    "$programs/fuzz_decode" -seed="$1" -max_total_time="$((seconds / jobs))" -reload=1 -max_len=65001 -timeout=10 \
        -rss_limit_mb=1024 -print_final_stats=1 -artifact_prefix=build/fuzz/found/ build/fuzz/corpus >"build/fuzz/log.$1.txt" 2>&1
}

running=()
for ((i = 1; i <= jobs; i++)); do fuzz "$i" & running+=($!); done
failed=0
for ((i = 1; i <= jobs; i++)); do
    wait "${running[i - 1]}" || { failed=1 && tail -n 60 "build/fuzz/log.$i.txt"; }
done
for ((i = 1; i <= jobs; i++)); do
    grep -E 'cov: ' "build/fuzz/log.$i.txt" | tail -n 1
    grep -E 'stat::number_of_executed_units|stat::peak_rss_mb' "build/fuzz/log.$i.txt"
done
exit "$failed"
