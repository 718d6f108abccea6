#!/usr/bin/env bash
# Downloads the arm64 packages that Sunder is linked with from the sources of apt, and unpacks them
# in a folder. Needs no root, and installs nothing.
#
# Usage: cmake/arm64_packages.sh [FOLDER]     (build-arm64/packages by default)
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=cmake/setup.sh
source cmake/setup.sh

packages=(libeigen3-dev libstb-dev libzstd-dev libzstd1 libxxhash-dev libxxhash0 nlohmann-json3-dev
  libtomlplusplus-dev libcli11-dev libbox2d-dev libbox2d2 libegl-dev libgl-dev
  libgtest-dev librapidcheck-dev)
folder=$(realpath -m "${1:-build-arm64/packages}")

for program in apt-get dpkg-deb; do
  command -v $program >/dev/null || fail "$program is missing: this script needs Debian or Ubuntu"
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work"/{state/lists,cache/archives}/partial "$work"/{files,unpacked}
: >"$work/status"
apt=(apt-get -q -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o APT::Sandbox::User=
  -o Dir::State="$work/state" -o Dir::State::status="$work/status" -o Dir::Cache="$work/cache"
  -o Debug::NoLocking=1)

say "Downloading ${#packages[@]} packages for arm64"
"${apt[@]}" update || fail "apt-get update failed: is the network reachable?"
(cd "$work/files" && "${apt[@]}" download "${packages[@]}") ||
  fail "apt-get could not download packages for arm64"
for file in "$work"/files/*.deb; do dpkg-deb -x "$file" "$work/unpacked"; done
mkdir -p "$(dirname "$folder")"
rm -rf "$folder"
mv "$work/unpacked" "$folder"
chmod 755 "$folder"
say "Unpacked in $folder"
