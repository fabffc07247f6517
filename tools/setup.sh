#!/usr/bin/env bash
# Installs what building and testing Aisle needs; only what is missing, so a second run does nothing.
#
#   tools/setup.sh [package...]     extra Debian packages, e.g. gcovr
#
# Debian packages come through apt (as root or with sudo), Unity from UNITY_ROOT, the system, or Debian's source package
# of ntpsec (its tests/unity), the Python packages go into build/venv. Nothing outside build/ is written but by apt.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# What the build, the tests and the gates call. libclang-rt: sanitizers and libFuzzer. xz: unpacks Unity.
# liblcm-java: used where javac is. chromium: plays the page of aisle view in a test.
packages=(cmake ninja-build gcc g++ clang clang-format llvm libclang-rt-14-dev libc6-dev liblcm-dev liblcm-bin
    liblcm-java libccd-dev libinih-dev python3 python3-venv chromium iproute2 util-linux tar xz-utils git)
python_packages=(lcm==1.5.3 -e '.[test]') # the rest is in pyproject.toml

say() { printf 'setup: %s\n' "$*"; }
die() {
    printf 'setup: %s\n' "$*" >&2
    exit 1
}

missing_packages() {
    local name
    for name in "$@"; do
        [ "$(dpkg-query -W -f '${db:Status-Abbrev}' "$name" 2>/dev/null)" = "ii " ] || printf '%s\n' "$name"
    done
}

install_packages() {
    local missing as_root=()
    command -v dpkg-query >/dev/null || die "no dpkg here; install the likes of: $*; then set AISLE_SETUP_NO_APT=1"
    mapfile -t missing < <(missing_packages "$@")
    [ ${#missing[@]} -gt 0 ] || return 0
    if [ "$(id -u)" != 0 ]; then
        command -v sudo >/dev/null || die "neither root nor sudo; ask for: apt-get install ${missing[*]}"
        as_root=(sudo)
    fi
    say "installing ${missing[*]}"
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq update </dev/null
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -y --no-install-recommends install \
        "${missing[@]}" </dev/null >/dev/null
}

unity_present() {
    local dir
    for dir in "${UNITY_ROOT:-}" build/deps/unity /usr/src/unity /usr/local/src/unity; do
        [ -n "$dir" ] || continue
        if [ -f "$dir/unity.c" ] || [ -f "$dir/src/unity.c" ]; then return 0; fi
    done
    return 1
}

# The machine's own apt sources of this release, asked for source packages instead: $1 takes *.list and *.sources.
source_entries() {
    local out=$1 list parts file codename
    codename=$(. /etc/os-release && printf '%s' "${VERSION_CODENAME:-stable}")
    list=$(apt-config shell f Dir::Etc::sourcelist/f | sed "s/^f='\(.*\)'$/\1/")
    parts=$(apt-config shell d Dir::Etc::sourceparts/d | sed "s/^d='\(.*\)'$/\1/")
    for file in "$list" "$parts"/*.list; do
        [ -f "$file" ] || continue
        awk -v suite="$codename" '$1 == "deb" && $0 ~ "[ \t]" suite "[ \t]" { $1 = "deb-src"; print }' "$file" \
            >>"$out/machine.list"
    done
    for file in "$parts"/*.sources; do
        [ -f "$file" ] || continue
        awk -v suite="$codename" 'BEGIN { RS = ""; FS = "\n" }
            $0 ~ "(^|\n)Suites:[^\n]*[ \t]" suite "([ \t\n]|$)" && $0 !~ "(^|\n)Enabled: *no" {
                for (i = 1; i <= NF; i++) { if ($i ~ /^Types:/) { $i = "Types: deb-src" } print $i }
                print ""
            }' "$file" >>"$out/machine.sources"
    done
    find "$out" -type f -empty -delete
    [ -n "$(ls -A "$out")" ] || die "no apt source of $codename found; set UNITY_ROOT to a copy of Unity"
}

# Unity 2.5 as the NTPsec source package carries it. apt checks the signatures; its lists and cache stay in build/.
fetch_unity() {
    local work=$PWD/build/deps/apt tarball
    say "fetching Unity from Debian's source package ntpsec"
    rm -rf "$work"
    mkdir -p "$work/parts" "$work/lists/partial" "$work/cache/archives/partial" "$work/download"
    source_entries "$work/parts"
    local options=(-qq -o Dir::Etc::SourceList=/dev/null -o Dir::Etc::SourceParts="$work/parts"
        -o Dir::State::Lists="$work/lists" -o Dir::Cache="$work/cache" -o Acquire::Languages=none)
    [ "$(id -u)" != 0 ] || options+=(-o APT::Sandbox::User=root)
    apt-get "${options[@]}" update </dev/null
    (cd "$work/download" && apt-get "${options[@]}" source --download-only ntpsec </dev/null >/dev/null)
    tarball=$(find "$work/download" -name 'ntpsec_*.orig.tar.*' ! -name '*.asc')
    [ -f "$tarball" ] || die "the source package ntpsec did not arrive; set UNITY_ROOT to a copy of Unity"
    mkdir -p "$work/unity"
    tar --no-same-owner -xf "$tarball" -C "$work/unity" --strip-components=3 --wildcards '*/tests/unity/*'
    [ -f "$work/unity/unity.c" ] || die "ntpsec no longer carries tests/unity; set UNITY_ROOT to a copy of Unity"
    rm -rf build/deps/unity
    mv "$work/unity" build/deps/unity
    rm -rf "$work"
}

install_python() {
    if ! build/venv/bin/python -c 'import pip' 2>/dev/null; then
        say "making build/venv"
        rm -rf build/venv
        python3 -m venv build/venv
    fi
    say "installing Python packages into build/venv"
    build/venv/bin/python -m pip install -q --disable-pip-version-check "${python_packages[@]}" </dev/null
}

# What the Python environment is made from: its place, this file, the package's description, the message types.
python_stamp() {
    { pwd && cat tools/setup.sh pyproject.toml setup.py lcmtypes/*.lcm; } | sha256sum | cut -c1-64
}

mkdir -p build/deps
exec 9>build/deps/setup.lock # two at a time would trip over each other
flock 9
[ -n "${AISLE_SETUP_NO_APT:-}" ] || install_packages "${packages[@]}" "$@"
unity_present || fetch_unity &
unity=$!
stamp=$(python_stamp)
if [ "$(cat build/venv/aisle.stamp 2>/dev/null)" != "$stamp" ] || ! build/venv/bin/python -c '' 2>/dev/null; then
    install_python
    printf '%s\n' "$stamp" >build/venv/aisle.stamp
fi
wait "$unity"
