# shellcheck shell=bash
# Shared by the scripts in this folder; sourced, not run.

project_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build_dir=$project_dir/build/release

# as_root COMMAND...: run it as root, through sudo when another user runs the script.
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

# say TEXT...: a line for the reader, apart from what the tools print.
say() { printf '== %s\n' "$*"; }

# answer_help SCRIPT ARGUMENT: ends with the comment at the script's head when that is asked for.
answer_help() {
  case $2 in
    -h | --help)
      sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$1"
      exit 0
      ;;
  esac
}

# missing_packages LIST...: what these files of this folder list and is not there yet, one to a line.  An entry
# PACKAGE/PROGRAM is there, too, when the program is: from elsewhere, it may exclude Debian's package.
missing_packages() {
  local entry package
  for entry in $(cd "$project_dir/deploy" && sed -e 's/#.*//' "$@"); do
    package=${entry%/*}
    [ "$package" = "$entry" ] || ! command -v "${entry#*/}" >/dev/null || continue
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || echo "$package"
  done
}

# check_machine ROOM LIST...: says all at once why this machine cannot do it, before anything is begun.  ROOM is what the
# build takes, in MB; the packages of the lists must be there, or can be installed.
check_machine() {
  local room=$1 faults=() there
  shift
  if ! grep -q '^VERSION_ID="12"' /etc/os-release 2>/dev/null; then
    echo "$0: this is not Debian 12, for which the packages are named; going on" >&2
  fi
  if [ -n "$(missing_packages "$@")" ]; then
    command -v apt-get >/dev/null || faults+=("packages are missing and there is no apt-get: $(missing_packages "$@" | tr '\n' ' ')")
    if [ "$(id -u)" -ne 0 ] && ! command -v sudo >/dev/null; then
      faults+=("installing packages needs root: run this as root or install sudo")
    fi
  fi
  there=$(df -Pm "$project_dir" | awk 'NR == 2 { print $4 }')
  if [ ! -e "$build_dir/build.ninja" ] && [ "$there" -lt "$room" ]; then
    faults+=("$project_dir has $there MB free, the build takes $room")
  fi
  [ -w "$project_dir" ] || faults+=("$project_dir is not writable")
  local memory
  memory=$(awk '/^MemTotal:/ { print int($2 / 1000) }' /proc/meminfo)
  [ "$memory" -ge 1900 ] || faults+=("$memory MB of memory, compiling takes 2000")
  [ "${#faults[@]}" -eq 0 ] && return
  printf "$0: %s\n" "${faults[@]}" >&2
  return 1
}

# install_packages LIST...: what these files of this folder list and is not there yet.
install_packages() {
  local missing
  mapfile -t missing < <(missing_packages "$@")
  if [ "${#missing[@]}" -eq 0 ]; then
    say "All packages are installed."
    return
  fi
  say "Installing ${#missing[@]} packages and what they need: ${missing[*]}"
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

# build [-DNAME=VALUE...] TARGET...: configure and build the release preset; several files at once, unless the folder
# was configured in another way.
build() {
  local settings=()
  [ -e "$build_dir/CMakeCache.txt" ] || settings+=(-DAFFSKEL_UNITY=ON)
  while [[ ${1:-} == -D* ]]; do
    settings+=("$1")
    shift
  done
  say "Building, $(build_jobs) at a time; [done/all] at the left."
  cmake -S "$project_dir" --preset release "${settings[@]}" >/dev/null
  cmake --build "$build_dir" --parallel "$(build_jobs)" --target "$@"
}
