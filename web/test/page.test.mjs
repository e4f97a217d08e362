// The page as a person uses it: opened from disk, pointed at, coloured, played, measured, printed.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { readFileSync, statSync } from "node:fs";

import { launch, open, scratch, screenshot, simulate } from "./browser.mjs";

const source = join(dirname(fileURLToPath(import.meta.url)), "..", "..");
const folder = scratch();
let browser;
let torus;
let unfinished;

before(async () => {
    torus = simulate(folder, join(source, "examples/torus/scene.toml"), "--set", "output.film_frames=12");
    unfinished = simulate(folder, join(source, "examples/stars/scene.toml"), "--set", "solver.max_iterations=3");
    browser = await launch();
}, { timeout: 600000 });
after(() => browser?.close());

const drawing = ".view.flat canvas";
const shape = ".view.shape canvas";
const report = () => JSON.parse(readFileSync(join(torus, "report.json"), "utf8"));

/** The picture on a canvas, kept in the page; gives a number to compare it by. */
const look = (page, selector) =>
    page.evaluate((css) => {
        window.rucheStage.drawNow();
        const small = document.createElement("canvas");
        small.width = small.height = 256;
        const ink = small.getContext("2d", { willReadFrequently: true });
        ink.drawImage(document.querySelector(css), 0, 0, 256, 256);
        window.looks ??= [];
        return window.looks.push(ink.getImageData(0, 0, 256, 256).data) - 1;
    }, selector);

/** Mean difference of two looks, in levels of 255. */
const difference = (page, a, b) =>
    page.evaluate(([i, j]) => {
        const [one, other] = [window.looks[i], window.looks[j]];
        return one.reduce((sum, v, k) => sum + Math.abs(v - other[k]), 0) / one.length;
    }, [a, b]);

/** The `which`-th of the points of a grid over the view that lie on a strip, counted from 0; negative from the end. */
async function pointOnStrip(page, selector, which = 0) {
    const frame = await page.locator(selector).boundingBox();
    const placing = selector === drawing ? "flat" : "shape";
    const found = await page.evaluate(([kind, box]) => {
        const points = [];
        for (let i = 1; i < 40; ++i)
            for (let j = 1; j < 40; ++j) {
                const [x, y] = [box.x + (box.width * i) / 40, box.y + (box.height * j) / 40];
                const strip = window.rucheStage.stripAt(kind, x, y);
                if (strip >= 0) points.push({ x, y, strip });
            }
        return points;
    }, [placing, frame]);
    assert.ok(found.length > 0, `no strip in ${selector}`);
    return found.at(which);
}

test("page: opens from disk without an error and asks for nothing else", async () => {
    const page = await open(browser, torus);
    assert.equal(await page.locator("h1").textContent(), "torus");
    assert.match(await page.locator(".badge").textContent(), /converged, stable/);
    assert.equal(await page.locator(".alert").count(), 0);
    assert.equal(await page.locator(".strips tbody tr").count(), report().strips.length);
    await screenshot(page, "desktop", { fullPage: true });
    assert.deepEqual(page.troubles, []);
    await page.close();
});

test("page: a strip that is pointed at in the drawing lights up on the shape and in the table, and the other way", async () => {
    const page = await open(browser, torus);
    for (const [here, there] of [[drawing, shape], [shape, drawing]]) {
        await page.mouse.move(5, 5);
        const dark = await look(page, there);
        const at = await pointOnStrip(page, here);
        await page.mouse.move(at.x, at.y);
        await page.waitForSelector(`.strips tr.hovered[data-strip="${at.strip}"]`);
        assert.ok((await difference(page, dark, await look(page, there))) > 0.002, `nothing lights up in ${there}`);
        const card = await page.locator(".hover:visible").textContent();
        const strip = report().strips[at.strip];
        assert.ok(card.includes(strip.id), card);
        assert.ok(card.includes(`${Number(strip.curvature_per_mm.toPrecision(4))} /mm`), card);
        assert.ok(card.includes(`${Number(strip.radius_mm.toPrecision(4))} mm`), card);
    }
    await screenshot(page, "hover");
    assert.deepEqual(page.troubles, []);
    await page.close();
});

test("page: a click chooses a strip until Escape lets it go", async () => {
    const page = await open(browser, torus);
    const at = await pointOnStrip(page, drawing);
    await page.mouse.click(at.x, at.y);
    await page.waitForSelector(`.strips tr[aria-selected="true"][data-strip="${at.strip}"]`);
    await page.mouse.move(5, 5);
    assert.match(await page.locator(".readout").textContent(), /curvature/);
    await page.locator(shape).focus();
    await page.keyboard.press("Escape");
    assert.equal(await page.locator('.strips tr[aria-selected="true"]').count(), 0);
    await page.close();
});

test("page: every colouring has a legend with its unit and changes both views", async () => {
    const page = await open(browser, torus);
    const units = { thickness: "mm", side: "", stretch_max: "", stretch_min: "", curvature_max: "/mm", curvature_min: "/mm", mean_curvature: "/mm", gauss_curvature: "/mm²", energy: "mJ/mm²" };
    const values = await page.locator('select[aria-label="colour by"] option').evaluateAll((all) => all.map((o) => o.value));
    assert.deepEqual(values, ["materials", ...Object.keys(units)]);
    let before = [await look(page, drawing), await look(page, shape)];
    for (const [field, unit] of Object.entries(units)) {
        await page.selectOption('select[aria-label="colour by"]', field);
        const heading = await page.locator(".legend p").first().textContent();
        assert.ok(heading.endsWith(unit), `${field}: ${heading}`);
        const now = [await look(page, drawing), await look(page, shape)];
        const unlike = field === "side" ? -1 : 0.01;  // one side, one thickness: the same picture
        for (const i of [0, 1])
            assert.ok((await difference(page, before[i], now[i])) > unlike, `${field} looks like the one before`);
        before = now;
        if (["stretch_min", "gauss_curvature", "energy"].includes(field)) await screenshot(page, `colour-${field}`);
    }
    assert.deepEqual(page.troubles, []);
    await page.close();
});

test("page: the release plays from flat to final, every stop says what it is", async () => {
    const page = await open(browser, torus);
    const slider = page.locator(".film input");
    const last = Number(await slider.getAttribute("max"));
    assert.ok(last >= 10, `only ${last} frames`);
    const final = await look(page, shape);
    await slider.fill("0");
    assert.match(await page.locator(".film output").textContent(), /^Flat/);
    const flat = await look(page, shape);
    assert.ok((await difference(page, final, flat)) > 2);
    await slider.fill(String(Math.floor(last / 2)));
    assert.match(await page.locator(".film output").textContent(), /Equilibrium at a pre-stretch of 1\.\d{3}/);
    await screenshot(page, "film-half");
    await slider.fill("0");
    await page.click(".play");
    await page.waitForFunction((end) => Number(document.querySelector(".film input").value) === end, last, { timeout: 600000 });
    assert.match(await page.locator(".film output").textContent(), /^Released/);
    // The camera has stepped back for the flat sheet; from its first place the shape is the first one again.
    await page.locator(shape).focus();
    await page.keyboard.press("0");
    assert.ok((await difference(page, final, await look(page, shape))) < 0.01);
    assert.deepEqual(page.troubles, []);
    await page.close();
});

test("page: two clicks measure the distance, on the shape and on the drawing", async () => {
    const page = await open(browser, torus);
    await page.click("button.tool");
    const [a, b] = [await pointOnStrip(page, drawing), await pointOnStrip(page, drawing, -1)];
    for (const { x, y } of [a, b]) await page.mouse.click(x, y);
    const text = await page.locator(".readout").textContent();
    const [released, printed] = text.match(/[\d.]+(?= mm)/g).map(Number);
    const mm = parseFloat(await page.locator(".scalebar b").textContent());
    const bar = (await page.locator(".scalebar i").boundingBox()).width;
    const expected = (Math.hypot(a.x - b.x, a.y - b.y) * mm) / bar;
    assert.ok(Math.abs(printed - expected) < 0.01 * expected, `${text}: expected ${expected} mm`);
    assert.ok(released > 0 && released < printed, text);
    await screenshot(page, "measure");
    await page.close();
});

test("page: the section plane takes away part of the shape, standard views turn it", async () => {
    const page = await open(browser, torus);
    const whole = await look(page, shape);
    await page.selectOption('select[aria-label="section plane"]', "y");
    const cut = await look(page, shape);
    assert.ok((await difference(page, whole, cut)) > 0.5);
    await screenshot(page, "section");
    await page.selectOption('select[aria-label="section plane"]', "");
    assert.ok((await difference(page, whole, await look(page, shape))) < 0.01);
    await page.selectOption('select[aria-label="standard view"]', "top");
    const top = await look(page, shape);
    assert.ok((await difference(page, whole, top)) > 1);
    await page.locator(shape).focus();
    await page.keyboard.press("1");
    assert.ok((await difference(page, top, await look(page, shape))) > 1);
    const front = await look(page, shape);
    await page.keyboard.press("ArrowLeft");
    assert.ok((await difference(page, front, await look(page, shape))) > 0.1);
    await page.close();
});

test("page: a shape that is not to be trusted says so before anything else", async () => {
    const page = await open(browser, unfinished);
    const alert = page.locator(".alert");
    assert.match(await alert.textContent(), /Not converged/);
    const [warned, stage] = await Promise.all([alert.boundingBox(), page.locator(".stage").boundingBox()]);
    assert.ok(warned.y + warned.height <= stage.y);
    assert.match(await page.locator(".badge").textContent(), /not converged/);
    assert.equal(await page.locator(".film").count(), 0);
    await screenshot(page, "not-converged");
    assert.deepEqual(page.troubles, []);
    await page.close();
});

test("page: on a phone nothing is wider than the screen, and a tap chooses a strip", async () => {
    const page = await open(browser, torus, { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true });
    const width = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(width <= 390, `${width} px wide`);
    await page.locator(drawing).scrollIntoViewIfNeeded();
    const at = await pointOnStrip(page, drawing);
    await page.touchscreen.tap(at.x, at.y);
    await page.waitForSelector(`.strips tr[aria-selected="true"][data-strip="${at.strip}"]`);
    await page.evaluate(() => window.scrollTo(0, 0));
    await screenshot(page, "phone", { fullPage: true });
    await page.close();
});

test("page: dark where the reader's system is dark", async () => {
    const page = await open(browser, torus, { colorScheme: "dark" });
    const background = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    const [r, g, b] = background.match(/\d+/g).map(Number);
    assert.ok(r + g + b < 150, background);
    await screenshot(page, "dark");
    await page.close();
});

test("page: in print the views are pictures, tables are whole and nothing is left to click", async () => {
    const page = await open(browser, torus, { viewport: { width: 800, height: 1100 } });
    await page.emulateMedia({ media: "print" });
    await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
    assert.equal(await page.locator("img.printed:visible").count(), 2);
    assert.equal(await page.locator("button:visible, select:visible, canvas:visible").count(), 6, "only the table's headings");
    const rows = page.locator(".strips tbody tr");
    const [table, last] = await Promise.all([page.locator(".strips").boundingBox(), rows.last().boundingBox()]);
    assert.ok(last.y + last.height <= table.y + table.height + 1, "rows are cut off");
    await screenshot(page, "print", { fullPage: true });
    await page.evaluate(() => window.dispatchEvent(new Event("afterprint")));
    assert.equal(await page.locator("img.printed").count(), 0);
    await page.emulateMedia({ media: null });
    assert.ok((await page.pdf({ format: "A4", printBackground: true })).length > 100000, "no picture can be in it");
    await page.close();
});

test("page: is small enough to be mailed", () => {
    assert.ok(statSync(join(torus, "report.html")).size < 3e6);
});
