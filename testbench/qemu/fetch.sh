#!/usr/bin/env bash
# Brings QEMU, a kernel and a static shell for the virtual machine from Debian's packages into target/qemu.
# Nothing is installed: packages are only downloaded and unpacked there, so no root is needed either.
set -eu -o pipefail
cd "$(dirname "$0")/../.."
folder=${CARGO_TARGET_DIR:-target}/qemu
mkdir -p "$folder/packages" "$folder/root"
folder=$(cd "$folder" && pwd)
if [ -e "$folder/complete" ]; then exit 0; fi

# A fresh machine knows no packages yet.
if ! apt-cache show qemu-system-x86 >/dev/null 2>&1; then apt-get update -q >/dev/null; fi
# QEMU with what it needs that is not here yet; the meta package names the kernel of the day.
needed=$(apt-get install --simulate --no-install-recommends qemu-system-x86 2>/dev/null | awk '/^Inst/ { print $2 }')
kernel=$(apt-cache depends linux-image-cloud-amd64 | awk '/Depends: linux-image-/ { print $2 }')
cd "$folder/packages"
# shellcheck disable=SC2086 # one word a package
apt-get download -q $needed qemu-system-x86 qemu-system-common qemu-system-data seabios busybox-static "$kernel"
for package in *.deb; do dpkg -x "$package" "$folder/root"; done
rm -rf "$folder/packages"
touch "$folder/complete"
