// A headless Chromium that reaches no network, and what tests ask of a page.

import { chromium } from "playwright-core";

const QUIET = ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
  "--disable-sync"];
const DRAWN = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const NOT_DRAWN = ["--disable-gpu", "--disable-3d-apis"];

/** A browser, with WebGL by software or without any. */
export function browser({ webgl = true } = {}) {
  const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
  return chromium.launch({ executablePath, args: [...QUIET, ...(webgl ? DRAWN : NOT_DRAWN)] });
}

/** Opens a file; `problems` fills with errors, warnings and requests for anything else. */
export async function open(browser, file, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 }, ...options });
  const problems = [];
  page.on("pageerror", (error) => problems.push(`error: ${error.message}`));
  page.on("console", (message) => {
    // Software drawing is told to be slow; that is no fault of the page.
    const isOfDriver = /GPU stall|swiftshader|GroupMarkerNotSet/i.test(message.text());
    if (["error", "warning"].includes(message.type()) && !isOfDriver) problems.push(`${message.type()}: ${message.text()}`);
  });
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) problems.push(`request: ${request.url()}`);
  });
  const start = Date.now();
  await page.goto(`file://${file}`);
  await page.evaluate(async () => { await window.viewer?.ready; });
  return { page, problems, milliseconds: Date.now() - start };
}

/** How many colours the view shows, and its pixels as a text to compare. */
export async function seen(page) {
  await page.waitForTimeout(150);
  return page.evaluate(() => {
    window.viewer.drawNow();
    const canvas = document.getElementById("canvas");
    const copy = Object.assign(document.createElement("canvas"), { width: 160, height: 100 });
    const context = copy.getContext("2d");
    context.drawImage(canvas, 0, 0, 160, 100);
    const data = context.getImageData(0, 0, 160, 100).data;
    const colours = new Set();
    let text = "";
    for (let k = 0; k < data.length; k += 4) {
      colours.add((data[k] << 16) | (data[k + 1] << 8) | data[k + 2]);
      text += String.fromCharCode(data[k], data[k + 1]);
    }
    return { colours: colours.size, text };
  });
}
