// A client of others drives the debug adapter: to a breakpoint, on, back to what cannot be taken
// back, and over it in the recording.
//
//     node client.js BINARY PROGRAMS TRANSCRIPT
"use strict";

const assert = require("assert");
const cp = require("child_process");
const fs = require("fs");
const net = require("net");
const path = require("path");
const { DebugClient } = require("@vscode/debugadapter-testsupport");

const [binary, programs, transcript] = process.argv.slice(2);
const glue = path.join(programs, "glue.obv");
const lineOf = (text) =>
  fs.readFileSync(glue, "utf8").split("\n").findIndex((line) => line.trim().startsWith(text)) + 1;

/** An adapter on a port, and the port. */
function listen() {
  const adapter = cp.spawn(binary, ["dap", "--port", "0"], { stdio: ["ignore", "ignore", "pipe"] });
  return new Promise((resolve, reject) => {
    let told = "";
    adapter.on("error", reject);
    adapter.stderr.on("data", (data) => {
      told += data;
      const found = told.match(/listening on port (\d+)/);
      if (found) resolve({ adapter, port: Number(found[1]) });
    });
  });
}

/** Keeps every message that the adapter sends, as it goes through. */
function tap(port, messages) {
  const server = net.createServer((client) => {
    const adapter = net.connect(port, "127.0.0.1");
    let bytes = Buffer.alloc(0);
    client.pipe(adapter);
    adapter.pipe(client);
    adapter.on("data", (data) => {
      bytes = Buffer.concat([bytes, data]);
      for (;;) {
        const end = bytes.indexOf("\r\n\r\n");
        if (end < 0) return;
        const length = Number(bytes.subarray(0, end).toString().match(/Content-Length: (\d+)/)[1]);
        if (bytes.length < end + 4 + length) return;
        messages.push(bytes.subarray(end + 4, end + 4 + length).toString());
        bytes = bytes.subarray(end + 4 + length);
      }
    });
    for (const socket of [client, adapter]) socket.on("error", () => socket.destroy());
  });
  return new Promise((resolve) => server.listen(0, "127.0.0.1", () => resolve(server)));
}

async function main() {
  const messages = [];
  const { adapter, port } = await listen();
  const server = await tap(port, messages);
  const client = new DebugClient("node", "", "obverse");
  client.defaultTimeout = 10000;
  await client.start(server.address().port);
  const never = lineOf("irreversible");
  const behind = never + 8;
  await client.hitBreakpoint({ program: glue, seed: 1 }, { path: glue, line: behind });
  const threadId = (await client.threadsRequest()).body.threads[0].id;
  await assert.rejects(client.stepBackRequest({ threadId }), /the glue is on the block/);
  await Promise.all([
    client.nextRequest({ threadId }),
    client.assertStoppedLocation("step", { line: behind + 1 }),
  ]);
  await Promise.all([
    client.reverseContinueRequest({ threadId }),
    client.waitForEvent("stopped"),
  ]);
  const stack = await client.stackTraceRequest({ threadId });
  assert.strictEqual(stack.body.stackFrames[0].line, behind);
  const rewind = { expression: "rewind", context: "repl" };
  await Promise.all([client.waitForEvent("stopped"), client.evaluateRequest(rewind)]);
  await Promise.all([client.waitForEvent("stopped"), client.reverseContinueRequest({ threadId })]);
  await Promise.all([client.waitForEvent("stopped"), client.reverseContinueRequest({ threadId })]);
  const start = await client.stackTraceRequest({ threadId });
  assert.ok(start.body.stackFrames[0].line !== behind);
  const scopes = await client.scopesRequest({ frameId: start.body.stackFrames[0].id });
  for (const { variablesReference } of scopes.body.scopes) {
    await client.variablesRequest({ variablesReference });
  }
  await client.disconnectRequest();
  adapter.kill();
  fs.writeFileSync(transcript, messages.join("\n") + "\n");
  console.log(`an outside client was answered ${messages.length} times`);
}

main().then(
  () => process.exit(0),
  (error) => {
    console.error(error);
    process.exit(1);
  },
);
