# Sourced by the scripts in this folder: packages, quiet steps, building a preset.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
logs=$(mktemp -d)
trap 'rm -rf "$logs"' EXIT

runtime_packages="pocl-opencl-icd binutils ocl-icd-opencl-dev opencl-clhpp-headers"
build_packages="g++ cmake make pkg-config libglm-dev libtinygltf-dev libopenexr-dev libimath-dev libpng-dev
  libstb-dev libcli11-dev libfmt-dev nlohmann-json3-dev"
test_packages="libgtest-dev libbenchmark-dev libembree-dev libtbb-dev
  libegl-dev libopengl-dev libegl-mesa0 libgl1-mesa-dri"

# step NAME COMMAND...: runs quietly; shows the output only where it fails
step() {
  local name=$1; shift
  printf '%s ... ' "$name"
  local start=$SECONDS
  if "$@" >"$logs/log" 2>&1; then
    printf 'done (%d s)\n' $((SECONDS - start))
  else
    local code=$?
    printf 'failed\n'
    tail -n "${STEP_LINES:-60}" "$logs/log"
    exit "$code"
  fi
}

missing_packages() {
  local package
  for package in "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || echo "$package"
  done
}

# install PACKAGE...: installs what is missing, with sudo where needed
install() {
  command -v dpkg-query >/dev/null || return 0  # not Debian: CMake names what it does not find
  local missing
  missing=$(missing_packages "$@" | tr '\n' ' ')
  [ -n "${missing// /}" ] || return 0
  local root=""
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || { echo "these packages are missing and there is no sudo: $missing"; exit 1; }
    root=sudo
  fi
  step "updating package lists" $root apt-get update
  step "installing $missing" $root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing
}

# build PRESET [CMAKE OPTION...]: configures and builds, through ccache where it is installed
build() {
  local preset=$1; shift
  local launcher=()
  command -v ccache >/dev/null && launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  step "configuring $preset" cmake --preset "$preset" "${launcher[@]}" "$@"
  step "building $preset" cmake --build --preset "$preset" -j "$(nproc)"
}
