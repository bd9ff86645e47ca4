// The client of the language server and of the debug adapter: both are the command `obverse`, which
// does everything else.
"use strict";

const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

/** The scheme of the files that come with the language. */
const LIBRARY = "obverse-library";

let client;

function command() {
  return vscode.workspace.getConfiguration("obverse").get("path") || "obverse";
}

async function start() {
  const server = { command: command(), args: ["lsp"] };
  client = new LanguageClient("obverse", "Obverse", server, {
    documentSelector: [
      { language: "obverse", scheme: "file" },
      { language: "obverse", scheme: "untitled" },
    ],
  });
  try {
    await client.start();
  } catch (error) {
    // What the client fails with need not be an error.
    const why = (error && error.message) || error || "it does not answer";
    const said = `The command \`${server.command}\` cannot be run: ${why}. `;
    vscode.window.showErrorMessage(`${said}Set \`obverse.path\` to where it is.`);
  }
}

async function stop() {
  const running = client;
  client = undefined;
  if (running && running.needsStop()) {
    await running.stop();
  }
}

/** What a configuration lacks when one presses the key without having written any. */
function resolveDebugConfiguration(_folder, configuration) {
  const editor = vscode.window.activeTextEditor;
  const isEmpty = !configuration.type && !configuration.request && !configuration.name;
  if (isEmpty && editor && editor.document.languageId === "obverse") {
    return {
      type: "obverse",
      request: "launch",
      name: "Debug this program",
      program: editor.document.fileName,
      stopOnEntry: true,
    };
  }
  return configuration;
}

function activate(context) {
  const adapter = {
    createDebugAdapterDescriptor: () => new vscode.DebugAdapterExecutable(command(), ["dap"]),
  };
  const library = {
    provideTextDocumentContent: (uri) =>
      client ? client.sendRequest("obverse/library", { uri: uri.toString(true) }) : "",
  };
  const changed = async (event) => {
    if (event.affectsConfiguration("obverse.path")) {
      await stop();
      await start();
    }
  };
  context.subscriptions.push(
    vscode.debug.registerDebugAdapterDescriptorFactory("obverse", adapter),
    vscode.debug.registerDebugConfigurationProvider("obverse", { resolveDebugConfiguration }),
    vscode.workspace.registerTextDocumentContentProvider(LIBRARY, library),
    vscode.workspace.onDidChangeConfiguration(changed),
  );
  return start();
}

module.exports = { activate, deactivate: stop };
