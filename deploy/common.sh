# shellcheck shell=bash
# Shared by the scripts in this folder; sourced, not run.

project_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build_dir=$project_dir/build/release

# as_root COMMAND...: run it as root, through sudo when we are somebody else.
as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    echo "$0: installing packages needs root; run this as root or install sudo" >&2
    return 1
  fi
}

# install_packages LIST...: what these files of this folder list and is not there yet.
install_packages() {
  local wanted missing=() package
  wanted=$(cd "$project_dir/deploy" && sed -e 's/#.*//' "$@")
  for package in $wanted; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
  done
  if [ "${#missing[@]}" -eq 0 ]; then
    echo "All packages are installed."
    return
  fi
  echo "Installing: ${missing[*]}"
  as_root apt-get update -q
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"
}

# build_jobs: one per core, but not more than one per 2 GB of memory.
build_jobs() {
  local by_memory cores
  by_memory=$(awk '/^MemTotal:/ { print int($2 / 2000000) }' /proc/meminfo)
  cores=$(nproc)
  [ "$by_memory" -lt 1 ] && by_memory=1
  echo $((cores < by_memory ? cores : by_memory))
}

# build TARGET...: configure and build the release preset.
build() {
  cmake -S "$project_dir" --preset release >/dev/null
  cmake --build "$build_dir" --parallel "$(build_jobs)" --target "$@"
}
