// How long the studio takes from a change in its form to a shape of that change on the screen.
//   node bench/preview_time.mjs [DRAWING.svg] [CHANGES]     else the torus example, 12 changes (RUCHE_PROGRAM)
// A change sets the thickness or the pre-stretch. Times count from the moment in which the page hears of it: the pause that
// waits for the next key, the drawing, the mesh, the solve, and the browser's own work with a software rasteriser are all in
// it. `moving`: the first shape of this change that is no longer the flat sheet; `preview`: the last one, at rest.
// The changes after the first come while nothing runs; half of them come in pairs, the second 0.6 s after the first, which
// is stopped then. Told, not judged: what stands against the two seconds of the studio's purpose is the machine's.
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { launch, studio } from "../web/test/browser.mjs";

const source = join(dirname(fileURLToPath(import.meta.url)), "..");
const drawing = process.argv[2] ?? join(source, "examples/torus/torus.svg");
const changes = Number(process.argv[3] ?? 12);

const { address, close } = await studio(drawing);
const browser = await launch();
const page = await browser.newPage({ viewport: { width: 1440, height: 1000 } });
page.setDefaultTimeout(600000);
await page.goto(address);
await page.waitForSelector("html[data-ready]");

/** The latest job, from the server. */
const latest = () => page.evaluate(async () => (await (await fetch("/api/jobs")).json())[0] ?? { id: 0, state: "done" });
const settled = async () => {
    for (;;) {
        const job = await latest();
        if (job.id > 0 && !["running", "waiting"].includes(job.state)) return job;
        await page.waitForTimeout(100);
    }
};

/** Changes a setting by its input and starts to write down which shapes are seen. */
const change = (key, value) => page.evaluate(([id, to]) => {
    const live = document.querySelector(".live");
    window.watcher?.disconnect();
    window.seen = [];
    window.watcher = new MutationObserver(() => window.seen.push({ job: Number(live.dataset.job), iteration: Number(live.dataset.iteration), at: performance.now() }));
    window.watcher.observe(live, { attributes: true, attributeFilter: ["data-job", "data-iteration"] });
    const input = document.getElementById(id);
    input.value = to;
    window.begin = performance.now();
    input.dispatchEvent(new Event("input", { bubbles: true }));
    input.dispatchEvent(new Event("change", { bubbles: true }));
}, [key, String(value)]);

async function measure(before) {
    let job = await settled();
    while (job.id <= before) {
        await page.waitForTimeout(50);
        job = await settled();
    }
    await page.waitForTimeout(500);  // the last shape may still be on its way
    const { seen, begin } = await page.evaluate(() => ({ seen: window.seen, begin: window.begin }));
    const own = seen.filter((s) => s.job === job.id);
    const moving = own.find((s) => s.iteration > 0);
    return { state: job.state, solve: job.seconds, moving: (moving?.at - begin) / 1000, preview: (own.at(-1)?.at - begin) / 1000 };
}

await settled();
const rows = [];
for (let i = 0; i < changes; ++i) {
    await settled();
    const hurried = i % 2 === 1;
    if (hurried) {
        await change("plastic.thickness_mm", 0.6 + 0.01 * i);
        await page.waitForTimeout(600);
    }
    const before = (await latest()).id;
    const key = i % 3 === 2 ? "fabric.prestretch" : "plastic.thickness_mm";
    await change(key, key === "fabric.prestretch" ? 1.55 + 0.01 * i : 0.7 + 0.01 * i);
    rows.push({ key, hurried, ...(await measure(before)) });
}
await browser.close();
await close();

const row = (cells) => console.log("| " + cells.join(" | ") + " |");
row(["change", "state", "moving s", "preview s", "of it the server's job s"]);
row(Array(5).fill("---"));
for (const r of rows) row([r.key + (r.hurried ? ", while another runs" : ""), r.state, r.moving.toFixed(2), r.preview.toFixed(2), r.solve.toFixed(2)]);
const sorted = (name) => rows.map((r) => r[name]).sort((a, b) => a - b);
const line = (name) => [sorted(name)[Math.floor(rows.length / 2)], sorted(name).at(-1)].map((v) => v.toFixed(2));
row(["median / worst", "", line("moving").join(" / "), line("preview").join(" / "), line("solve").join(" / ")]);
