#!/bin/sh
# Installs the extension in a real Visual Studio Code, which runs as a server (npm's `code-server`),
# and drives that in a browser as a person would: are the language, classes and mistakes shown, does a
# debug session start, step, step back, and go back to the start?
#
#     cargo build && sh editors/real/run.sh
#
# Needs node 20 with npm, its registry, a C++ compiler for modules of the editor that are built here,
# and chromium; CHROMIUM and OBVERSE name the browser and the command, where they are elsewhere.
# Everything is put into the target folder: 400 MB, in two minutes, once. Tells a line for what is
# seen, and leaves pictures beside it. Ends with 0 if all is seen, 1 if something is not, and 2 if the
# editor cannot be had here. It is no part of `cargo test`.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
target=${CARGO_TARGET_DIR:-$root/target}
obverse=${OBVERSE:-$target/debug/obverse}
scratch=$target/real-editor
version=4.96.4
code=$scratch/code-server-$version

# Of the modules of the editor, one is locked to a place where its source is kept, and the registry
# has the same version; and only those that are needed here are built.
install_editor() {
  cd "$scratch"
  npm pack --silent "code-server@$version" > /dev/null
  tar xzf "code-server-$version.tgz"
  rm "code-server-$version.tgz"
  cd package
  npm install --omit=dev --ignore-scripts --no-audit --no-fund --silent
  npm rebuild --silent argon2
  cd lib/vscode
  node -e '
    const fs = require("node:fs");
    const lock = JSON.parse(fs.readFileSync("npm-shrinkwrap.json"));
    for (const one of Object.values(lock.packages)) {
      if (!(one.resolved || "").startsWith("git")) continue;
      delete one.resolved;
      delete one.integrity;
    }
    fs.writeFileSync("npm-shrinkwrap.json", JSON.stringify(lock));'
  npm install --omit=dev --ignore-scripts --no-audit --no-fund --silent
  npm rebuild --silent @vscode/spdlog node-pty native-watchdog @parcel/watcher @vscode/deviceid
  ln -sfn node_modules node_modules.asar
  cd extensions
  npm install --omit=dev --ignore-scripts --no-audit --no-fund --silent
  mv "$scratch/package" "$code"
}

cannot() {
  echo "the editor cannot be had here: $1" >&2
  exit 2
}

[ -x "$obverse" ] || cannot "no command at $obverse"
CHROMIUM=$(command -v "${CHROMIUM:-chromium}") || cannot "no browser; set CHROMIUM"
export CHROMIUM
mkdir -p "$scratch"
if [ ! -d "$code" ]; then
  rm -rf "$scratch/package"
  (install_editor) || cannot "code-server $version does not install"
fi
mkdir -p "$scratch/driver"
cp "$here/look.js" "$here/package.json" "$here/.npmrc" "$scratch/driver"
(cd "$scratch/driver" && npm install --silent --no-audit --no-fund) || cannot "no playwright-core"

# The extension as it is now.
rm -rf "$scratch/extension" "$scratch/home"
mkdir -p "$scratch/extension" "$scratch/home/data/Machine" "$scratch/home/programs"
(cd "$root/editors/vscode" && tar cf - --exclude node_modules --exclude '*.vsix' .) |
  (cd "$scratch/extension" && tar xf -)
(cd "$scratch/extension" && npm ci --silent --no-audit --no-fund && npm run --silent package) \
  > "$scratch/package.log" || cannot "the extension does not package"
cp "$root"/programs/peg_in_hole.* "$scratch/home/programs"
cat > "$scratch/home/data/Machine/settings.json" << END
{
  "obverse.path": "$obverse",
  "files.autoSave": "off",
  "git.openRepositoryInParentFolders": "never",
  "workbench.startupEditor": "none",
  "workbench.colorTheme": "Default Light Modern"
}
END
serve() {
  HOME=$scratch/home exec node "$code/out/node/entry.js" --auth none --bind-addr 127.0.0.1:0 \
    --disable-telemetry --disable-update-check --disable-workspace-trust \
    --user-data-dir "$scratch/home/data" --extensions-dir "$scratch/home/extensions" "$@"
}
(serve --install-extension "$scratch/extension/obverse.vsix") > "$scratch/server.log" 2>&1 ||
  cannot "the extension does not install: $scratch/server.log"
serve "$scratch/home/programs" > "$scratch/server.log" 2>&1 &
server=$!
trap 'kill "$server" 2> /dev/null || true' EXIT
address=
for _ in $(seq 50); do
  address=$(sed -n 's|.*listening on \(http://[0-9.:]*\).*|\1|p' "$scratch/server.log" | head -1)
  [ -z "$address" ] || break
  sleep 0.2
done
[ -n "$address" ] || cannot "it does not listen: $scratch/server.log"
cd "$scratch/driver"
HOME=$scratch/home node look.js "$address" "$scratch/home/programs" "$scratch" || exit 1
echo "pictures are in $scratch"
