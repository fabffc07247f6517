#!/usr/bin/env bash
# Line and branch coverage of the C sources by all tests: a table, and build/coverage/report.html.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/setup.sh gcovr
cmake --preset coverage >/dev/null
cmake --build --preset coverage --parallel "$(nproc)"
find build/coverage -name '*.gcda' -delete
ctest --preset coverage --parallel "$(nproc)" --output-log build/coverage/ctest.txt | tail -n 3
gcovr --root . --object-directory build/coverage --filter src/ --filter include/ --exclude-unreachable-branches \
    --html-details build/coverage/report.html --print-summary
