#!/bin/sh
# The extension for Visual Studio Code, as a user would build it: installed from its lock file, a
# session with the language server by a foreign client, and the package with what belongs into it.
# Needs node from 20 on, npm and unzip, and the command obverse (or OBVERSE, where it is). Ends with 77
# where its packages cannot be had, and nothing was checked.
set -eu
cd "$(dirname "$0")/vscode"
npm ci --silent --prefer-offline --no-audit --no-fund || {
  echo "not checked: the packages of the extension cannot be had" >&2
  exit 77
}
for file in extension.js check.js; do
  node --check "$file"
done
npm test
npm run --silent package > /dev/null
for file in extension.js package.json language-configuration.json \
  syntaxes/obverse.tmLanguage.json node_modules/vscode-languageclient/package.json; do
  unzip -l obverse.vsix "extension/$file" > /dev/null || {
    echo "the package has no $file" >&2
    exit 1
  }
done
echo "obverse.vsix: $(wc -c < obverse.vsix) bytes"
