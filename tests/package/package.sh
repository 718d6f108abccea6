#!/usr/bin/env bash
# Builds the Debian packages, checks them by lintian, installs them in a clean Debian, uses them
# there as an ordinary user, removes them, and checks that nothing of them is left. Prints the time
# from the installation to the first video.
#
# usage: tests/package/package.sh [FOLDER]   FOLDER has the packages; default: build-package/packages,
#                                            built here first
#
# Needs root, the packages mmdebstrap and lintian, and a Debian mirror; says so and exits with 77
# where one of them is missing.
# shellcheck disable=SC2016  # $ in single quotes is for the shell in the clean Debian
set -euo pipefail
cd "$(dirname "$0")/../.."


skip() {
  echo "skipped: $*"
  exit 77
}
fail() {
  echo "failed: $*" >&2
  exit 1
}
say() { printf '\n== %s\n' "$*"; }

for tool in cpack dpkg-deb mmdebstrap lintian; do
  command -v "$tool" >/dev/null || skip "$tool is missing: apt-get install cmake dpkg mmdebstrap lintian"
done
[ "$(id -u)" -eq 0 ] || skip "a clean Debian is made and entered by root"
# shellcheck source=/dev/null
suite=$(. /etc/os-release && [ "$ID" = debian ] && echo "$VERSION_CODENAME") ||
  skip "this is not Debian"

packages=${1:-}
if [ -z "$packages" ]; then
  say "Building the packages"
  packages=build-package/packages
  rm -rf "$packages"
  cmake --preset package >/dev/null
  cmake --build --preset package | tail -n 1
  cpack --config build-package/CPackConfig.cmake | tail -n 4
fi
packages=$(realpath "$packages")
ls "$packages"/sunder_*.deb "$packages"/libsunder0_*.deb "$packages"/libsunder-dev_*.deb >/dev/null ||
  fail "$packages has not the packages sunder, libsunder0 and libsunder-dev"

say "lintian"
lintian --allow-root --fail-on error "$packages"/*.deb || fail "lintian found errors"

work=$(mktemp -d)
root=$work/root
leave() {
  umount "$root/proc" "$root/dev" 2>/dev/null || true
  rm -rf --one-file-system "$work"
}
trap leave EXIT

say "Making a clean Debian $suite"
mmdebstrap --quiet --variant=apt --mode=root "$suite" "$root" ||
  skip "mmdebstrap could not make a clean Debian: is a mirror reachable?"
if ! mount -t proc proc "$root/proc" || ! mount --bind /dev "$root/dev"; then
  skip "file systems cannot be mounted here"
fi
echo 'Dpkg::Use-Pty "0";' >"$root/etc/apt/apt.conf.d/50package-test"
for conf in /etc/resolv.conf /etc/hosts; do cp -L "$conf" "$root/etc/"; done

inside() {
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive \
    "$@"
}
# Runs a command as a user without rights, in its home.
as_user() {
  chroot --userspec=4711:4711 "$root" env -i PATH=/usr/bin:/bin HOME=/home/user sh -c "cd && $1"
}
# Lists all files, but not what apt and dpkg keep about packages in general.
files() {
  (cd "$root" && find . -xdev \( -path ./proc -o -path ./dev -o -path ./var/lib/dpkg -o -path \
    ./var/lib/apt -o -path ./var/cache -o -path ./var/log -o -path ./home -o -path ./packages \) \
    -prune -o -print | sort)
}

inside apt-get -q update >/dev/null || skip "apt-get update failed: is a mirror reachable?"
mkdir -p "$root/home/user" "$root/packages"
chown 4711:4711 "$root/home/user"
cp "$packages"/*.deb "$root/packages"
files >"$work/before"

say "Installing sunder, and making a video"
start=$(date +%s)
inside sh -c 'apt-get -q install -y /packages/sunder_*.deb' >"$work/apt.log" ||
  { tail "$work/apt.log"; fail "sunder cannot be installed"; }
installed=$(date +%s)
touch "$work/stamp"
as_user "sunder render house -o house.mp4 --frames 0:60 --size 640x360"
finished=$(date +%s)
[ -s "$root/home/user/house.mp4" ] || fail "there is no video"
echo "installed in $((installed - start)) s, first video after $((finished - start)) s"

say "Using it as an ordinary user"
as_user "sunder doctor"
as_user "sunder golden test stack glass --junit golden.xml"
as_user "sunder bench stack --frames 10 --repeats 1 --warm-up 0 --quiet --json bench.json"
as_user "sunder trade stack --frames 2 --seeds 1 --quiet -o trade"
if as_user "sunder golden accept stack" 2>"$work/refused"; then
  fail "the goldens of the package were accepted"
fi
grep -q -- --folder "$work/refused" || fail "no remedy is named: $(cat "$work/refused")"
as_user "mkdir -p tests && cp -r /usr/share/sunder/golden tests/ && sunder golden accept stack"
as_user "rm -r tests && sunder bench stack --accept --repeats 1 --warm-up 0 --quiet"
[ -s "$root/home/user/tests/golden/hashes.txt" ] || fail "bench --accept stored no states"
changed=$(cd "$root" && find usr etc var/lib -xdev -newer "$work/stamp" -type f)
[ -z "$changed" ] || fail "files outside of the user's folders were changed: $changed"
[ -e "$root/usr/share/man/man1/sunder-render.1.gz" ] || fail "the manual page is missing"

say "Installing the library and the module"
inside sh -c 'apt-get -q install -y --no-install-recommends /packages/libsunder0_*.deb' \
  >"$work/apt.log" || { tail "$work/apt.log"; fail "libsunder0 cannot be installed"; }
if ls "$packages"/python3-sunder_*.deb >/dev/null 2>&1; then
  inside sh -c 'apt-get -q install -y --no-install-recommends /packages/python3-sunder_*.deb' \
    >"$work/apt.log" || { tail "$work/apt.log"; fail "python3-sunder cannot be installed"; }
  as_user "python3 -c 'import sunder; w = sunder.World(sunder.load_scene(\"stack\")); w.run(0.1); \
print(\"Python module\", sunder.__version__, len(w.bodies.positions), \"bodies\")'"
fi
inside sh -c 'apt-get -q install -y --no-install-recommends gcc libc6-dev pkg-config \
  /packages/libsunder-dev_*.deb' >"$work/apt.log" ||
  { tail "$work/apt.log"; fail "libsunder-dev cannot be installed"; }
cp examples/minimal.c "$root/home/user/"
as_user 'gcc minimal.c -o minimal $(pkg-config --cflags --libs sunder) -lm && ./minimal'

say "Removing them"
inside sh -c 'apt-get -q purge -y sunder libsunder0 libsunder-dev $(dpkg-query -W -f "\${Package}" \
  python3-sunder 2>/dev/null)' >"$work/apt.log" || { tail "$work/apt.log"; fail "purge failed"; }
files >"$work/after"
left=$(grep -i sunder "$work/after" || true)
[ -z "$left" ] || fail "these files are left: $left"
left=$(inside dpkg-query -W -f '${Package} ${Status}\n' '*sunder*' 2>/dev/null | grep -v not-installed ||
  true)
[ -z "$left" ] || fail "these packages are left: $left"
inside sh -c 'apt-get -q purge -y --autoremove gcc libc6-dev pkg-config' >"$work/apt.log"
inside sh -c 'apt-get -q autoremove -y --purge' >>"$work/apt.log"
files >"$work/end"
comm -13 "$work/before" "$work/end" >"$work/more"
echo "$(wc -l <"$work/more") files are more than before, of the packages that Sunder needs:"
head -n 5 "$work/more"

say "Done: the packages install, work, and leave nothing"
