#!/usr/bin/env bash
# Makes a minimal Debian, copies the committed files into it, and runs ./demo.sh, ./test.sh and, with
# --all, ./test.sh --all there, with an empty home. Prints the time of each, and the size of the
# packages that were installed. Not a test of ctest: takes from ten minutes to an hour.
#
# usage: tests/package/fresh_root.sh [--all] [SUITE]   SUITE: bookworm (default), trixie
#
# Needs root, the package mmdebstrap, and a Debian mirror.
# shellcheck disable=SC2016  # $ in single quotes is for the shell in the new Debian
set -euo pipefail
cd "$(dirname "$0")/../.."

steps=(./demo.sh ./test.sh)
if [ "${1:-}" = --all ]; then
  steps+=("./test.sh --all")
  shift
fi
suite=${1:-bookworm}

work=$(mktemp -d)
root=$work/root
leave() {
  umount "$root/proc" "$root/dev" 2>/dev/null || true
  rm -rf --one-file-system "$work"
}
trap leave EXIT

mmdebstrap --quiet --variant=minbase --include=ca-certificates --mode=root "$suite" "$root"
mount -t proc proc "$root/proc"
mount --bind /dev "$root/dev"
for conf in /etc/resolv.conf /etc/hosts; do cp -L "$conf" "$root/etc/"; done
mkdir "$root/sunder"
git archive HEAD | tar -x -C "$root/sunder"

inside() {
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/home DEBIAN_FRONTEND=noninteractive \
    sh -c "cd /sunder && $1"
}
# Prints the number and the installed size of all packages, in MB.
packages() {
  chroot "$root" dpkg-query -W -f='${Installed-Size}\n' |
    awk '{ size += $1 } END { printf "%d packages, %d MB installed\n", NR, size / 1e3 }'
}

echo "$suite: $(packages)"
for step in "${steps[@]}"; do
  log=out/$suite-$(tr -cd a-z <<<"$step").log
  mkdir -p out
  start=$SECONDS
  if ! inside "$step" >"$log" 2>&1; then
    tail -n 40 "$log"
    echo "failed: $step in $suite, after $((SECONDS - start)) s; the output is in $log" >&2
    exit 1
  fi
  echo "$step: $((SECONDS - start)) s; $(packages); archives fetched so far:" \
    "$(sed -n 's/^Need to get \(.*\) of archives.*/\1/p' "$log" | paste -sd+ | tr -d '\n')"
done
