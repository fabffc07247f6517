#!/usr/bin/env bash
# libFuzzer with AddressSanitizer and UndefinedBehaviorSanitizer on the message decoders, from seeds of every type.
#   tools/gates/fuzz.sh [seconds]      default 60; a find is kept in build/fuzz/found, its stack is printed
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

seconds=${1:-60}
programs=build/fuzz/tests/fuzz
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --parallel "$(nproc)" --target fuzz_decode fuzz_seeds
mkdir -p build/fuzz/corpus build/fuzz/found
"$programs/fuzz_seeds" build/fuzz/corpus
"$programs/fuzz_decode" -max_total_time="$seconds" -max_len=65001 -timeout=10 -rss_limit_mb=1024 -print_final_stats=1 \
    -artifact_prefix=build/fuzz/found/ build/fuzz/corpus >build/fuzz/log.txt 2>&1 || {
    tail -n 60 build/fuzz/log.txt
    exit 1
}
grep -E 'cov: ' build/fuzz/log.txt | tail -n 1
grep -E 'stat::number_of_executed_units|stat::peak_rss_mb' build/fuzz/log.txt
