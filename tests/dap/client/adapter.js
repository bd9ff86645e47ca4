// An adapter on a port, a client of others that is connected to it, and every message that the
// adapter sends meanwhile.
"use strict";

const cp = require("child_process");
const fs = require("fs");
const net = require("net");
const { DebugClient } = require("@vscode/debugadapter-testsupport");

/** How long an answer may take, in milliseconds. */
const PATIENCE_MS = 10_000;

/** An adapter on a port, and the port. */
function listen(binary) {
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

/** Let a client hold a session, and write what the adapter sent to a transcript. */
async function session(binary, transcript, hold) {
  const messages = [];
  const { adapter, port } = await listen(binary);
  try {
    const server = await tap(port, messages);
    const client = new DebugClient("node", "", "obverse");
    client.defaultTimeout = PATIENCE_MS;
    await client.start(server.address().port);
    await hold(client);
    await client.disconnectRequest();
  } finally {
    adapter.kill();
  }
  fs.writeFileSync(transcript, messages.join("\n") + "\n");
  return messages.length;
}

module.exports = { session };
