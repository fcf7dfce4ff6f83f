#!/usr/bin/env bash
# The release archive: racbot for a PC, the robot's one static file, the bitstream, units, the book, manual pages,
# completions, checksums. From the same sources it has the same bytes, but for what the compiler does.
#
#   dist/release.sh [--out DIR] [--pc FILE] [--robot FILE]
#
# --pc and --robot take commands that are built already; else both are built here.
set -eu -o pipefail
repository=$(cd "$(dirname "$0")/.." && pwd)
out=$repository/target/dist
pc=
robot=
while [ $# -gt 0 ]; do
    [ $# -gt 1 ] || { echo "release.sh: $1: its value is missing; see the head of this file" >&2; exit 2; }
    case $1 in
    --out) out=$2 ;;
    --pc) pc=$2 ;;
    --robot) robot=$2 ;;
    *) echo "release.sh: $1: unknown; it takes --out DIR, --pc FILE, --robot FILE" >&2; exit 2 ;;
    esac
    shift 2
done
target=${CARGO_TARGET_DIR:-$repository/target}
triple=x86_64-unknown-linux-gnu
if [ -z "$pc" ]; then
    (cd "$repository" && cargo build --locked --release -p racbot)
    pc=$target/release/racbot
fi
if [ -z "$robot" ]; then
    (cd "$repository" && RUSTFLAGS="-C target-feature=+crt-static" cargo build --locked --profile robot -p racbot \
        --no-default-features --target $triple)
    robot=$target/$triple/robot/racbot
fi

version=$("$pc" --version | cut -d' ' -f2)
name=racbot-$version-x86_64-linux
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
root=$work/$name
mkdir -p "$root"/{bin,robot,share/man/man1,share/completions,data,generated,docs/book/src/effects,docs/measured,docs/pictures}
install -m 755 "$pc" "$root/bin/racbot"
install -m 755 "$robot" "$root/robot/racbot"
install -m 644 "$repository/generated/rac4i65.bit" "$root/robot/"
for file in 60-racbot.rules INSTALL.md racbot-drive@.service racbot-load.service racbot.limits racbot.sysusers; do
    install -m 644 "$repository/dist/$file" "$root/robot/"
done
install -m 644 "$repository"/{README.md,CHANGELOG.md,ARCHITECTURE.md,CONTRIBUTING.md,LICENSE-MIT,LICENSE-APACHE} "$root/"
# What README and errors point to: the book, with the tables and pictures that it shows.
for folder in docs/book/src docs/book/src/effects docs/measured docs/pictures; do
    find "$repository/$folder" -maxdepth 1 -type f -exec install -m 644 -t "$root/$folder" {} +
done
install -m 644 "$repository"/generated/{blocks,registers}.md "$root/generated/"
install -m 644 "$repository/data/robot.toml" "$root/data/"
"$pc" man "$root/share/man/man1" >/dev/null
for shell in bash zsh fish elvish powershell; do
    "$pc" completions $shell >"$root/share/completions/racbot.$shell"
done
chmod 644 "$root"/share/man/man1/* "$root"/share/completions/*
(cd "$root" && find . -type f ! -name SHA256SUMS | LC_ALL=C sort | xargs sha256sum >SHA256SUMS)

mkdir -p "$out"
tar --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner -C "$work" -cf - "$name" | gzip -n9 >"$out/$name.tar.gz"
(cd "$out" && sha256sum "$name.tar.gz" >"$name.tar.gz.sha256")
echo "$out/$name.tar.gz"
