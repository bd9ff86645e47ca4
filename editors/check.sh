#!/bin/sh
# The extension for Visual Studio Code, as a user would build it: installed from its lock file, a
# session with the language server by a foreign client, and the package with what belongs into it.
# Needs node and npm, and the command obverse (or OBVERSE, where it is).
set -eu
cd "$(dirname "$0")/vscode"
npm ci --no-audit --no-fund
for file in extension.js check.js; do
  node --check "$file"
done
npm test
npm run package
for file in extension.js package.json language-configuration.json \
  syntaxes/obverse.tmLanguage.json node_modules/vscode-languageclient/package.json; do
  unzip -l obverse.vsix "extension/$file" > /dev/null || {
    echo "the package has no $file" >&2
    exit 1
  }
done
echo "obverse.vsix: $(wc -c < obverse.vsix) bytes"
