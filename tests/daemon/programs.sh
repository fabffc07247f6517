#!/bin/sh
# aisled and aisle-replay as programs: options, exit codes, one line on stderr, clean stop. On LCM's memq, so no network.
#   programs.sh AISLED AISLE_REPLAY PACKAGING DAEMON_LIBRARY
set -u
aisled=$1 replay=$2 packaging=$3 library=$4
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
failures=0

fail() {
    echo "FAILED: $*"
    sed 's/^/    /' "$work/out" "$work/err"
    failures=$((failures + 1))
}

# expect CODE COMMAND...: runs it; its output is in $work/out and $work/err.
expect() {
    want=$1
    shift
    "$@" >"$work/out" 2>"$work/err"
    got=$?
    [ $got = "$want" ] || fail "exit $got, not $want: $*"
}

says() { grep -q -- "$2" "$work/$1" || fail "no \"$2\" on $1"; }
one_line() { [ "$(wc -l <"$work/err")" = 1 ] || fail "stderr is not one line"; }

expect 0 "$aisled" --version && says out '^aisled [0-9]*\.[0-9]*\.[0-9]*$'
expect 0 "$aisled" --help && says out '--check-config'
expect 2 "$aisled" --nonsense && says err 'unknown option' && one_line
expect 2 "$aisled" --prefix 'a b' && says err 'prefix' && one_line
expect 2 "$aisled" --config && says err 'missing' && one_line
expect 0 "$aisled" --check-config && says out 'defaults: good'
expect 0 "$aisled" --check-config --config "$packaging/aisled.ini" && says out 'good'
for section in bus planner limits vehicle daemon; do # the example names every setting that there is
    printf '[%s]\nno = 1\n' $section >"$work/no.ini"
    expect 2 "$aisled" --check-config --config "$work/no.ini"
    keys=$(sed -n 's/.*; allowed: //p' "$work/err" | tr -d ',')
    [ -n "$keys" ] || fail "no keys in [$section]"
    for key in $keys; do
        sed "1,/^\[$section\]/d; /^\[/,\$d" "$packaging/aisled.ini" | grep -q "^;* *$key =" || fail "no $key in aisled.ini"
    done
done
printf '[bus]\nprefix = OK\n[limits]\ncells = many\n' >"$work/bad.ini"
expect 2 "$aisled" --check-config --config "$work/bad.ini" && one_line
says err "^$work/bad.ini:4: .*allowed: 4096 to 16777216"
expect 2 "$aisled" --config "$work/bad.ini" && one_line
expect 2 "$aisled" --config "$work/none.ini" && says err 'cannot be read' && one_line
expect 0 "$aisled" --memory && says out '^heap of the core after start *0$' && says out '^planner, sum'
expect 1 "$aisled" --lcm-url "file:///none/log?mode=r" && says err 'bus cannot be joined'

stop() { # signal: starts and stops one; the milliseconds in $took
    "$aisled" --lcm-url memq:// >"$work/out" 2>"$work/err" &
    daemon=$!
    sleep 0.5
    before=$(date +%s%N)
    kill -"$1" $daemon
    wait $daemon
    got=$?
    took=$((($(date +%s%N) - before) / 1000000))
    [ $got = 0 ] || fail "exit $got after SIG$1"
    [ -s "$work/err" ] && fail "said something when stopped"
}

# A clean stop: exit 0 within 200 ms of the signal, in one of five tries where the machine is busy.
for signal in TERM INT; do
    for try in 1 2 3 4 5; do
        stop $signal
        [ $took -ge 200 ] || break
    done
    [ $took -lt 200 ] || fail "each stop took 200 ms or more after SIG$signal, the last one $took"
done

# Every allocation of the daemon's own is in engine.c, before the loop.
nm -A "$library" 2>"$work/err" | grep -E ' U (malloc|calloc|realloc|aligned_alloc|posix_memalign|strdup|mmap)$' \
    | grep -v ':engine.c' >"$work/out"
[ -s "$work/out" ] && fail "allocates outside engine.c"

expect 0 "$replay" --version && says out '^aisle-replay '
expect 2 "$replay" && says err 'log is missing' && one_line
expect 2 "$replay" log --repeat 0 && one_line
expect 2 "$replay" log --bench --check && one_line
expect 2 "$replay" a b && one_line
expect 1 "$replay" "$work/none.log" && says err 'No such file' && one_line
: >"$work/empty.log"
expect 0 "$replay" "$work/empty.log" && says out 'events 0'
expect 1 "$replay" "$work/empty.log" --check && says out 'equal 0'
expect 0 "$replay" "$work/empty.log" --json "$work/x.json"
python3 -c 'import json, sys; json.load(open(sys.argv[1]))' "$work/x.json" || fail "not JSON"
expect 0 "$replay" "$work/empty.log" --bench --json "$work/x.json"
python3 -c 'import json, sys; json.load(open(sys.argv[1]))' "$work/x.json" || fail "not JSON"

[ $failures = 0 ] && echo "all good"
exit $failures
