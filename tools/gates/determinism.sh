#!/usr/bin/env bash
# The same log gives the same bytes: gcc and clang, -O0 and -O3, and fused multiply-add where this CPU has it.
# Builds aisle-replay five ways, as the presets release and clang do (-O3) and in build/det-*, replays logs made by the
# aisle command, compares sha256 of the outputs; each variant replays twice. On the way: gcc's -O0 call graph shows
# recursion that an optimiser might have unrolled.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

aisle=build/venv/bin/aisle
work=build/det
variants=("gcc-O0 gcc -O0" "release" "clang-O0 clang -O0" "clang") # a preset, or a name, compiler and flags
if grep -qw fma /proc/cpuinfo && grep -qw avx2 /proc/cpuinfo; then
    variants+=("gcc-O3-fma gcc -O3 -march=x86-64-v3")
fi

folder_of() { # variant
    if [ -d "build/det-$1" ]; then printf 'build/det-%s' "$1"; else printf 'build/%s' "$1"; fi
}

build_variant() { # preset, or name compiler flags...
    local name=$1
    if [ $# = 1 ]; then
        cmake --preset "$name" >/dev/null
    else
        cmake -G Ninja -S . -B "build/det-$name" -DCMAKE_BUILD_TYPE=None -DCMAKE_C_COMPILER="$2" \
            -DCMAKE_C_FLAGS="${*:3}" -DAISLE_BUILD_TESTS=OFF -DAISLE_BUILD_JAVA=OFF >/dev/null
    fi
    local targets=(aisle-replay)
    [ "$name" != release ] || targets+=(aisle-sim) # it drives for a log
    cmake --build "$(folder_of "$name")" --parallel "$(nproc)" --target "${targets[@]}" >"$work/build-$name.txt" 2>&1 || {
        cat "$work/build-$name.txt" && return 1
    }
}

drive_log() { # a vehicle that is driven among people: re-paced, stopped, sent round
    local scenario=tests/data/scenarios/clutter_50.json start=$work/start.txt
    "$aisle" map --log "$start" "$scenario"
    "$aisle" vehicle --log "$start" --footprint 1.0x0.7 --margin 0.1
    "$aisle" goal --log "$start" --goal 48,48 --pose 2,2,0.7
    build/release/aisle-sim "$start" --movers person:4,adversarial:1 --seed 1 --time 45 --out "$work/drive.log" || true # not there yet: 1
    [ -s "$work/drive.log" ]
}

make_logs() { # a scanned map with its goals, rooms of polygons with a disc and with a polygon footprint, a car, zones
    rm -f "$work"/*.log
    {
        "$aisle" map --log "$work/depot.log" tests/data/ros_maps/nav2_depot.yaml
        "$aisle" vehicle --log "$work/depot.log" --footprint 0.6x0.4 --margin 0.05
        "$aisle" query --log "$work/depot.log" --goals tests/data/ros_maps/nav2_depot.goals.csv
        "$aisle" query --log "$work/depot.log" --goals tests/data/ros_maps/nav2_depot.goals.csv --objective shortest \
            --interpolation linear
        for name in field_12_disc field_8 barrier_2; do
            "$aisle" map --log "$work/$name.log" "tests/data/scenarios/$name.json"
            "$aisle" vehicle --log "$work/$name.log" --scenario "tests/data/scenarios/$name.json"
            "$aisle" query --log "$work/$name.log" --scenario "tests/data/scenarios/$name.json"
            "$aisle" query --log "$work/$name.log" --scenario "tests/data/scenarios/$name.json" --objective shortest \
                --planner pso --seed 7
        done
        drive_log
    } >"$work/logs.txt"
    build/venv/bin/python tools/gates/determinism_logs.py make "$work"
}

replay() { # variant run: checksums of the outputs of all logs on stdout
    local variant=$1 run=$2 program log out
    program=$(folder_of "$variant")/aisle-replay
    for log in "$work"/*.log; do
        out=$work/$(basename "$log" .log).$variant.$run
        "$program" --out "$out" "$log" >"$out.txt"
        if [ ! -s "$out" ] || ! grep -q 'proved [1-9]' "$out.txt"; then
            echo "determinism: $variant proved no path for $log" >&2 && return 1
        fi
        printf '%s %s\n' "$(basename "$log")" "$(sha256sum <"$out")"
    done
}

rm -rf "$work"
mkdir -p "$work"
build_variant release
make_logs & # beside the other builds
logs=$!
for variant in "${variants[@]}"; do
    # shellcheck disable=SC2086 # several words
    [ "$variant" = release ] || build_variant $variant
done
wait "$logs"
failed=0
for variant in "${variants[@]}"; do
    name=${variant%% *}
    replay "$name" 1 >"$work/sums.$name.1" &
    first=$!
    replay "$name" 2 >"$work/sums.$name.2"
    wait "$first"
    for run in 1 2; do
        if cmp -s "$work/sums.gcc-O0.1" "$work/sums.$name.$run"; then
            printf 'determinism: %-12s run %s: same bytes\n' "$name" "$run"
        else
            printf 'determinism: %-12s run %s: OTHER BYTES\n' "$name" "$run"
            diff "$work/sums.gcc-O0.1" "$work/sums.$name.$run" || true
            failed=1
        fi
    done
done
cat "$work/sums.gcc-O0.1"
for name in racks zones; do
    build/venv/bin/python tools/gates/determinism_logs.py look "$work/$name.log" "$work/$name.gcc-O0.1" || failed=1
done
build/venv/bin/python tools/gates/stack.py build/det-gcc-O0/CMakeFiles/aisle_*.dir >"$work/stack.txt" || failed=1
grep -E '^stack:' "$work/stack.txt"
exit "$failed"
