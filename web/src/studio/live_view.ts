import { PackedArrays } from "../data/packed";
import { readSheet } from "../data/result";
import { h, number, seconds } from "../dom";
import { paintMaterials } from "../viewer/paint";
import { SheetModel } from "../viewer/sheet_model";
import { View } from "../viewer/view";
import { get, type Form, type Job, type Shape } from "./api";

/** A line of residuals over steps, each mesh in its own shade. */
function residualChart(history: [number, number][]): SVGElement {
    const made = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    made.setAttribute("viewBox", "0 0 160 36");
    made.setAttribute("aria-label", "residual over steps, logarithmic");
    const logs = history.map(([, r]) => Math.log10(Math.max(r, 1e-12)));
    const [low, high] = [Math.min(...logs, -9), Math.max(...logs, 1)];
    const at = (i: number) => `${(160 * i) / Math.max(1, logs.length - 1)} ${34 - (32 * (logs[i]! - low)) / (high - low)}`;
    for (let i = 1; i < logs.length; ++i) {
        const line = document.createElementNS(made.namespaceURI, "path");
        line.setAttribute("d", `M${at(i - 1)}L${at(i)}`);
        line.setAttribute("class", history[i]![0] === history[i - 1]![0] ? "" : "finer");
        made.append(line);
    }
    return made as SVGElement;
}

/** The shape as the solver moves it, with how far it is and the means to stop it. */
export class LiveView {
    readonly element: HTMLElement;
    private readonly host = h("div", { class: "view shape" });
    private readonly title = h("strong", {});
    private readonly details = h("span", {});
    private readonly bar = h("progress", { max: 1, "aria-label": "progress of the release" });
    private readonly chart = h("div", { class: "residual" });
    private readonly cancel: HTMLButtonElement;
    private readonly panel: HTMLElement;
    private readonly empty = h("p", { class: "invitation" });
    private view: View | undefined;
    private model: SheetModel | undefined;
    private mesh = 0;
    private asking = false;
    private again = false;
    private job: Job | undefined;

    constructor(
        private readonly colours: Form["colours"],
        onCancel: (id: number) => void,
    ) {
        this.cancel = h("button", { type: "button", class: "cancel", click: () => this.job && onCancel(this.job.id) }, "Cancel");
        this.panel = h("div", { class: "progress", role: "status", hidden: true }, h("div", { class: "line" }, this.title, this.details, this.cancel), this.bar, this.chart);
        this.host.append(this.empty);
        this.element = h("div", { class: "live" }, this.host, this.panel);
    }

    invite(text: string): void {
        this.empty.textContent = text;
        this.empty.hidden = this.model !== undefined;
    }

    /** The job that the view follows. */
    follow(job: Job | undefined): void {
        this.job = job;
        this.panel.hidden = !job || (job.state !== "running" && job.state !== "waiting");
        if (!job) return;
        const what = job.kind === "preview" ? "Preview" : `Releasing ${job.folder.replace(/\.out$/, "")}`;
        this.title.textContent = job.state === "waiting" ? `${what}: waits its turn` : what;
        const left = job.left_s === null ? "" : ` · about ${seconds(Math.max(1, Math.round(job.left_s)))} left`;
        this.details.textContent = job.state === "running" ? `${seconds(Math.round(10 * job.seconds) / 10)}${left} · ${job.phase === "release" ? job.text.split(":")[0]! : job.phase}` : "";
        if (job.share > 0) this.bar.value = job.share;
        else this.bar.removeAttribute("value");
        this.cancel.hidden = job.kind === "preview";
    }

    /** Fetches the latest shape and shows it; where shapes come faster than they can be shown, some are left out. */
    async refresh(wanted: (job: number) => boolean): Promise<void> {
        this.again = true;
        if (this.asking || document.hidden) return;
        this.asking = true;
        try {
            while (this.again) {
                this.again = false;
                const shape = await get<Shape>(`/api/shape?mesh=${this.mesh}`);
                if (shape.job !== undefined && wanted(shape.job)) this.show(shape);
                await new Promise((done) => requestAnimationFrame(done));
            }
        } finally {
            this.asking = false;
        }
    }

    private show(shape: Shape): void {
        const arrays = new PackedArrays(shape.arrays, shape.bytes);
        const positions = arrays.numbers("shape_mm");
        const first = !this.view;
        try {
            this.view ??= new View(this.host, { placing: "shape", label: "the shape as it is released; arrow keys turn it", elevationDeg: 38 });
        } catch {
            return this.invite("This browser cannot draw the shape: WebGL is missing or switched off.");
        }
        this.empty.hidden = true;
        if (arrays.has("triangles")) {
            const sheet = readSheet(arrays, "");
            this.model = new SheetModel(sheet, positions, 0);
            this.mesh = shape.mesh;
            this.model.paint((display, out) => paintMaterials(display, this.colours, undefined, out));
            this.view.show(this.model, !first && shape.iteration > 0);
        } else if (this.model && shape.mesh === this.mesh) {
            this.model.setShape(positions);
            this.view.show(this.model, true);
        }
        if (shape.iteration === 0 && shape.residual_N === null) this.view.look("home");
        this.view.makeRoom();
        Object.assign(this.element.dataset, { job: shape.job, iteration: shape.iteration });  // which shape is seen
        if (shape.history.length > 1) this.chart.replaceChildren(residualChart(shape.history), h("span", {}, `step ${shape.history.length}, ${shape.triangles.toLocaleString("en")} triangles, residual ${number(shape.residual_N, 2)} N`));
    }

    dispose(): void {
        this.view?.dispose();
        this.view = undefined;
        this.model = undefined;
        this.mesh = 0;
    }
}
