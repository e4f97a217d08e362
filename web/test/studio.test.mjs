// The studio as a person uses it: drop a drawing, set numbers, release, cancel, look, compare, take files away.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { copyFileSync, existsSync, readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { dirname, join } from "node:path";
import { setTimeout } from "node:timers/promises";
import { fileURLToPath, pathToFileURL } from "node:url";

import { launch, screenshot, studio } from "./browser.mjs";

const program = process.env.RUCHE_PROGRAM ?? "build/release/ruche";
const source = join(dirname(fileURLToPath(import.meta.url)), "..", "..");
const torus = join(source, "examples/torus/torus.svg");
const desktop = { width: 1440, height: 1000 };
let browser;

before(async () => {
    browser = await launch();
}, { timeout: 600000 });
after(() => browser?.close());

/** A studio for one test alone, with the torus in its folder; what a test finds there it has put there. */
async function fresh(t) {
    const made = await studio(torus);
    t.after(made.close);
    return made;
}

async function open(address, options = {}) {
    const context = await browser.newContext({ viewport: desktop, acceptDownloads: true, ...options });
    context.setDefaultTimeout(300000);  // before the test's own time is over: that would not say where it stands
    const page = await context.newPage();
    page.troubles = [];
    page.on("console", (message) => {
        // Chromium itself remarks on refused requests, which are part of these tests, and on its software renderer.
        if (["error", "warning"].includes(message.type()) && !/GPU stall|GL Driver Message|status of 4/.test(message.text())) page.troubles.push(message.text());
    });
    page.on("pageerror", (error) => page.troubles.push(String(error)));
    page.on("request", (request) => {
        if (!request.url().startsWith(address) && !/^(data|blob):/.test(request.url())) page.troubles.push(`request for ${request.url()}`);
    });
    await page.goto(address);
    await page.waitForSelector("html[data-ready]", { timeout: 600000 });
    return page;
}

/** As if a file were dragged from the desktop onto the page. */
async function drop(page, path, name) {
    const data = await page.evaluateHandle(([text, called]) => {
        const transfer = new DataTransfer();
        transfer.items.add(new File([text], called, { type: "image/svg+xml" }));
        return transfer;
    }, [readFileSync(path, "utf8"), name]);
    await page.dispatchEvent("body", "dragover", { dataTransfer: data });
    await page.dispatchEvent("body", "drop", { dataTransfer: data });
}

async function set(page, label, value) {
    await page.locator(`[id="${label}"]`).fill(String(value));
    await page.locator(`[id="${label}"]`).press("Enter");
}

/** The studio's jobs, the latest first, as soon as they are as wanted. */
async function jobs(page, wanted) {
    for (;;) {
        const all = await (await fetch(new URL("/api/jobs", page.url()))).json();
        if (wanted(all)) return all;
        await setTimeout(50);
    }
}

/** Nothing is under way, nor will a preview begin for what was set last. */
async function idle(page) {
    await setTimeout(1000);
    await jobs(page, (all) => all.every((job) => !["running", "waiting"].includes(job.state)));
}

const shown = (page, name) => page.waitForSelector(`section.result[aria-label="result ${name}"]`, { timeout: 600000 });

test("studio: a drawing that is dropped is shown to scale and previewed after every change", { timeout: 600000 }, async (t) => {
    const { address, folder } = await fresh(t);
    const page = await open(address);
    await drop(page, torus, "my torus.svg");
    await page.waitForFunction(() => document.querySelector("#source").value.includes("my-torus.svg"));
    await page.waitForFunction(() => document.querySelectorAll(".layout .strip").length > 20);
    assert.ok(existsSync(join(folder, "my-torus.svg")));
    // In one go: the drawing may be drawn anew between two questions.
    const measured = await page.waitForFunction(() => {
        const bar = document.querySelector(".layout .scalebar");
        const fabric = document.querySelector(".layout svg > g > path");
        if (!bar || !fabric) return false;
        const px = fabric.getBoundingClientRect().width;
        return (px * parseFloat(bar.lastElementChild.textContent)) / bar.firstElementChild.getBoundingClientRect().width;
    });
    const width = await measured.jsonValue();
    assert.ok(Math.abs(width - 68) < 1, `the fabric is 68 mm wide, the bar says ${width}`);
    await page.waitForSelector(".live canvas", { timeout: 600000 });
    await idle(page);
    const times = [];
    for (const thickness of [0.65, 0.7, 0.75]) {
        await idle(page);
        const [known] = await jobs(page, () => true);
        const begin = Date.now();
        await set(page, "plastic.thickness_mm", thickness);
        await jobs(page, ([job]) => job.id > known.id && job.state === "done");
        times.push((Date.now() - begin) / 1000);
    }
    console.log(`preview ready after ${times.map((t) => t.toFixed(2)).join(", ")} s`);
    await screenshot(page, "studio-preview");
    assert.deepEqual(page.troubles, []);
    await page.context().close();
});

test("studio: release, cancel, release again, pick a strip, colour, take the report away, compare two", { timeout: 600000 }, async (t) => {
    const { address, folder } = await fresh(t);
    const page = await open(address);
    await page.selectOption("#source", JSON.stringify({ svg: "torus.svg" }));
    await set(page, "fabric.prestretch", 1.7);
    await set(page, "plastic.thickness_mm", 0.7);
    await page.click(".more-settings > summary");
    await set(page, "mesh.size_mm", 0.2);  // a release that does not end before it is cancelled
    await idle(page);
    // Cancelled in the page, as soon as it says how long it will take: on a busy machine whole frames go by between
    // what a test sees and what it clicks, and the release may end in one.
    await page.evaluate(() => new MutationObserver((_, watch) => {
        if (!/about/.test(document.querySelector(".progress .line").textContent)) return;
        const cancel = document.querySelector(".progress:not([hidden]) .cancel:not([hidden])");
        if (!cancel) return;  // of a preview
        watch.disconnect();
        cancel.click();
    }).observe(document.querySelector(".progress"), { subtree: true, childList: true, characterData: true, attributes: true }));
    await page.click(".release");
    await jobs(page, (all) => all.some((job) => job.kind === "release" && job.state === "cancelled"));
    await set(page, "mesh.size_mm", 1);
    await idle(page);

    await page.click(".release");
    await shown(page, "torus-2");
    assert.match(await page.locator("section.result .badge").first().textContent(), /converged, stable/);
    await screenshot(page, "studio-result");
    const strip = page.locator(".strips tbody tr").nth(3);
    await strip.click();
    assert.equal(await strip.getAttribute("aria-selected"), "true");
    await page.selectOption('select[aria-label="colour by"]', "curvature_max");
    assert.match(await page.locator(".legend p").first().textContent(), /Curvature, largest/);
    await screenshot(page, "studio-coloured");

    const [download] = await Promise.all([page.waitForEvent("download"), page.click('.downloads a[href$="report.html?download"]')]);
    assert.equal(download.suggestedFilename(), "torus-2-report.html");
    const file = join(folder, "..", "mailed.html");
    await download.saveAs(file);
    const mailed = await page.context().newPage();
    await mailed.goto(pathToFileURL(file).href);
    await mailed.waitForSelector("html[data-ready]", { timeout: 600000 });
    assert.match(await mailed.locator(".badge").first().textContent(), /converged, stable/);
    await mailed.close();
    for (const name of ["shape.obj", "shape.glb", "shape.stl", "scene.toml", "drawing.svg"]) {
        const [got] = await Promise.all([page.waitForEvent("download"), page.click(`.downloads a[href$="${name}?download"]`)]);
        assert.ok(readFileSync(await got.path()).length > 500, name);
    }

    await page.click("text=Back to the print");
    await page.selectOption('select[aria-label="begin with"]', "torus-2.out");
    await set(page, "plastic.thickness_mm", 0.9);
    await page.click(".release");
    await shown(page, "torus-3");
    await page.check('input[aria-label="compare torus-2"]');
    await page.check('input[aria-label="compare torus-3"]');
    await page.click("text=Compare two");
    await page.waitForSelector(".comparison .pair canvas >> nth=1");
    const differences = await page.locator(".differences").textContent();
    assert.match(differences, /plastic\.thickness_mm/);
    assert.match(differences, /laid upon|Laid upon/i);
    await screenshot(page, "studio-side-by-side", { fullPage: true });
    await page.click("text=Overlaid");
    assert.equal(await page.locator(".comparison canvas").count(), 1);
    await screenshot(page, "studio-overlaid");

    await set(page, "mesh.size_mm", 0.25);
    await idle(page);
    await page.click(".release");
    await page.waitForSelector(".progress:not([hidden]) .cancel:visible");
    assert.ok(await page.locator(".progress").evaluate((e) => e.getBoundingClientRect().bottom <= innerHeight && e.getBoundingClientRect().top >= 0), "seen, wherever Release was pressed");
    await screenshot(page, "studio-releasing");
    await page.evaluate(() => document.querySelector(".progress:not([hidden]) .cancel:not([hidden])")?.click());  // if it still runs
    await idle(page);
    assert.deepEqual(page.troubles, []);
    await page.context().close();
});

test("studio: a mistake is said beside its setting, in the program's words, and mended there", { timeout: 600000 }, async (t) => {
    const { address } = await fresh(t);
    const page = await open(address);
    await page.selectOption("#source", JSON.stringify({ generator: "radial" }));
    await set(page, "fabric.prestretch", 4);
    const said = page.locator('.row[data-key="fabric.prestretch"] .trouble');
    await said.waitFor();
    assert.match(await said.textContent(), /outside \[1, 3\]/);
    assert.ok(await page.locator(".release").isDisabled());
    await set(page, "pattern.options.inner_mm", 900);
    await set(page, "fabric.prestretch", 1.6);
    await page.locator('.options .trouble:visible').first().waitFor();
    await screenshot(page, "studio-mistake");
    await set(page, "pattern.options.inner_mm", 12);
    await page.waitForFunction(() => !document.querySelector(".release").disabled && ![...document.querySelectorAll(".trouble")].some((e) => !e.hidden));
    await page.context().close();
});

test("studio: thickness and side can be set per colour", { timeout: 600000 }, async (t) => {
    const { address } = await fresh(t);
    const page = await open(address);
    await page.selectOption("#source", JSON.stringify({ svg: "torus.svg" }));
    await page.waitForSelector('input[aria-label="thickness of #d9480f, mm"]');
    await page.fill('input[aria-label="thickness of #d9480f, mm"]', "1.1");
    await page.press('input[aria-label="thickness of #d9480f, mm"]', "Enter");
    await page.selectOption('select[aria-label="side of #d9480f"]', "back");
    await page.waitForFunction(() => document.querySelector(".layout .strip")?.getAttribute("fill-opacity") === "0.6");
    await page.locator(".layout .strip").first().hover();
    assert.match(await page.locator(".layout .hover").textContent(), /1\.1 mm, back/);
    await page.context().close();
});

test("studio: what the command line writes into the folder appears by itself", { timeout: 600000 }, async (t) => {
    const { address, folder } = await fresh(t);
    const page = await open(address);
    copyFileSync(torus, join(folder, "typed.svg"));
    const made = spawn(program, ["simulate", "typed.svg", "--quiet", "--set", "output.picture=false", "--set", "mesh.size_mm=2", "--set", "mesh.fabric_size_mm=3"], { cwd: folder });
    await new Promise((done) => made.on("exit", done));
    await page.waitForSelector('tr[data-folder="typed.out"]', { timeout: 600000 });
    await page.click('tr[data-folder="typed.out"] button.link');
    await shown(page, "typed");
    await page.context().close();
});

test("studio: a scan that is dropped on a result is compared with it", { timeout: 600000 }, async (t) => {
    const { address, folder } = await fresh(t);
    const made = spawn(program, ["simulate", "torus.svg", "--quiet", ...["output.picture=false", "output.stl=true", "output.film_frames=0", "mesh.size_mm=2", "mesh.fabric_size_mm=3"].flatMap((set) => ["--set", set])], { cwd: folder });
    await new Promise((done) => made.on("exit", done));
    const page = await open(address);
    await page.click('tr[data-folder="torus.out"] button.link');
    await shown(page, "torus");
    assert.equal(await page.locator("section.scan").count(), 0);
    await page.setInputFiles("#made", join(folder, "torus.out", "shape.stl"));
    await page.waitForSelector("section.scan", { timeout: 600000 });
    assert.match(await page.locator("section.scan").textContent(), /mm, guessed from the sizes/);
    assert.match(await page.locator(".legend p").first().textContent(), /mm$/);
    assert.ok(existsSync(join(folder, "shape.stl")) && existsSync(join(folder, "torus.out", "compare.html")));
    await screenshot(page, "studio-scan", { fullPage: true });
    // What is no scan is said beside the field.
    await page.setInputFiles("#made", torus);
    await page.waitForSelector(".made-form .trouble:not([hidden])");
    assert.match(await page.locator(".made-form .trouble").textContent(), /neither a scan/);
    assert.deepEqual(page.troubles, []);
    await page.context().close();
});

test("studio: a photo of a roll is compared by the circle around it, once a length in it is known", { timeout: 600000 }, async (t) => {
    const { address, folder } = await fresh(t);
    const made = spawn(program, ["simulate", "torus.svg", "--quiet", ...["output.picture=false", "output.film_frames=0", "mesh.size_mm=2", "mesh.fabric_size_mm=3"].flatMap((set) => ["--set", set])], { cwd: folder });
    await new Promise((done) => made.on("exit", done));
    const page = await open(address);
    // A ring with a gap, 200 pixels in radius, and a ruler of 400 pixels above it, as the browser draws them.
    const drawn = await page.evaluate(() => {
        const paper = document.createElement("canvas");
        [paper.width, paper.height] = [800, 600];
        const ink = paper.getContext("2d");
        ink.fillStyle = "#e8e4dc";
        ink.fillRect(0, 0, 800, 600);
        ink.lineWidth = 12;
        ink.beginPath();
        ink.arc(400, 340, 194, 0.4, 5.6);
        ink.stroke();
        ink.fillRect(200, 60, 400, 16);
        return paper.toDataURL("image/jpeg", 0.9).split(",")[1];
    });
    await page.click('tr[data-folder="torus.out"] button.link');
    await shown(page, "torus");
    await page.setInputFiles("#made", { name: "My roll.JPG", mimeType: "image/jpeg", buffer: Buffer.from(drawn, "base64") });
    const canvas = page.locator(".photo-marks canvas");
    await canvas.scrollIntoViewIfNeeded();
    const { width, height } = await canvas.boundingBox();
    assert.ok(await page.locator(".photo-marks button").isDisabled());
    for (const x of [200, 600]) await canvas.click({ position: { x: (x * width) / 800, y: (68 * height) / 600 } });
    await page.fill("#known-length", "20");
    await screenshot(page, "studio-photo-marks", { fullPage: true });
    await page.click(".photo-marks button");
    await page.waitForSelector("section.silhouette img", { timeout: 600000 });
    // 400 pixels are 20 mm, pointed at to a pixel of the screen; the outer radius is 200 pixels.
    const radius = Number((await page.locator("section.silhouette").textContent()).match(/radius in the photo([\d.]+) mm/)[1]);
    assert.ok(Math.abs(radius - 10) < (0.1 * 800) / width, `${radius} mm`);
    await page.waitForFunction(() => document.querySelector("section.silhouette img").naturalWidth > 0);
    assert.ok(existsSync(join(folder, "My-roll.jpg")));
    await screenshot(page, "studio-photo", { fullPage: true });
    assert.deepEqual(page.troubles, []);
    await page.context().close();
});

test("studio: ten tabs are answered while a release runs", { timeout: 600000 }, async (t) => {
    const { address } = await fresh(t);
    const context = await browser.newContext({ viewport: desktop });
    context.setDefaultTimeout(600000);
    const pages = [];
    for (let i = 0; i < 10; ++i) {
        const page = await context.newPage();
        await page.goto(address);
        await page.waitForSelector("html[data-ready]", { timeout: 600000 });
        pages.push(page);
    }
    await pages[0].selectOption("#source", JSON.stringify({ svg: "torus.svg" }));
    await pages[0].uncheck("#preview");
    await pages[0].waitForSelector(".layout .strip");
    await pages[0].click(".release");
    const times = [];
    for (const page of pages) {
        times.push(await page.evaluate(async () => {
            const begin = performance.now();
            await (await fetch("/api/jobs")).json();
            await (await fetch("/api/runs")).json();
            return performance.now() - begin;
        }));
    }
    console.log(`answers in ten tabs: ${times.map((t) => t.toFixed(0)).join(", ")} ms`);
    // News reach the tabs that do not listen themselves.
    await pages[0].waitForSelector("section.result", { timeout: 600000 });
    for (const page of pages) await page.waitForFunction((n) => document.querySelectorAll(".results tbody tr").length >= n, 1, { timeout: 600000 });
    // When the tab that listens is closed, another one takes over.
    await pages[0].close();
    await pages[5].waitForTimeout(500);
    await pages[5].click(".release");
    await pages[9].waitForFunction((n) => document.querySelectorAll(".results tbody tr").length >= n, 2, { timeout: 600000 });
    await context.close();
});

test("studio: can be used from the keyboard alone", { timeout: 600000 }, async (t) => {
    const { address } = await fresh(t);
    const page = await open(address);
    const reached = [];
    for (let i = 0; i < 40 && !reached.includes("release"); ++i) {
        await page.keyboard.press("Tab");
        reached.push(await page.evaluate(() => document.activeElement.id || document.activeElement.className));
    }
    for (const wanted of ["file", "source", "fabric.prestretch", "plastic.thickness_mm", "release"]) assert.ok(reached.includes(wanted), `${wanted}: ${reached}`);
    await page.context().close();
});

test("studio: on a phone nothing is wider than the screen; dark where the system is", { timeout: 600000 }, async (t) => {
    const { address } = await fresh(t);
    const phone = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true };
    for (const colorScheme of ["light", "dark"]) {
        const page = await open(address, { ...phone, colorScheme });
        await page.selectOption("#source", JSON.stringify({ svg: "torus.svg" }));
        await page.waitForSelector(".layout .strip");
        await idle(page);
        const width = await page.evaluate(() => document.documentElement.scrollWidth);
        assert.ok(width <= 390, `${width} px wide`);
        await page.evaluate(() => window.scrollTo(0, 0));
        await screenshot(page, `studio-phone-${colorScheme}`, { fullPage: true });
        await page.context().close();
    }
    const dark = await open(address, { colorScheme: "dark" });
    await dark.selectOption("#source", JSON.stringify({ svg: "torus.svg" }));
    await idle(dark);
    await dark.waitForTimeout(500);
    await screenshot(dark, "studio-dark", { fullPage: true });
    await dark.context().close();
});
