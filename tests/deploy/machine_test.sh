#!/usr/bin/env bash
# check_machine names everything that stands in the way, before anything is installed or built.  What it asks the machine
# by is replaced by functions.  Usage: machine_test.sh DEPLOY-FOLDER
set -euo pipefail
deploy=$1

# try SETUP: check_machine on a machine that SETUP makes; a build from nothing takes 500 MB.
try() {
  bash -c "set -euo pipefail; source '$deploy/common.sh'; build_dir=/nowhere
    dpkg-query() { printf installed; }; df() { printf 'x\\nfs 1 1 5000 1%% /\\n'; }; id() { echo 1000; }
    awk() { case \$1 in *MemTotal*) echo 4000 ;; *) command awk \"\$@\" ;; esac; }
    $1
    check_machine 500 packages.txt" 2>&1
}

# refused SETUP WORDS: that machine is refused with these words.
refused() {
  local said
  if said=$(try "$1"); then
    echo "not refused: $1" >&2
    exit 1
  fi
  if [[ $said != *"$2"* ]]; then
    echo "'$2' is not said: $said" >&2
    exit 1
  fi
}

try : || { echo "a good machine is refused" >&2; exit 1; }
refused 'df() { printf "x\nfs 1 1 300 1%% /\n"; }' "has 300 MB free, the build takes 500"
refused 'awk() { case $1 in *MemTotal*) echo 900 ;; *) command awk "$@" ;; esac; }' "900 MB of memory"
refused 'dpkg-query() { return 1; }; command() { [ "$2" != sudo ] && builtin command "$@"; }' "installing packages needs root"
# No name is needed to build and compute.
try 'getent() { return 2; }' || { echo "a machine without localhost in /etc/hosts is refused" >&2; exit 1; }
# A program that was installed from elsewhere is enough where the list says so.
for program in kubectl ''; do
  said=$(bash -c "set -euo pipefail; source '$deploy/common.sh'; dpkg-query() { return 1; }
    command() { if [ \"\$2\" = kubectl ]; then [ -n '$program' ]; else builtin command \"\$@\"; fi; }
    missing_packages container-packages.txt")
  if [[ $said == *kubernetes-client* && -n $program || $said != *kubernetes-client* && -z $program || $said != *podman* ]]; then
    echo "with the program '$program' these are missing: $said" >&2
    exit 1
  fi
done
# Everything at once.
all='awk() { case $1 in *MemTotal*) echo 900 ;; *) command awk "$@" ;; esac; }; df() { printf "x\nfs 1 1 300 1%% /\n"; }'
refused "$all" "900 MB of memory"
refused "$all" "has 300 MB free"
# A build that is there needs no more room.
there=$(mktemp -d)
trap 'rm -r "$there"' EXIT
touch "$there/build.ninja"
export there
try 'df() { printf "x\nfs 1 1 300 1%% /\n"; }; build_dir=$there' ||
  { echo "a second run is refused" >&2; exit 1; }
# --help prints help, and nothing is installed.
for script in quickstart run-tests; do
  said=$("$deploy/$script" --help)
  [[ $said == *"Usage: deploy/$script"* && $said != *"#"* && $said != *"=="* ]] || { echo "no help: $said" >&2; exit 1; }
done
if said=$("$deploy/quickstart" --fast 2>&1) || [[ $said != *"no option --fast"* ]]; then
  echo "--fast is taken: $said" >&2
  exit 1
fi
# Without localhost, run-tests leaves out the tests that need it, and names them.
mkdir "$there/deploy" "$there/bin"
cp "$deploy/run-tests" "$there/deploy"
cat > "$there/deploy/common.sh" <<'END'
project_dir=$there build_dir=$there
say() { echo "== $*"; }
answer_help() { :; }; check_machine() { :; }; install_packages() { :; }; build() { :; }
END
printf '#!/bin/sh\nexit 2\n' > "$there/bin/getent"
printf '#!/bin/sh\ncase $* in *" -N "*) echo "  Test #7: browser.web" ;; *) echo "ctest $*" ;; esac\n' > "$there/bin/ctest"
chmod +x "$there/bin/getent" "$there/bin/ctest"
said=$(PATH="$there/bin:$PATH" "$there/deploy/run-tests")
for words in 'of the label "localhost", a name that has no address here' 'browser.web' '-LE ^(all|localhost)$'; do
  [[ $said == *"$words"* ]] || { echo "'$words' is not said: $said" >&2; exit 1; }
done
