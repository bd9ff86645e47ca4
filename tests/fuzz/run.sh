#!/bin/sh
# Builds all fuzz targets and runs each for some seconds (120), with a line each: how many inputs, and
# what was found. Needs a nightly toolchain and cargo-fuzz. Ends with 1 if anything was found; what it
# was told is beside it in `artifacts`.
#
#     sh run.sh [SECONDS [TARGET...]]
set -eu
cd "$(dirname "$0")"
seconds=${1:-120}
[ $# -eq 0 ] || shift
[ $# -gt 0 ] || set -- $(cd targets && ls | sed 's/[.]rs$//')
cargo +nightly fuzz build --fuzz-dir .
mkdir -p artifacts
found=0
for target in "$@"; do
  log=artifacts/$target.log
  if cargo +nightly fuzz run --fuzz-dir . "$target" -- -max_total_time="$seconds" \
    -timeout=60 -rss_limit_mb=4096 > "$log" 2>&1; then
    echo "$target: $(grep '^Done' "$log" | tail -1)"
  else
    found=1
    echo "$target: something was found, see $log"
  fi
done
exit "$found"
