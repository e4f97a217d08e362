// A page of a result in headless Chromium, opened from disk, with everything that should not happen on record.
import { execFileSync, spawn } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { pathToFileURL } from "node:url";

import { chromium } from "playwright-core";

const program = process.env.RUCHE_PROGRAM ?? "build/release/ruche";

export function launch() {
    const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
    if (!existsSync(executablePath)) throw new Error(`${executablePath} is missing: tools/setup test installs it`);
    return chromium.launch({
        executablePath,
        args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-dev-shm-usage", "--enable-precise-memory-info"],
    });
}

/** A folder that is gone when the tests end. */
export function scratch() {
    const folder = mkdtempSync(join(tmpdir(), "ruche-page-"));
    process.on("exit", () => rmSync(folder, { recursive: true, force: true }));
    return folder;
}

/** Simulates and gives the result's folder. Exit codes 0 and 3 both leave a result. */
export function simulate(folder, scene, ...options) {
    const out = join(folder, `result-${Math.random().toString(36).slice(2)}`);
    try {
        execFileSync(program, ["simulate", scene, "-o", out, "--quiet", "--set", "output.picture=false", ...options]);
    } catch (failure) {
        if (failure.status !== 3) throw failure;
    }
    return out;
}

/** Opens report.html; `page.troubles` collects errors of the console and requests other than for the file itself. */
export async function open(browser, result, options = {}) {
    const context = await browser.newContext({ viewport: { width: 1440, height: 1000 }, ...options });
    context.setDefaultTimeout(600000);
    const page = await context.newPage();
    const url = pathToFileURL(join(result, "report.html")).href;
    page.troubles = [];
    page.on("console", (message) => {
        // Chromium itself remarks on slow read-backs of the software renderer.
        if (["error", "warning"].includes(message.type()) && !/GPU stall|GL Driver Message/.test(message.text()))
            page.troubles.push(message.text());
    });
    page.on("pageerror", (error) => page.troubles.push(String(error)));
    page.on("request", (request) => {
        if (request.url() !== url && !request.url().startsWith("data:") && !request.url().startsWith("blob:"))
            page.troubles.push(`request for ${request.url()}`);
    });
    await page.goto(url);
    await page.waitForSelector("html[data-ready]", { timeout: 600000 });
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    return page;
}

/** A studio in a new folder with copies of some files; `address`, `folder`, and `close()` when it is not needed any more. */
export async function studio(...files) {
    const folder = join(scratch(), "work");
    mkdirSync(folder);
    for (const file of files) copyFileSync(file, join(folder, basename(file)));
    const server = spawn(program, ["studio", folder, "--no-browser"], { stdio: ["ignore", "pipe", "inherit"] });
    const address = await new Promise((found, failed) => {
        server.stdout.on("data", (text) => {
            const [match] = String(text).match(/http:\S+/) ?? [];
            if (match) found(match);
        });
        server.on("exit", () => failed(new Error("the server did not start")));
    });
    return { address, folder, close: () => new Promise((done) => { server.on("exit", done); server.kill("SIGTERM"); }) };
}

/** Pictures go to RUCHE_SCREENSHOTS, for people to look at. */
export async function screenshot(page, name, options = {}) {
    const folder = process.env.RUCHE_SCREENSHOTS;
    if (folder) await page.screenshot({ path: join(folder, `${name}.png`), ...options });
}
