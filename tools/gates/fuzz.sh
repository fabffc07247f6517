#!/usr/bin/env bash
# Runs every libFuzzer program of tests/fuzz with AddressSanitizer for a share of the seconds given.
#   tools/gates/fuzz.sh [seconds]
# Seeds come from tests/fuzz/corpus/<program>, if there; what is found is kept in build/fuzz/found.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

seconds=${1:-60}
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --parallel "$(nproc)"
mapfile -t programs < <(find build/fuzz/tests/fuzz -maxdepth 1 -type f -name 'fuzz_*' -perm -u+x | sort)
[ ${#programs[@]} -gt 0 ] || { echo "fuzz: no programs built" >&2 && exit 1; }
share=$((seconds / ${#programs[@]}))
[ "$share" -gt 0 ] || share=1
mkdir -p build/fuzz/found
for program in "${programs[@]}"; do
    name=$(basename "$program")
    mkdir -p "build/fuzz/corpus/$name"
    seeds=()
    [ ! -d "tests/fuzz/corpus/$name" ] || seeds=("tests/fuzz/corpus/$name")
    printf 'fuzz: %s for %s s\n' "$name" "$share"
    "$program" -max_total_time="$share" -timeout=10 -rss_limit_mb=1024 -max_len=65536 -print_final_stats=1 \
        -artifact_prefix="build/fuzz/found/$name-" "build/fuzz/corpus/$name" "${seeds[@]}" 2>"build/fuzz/$name.txt" || {
        tail -n 60 "build/fuzz/$name.txt" && exit 1
    }
    grep -E 'stat::number_of_executed_units|stat::peak_rss_mb|cov: ' "build/fuzz/$name.txt" | tail -n 3
done
