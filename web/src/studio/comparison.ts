import type { Result, ReleasedSheet } from "../data/result";
import { h, number } from "../dom";
import { paintMaterials } from "../viewer/paint";
import { SheetModel } from "../viewer/sheet_model";
import { View } from "../viewer/view";
import { parseColour } from "../colour/maps";
import type { Difference, Run } from "./api";
import { boxText, nameOf, stateOf, valueText } from "./results";

export interface Side {
    run: Run;
    result: Result;
}

const tints = ["#d98e1f", "#2f7f93"];

/** The second shape as it lies on the first. */
function moved(shape: Float32Array, { rotation: r, translation: t }: Difference): Float32Array {
    const out = new Float32Array(shape.length);
    for (let i = 0; i < shape.length; i += 3)
        for (let k = 0; k < 3; ++k)
            out[i + k] = r[3 * k]! * shape[i]! + r[3 * k + 1]! * shape[i + 1]! + r[3 * k + 2]! * shape[i + 2]! + t[k]!;
    return out;
}

/** Two sheets as one mesh, so that both stand in one view; strips lose their numbers. */
function together(a: ReleasedSheet, b: ReleasedSheet): ReleasedSheet {
    const floats = (key: "layout" | "frontMm" | "backMm" | "shape") => {
        const out = new Float32Array(a[key].length + b[key].length);
        out.set(a[key]);
        out.set(b[key], a[key].length);
        return out;
    };
    const triangles = new Uint32Array(a.triangles.length + b.triangles.length);
    triangles.set(a.triangles);
    triangles.set(b.triangles.map((v) => v + a.vertexCount), a.triangles.length);
    const count = a.triangleCount + b.triangleCount;
    const none = new Int32Array(count).fill(-1);
    const empty = new Float32Array(0);
    return {
        vertexCount: a.vertexCount + b.vertexCount,
        triangleCount: count,
        triangles,
        layout: floats("layout"),
        frontMm: floats("frontMm"),
        backMm: floats("backMm"),
        shape: floats("shape"),
        frontStrip: none,
        backStrip: none,
        curvatureMax: empty,
        curvatureMin: empty,
        stretchMax: empty,
        stretchMin: empty,
        passesThrough: new Uint8Array(count),
    };
}

function table(a: Run, b: Run, difference: Difference): HTMLElement {
    const rows: [string, string, string, string][] = [];
    const [p, q] = [a.summary, b.summary];
    const add = (name: string, x: number | undefined, y: number | undefined, unit: string) => {
        if (x === undefined || y === undefined) return;
        const change = x === 0 ? "" : ` (${y >= x ? "+" : ""}${number((100 * (y - x)) / x, 3)} %)`;
        rows.push([name, `${number(x)} ${unit}`, `${number(y)} ${unit}`, `${number(y - x, 3)} ${unit}${change}`]);
    };
    rows.push(["state", stateOf(a).text, stateOf(b).text, ""]);
    rows.push(["size released", boxText(a), boxText(b), ""]);
    ["width", "depth", "height"].forEach((name, k) => add(name, p.box_size_mm[k], q.box_size_mm[k], "mm"));
    ["lowest", "median", "highest"].forEach((name, k) => add(`curvature, ${name}`, p.curvature_per_mm?.[k], q.curvature_per_mm?.[k], "/mm"));
    add("energy", p.energy_mJ, q.energy_mJ, "mJ");
    for (const key of new Set([...Object.keys(p.settings), ...Object.keys(q.settings)])) {
        const [x, y] = [valueText(p.settings[key]), valueText(q.settings[key])];
        if (x !== y) rows.push([key, x, y, "set differently"]);
    }
    return h(
        "table",
        { class: "differences" },
        h("thead", {}, h("tr", {}, h("th", {}, ""), h("th", {}, h("i", { class: "swatch", style: `background:${tints[0]}` }), nameOf(a)), h("th", {}, h("i", { class: "swatch", style: `background:${tints[1]}` }), nameOf(b)), h("th", {}, "difference"))),
        h("tbody", {}, ...rows.map(([name, ...cells]) => h("tr", {}, h("th", { scope: "row" }, name), ...cells.map((cell) => h("td", {}, cell))))),
        h("caption", {}, `Laid upon each other, points of the same place on the print are ${number(difference.rms_mm, 3)} mm apart (root mean square), ${number(difference.largest_mm, 3)} mm at most.`),
    );
}

/** Two results side by side, turned together, or laid upon each other. */
export class Comparison {
    readonly element: HTMLElement;
    private views: View[] = [];
    private readonly hosts = h("div", { class: "pair" });
    private readonly modes: HTMLButtonElement[];
    private readonly second: Float32Array;

    constructor(
        private readonly a: Side,
        private readonly b: Side,
        difference: Difference,
        close: () => void,
    ) {
        this.second = moved(b.result.sheet.shape, difference);
        const mode = (text: string, overlaid: boolean) => h("button", { type: "button", click: () => this.show(overlaid) }, text);
        this.modes = [mode("Side by side", false), mode("Overlaid", true)];
        this.element = h(
            "section",
            { class: "comparison", "aria-label": "comparison" },
            h("div", { class: "stage" }, this.hosts, h("div", { class: "controls" }, ...this.modes, h("span", { class: "spacer" }), h("button", { type: "button", click: close }, "Close"))),
            h("div", { class: "card scroll" }, table(a.run, b.run, difference)),
        );
    }

    /** To be called when the element has its place in the page. */
    begin(): void {
        this.show(false);
    }

    dispose(): void {
        for (const view of this.views) view.dispose();
        this.views = [];
    }

    private show(overlaid: boolean): void {
        this.dispose();
        this.modes.forEach((button, i) => button.setAttribute("aria-pressed", String((i === 1) === overlaid)));
        const { rotation, elevationDeg } = this.a.result;
        const view = (label: string) => {
            const host = h("div", { class: "view shape" });
            this.hosts.append(h("figure", {}, h("figcaption", {}, label), host));
            const made = new View(host, { placing: "shape", label, rotation, elevationDeg });
            this.views.push(made);
            return made;
        };
        this.hosts.replaceChildren();
        const { sheet: one } = this.a.result;
        const other = { ...this.b.result.sheet, shape: this.second };
        if (overlaid) {
            const both = together(one, other);
            const model = new SheetModel(both, both.shape, 0);
            const colours = tints.map(parseColour);
            model.paint((display, out) => {
                paintMaterials(display, { ...this.a.result.colours, fabric: tints[0]!, plasticFront: "#8a5a10", plasticBack: "#8a5a10" }, undefined, out);
                for (let i = 0; i < display.count; ++i) {
                    if (display.source[i]! < one.vertexCount) continue;
                    const dark = display.part[i] === 0 ? 1 : 0.6;
                    colours[1]!.forEach((c, k) => (out[4 * i + k] = Math.round(65535 * ((dark * c) / 255) ** 2.2)));
                }
            });
            view(`${nameOf(this.a.run)} and ${nameOf(this.b.run)}, laid upon each other`).show(model);
            return;
        }
        const shown = [[one, this.a], [other, this.b]] as const;
        for (const [sheet, side] of shown) {
            const model = new SheetModel(sheet, sheet.shape, 0);
            model.paint((display, out) => paintMaterials(display, side.result.colours, sheet.passesThrough, out));
            view(nameOf(side.run)).show(model);
        }
        this.turnTogether();
    }

    private turnTogether(): void {
        const [left, right] = this.views as [View, View];
        let leading = false;
        for (const [from, to] of [[left, right], [right, left]] as const)
            from.onTurn(() => {
                if (leading) return;
                leading = true;
                to.lookLike(from);
                leading = false;
            });
        left.look("home");  // it has half the width now
        right.lookLike(left);
    }
}
