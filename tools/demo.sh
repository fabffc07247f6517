#!/usr/bin/env bash
# The main job on a real map: a scanned warehouse, an AGV and ten start/goal pairs go to aisled over LCM; proved paths
# come back and are drawn; at the end one load that does not fit, and where. Sets up and builds what is missing.
# Everything on the bus stays inside one network namespace with nothing but loopback.
#
#   tools/demo.sh      writes build/demo/paths.png
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

out=build/demo
map=tests/data/ros_maps/nav2_warehouse.yaml
aisle=build/venv/bin/aisle

say() { printf '\n== %s\n' "$*"; }

build() {
    tools/setup.sh
    cmake --preset release >build/configure.log 2>&1 || { cat build/configure.log && exit 1; }
    cmake --build --preset release --parallel "$(nproc)" --target aisled >build/demo.log 2>&1 || { cat build/demo.log && exit 1; }
}

stop_daemon() {
    kill "$daemon" 2>/dev/null || true
    wait "$daemon" 2>/dev/null || true
}

on_the_bus() { # inside the namespace
    export LCM_DEFAULT_URL='udpm://239.255.76.67:7667?ttl=0' MPLCONFIGDIR=$PWD/build/demo/matplotlib
    build/release/aisled 2>"$out/aisled.err" &
    daemon=$!
    trap stop_daemon EXIT

    say "the map and the vehicle"
    "$aisle" map "$map"
    "$aisle" vehicle --vehicle tools/demo/vehicle.yaml

    say "ten queries (m, m/s, s; bound: no path is shorter)"
    "$aisle" query --map "$map" --goals tools/demo/pairs.csv --vehicle tools/demo/vehicle.yaml --save "$out/replies.log"

    say "an independent look at them: footprint every centimetre against every cell"
    "$aisle" check "$out/replies.log" --map "$map"

    say "the same AGV under a load of 3.0 x 2.2 m, which does not fit"
    "$aisle" vehicle --vehicle tools/demo/wide_load.yaml
    local answer=0
    "$aisle" query --map "$map" --start 2,-15 --goal -12.8,10.6 --vehicle tools/demo/wide_load.yaml \
        --timeout 60 --save "$out/refused.log" || answer=$?
    [ "$answer" = 1 ] || { echo "demo: expected a refusal" >&2 && exit 1; }

    say "the picture"
    "$aisle" plot --map "$map" --replies "$out/replies.log" --replies "$out/refused.log" --out "$out/paths.png" \
        --title "Proved paths of an AGV of 1.0 x 0.7 m, margin 0.1 m, and one load that does not fit"
}

mkdir -p "$out"
if [ "${1:-}" = --on-the-bus ]; then
    on_the_bus
    exit 0
fi
[ $# = 0 ] || { sed -n '2,7s/^# \{0,1\}//p' "$0" && exit 2; }
build
exec tools/netns-lo "$0" --on-the-bus
