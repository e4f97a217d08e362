import { h, number, seconds } from "../dom";
import { fileAddress, type Run, type Value } from "./api";

export interface ResultActions {
    open: (run: Run) => void;
    compare: (a: Run, b: Run) => void;
    goOn: (run: Run) => void;
}

export const nameOf = (run: Run) => run.folder.replace(/\.out$/, "");

export function stateOf({ summary }: Run): { text: string; good: boolean } {
    if (summary.status === "converged" && summary.stable) return { text: "stable", good: true };
    if (summary.status === "converged") return { text: "not stable", good: false };
    return { text: summary.status.replace("_", " "), good: false };
}

function when(written: number): string {
    const date = new Date(1000 * written);
    const today = date.toDateString() === new Date().toDateString();
    return today ? date.toLocaleTimeString([], { hour: "2-digit", minute: "2-digit" }) : date.toLocaleDateString();
}

export function valueText(value: Value | undefined): string {
    if (value === undefined) return "–";
    if (Array.isArray(value)) return value.every((v) => v === value[0]) ? number(value[0]) : value.map((v) => number(v)).join(" × ");
    return typeof value === "number" ? number(value) : String(value);
}

export const boxText = (run: Run) => `${run.summary.box_size_mm.map((mm) => mm.toFixed(0)).join(" × ")} mm`;

function settingsText({ summary: { settings } }: Run): string {
    const parts = [
        settings["fabric.prestretch"] !== undefined && `stretch ${valueText(settings["fabric.prestretch"])}`,
        settings["plastic.thickness_mm"] !== undefined && `${valueText(settings["plastic.thickness_mm"])} mm`,
        settings["plastic.side"] !== undefined && String(settings["plastic.side"]),
    ];
    return parts.filter(Boolean).join(", ");
}

/** What can be taken away from a result. */
export function downloads(run: Run): HTMLElement {
    const link = (name: string, text: string) => h("a", { href: `${fileAddress(run.folder, name)}?download`, download: "" }, text);
    return h(
        "nav",
        { class: "downloads", "aria-label": `files of ${nameOf(run)}` },
        run.page && h("a", { href: fileAddress(run.folder, "report.html"), target: "_blank", rel: "noopener" }, "Open report"),
        run.page && link("report.html", "Report"),
        link("shape.obj", "OBJ"),
        link("shape.glb", "GLB"),
        link("shape.stl", "STL"),
        link("drawing.svg", "Drawing"),
        link("scene.toml", "Scene"),
        run.compared && link("compare.html", "Scan"),
        run.photographed && link("silhouette.png", "Silhouette"),
    );
}

/** All results in the folder, whoever wrote them. */
export class ResultList {
    readonly element: HTMLElement;
    private readonly body = h("tbody", {});
    private readonly table: HTMLElement;
    private readonly compareButton: HTMLButtonElement;
    private readonly none = h("p", { class: "hint" }, "None yet. What the command line writes into this folder appears here, too.");
    private runs: Run[] = [];
    private chosen: string[] = [];
    private shown = "";

    constructor(private readonly actions: ResultActions) {
        this.compareButton = h("button", { type: "button", disabled: true, click: () => this.compare() }, "Compare two");
        const head = h("tr", {}, ...["", "result", "", "size released", "curvature, 1/mm", "set", "when"].map((text) => h("th", {}, text)));
        this.table = h("div", { class: "scroll", hidden: true }, h("table", {}, h("thead", {}, head), this.body));
        this.element = h(
            "section",
            { class: "card results", "aria-label": "results" },
            h("div", { class: "heading" }, h("h2", {}, "Results"), this.compareButton),
            this.none,
            this.table,
        );
    }

    show(runs: Run[]): void {
        this.runs = runs;
        this.chosen = this.chosen.filter((folder) => runs.some((run) => run.folder === folder));
        this.none.hidden = runs.length > 0;
        this.table.hidden = runs.length === 0;
        this.fill();
    }

    mark(folder: string): void {
        this.shown = folder;
        this.fill();
    }

    private fill(): void {
        this.body.replaceChildren(...this.runs.map((run) => this.row(run)));
        this.compareButton.disabled = this.chosen.length !== 2;
    }

    private compare(): void {
        const [a, b] = this.chosen.map((folder) => this.runs.find((run) => run.folder === folder));
        if (a && b) this.actions.compare(a, b);
    }

    private row(run: Run): HTMLElement {
        const state = stateOf(run);
        const curvature = run.summary.curvature_per_mm;
        const box = h("input", {
            type: "checkbox",
            "aria-label": `compare ${nameOf(run)}`,
            change: () => {
                this.chosen = box.checked ? [...this.chosen, run.folder].slice(-2) : this.chosen.filter((f) => f !== run.folder);
                this.fill();
            },
        });
        box.checked = this.chosen.includes(run.folder);
        return h(
            "tr",
            { "data-folder": run.folder, class: run.folder === this.shown ? "shown" : "" },
            h("td", {}, box),
            h("th", { scope: "row" }, h("button", { type: "button", class: "link", click: () => this.actions.open(run) }, nameOf(run)), h("button", { type: "button", class: "quiet", title: "Go on from its settings and its shape", click: () => this.actions.goOn(run) }, "go on")),
            h("td", {}, h("span", { class: `badge ${state.good ? "good" : "bad"}`, title: run.summary.message }, state.text)),
            h("td", {}, boxText(run)),
            h("td", {}, curvature ? `${number(curvature[0], 3)} to ${number(curvature[2], 3)}` : "–"),
            h("td", { class: "set" }, settingsText(run)),
            h("td", { title: seconds(run.summary.seconds) + " to solve" }, when(run.written)),
        );
    }
}
