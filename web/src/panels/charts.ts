import * as Plot from "@observablehq/plot";

import type { Level, Parameter, Report } from "../data/report";
import type { Result } from "../data/result";
import { h, number, seconds } from "../dom";
import type { Attention } from "../signal";

const phases: Record<string, string> = {
    mesh: "meshing",
    release: "release",
    check: "checks",
    search: "other shapes",
    film: "film of the release",
};

/** Re-draws a chart as wide as the place that it stands in. */
function responsive(label: string, draw: (width: number) => Element): HTMLElement {
    const host = h("div", { class: "chart", role: "img", "aria-label": label });
    let width = 0;
    const fill = () => {
        const now = Math.floor(host.clientWidth);
        if (now === width || now === 0) return;
        width = now;
        host.replaceChildren(draw(width));
    };
    new ResizeObserver(fill).observe(host);
    host.addEventListener("redraw", () => {
        width = 0;
        fill();
    });
    return host;
}

/** How many strips have which curvature; the one that is pointed at is marked. */
export function distribution(result: Result, attention: Attention): HTMLElement {
    const strips = result.report.strips
        .map((strip, index) => ({ ...strip, index }))
        .filter((strip) => strip.curvature_per_mm !== null);
    if (strips.length === 0)
        return h("section", { class: "card" }, h("h2", {}, "Curvature of the strips"), h("p", { class: "hint" }, "No strip has a centre line to measure."));
    const values = strips.map((s) => s.curvature_per_mm!);
    const mean = values.reduce((a, b) => a + b) / values.length;
    const spread = Math.max(...values) - Math.min(...values);
    // All strips alike: a histogram of rounding errors would say the opposite of what is so.
    const domain = spread < 0.02 * Math.abs(mean) ? [mean - 0.05 * Math.abs(mean), mean + 0.05 * Math.abs(mean)] : undefined;
    const chart = responsive("Histogram of strip curvatures", (width) => {
        const marks = [
            { colour: "var(--chosen)", at: result.report.strips[attention.chosen.value]?.curvature_per_mm },
            { colour: "var(--hovered)", at: result.report.strips[attention.hovered.value]?.curvature_per_mm },
        ].filter(({ at }) => typeof at === "number");
        return Plot.plot({
            width,
            height: 190,
            marginLeft: 38,
            marginBottom: 38,
            x: { label: "curvature, 1/mm", ...(domain ? { domain } : { nice: true }), tickFormat: (v: number) => number(v, 3) },
            color: { type: "identity" },
            y: { label: "strips", grid: true, tickFormat: (v: number) => (Number.isInteger(v) ? String(v) : "") },
            marks: [
                Plot.rectY(values, {
                    ...Plot.binX({ y: "count" }, { x: (v: number) => v, thresholds: 18 }),
                    fill: "var(--honey)",
                    inset: 0.5,
                }),
                Plot.ruleY([0]),
                Plot.ruleX(marks, { x: "at", stroke: "colour", strokeWidth: 2.5 }),
            ],
        });
    });
    const redraw = () => chart.dispatchEvent(new Event("redraw"));
    attention.chosen.watch(redraw);
    attention.hovered.watch(redraw);
    const sorted = [...values].sort((a, b) => a - b);
    return h(
        "section",
        { class: "card" },
        h("h2", {}, "Curvature of the strips"),
        chart,
        h("p", { class: "hint" }, `${number(sorted[0])} to ${number(sorted.at(-1))} /mm, median ${number(sorted[Math.floor(sorted.length / 2)])} /mm.`),
    );
}

interface Bar {
    label: string;
    value: number;
}

function bars(label: string, list: Bar[], format: (v: number) => string): HTMLElement {
    const largest = Math.max(...list.map((b) => Math.abs(b.value)), 1e-300);
    return h(
        "dl",
        { class: "bars", "aria-label": label },
        ...list.flatMap((b) => [
            h("dt", {}, b.label),
            h("dd", {}, h("i", { style: `width:${(100 * Math.abs(b.value)) / largest}%` }), h("span", {}, format(b.value))),
        ]),
    );
}

export function energy({ report }: Result): HTMLElement {
    const { total, ...terms } = report.energy_mJ;
    const names: Record<string, string> = {
        fabric_membrane: "fabric, stretching",
        fabric_bending: "fabric, bending",
        plastic: "plastic on fabric",
        gravity: "weight and loads",
        contact: "contact",
    };
    const list = Object.entries(terms)
        .filter(([, value]) => value !== 0)
        .map(([key, value]) => ({ label: names[key] ?? key, value }));
    const { shape } = report;
    return h(
        "section",
        { class: "card" },
        h("h2", {}, "Energy"),
        bars("energy by kind", list, (v) => `${number(v)} mJ`),
        h("p", { class: "hint" }, `${number(total, 6)} mJ in all. The sheet has shrunk from ${number(shape.layout_area_mm2)} to ${number(shape.area_mm2)} mm², ${number((100 * shape.printed_area_mm2) / shape.layout_area_mm2, 3)} % of it printed.`),
    );
}

/** The largest force left over before every iteration, each mesh in its own shade, the finest darkest. */
function residuals(levels: Level[], tolerance: number | undefined): HTMLElement | undefined {
    let iteration = 0;
    const points = levels.flatMap((level, i) =>
        level.residuals_N.map((residual) => ({ residual, iteration: iteration++, level: i })).filter((p): p is typeof p & { residual: number } => p.residual !== null && p.residual > 0),
    );
    if (points.length < 2) return undefined;
    return responsive("Residual over the iterations, logarithmic", (width) =>
        Plot.plot({
            width,
            height: 170,
            marginLeft: 48,
            marginBottom: 38,
            x: { label: "iteration", tickFormat: (v: number) => (Number.isInteger(v) ? String(v) : "") },
            y: { type: "log", label: "residual, N", grid: true, ticks: 5, tickFormat: (v: number) => v.toExponential(0) },
            marks: [
                tolerance ? Plot.ruleY([tolerance], { stroke: "currentColor", strokeDasharray: "3,3" }) : undefined,
                Plot.line(points, { x: "iteration", y: "residual", z: "level", stroke: "var(--honey)", strokeWidth: 2, strokeOpacity: (p: { level: number }) => (p.level + 1) / levels.length }),
                Plot.dot(points, { x: "iteration", y: "residual", r: 2.5, fill: "var(--honey)", fillOpacity: (p: { level: number }) => (p.level + 1) / levels.length }),
            ],
        }),
    );
}

export function convergence({ report }: Result): HTMLElement {
    const { solver } = report;
    const time = Object.entries(report.seconds).map(([key, value]) => ({ label: phases[key] ?? key, value }));
    time.sort((a, b) => b.value - a.value);
    const tolerance = (report.parameters["solver"] as Record<string, Parameter> | undefined)?.["residual_tolerance_n"]?.value;
    const chart = residuals(solver.levels, typeof tolerance === "number" ? tolerance : undefined);
    return h(
        "section",
        { class: "card" },
        h("h2", {}, "Convergence and time"),
        h("p", {}, verdict(report)),
        chart ?? "",
        chart ? h("p", { class: "hint" }, "Largest force left over before every iteration; one line a mesh, the finest one darkest; dashed: where a solve may stop.") : "",
        h(
            "table",
            { class: "plain" },
            h("thead", {}, h("tr", {}, ...["mesh", "triangles", "iterations", "factorisations"].map((t) => h("th", { scope: "col" }, t)))),
            h("tbody", {}, ...solver.levels.map((level, i) =>
                h("tr", {},
                    h("th", { scope: "row" }, i === solver.levels.length - 1 ? "finest" : `coarse ${i + 1}`),
                    ...[level.triangles, level.iterations, level.factorizations].map((n) => h("td", {}, n.toLocaleString("en"))))),
            ),
        ),
        bars("seconds by phase", time, seconds),
    );
}

function verdict({ message, residual_N, typical_force_N }: Report): string {
    const relative = typical_force_N > 0 ? ` (${number(residual_N / typical_force_N, 2)} of the typical force in an element)` : "";
    return `${message[0]?.toUpperCase() ?? ""}${message.slice(1)}. Largest force left: ${number(residual_N, 2)} N${relative}.`;
}

/** Other stable shapes that were found, when they were looked for. */
export function alternatives({ report }: Result): HTMLElement | undefined {
    const list = report.alternatives;
    if (!list) return undefined;
    return h(
        "section",
        { class: "card" },
        h("h2", {}, "Other stable shapes"),
        h("p", { class: "hint" }, `${list.shapes.length} found from ${list.starts} further starts${list.interrupted ? "; the search was interrupted" : ""}.`),
        h(
            "table",
            { class: "plain" },
            h("thead", {}, h("tr", {}, ...["folder", "energy, mJ", "above the lowest"].map((t) => h("th", { scope: "col" }, t)))),
            h("tbody", {}, ...list.shapes.map((s) =>
                h("tr", {}, h("th", { scope: "row" }, s.folder + (s.ordinary ? " (this one)" : "")), h("td", {}, number(s.energy_mJ, 6)), h("td", {}, `${number(100 * s.above_lowest, 2)} %`)))),
        ),
    );
}
