# shellcheck shell=bash
# What the scripts share; they source it. Not to be run.
set -euo pipefail

HIRES_SOURCE=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)

# Debian's python3 must come first: catkin lives in its dist-packages, and another python3 ahead of
# it ends configuring with "No module named catkin_pkg".
export PATH="/usr/sbin:/usr/bin:/sbin:/bin:$PATH"
export HOME="${HOME:-$(getent passwd "$(id -u)" | cut -d: -f6)}"
# ccache learns from the compiler what was included, instead of preprocessing each file once more, and
# it may answer for precompiled headers, which CMake writes anew into each folder.
export CCACHE_DEPEND="${CCACHE_DEPEND:-1}"
export CCACHE_SLOPPINESS="pch_defines,time_macros,include_file_mtime,include_file_ctime${CCACHE_SLOPPINESS:+,$CCACHE_SLOPPINESS}"
# Message code for Lisp, Emacs and JavaScript would only cost time.
export ROS_LANG_DISABLE="${ROS_LANG_DISABLE:-genlisp:geneus:gennodejs}"

Say() { printf '%s: %s\n' "$(basename "$0")" "$*"; }
Die() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# The comment at the top of a script is its help text.
Usage() {
  sed -n '2,/^[^#]/{s/^# \{0,1\}//p}' "$0"
  exit "${1:-0}"
}

# BuildFolder [variant]: where a build lives, outside of the source tree because rosrun overlooks
# programs below it. Checkouts in different places never share one.
BuildFolder() {
  local base="${HIRES_BUILD:-}"
  if [ -z "$base" ]; then
    local hash
    hash=$(printf '%s' "$HIRES_SOURCE" | sha256sum | cut -c1-12)
    base="${XDG_CACHE_HOME:-$HOME/.cache}/hires/$hash"
  fi
  printf '%s%s\n' "$base" "${1:+-$1}"
}

# Ubuntu 20.04 keeps ROS under /opt; Debian keeps it in /usr.
SourceRosIfApart() {
  if [ -f /opt/ros/noetic/setup.bash ]; then
    set +u
    # shellcheck disable=SC1091
    . /opt/ros/noetic/setup.bash
    set -u
  fi
}

# Nothing listens beyond this machine unless the user asked for it.
BindToLoopback() {
  if [ -z "${ROS_HOSTNAME:-}" ] && [ -z "${ROS_IP:-}" ]; then export ROS_HOSTNAME=localhost; fi
}

# Configure folder [-Dkey=value ...]: quick and quiet when nothing changed.
Configure() {
  local folder=$1
  shift
  local generator=(-G Ninja)
  command -v ninja >/dev/null || generator=(-G 'Unix Makefiles')
  if [ -f "$folder/CMakeCache.txt" ]; then generator=(); fi
  mkdir -p "$folder"
  if ! cmake -S "$HIRES_SOURCE" -B "$folder" "${generator[@]}" \
    -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3 "$@" \
    >"$folder/configure.log" 2>&1; then
    cat "$folder/configure.log" >&2
    Die "configuring failed; if a package is missing, run scripts/setup"
  fi
}

Compile() {
  local folder=$1
  shift
  cmake --build "$folder" --parallel "${HIRES_JOBS:-$(nproc)}" "$@"
}

# RunTests folder [ctest arguments]: the verdict is ctest's, and its summary comes last. Tests that wait
# more than they compute take half a processor, so halves are counted.
RunTests() {
  local folder=$1
  shift
  (cd "$folder" && ctest --output-on-failure --no-tests=error \
    --parallel "$((2 * ${HIRES_JOBS:-$(nproc)}))" "$@")
}
