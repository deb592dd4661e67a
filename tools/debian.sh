# Sourced by tools/demo and tools/test: what they need on a bare Debian 12, and the configured build folder.

# Installs the packages that are missing, and further ones given; says what to do where that is not possible.
install_missing_packages() {
  local packages=(g++ make cmake ninja-build libembree-dev libglm-dev libtinygltf-dev libopenimageio-dev openimageio-tools
    libtbb-dev libcli11-dev nlohmann-json3-dev libfmt-dev libssl-dev catch2 gnuplot-nox "$@")
  if ! command -v dpkg-query >/dev/null; then
    echo "$0: no Debian here; the packages below must come from elsewhere: ${packages[*]}" >&2
    return
  fi
  local missing=() package
  for package in "${packages[@]}"; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  if [ ${#missing[@]} -eq 0 ]; then return; fi
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "$0: packages are missing, and neither root nor sudo is at hand. As root: apt-get install ${missing[*]}" >&2
      exit 2
    fi
    as_root=(sudo)
  fi
  echo "installing: ${missing[*]}"
  "${as_root[@]}" apt-get update -q
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
}

# Configures build/ (further arguments go to CMake); keeps the generator of a folder that is configured already.
configure() {
  local generator=()
  if [ ! -f build/CMakeCache.txt ] && command -v ninja >/dev/null; then generator=(-G Ninja); fi
  cmake -S . -B build "${generator[@]}" -DCMAKE_BUILD_TYPE=Release "$@"
}
