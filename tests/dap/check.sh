#!/bin/sh
# Holds what the debug adapter sends against the protocol's own schema, and lets a client of others
# drive it. Needs python3, node and their registries; everything is put into the target folder.
#
#     cargo test --test dap && tests/dap/check.sh
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
target=${CARGO_TARGET_DIR:-$root/target}
# Where cargo lets tests write: the sessions that are held against the schema are there.
scratch=$target/tmp
messages=$scratch/dap
mkdir -p "$messages"
venv=$scratch/dap-venv
if [ ! -x "$venv/bin/python" ]; then
  python3 -m venv "$venv"
  "$venv/bin/pip" -q install debugpy jsonschema
fi
client=$scratch/dap-client
mkdir -p "$client"
cp "$here"/client/* "$here"/client/.npmrc "$client"
(
  cd "$client"
  npm install --silent --no-fund --no-audit
  node client.js "$target/debug/obverse" "$root/programs" "$messages"
)
"$venv/bin/python" "$here/schema.py" "$messages"
