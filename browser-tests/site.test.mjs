// The site in a browser. BOOK is the folder that scripts/site.sh has filled.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { after, before, describe, it } from "node:test";
import { browser, open } from "./browser.mjs";

const book = resolve(process.env.BOOK ?? "../target/book");
const path = (name) => `${book}/${name}`;
/** The pages of the list of contents, in its order. */
const pages = [...new Set([...readFileSync(path("toc.html"), "utf8").matchAll(/href="([^"#]+\.html)"/g)].map((found) => found[1]))];
const FOCUSED = "a[href], button, input, select, summary, [tabindex]";

describe("the site", () => {
  let chromium;
  before(async () => { chromium = await browser({ webgl: false }); });
  after(() => chromium.close());

  it("has the pages of the manual", () => {
    assert.ok(pages.length > 30, `${pages.length} pages`);
    for (const name of ["tutorial.html", "which-method.html", "glossary.html", "reference.html", "side-by-side.html"]) {
      assert.ok(pages.includes(name), name);
    }
  });

  it("every page of the contents opens without a complaint, with all of its pictures and within the window", async () => {
    for (const name of pages) {
      const { page, problems } = await open(chromium, path(name));
      assert.ok((await page.locator("main h1").first().innerText()).length > 2, name);
      const missing = await page.evaluate(async () => {
        const images = [...document.querySelectorAll("main img")];
        images.forEach((image) => { image.loading = "eager"; });
        await Promise.all(images.map((image) => image.decode().catch(() => {})));
        return images.filter((image) => image.naturalWidth === 0).map((image) => image.src);
      });
      assert.deepEqual(missing, [], name);
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
      assert.ok(wide <= 0, `${name}: ${wide} pixels too wide`);
      assert.deepEqual(problems, [], name);
      await page.close();
    }
    console.log(`${pages.length} pages`);
  });

  it("is read on a narrow screen", async () => {
    for (const name of ["tutorial.html", "reference.html", "side-by-side.html"]) {
      const { page } = await open(chromium, path(name), { viewport: { width: 400, height: 800 } });
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
      assert.ok(wide <= 0, `${name}: ${wide} pixels too wide`);
      await page.close();
    }
  });

  it("is searched by keys", async () => {
    const { page, problems } = await open(chromium, path("tutorial.html"));
    await page.keyboard.press("s");
    await page.waitForFunction(() => document.activeElement?.tagName === "INPUT");
    await page.keyboard.type("capstan");
    const first = page.locator("#mdbook-searchresults a").first();
    await first.waitFor({ state: "visible" });
    assert.ok(await page.locator("#mdbook-searchresults a").count() >= 3);
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("Enter");
    await page.waitForURL(/highlight=capstan/);
    assert.ok(/capstan/i.test(await page.locator("main").innerText()));
    assert.deepEqual(problems, []);
    await page.close();
  });

  it("every link and control of a page is reached by keys", async () => {
    const { page } = await open(chromium, path("tutorial.html"));
    const wanted = await page.evaluate((which) => {
      const all = [...document.querySelectorAll(which)];
      return all.filter((e) => e.tabIndex >= 0 && !e.disabled && e.checkVisibility({ visibilityProperty: true })).length;
    }, FOCUSED);
    const reached = new Set();
    for (let k = 0; k < wanted + 60; k++) {
      await page.keyboard.press("Tab");
      const at = await page.evaluate((which) => [...document.querySelectorAll(which)].indexOf(document.activeElement), FOCUSED);
      if (at >= 0) reached.add(at);
    }
    assert.ok(wanted > 20 && reached.size >= wanted, `${reached.size} of ${wanted}`);
    await page.close();
  });

  it("is turned over by keys", async () => {
    const { page } = await open(chromium, path(pages[0]));
    for (const name of pages.slice(1, 5)) {
      await page.keyboard.press("ArrowRight");
      await page.waitForURL(new RegExp(`${name.replace(".", "\\.")}$`));
    }
    await page.close();
  });

  it("is dark where that is preferred", async () => {
    const light = async (scheme) => {
      const { page, problems } = await open(chromium, path("tutorial.html"), { colorScheme: scheme });
      const colour = await page.evaluate(() => getComputedStyle(document.documentElement).backgroundColor);
      assert.deepEqual(problems, []);
      await page.close();
      const [red, green, blue] = colour.match(/\d+/g).map(Number);
      return (red + green + blue) / 3;
    };
    assert.ok(await light("light") > 200);
    assert.ok(await light("dark") < 60);
  });
});
