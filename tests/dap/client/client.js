// A client of others drives the debug adapter: through a run to a breakpoint, on, and back to what
// cannot be taken back; and through the tape of a run, from its end.
//
//     node client.js BINARY PROGRAMS TRANSCRIPTS
"use strict";

const assert = require("assert");
const cp = require("child_process");
const fs = require("fs");
const path = require("path");
const { session } = require("./adapter");

const [binary, programs, transcripts] = process.argv.slice(2);

/** The line of a program that begins so. */
function lineOf(program, text) {
  const lines = fs.readFileSync(program, "utf8").split("\n");
  const line = lines.findIndex((one) => one.trim().startsWith(text)) + 1;
  assert.ok(line > 0, `${program} has no line ${text}`);
  return line;
}

/** Ask for something that ends in a stop; the stop. */
async function stops(client, asked) {
  const [stopped] = await Promise.all([client.waitForEvent("stopped"), asked()]);
  return stopped.body;
}

/** Type something into the console that shows another moment; what it answers. */
async function jumps(client, expression) {
  let answer;
  await stops(client, async () => {
    answer = await client.evaluateRequest({ expression, context: "repl" });
  });
  return answer.body.result;
}

async function value(client, expression) {
  const answer = await client.evaluateRequest({ expression, context: "watch" });
  return answer.body.result;
}

async function top(client, threadId) {
  const stack = await client.stackTraceRequest({ threadId });
  return stack.body.stackFrames[0];
}

/** A run of a program, live: forward, in reverse up to what cannot be taken back, and rewound. */
async function live(client) {
  const glue = path.join(programs, "glue.obv");
  const behind = lineOf(glue, "irreversible") + 8;
  await client.hitBreakpoint({ program: glue, seed: 1 }, { path: glue, line: behind });
  const threadId = (await client.threadsRequest()).body.threads[0].id;
  await assert.rejects(client.stepBackRequest({ threadId }), /the glue is on the block/);
  await Promise.all([
    client.nextRequest({ threadId }),
    client.assertStoppedLocation("step", { line: behind + 1 }),
  ]);
  await stops(client, () => client.reverseContinueRequest({ threadId }));
  assert.strictEqual((await top(client, threadId)).line, behind);
  await client.evaluateRequest({ expression: "bookmark here", context: "repl" });
  await jumps(client, "goto here");
  await stops(client, () => client.reverseContinueRequest({ threadId }));
  await stops(client, () => client.reverseContinueRequest({ threadId }));
  const start = await top(client, threadId);
  assert.ok(start.line !== behind);
  const scopes = await client.scopesRequest({ frameId: start.id });
  for (const { variablesReference } of scopes.body.scopes) {
    await client.variablesRequest({ variablesReference });
  }
}

/** The tape of a run whose first pin jams: what went wrong, and what the second would have done. */
async function recorded(client) {
  const program = path.join(programs, "bad_pin.obv");
  const tape = path.join(transcripts, "bad_pin.tape");
  const ran = cp.spawnSync(binary, ["run", program, "--seed", "1", "--tape", tape]);
  assert.strictEqual(ran.status, 0, String(ran.stderr));
  await client.initializeRequest();
  const initialized = client.waitForEvent("initialized");
  await client.attachRequest({ tape, program });
  await initialized;
  const source = { path: program };
  const throws = lineOf(program, "throw pin_jams");
  const picks = lineOf(program, "move to pin.grasp");
  const asked = { source, breakpoints: [{ line: throws }, { line: picks }] };
  const set = await client.setBreakpointsRequest(asked);
  assert.ok(set.body.breakpoints.every((breakpoint) => breakpoint.verified));

  const opened = await stops(client, () => client.configurationDoneRequest());
  assert.match(opened.description, /at the end of the recording/);
  const threadId = (await client.threadsRequest()).body.threads[0].id;
  const [ended, steps] = [await value(client, "next_pin"), await value(client, "steps")];
  assert.strictEqual(ended, "3");

  // Back over the pick of the second pin to where the first jammed; the end is as it was.
  const back = () => stops(client, () => client.reverseContinueRequest({ threadId }));
  assert.strictEqual((await back()).reason, "breakpoint");
  assert.strictEqual((await top(client, threadId)).line, picks);
  await back();
  assert.strictEqual((await top(client, threadId)).line, throws);
  assert.strictEqual(await value(client, "held"), "pin_1");
  await jumps(client, "goto end");
  assert.strictEqual(await value(client, "steps"), steps);
  assert.match(await jumps(client, "goto error"), new RegExp(`:${throws}\\b`));
  assert.strictEqual((await top(client, threadId)).line, throws);

  // What would have been, had the second pin been fetched first.
  await jumps(client, "goto start");
  await stops(client, () => client.nextRequest({ threadId }));
  assert.match(await jumps(client, "what-if"), /^what-if/);
  await client.evaluateRequest({ expression: "set next_pin = 2", context: "repl" });
  await client.setBreakpointsRequest({ source, breakpoints: [{ line: throws }] });
  const tried = await stops(client, () => client.continueRequest({ threadId }));
  assert.match(tried.description, /the program has ended/, "nothing is thrown");
  assert.strictEqual(await value(client, "next_pin"), "3");
  await jumps(client, "leave");
  await jumps(client, "goto end");
  assert.strictEqual(await value(client, "steps"), steps, "the recording is as it was");
}

async function main() {
  for (const [name, hold] of Object.entries({ outside: live, outside_tape: recorded })) {
    const transcript = path.join(transcripts, `${name}.jsonl`);
    const count = await session(binary, transcript, hold);
    console.log(`${name}: an outside client was sent ${count} messages`);
  }
}

main().then(
  () => process.exit(0),
  (error) => {
    console.error(error);
    process.exit(1);
  },
);
