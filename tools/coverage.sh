#!/usr/bin/env bash
# Line and branch coverage of the C sources by all tests: a table, and build/coverage/report.html.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/setup.sh gcovr
cmake --preset coverage >/dev/null
cmake --build --preset coverage --parallel "$(nproc)" >/dev/null
find build/coverage -name '*.gcda' -delete
ctest --preset coverage --parallel "$(nproc)" --quiet --output-log build/coverage/ctest.txt ||
    echo "tests failed: build/coverage/ctest.txt"
gcovr --root . --filter src/ --filter include/ --exclude-directories '.*(CompilerId|/install/).*' \
    --exclude-unreachable-branches --txt --html-details build/coverage/report.html --print-summary build/coverage
