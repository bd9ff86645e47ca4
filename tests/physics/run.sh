#!/bin/sh
# Compare contact and kinematics with other libraries; see README.md beside this.
# Exits with 1 if one of them is below its target. Arguments go to insertions.py.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
target=${CARGO_TARGET_DIR:-$root/target}
venv=$target/physics-venv

(cd "$root" && cargo build --quiet --package obverse-sim --examples)
if ! cmp -s "$here/requirements.txt" "$venv/installed.txt"; then
  python3 -m venv --clear "$venv"
  "$venv/bin/pip" install --quiet --requirement "$here/requirements.txt"
  cp "$here/requirements.txt" "$venv/installed.txt"
fi

export PYTHONDONTWRITEBYTECODE=1
status=0
echo "# Forward kinematics"
echo
"$venv/bin/python" "$here/kinematics.py" "$target/debug/examples/forward" || status=1
echo
echo "# Insertions"
echo
"$venv/bin/python" "$here/insertions.py" "$target/debug/examples/insertions" "$@" || status=1
exit $status
