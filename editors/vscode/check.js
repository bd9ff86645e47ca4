// A session with the language server by a client that knows nothing of it: the protocol library
// that editors use. `OBVERSE` names the command; `npm test` runs this.
"use strict";

const assert = require("node:assert");
const { spawn } = require("node:child_process");
const fs = require("node:fs");
const path = require("node:path");
const { pathToFileURL } = require("node:url");
const rpc = require("vscode-languageserver-protocol/node");

const PATIENCE_MS = 30_000;
const programs = path.join(__dirname, "..", "..", "programs");

function withinPatience(promise, what) {
  const late = new Promise((_, reject) =>
    setTimeout(() => reject(new Error(`no ${what} came`)), PATIENCE_MS).unref());
  return Promise.race([promise, late]);
}

async function session(connection, ended) {
  const file = path.join(programs, "handover.obv");
  const uri = pathToFileURL(file).toString();
  const published = new Promise((resolve) =>
    connection.onNotification(rpc.PublishDiagnosticsNotification.type, (found) => {
      if (found.uri === uri) resolve(found.diagnostics);
    }));
  connection.onRequest(rpc.RegistrationRequest.type, () => undefined);
  connection.listen();
  const ask = (type, params) => withinPatience(connection.sendRequest(type, params), type.method);
  const begun = await ask(rpc.InitializeRequest.type, {
    processId: process.pid, rootUri: null, capabilities: {},
  });
  assert.equal(begun.serverInfo.name, "obverse");
  await connection.sendNotification(rpc.InitializedNotification.type, {});
  const text = fs.readFileSync(file, "utf8");
  await connection.sendNotification(rpc.DidOpenTextDocumentNotification.type, {
    textDocument: { uri, languageId: "obverse", version: 1, text },
  });
  assert.deepEqual(await withinPatience(published, "diagnostics"), []);
  const textDocument = { uri };
  const line = text.split("\n").findIndex((one) => one.startsWith("sequence main"));
  const position = { line, character: "sequence m".length };
  const hover = await ask(rpc.HoverRequest.type, { textDocument, position });
  assert.match(hover.contents.value, /Class \*/);
  const lenses = await ask(rpc.CodeLensRequest.type, { textDocument });
  assert.ok(lenses.length > 0);
  const tokens = await ask(rpc.SemanticTokensRequest.type, { textDocument });
  assert.equal(tokens.data.length % 5, 0);
  const end = { line: text.split("\n").length, character: 0 };
  const range = { start: { line: 0, character: 0 }, end };
  const hints = await ask(rpc.InlayHintRequest.type, { textDocument, range });
  assert.ok(hints.length > 0);
  await ask(rpc.ShutdownRequest.type);
  await connection.sendNotification(rpc.ExitNotification.type);
  assert.equal(await withinPatience(ended, "end"), 0);
  console.log(`${begun.serverInfo.name} ${begun.serverInfo.version}: ` +
    `${lenses.length} lenses, ${hints.length} hints, ${tokens.data.length / 5} tokens`);
}

const server = spawn(process.env.OBVERSE || "obverse", ["lsp"], {
  stdio: ["pipe", "pipe", "inherit"],
});
const ended = new Promise((resolve) => server.on("exit", resolve));
server.on("error", (error) => {
  console.error(`the command cannot be run: ${error.message}; set OBVERSE to where it is`);
  process.exit(1);
});
const connection = rpc.createProtocolConnection(
  new rpc.StreamMessageReader(server.stdout), new rpc.StreamMessageWriter(server.stdin));
session(connection, ended).then(
  () => process.exit(0),
  (error) => {
    console.error(error);
    server.kill();
    process.exit(1);
  });
