#!/usr/bin/env bash
# Sets up, builds with warnings as errors, runs every test; the last line is ctest's verdict.
#
#   tools/test.sh [--preset NAME] [--jobs N] [ctest argument...]     e.g. --preset sanitize -R wire
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

preset=release
jobs=$(nproc)
while [ $# -gt 0 ]; do
    case $1 in
    --preset) preset=${2:?--preset needs a name} && shift 2 ;;
    --jobs) jobs=${2:?--jobs needs a number} && shift 2 ;;
    -h | --help) sed -n '2,4s/^# \{0,1\}//p' "$0" && exit 0 ;;
    *) break ;;
    esac
done

tools/setup.sh
cmake --preset "$preset" >build/configure.log 2>&1 || { cat build/configure.log && exit 1; }
cmake --build --preset "$preset" --parallel "$jobs"
mkdir -p build/log
status=0
# Beside those that work there are up to three that wait for a bus (tests/e2e/CMakeLists.txt).
ctest --preset "$preset" --parallel "$((jobs + 3))" "$@" 2>&1 | tee "build/log/ctest-$preset.txt" || status=$?
grep -E '^[0-9]+% tests passed' "build/log/ctest-$preset.txt" || status=1
exit "$status"
