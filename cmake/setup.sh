# Functions of demo.sh and test.sh that check the processor, install packages and configure the
# build. Sourced from the root of the project.
# shellcheck shell=bash

# Debian packages: `tools` build and run the program; `checks` test and time it.
tools=(g++ cmake ninja-build ccache pkg-config
  libeigen3-dev libstb-dev libzstd-dev libxxhash-dev nlohmann-json3-dev
  libtomlplusplus-dev libcli11-dev libbox2d-dev libegl-dev libgl-dev
  libegl1 libegl-mesa0 libgl1-mesa-dri libosmesa6 ffmpeg)
checks=(libgtest-dev libgmock-dev librapidcheck-dev libbenchmark-dev python3)

say() { printf '\n== %s\n' "$*"; }
fail() {
  printf '\nerror: %s\n' "$*" >&2
  exit 1
}

# On x86-64 the program is compiled for x86-64-v3 unless SUNDER_ARCH says otherwise.
check_processor() {
  if [ -n "${SUNDER_ARCH:-}" ] || [ "$(uname -m)" != x86_64 ]; then return; fi
  local flag
  for flag in avx2 bmi2 fma movbe; do
    grep -qw "$flag" /proc/cpuinfo ||
      fail "this processor has no $flag, which x86-64-v3 code needs." \
        "Try: SUNDER_ARCH=x86-64-v2 $0"
  done
}

# Prints the packages that are not installed.
missing() {
  local installed
  installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "$@" 2>/dev/null |
    sed -n 's/^installed //p') || true
  comm -23 <(printf '%s\n' "$@" | sort -u) <(sort -u <<<"$installed")
}

# Installs the packages that are missing, and does nothing if all are installed.
install_packages() {
  local wanted run=()
  mapfile -t wanted < <(missing "$@")
  if [ ${#wanted[@]} -eq 0 ]; then
    say "All packages are installed"
    return
  fi
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null ||
      fail "these packages are missing, and installing them needs root or sudo: ${wanted[*]}"
    run=(sudo)
  fi
  say "Installing ${wanted[*]}"
  run+=(env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300)
  "${run[@]}" update || fail "apt-get update failed: is the network reachable?"
  "${run[@]}" install -y --no-install-recommends "${wanted[@]}" ||
    fail "apt-get could not install: ${wanted[*]}"
}

# Installs packages like install_packages, but only warns if that fails.
install_optional() {
  (install_packages "$@") ||
    echo "warning: continuing without $*: tests and benchmarks that need them are skipped"
}

# Checks the processor, installs the packages, and configures the build in build/.
set_up() {
  check_processor
  if command -v dpkg-query >/dev/null && command -v apt-get >/dev/null; then
    install_packages "${tools[@]}" "${checks[@]}"
  else
    echo "warning: this is not Debian or Ubuntu (no apt-get): installing nothing." \
      "The names of the Debian packages needed are in cmake/setup.sh."
  fi
  say "Configuring"
  cmake --preset release ${SUNDER_ARCH:+-DSUNDER_ARCH="$SUNDER_ARCH"}
}
