// What report.html costs in a browser: bytes, time to open, memory, draw calls, main-thread time per frame.
//   node bench/page_budget.mjs [RESULT...]     folders with a report.html; without any, torus meshes of about 20,000,
//                                              200,000 and 500,000 triangles are made (minutes; RUCHE_PROGRAM)
// Fails when a frame takes more main-thread time than 4 ms up to 200,000 triangles and 8 ms up to 500,000, or a page of
// up to 200,000 triangles more than 25 MB. The time of Chromium's software rasteriser is told, not judged.
import { statSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { launch, open, scratch, simulate } from "../web/test/browser.mjs";

const source = join(dirname(fileURLToPath(import.meta.url)), "..");
const frames = 20;

/** One Newton step only: what is measured does not depend on the shape. */
function torus(folder, sizeMm) {
    return simulate(folder, join(source, "examples/torus/scene.toml"),
        ...[`mesh.size_mm=${sizeMm}`, `mesh.fabric_size_mm=${2 * sizeMm}`, "solver.max_iterations=1", "solver.coarse_start=false",
            ...["obj", "ply", "vtu", "glb"].map((name) => `output.${name}=false`)].flatMap((set) => ["--set", set]));
}

const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];

async function measure(browser, result) {
    const bytes = statSync(join(result, "report.html")).size;
    const page = await open(browser, result);
    const measured = await page.evaluate(async (count) => {
        const { view } = window.rucheStage;
        const frame = () => new Promise((done) => requestAnimationFrame(done));
        const main = [];
        const begin = performance.now();
        for (let i = 0; i < count; ++i) {
            await frame();
            const start = performance.now();
            view.turn(0.3, 0);
            view.drawNow();
            main.push(performance.now() - start);
        }
        const whole = (performance.now() - begin) / count;
        const hover = performance.now();
        const box = view.canvas.getBoundingClientRect();
        window.rucheStage.stripAt("shape", box.x + box.width / 2, box.y + box.height / 2);
        const first = performance.now() - hover;
        const again = performance.now();
        window.rucheStage.stripAt("shape", box.x + box.width / 2, box.y + box.height / 2);
        const paint = performance.now();
        window.rucheStage.colour.set("stretch_min");
        return {
            main, whole, first_pick_ms: first, pick_ms: paint - again, recolour_ms: performance.now() - paint,
            ready_ms: Number(document.documentElement.dataset.ready),
            heap_mb: performance.memory.usedJSHeapSize / 1e6,
            calls: view.cost.calls, drawn: view.cost.triangles,
        };
    }, frames);
    const triangles = await page.evaluate(() => Number(document.querySelectorAll(".facts dd")[2].textContent.replaceAll(",", "")));
    const troubles = page.troubles;
    await page.context().close();
    return { bytes, triangles, troubles, ...measured };
}

const folder = scratch();
const results = process.argv.length > 2 ? process.argv.slice(2) : [0.57, 0.162, 0.1].map((size) => torus(folder, size));
const browser = await launch();
let failed = false;
const row = (cells) => console.log("| " + cells.join(" | ") + " |");
row(["triangles", "MB", "open s", "heap MB", "draw calls", "triangles drawn", "main thread ms: median", "worst", "with rasteriser ms", "first pick ms", "pick ms", "recolour ms"]);
row(Array(12).fill("---"));
for (const result of results) {
    const m = await measure(browser, result);
    row([m.triangles, (m.bytes / 1e6).toFixed(2), (m.ready_ms / 1000).toFixed(2), m.heap_mb.toFixed(0), m.calls, m.drawn,
        median(m.main).toFixed(2), Math.max(...m.main).toFixed(2), m.whole.toFixed(1), m.first_pick_ms.toFixed(0), m.pick_ms.toFixed(2), m.recolour_ms.toFixed(0)]);
    const most = m.triangles <= 210e3 ? 4 : 8;
    for (const [wrong, text] of [
        [median(m.main) > most, `a frame takes ${median(m.main)} ms of the main thread, allowed are ${most}`],
        [m.triangles <= 210e3 && m.bytes > 25e6, `${m.bytes} bytes, allowed are 25 MB`],
        [m.troubles.length > 0, m.troubles.join("; ")],
    ]) if (wrong) {
        console.error(`${m.triangles} triangles: ${text}`);
        failed = true;
    }
}
await browser.close();
process.exit(failed ? 1 : 0);
