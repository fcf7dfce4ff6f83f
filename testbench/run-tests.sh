#!/usr/bin/env bash
# Every test binary of the workspace, as many side by side as there are cores: one alone seldom keeps two busy, and
# `cargo test` runs one after the other. Arguments after `--` go to each. Prints every binary's output when it ends, then
# the seconds of wall clock and processor that each took.
set -u -o pipefail
cd "$(dirname "$0")/.."
shift # the `--`

target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
results=$target/test-results
rm -rf "$results"
mkdir -p "$results"
# The longest first, so that none of them is left alone at the end.
longest=(equivalence qemu formal timing bitstream_build workflow)

# Lines of the package's folder, a tab and a binary, from what cargo built.
binaries() {
    cargo test --workspace --release --no-run --message-format=json --quiet |
        sed -n 's/.*"manifest_path":"\([^"]*\)\/Cargo.toml".*"test":true},"features".*"executable":"\([^"]*\)".*/\1\t\2/p' |
        sort
}
list=$(binaries) && [ -n "$list" ] || exit 1
order() {
    local name
    for name in "${longest[@]}"; do grep "/$name-[0-9a-f]*$" <<<"$list"; done
    grep -vE "/($(IFS='|'; printf '%s' "${longest[*]}"))-[0-9a-f]*$" <<<"$list"
}

one() {
    local folder=${1%%$'\t'*} binary=${1##*$'\t'} name result output
    shift
    name=$(basename "$binary")
    output=$results/$name
    cd "$folder" || return 1
    # shellcheck disable=SC2034 # read by `time`
    TIMEFORMAT='%R %U %S'
    { time CARGO_MANIFEST_DIR=$folder "$binary" "$@" >"$output.out" 2>&1; result=$?; } 2>"$output.time"
    local marked=passed
    [ "$result" = 0 ] || { marked=FAILED; touch "$output.failed"; }
    # One write, so that two that end together do not mix.
    printf '%s\n' "--- ${folder##*/}: ${name%-*}: $marked ($(cut -d' ' -f1 "$output.time") s)
$(cat "$output.out")"
    return "$result"
}
export -f one
export results

order | xargs -d '\n' -P "$(nproc)" -I '{}' bash -c 'one "$@"' one '{}' "$@"
passed=$?
# What is not a binary: the examples in the documentation.
cargo test --workspace --release --doc --no-fail-fast --quiet || passed=1
sum() { cat "$results"/*.out | sed -n "s/^test result: .* \([0-9]*\) $1;.*/\1/p" | awk '{ n += $1 } END { print n + 0 }'; }
printf '\nThe ten longest, in seconds by the clock and of the processor:\n'
for file in "$results"/*.time; do
    name=$(basename "$file" .time)
    awk -v name="${name%-*}" '{ printf "%7.0f %7.0f  %s\n", $1, $2 + $3, name }' "$file"
done | sort -rn | sed 10q
printf '%s functions passed, %s failed\n' "$(sum passed)" "$(sum failed)"
for file in "$results"/*.failed; do [ -e "$file" ] && printf 'FAILED: %s\n' "$(basename "$file" .failed)"; done
exit "$passed"
