// Drives Visual Studio Code in a browser, with the extension installed, as a person would: opens a
// program, makes a mistake, asks for parameters, and debugs forwards and back.
//
//     node look.js ADDRESS FOLDER PICTURES
//
// CHROMIUM is the path of the browser. FOLDER is open there and has `peg_in_hole.obv` in it. A line is told for everything that is seen;
// the exit code is 1 if something is not.
"use strict";

const assert = require("node:assert");
const fs = require("node:fs");
const path = require("node:path");
const { chromium } = require("playwright-core");

const [address, folder, pictures] = process.argv.slice(2);
const PATIENCE_MS = 40_000;

/** The address at which a file of the folder is open. */
function opened(file) {
  const { host } = new URL(address);
  const resource = `vscode-remote://${host}${path.join(folder, file)}`;
  const payload = JSON.stringify([["openFile", resource]]);
  return `${address}/?folder=${folder}&payload=${encodeURIComponent(payload)}`;
}

/** Wait until something is seen; what it is. */
async function until(what, look) {
  const end = Date.now() + PATIENCE_MS;
  for (;;) {
    const seen = await look();
    if (seen) {
      console.log(`ok: ${what}`);
      return seen;
    }
    if (Date.now() > end) throw new Error(`not seen: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 200));
  }
}

async function texts(page, selector) {
  const all = await page.$$eval(selector, (found) => found.map((one) => one.textContent));
  return all.map((text) => text.replace(/\u00a0/g, " ").trim());
}

async function shot(page, name, clip) {
  await page.screenshot({ path: path.join(pictures, `${name}.png`), clip });
}

/** The line that the cursor is on, which goes along with the run. */
async function line(page) {
  const status = (await texts(page, ".statusbar-item")).join("\n");
  return Number((status.match(/Ln (\d+)/) || [])[1]);
}

async function reading(page) {
  await until("the language is recognised", async () =>
    (await texts(page, ".statusbar-item")).includes("Obverse"));
  await until("a lens says how far a sequence goes back", async () =>
    (await texts(page, ".codelens-decoration")).includes("goes back to its start"));
  await until("hints say classes", async () => {
    const lines = await texts(page, ".view-line");
    const has = (text) => lines.some((one) => text.test(one));
    return has(/^move to handle\W*after$/) && has(/^wait 0.2 s\W*always$/);
  });
  const problems = await texts(page, ".squiggly-error");
  assert.deepEqual(problems, [], "no mistake is seen where there is none");
  await shot(page, "reading");
}

async function writing(page) {
  await page.keyboard.press("Control+End");
  await page.keyboard.type("sequence other { move ");
  await page.keyboard.press("Control+Shift+Space");
  await until("a command tells its form", async () => {
    const shown = await texts(page, ".parameter-hints-widget .signature");
    return shown.some((text) => text.startsWith("move distance direction"));
  });
  await until("a mistake is underlined", async () =>
    (await page.$$(".squiggly-error")).length > 0);
  await shot(page, "writing");
  await page.keyboard.press("Escape");
  // Back to what is on the disk; undoing further does nothing.
  for (let undone = 0; undone < 12; undone += 1) {
    await page.keyboard.press("Control+Z");
  }
  await until("and is gone when it is mended", async () =>
    (await page.$$(".squiggly-error")).length === 0);
}

async function debugging(page, program) {
  const lines = fs.readFileSync(program, "utf8").split("\n");
  const first = lines.findIndex((one) => one.startsWith("sequence reliability_test")) + 2;
  const press = (label) => page.click(`.debug-toolbar a[aria-label^="${label}"]`);
  const at = (number) => async () => (await line(page)) === number;
  await page.keyboard.press("F5");
  await page.waitForSelector(".debug-toolbar", { timeout: PATIENCE_MS });
  await until("a run begins at its first action", at(first));
  await press("Step Over");
  await until("it steps over an action", at(first + 1));
  await press("Step Over");
  await until("and over another", at(first + 2));
  await press("Step Back");
  await until("it steps back", at(first + 1));
  await page.click(".debug-viewlet .monaco-list-row:has-text('Workcell')");
  await until("the workcell can be looked into", async () =>
    (await texts(page, ".debug-viewlet .monaco-list-row")).some((row) => row.startsWith("force")));
  // What is below names folders of this machine.
  await shot(page, "debugging", { x: 0, y: 0, width: 1100, height: 440 });
  await press("Reverse");
  await until("it goes back to the start", at(first - 1));
  await until("and says so", async () =>
    (await texts(page, ".debug-viewlet")).join("\n").includes("back at the start"));
  await until("with the variables there", async () =>
    (await texts(page, ".debug-viewlet .monaco-list-row")).includes("Workcell"));
  await press("Stop");
  await until("the session ends", async () => (await page.$$(".debug-toolbar")).length === 0
    || !(await page.isVisible(".debug-toolbar")));
}

async function main() {
  const executablePath = process.env.CHROMIUM;
  const browser = await chromium.launch({ executablePath, args: ["--no-sandbox"] });
  const page = await browser.newPage({ viewport: { width: 1100, height: 700 } });
  try {
    await page.goto(opened("peg_in_hole.obv"));
    await page.waitForSelector(".monaco-editor .view-line", { timeout: PATIENCE_MS });
    await page.click(".monaco-editor .view-line");
    await reading(page);
    await writing(page);
    await debugging(page, path.join(folder, "peg_in_hole.obv"));
  } catch (error) {
    await shot(page, "failed");
    throw error;
  } finally {
    await browser.close();
  }
}

main().then(
  () => process.exit(0),
  (error) => {
    console.error(error.message);
    process.exit(1);
  },
);
