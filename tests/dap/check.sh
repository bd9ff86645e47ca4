#!/bin/sh
# Holds what the debug adapter sends against the protocol's own schema, and lets a client of others
# drive it. Needs python3 with venv, node and npm; what else it needs comes from their registries
# once, into the target folder. Ends with 77 where that cannot be had, and nothing was checked.
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

lacks() {
  echo "not checked: $1" >&2
  exit 77
}

venv=$scratch/dap-venv
if ! "$venv/bin/python" -c 'import debugpy, jsonschema' 2>/dev/null; then
  python3 -m venv "$venv" || lacks "python3 makes no environment"
  "$venv/bin/pip" -q install debugpy jsonschema || lacks "debugpy and jsonschema cannot be had"
fi
client=$scratch/dap-client
mkdir -p "$client"
cp "$here"/client/* "$here"/client/.npmrc "$client"
cd "$client"
if ! node -e 'require("@vscode/debugadapter-testsupport")' 2>/dev/null; then
  npm install --silent --no-fund --no-audit || lacks "the client's packages cannot be had"
fi
node client.js "$target/debug/obverse" "$root/programs" "$messages"
"$venv/bin/python" "$here/schema.py" "$messages"
