// Reports of gallery cases in a browser. REPORTS is a folder with NAME.html; SOME=1 tests what users do on a few of them only.

import assert from "node:assert/strict";
import { readdirSync, statSync } from "node:fs";
import { resolve } from "node:path";
import { after, before, describe, it } from "node:test";
import { browser, open, seen } from "./browser.mjs";

const folder = resolve(process.env.REPORTS ?? "reports");
const files = readdirSync(folder).filter((name) => name.endsWith(".html"));
const path = (name) => `${folder}/${name}`;
/** Cases with several states, in the plane and in space. */
const moving = files.filter((name) => ["snap_in.html", "die.html", "cosine_disc.html", "belt.html"].includes(name));

describe("with WebGL", () => {
  let chromium;
  before(async () => { chromium = await browser(); });
  after(() => chromium.close());

  for (const name of files) {
    it(`${name} is small, quick, shows something and complains of nothing`, async () => {
      const size = statSync(path(name)).size;
      assert.ok(size <= 5e6, `${size} bytes`);
      const { page, problems, milliseconds } = await open(chromium, path(name));
      assert.ok(milliseconds <= 2000, `${milliseconds} ms to the first view`);
      assert.ok((await page.locator("#verdict .short").innerText()).length > 2);
      if (await page.evaluate(() => Boolean(window.viewer))) {
        const { colours } = await seen(page);
        assert.ok(colours > 3, `only ${colours} colours`);
      } else {
        assert.ok(await page.locator("#fallback img, #view img").count() > 0 || await page.locator("#view").count() === 0);
      }
      const charts = await page.locator(".chart").count();
      assert.equal(await page.locator(".chart .uplot").count(), charts);
      // Nothing hangs out of the page.
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
      assert.ok(wide <= 0, `${wide} pixels too wide`);
      console.log(`${name}: ${(size / 1e6).toFixed(2)} MB, ${milliseconds} ms`);
      assert.deepEqual(problems, []);
      await page.close();
    });
  }

  for (const name of moving) {
    it(`${name}: slider, field, cut and keys change the view`, async () => {
      const { page, problems } = await open(chromium, path(name));
      let last = (await seen(page)).text;
      const changes = async (what) => {
        await page.evaluate(async () => { await window.viewer.ready; });
        const now = (await seen(page)).text;
        assert.notEqual(now, last, what);
        last = now;
      };
      await page.focus("#time");
      await page.keyboard.press("Home");
      assert.equal(await page.locator("#time-value").innerText(), await page.evaluate(() => shown(window.viewer.scene.times[0], 5)));
      await changes("the slider");
      await page.keyboard.press("End");
      await changes("the end of the slider");
      await page.selectOption("#field", "-1");
      await changes("colours of bodies");
      await page.focus("#canvas");
      await page.keyboard.press("ArrowRight");
      await changes("an arrow");
      await page.keyboard.press("+");
      await changes("plus");
      await page.keyboard.press("Home");
      await changes("Home");
      if (await page.locator("#cut-control").isVisible()) {
        await page.selectOption("#cut", "0");
        await page.focus("#cut-place");
        await page.keyboard.press("ArrowRight");
        await changes("a cut");
      }
      assert.deepEqual(problems, []);
      await page.close();
    });

    it(`${name}: all controls are reached by keys`, async () => {
      const { page } = await open(chromium, path(name));
      const wanted = await page.evaluate(() => {
        const all = [...document.querySelectorAll("button, select, input, summary, canvas[tabindex], .chart")];
        return all.filter((e) => !e.disabled && e.checkVisibility()).length;
      });
      const reached = new Set();
      for (let k = 0; k < 120; k++) {
        await page.keyboard.press("Tab");
        const at = await page.evaluate(() => {
          const all = [...document.querySelectorAll("button, select, input, summary, canvas[tabindex], .chart")];
          return all.indexOf(document.activeElement);
        });
        if (at >= 0) reached.add(at);
      }
      assert.ok(reached.size >= wanted, `${reached.size} of ${wanted}`);
      await page.close();
    });
  }

  it("is dark where that is preferred, and light in print", async () => {
    const { page, problems } = await open(chromium, path(moving[0] ?? files[0]), { colorScheme: "dark" });
    const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    assert.equal(await ground(), "rgb(22, 24, 28)");
    await page.emulateMedia({ media: "print", colorScheme: "light" });
    assert.equal(await ground(), "rgb(255, 255, 255)");
    assert.ok(!(await page.locator("#viewer").isVisible()));
    assert.ok(await page.locator("#fallback").isVisible());
    assert.ok((await page.pdf()).length > 10000);
    assert.deepEqual(problems, []);
    await page.close();
  });
});

describe("without WebGL", () => {
  it("shows the stored picture", async () => {
    const chromium = await browser({ webgl: false });
    const { page, problems } = await open(chromium, path(moving[0] ?? files[0]));
    assert.ok(!(await page.locator("#viewer").isVisible()));
    assert.ok(await page.locator("#fallback img").isVisible());
    assert.ok(await page.locator(".uplot").count() > 0);
    assert.deepEqual(problems, []);
    await chromium.close();
  });

  it("is read without JavaScript", async () => {
    const chromium = await browser({ webgl: false });
    const context = await chromium.newContext({ javaScriptEnabled: false });
    const page = await context.newPage();
    await page.goto(`file://${path(moving[0] ?? files[0])}`);
    assert.ok(await page.locator("#verdict").isVisible());
    assert.ok(await page.locator("#fallback img").isVisible());
    await chromium.close();
  });
});
