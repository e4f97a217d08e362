import "../style.css";
import "./studio.css";
import { resultInDocument, type Result } from "../data/result";
import { h } from "../dom";
import { header } from "../panels/header";
import { scanComparison } from "../panels/scan_comparison";
import { stripTable } from "../panels/strips";
import { distribution } from "../panels/charts";
import { attention } from "../signal";
import { Stage } from "../stage";
import { fileAddress, get, post, ServerError, text, type Difference, type Drawing, type Form, type Job, type Run, type Trouble } from "./api";
import { Comparison } from "./comparison";
import { listen } from "./events";
import { LayoutView } from "./layout_view";
import { LiveView } from "./live_view";
import { downloads, nameOf, ResultList } from "./results";
import { isMeasured, MadeForm } from "./made_form";
import { Settings } from "./settings";
import { silhouette, type Silhouette } from "./silhouette";

const changePauseMs = 250;
/** What a release writes unless the person says otherwise: the page shows the shape itself, sooner without a picture. */
const forTheFolder = { "output.stl": true, "output.picture": false };

/** The whole page: settings on the left, the print and its shape on the right, results below. */
class Studio {
    private readonly owner = crypto.randomUUID();
    private readonly settings: Settings;
    private readonly layout: LayoutView;
    private readonly live: LiveView;
    private readonly results: ResultList;
    private readonly place = h("div", { class: "place" });
    private readonly bench: HTMLElement;
    private readonly alarm = h("p", { class: "alert", role: "alert", hidden: true });
    private readonly release: HTMLButtonElement;
    private readonly preview = h("input", { type: "checkbox", id: "preview", checked: true, change: () => this.preview.checked && this.changed() });
    private readonly goOn = h("select", { "aria-label": "begin with" });
    private readonly jobs = new Map<number, Job>();
    private runs: Run[] = [];
    private made: MadeForm | undefined;  // of the result that is shown
    private mine: number | undefined;  // the job whose shape is shown
    private timer = 0;
    private asked = 0;
    private dispose: () => void = () => {};

    constructor(private readonly form: Form) {
        this.settings = new Settings(form, () => this.changed(), (file) => void this.upload(file));
        this.layout = new LayoutView(form.colours);
        this.live = new LiveView(form.colours, (id) => void post("/api/cancel", { id }).catch((e: unknown) => this.fail(e)));
        this.results = new ResultList({ open: (run) => void this.open(run), compare: (a, b) => void this.compare(a, b), goOn: (run) => this.goOnFrom(run) });
        this.release = h("button", { type: "button", class: "release", click: () => void this.start("release") }, "Release");
        this.bench = h(
            "section",
            { class: "stage bench", "aria-label": "print and release" },
            h("figure", { class: "drawing" }, h("figcaption", {}, "Printed flat, on stretched fabric, to scale"), this.layout.element),
            h("figure", { class: "released" }, h("figcaption", {}, "Released"), this.live.element),
        );
        this.settings.element.append(
            h("div", { class: "actions" }, this.release, h("label", { class: "field", for: "preview" }, this.preview, "preview while I change things"), h("label", { class: "field" }, "begin with", this.goOn)),
        );
    }

    async begin(): Promise<void> {
        document.body.replaceChildren(
            h("header", { class: "top" }, h("h1", {}, "Ruche studio"), h("p", { class: "details" }, this.form.folder)),
            this.alarm,
            h("div", { class: "workbench" }, this.settings.element, h("div", { class: "right" }, this.place, this.results.element)),
            h("footer", {}, h("p", {}, `Ruche ${this.form.version}. Everything here lies in the folder above; the command line reads and writes the same files.`)),
        );
        this.listStarts();
        this.showBench();
        this.takeDrops();
        document.addEventListener("visibilitychange", () => void this.refreshShape());
        listen((type, data) => this.hear(type, data));
        await Promise.all([this.refreshRuns(), this.refreshJobs(), this.draw()]);
        document.documentElement.dataset.ready = "true";
    }

    // What the person does.

    private changed(): void {
        ++this.asked;  // answers to what was set before come too late
        window.clearTimeout(this.timer);
        this.timer = window.setTimeout(() => {
            this.showBench();
            void this.draw();
        }, changePauseMs);
    }

    private async draw(): Promise<void> {
        const asked = ++this.asked;
        try {
            const drawing = await post<Drawing>("/api/drawing", this.settings.request());
            if (asked !== this.asked) return;
            this.settings.show(drawing);
            this.layout.show(drawing);
            this.release.disabled = false;
            this.say(undefined);
            if (this.preview.checked && !this.releasing()) await this.start("preview");
        } catch (error) {
            if (asked !== this.asked) return;
            this.release.disabled = error instanceof ServerError && error.trouble.problem !== undefined;
            this.fail(error);
        }
    }

    private async start(kind: "release" | "preview"): Promise<void> {
        const request = this.settings.request();
        const values = kind === "release" ? { ...forTheFolder, ...request.values } : request.values;
        const start = kind === "release" ? this.goOn.value : "";
        try {
            const { id } = await post<{ id: number }>(`/api/${kind}`, { ...request, values, owner: this.owner, start });
            this.mine = id;
            if (kind === "release") this.showBench();
            await this.refreshJobs();
            if (kind === "release") this.live.element.scrollIntoView({ block: "nearest" });  // settings may reach far below
        } catch (error) {
            this.fail(error);
        }
    }

    private async upload(file: File): Promise<void> {
        try {
            const { name } = await post<{ name: string }>("/api/upload", { name: file.name, text: await file.text() });
            this.settings.update(await get<Form>("/api/form"));
            this.settings.choose({ svg: name });
        } catch (error) {
            this.fail(error);
        }
    }

    private takeDrops(): void {
        document.addEventListener("dragover", (event) => {
            event.preventDefault();
            document.body.classList.add("dragging");
        });
        document.addEventListener("dragleave", (event) => {
            if (!event.relatedTarget) document.body.classList.remove("dragging");
        });
        document.addEventListener("drop", (event) => {
            event.preventDefault();
            document.body.classList.remove("dragging");
            const [file] = event.dataTransfer?.files ?? [];
            if (!file) return;
            if (!isMeasured(file)) void this.upload(file);
            else if (this.made && this.place.contains(this.made.element)) void this.made.take(file);
            else this.say({ message: `${file.name} shows what was made: open the result that it is to be compared with, and drop it again.` });
        });
    }

    private goOnFrom(run: Run): void {
        this.goOn.value = run.folder;
        this.settings.choose({ scene: `${run.folder}/scene.toml` });
        this.settings.element.scrollIntoView({ block: "start", behavior: "smooth" });
    }

    // What is shown.

    private put(element: HTMLElement, dispose: () => void): void {
        this.dispose();
        this.dispose = dispose;
        this.place.replaceChildren(element);
    }

    private showBench(): void {
        if (this.place.contains(this.bench)) return;
        this.put(this.bench, () => this.live.dispose());
        this.results.mark("");
        this.live.invite("Set stretch and thickness, then press Release.");
        void this.refreshShape();
    }

    private async load(run: Run, page: "report.html" | "compare.html" = "report.html"): Promise<Result> {
        if (!run.page) throw new ServerError({ message: `${nameOf(run)} has no report.html: it was written with output.page = false, or by a program without the page.` });
        const written = await text(fileAddress(run.folder, page));
        return resultInDocument(new DOMParser().parseFromString(written, "text/html"));
    }

    private async open(run: Run, page?: "compare.html"): Promise<void> {
        try {
            const result = { ...(await this.load(run, page)), title: nameOf(run) };
            const shared = attention();
            const stage = new Stage(result, shared);
            const photo = run.photographed && !page ? await get<Silhouette>(fileAddress(run.folder, "compare.json")) : undefined;
            this.made = new MadeForm(run, (kind) => void (kind === "scan" ? this.open({ ...run, compared: true }, "compare.html") : this.open({ ...run, photographed: true })));
            const element = h(
                "section",
                { class: "result", "aria-label": `result ${nameOf(run)}` },
                header(result),
                stage.element,
                h("div", { class: "below" },
                    h("div", { class: "column" },
                        h("div", { class: "card" }, h("h2", {}, "Take it with you"), downloads(run),
                            h("button", { type: "button", click: () => this.showBench() }, "Back to the print"),
                            run.compared && !page && h("button", { type: "button", click: () => void this.open(run, "compare.html") }, "Show the scan")),
                        distribution(result, shared)),
                    h("div", { class: "column" }, photo?.photo !== undefined && silhouette(run, photo), this.made.element),
                    result.comparison && scanComparison(result.comparison),
                    stripTable(result, shared)),
            );
            this.put(element, () => stage.dispose());
            this.results.mark(run.folder);
            this.goOn.value = run.folder;
            stage.begin();
            Object.assign(window, { rucheStage: stage });
        } catch (error) {
            this.fail(error);
        }
    }

    private async compare(a: Run, b: Run): Promise<void> {
        try {
            const address = `/api/difference?a=${encodeURIComponent(a.folder)}&b=${encodeURIComponent(b.folder)}`;
            const [difference, one, other] = await Promise.all([get<Difference>(address), this.load(a), this.load(b)]);
            const comparison = new Comparison({ run: a, result: one }, { run: b, result: other }, difference, () => this.showBench());
            this.put(comparison.element, () => comparison.dispose());
            comparison.begin();
            this.place.scrollIntoView({ block: "nearest" });
        } catch (error) {
            this.fail(error);
        }
    }

    private fail(error: unknown): void {
        this.say(error instanceof ServerError ? error.trouble : { message: String(error) });
    }

    /** About a setting beside it, else on top of the page. */
    private say(trouble: Trouble | undefined): void {
        const ofForm = trouble?.problem !== undefined;
        this.settings.complain(ofForm ? trouble : undefined);
        this.alarm.hidden = !trouble || ofForm;
        this.alarm.textContent = trouble && !ofForm ? trouble.message : "";
    }

    // What the server says.

    private hear(type: string, data: string): void {
        if (type === "job") this.take(JSON.parse(data) as Job);
        else if (type === "shape") void this.refreshShape();
        else if (type === "runs") void this.refreshRuns();
        else if (type === "closed") document.body.classList.add("away");
        else if (type === "open") {
            document.body.classList.remove("away");
            void this.refreshJobs();
            void this.refreshRuns();
        }
    }

    private take(job: Job): void {
        const before = this.jobs.get(job.id);
        this.jobs.set(job.id, job);
        this.made?.follow(job);
        if (job.id !== this.mine) return;
        this.live.follow(job);
        this.release.textContent = this.releasing() ? "Release once more" : "Release";
        if (before?.state === job.state) return;
        if (job.state === "failed" && job.error) this.say(job.error);
        if (job.kind === "release" && job.state === "done") void this.finished(job);
        if (job.state === "cancelled" && job.kind === "release") {
            this.live.invite("Cancelled.");
            void this.refreshRuns();
        }
    }

    private async finished(job: Job): Promise<void> {
        await this.refreshRuns();
        const run = this.runs.find((r) => r.folder === job.folder);
        if (run && this.mine === job.id) await this.open(run);
    }

    private releasing(): boolean {
        const job = this.mine === undefined ? undefined : this.jobs.get(this.mine);
        return job?.kind === "release" && (job.state === "running" || job.state === "waiting");
    }

    private async refreshJobs(): Promise<void> {
        try {
            for (const job of (await get<Job[]>("/api/jobs")).reverse()) this.take(job);
        } catch (error) {
            this.fail(error);
        }
    }

    private async refreshRuns(): Promise<void> {
        try {
            this.runs = await get<Run[]>("/api/runs");
            this.results.show(this.runs);
            this.listStarts();
        } catch (error) {
            this.fail(error);
        }
    }

    private async refreshShape(): Promise<void> {
        if (this.place.contains(this.bench)) await this.live.refresh((job) => job === this.mine).catch((e: unknown) => this.fail(e));
    }

    private listStarts(): void {
        const before = this.goOn.value;
        this.goOn.replaceChildren(h("option", { value: "" }, "the flat sheet"), ...this.runs.slice(0, 30).map((run) => h("option", { value: run.folder }, `the shape of ${nameOf(run)}`)));
        if (this.runs.some((run) => run.folder === before)) this.goOn.value = before;
    }
}

void get<Form>("/api/form")
    .then((form) => new Studio(form).begin())
    .catch((error: unknown) => {
        document.body.replaceChildren(h("p", { class: "alert", role: "alert" }, String(error)));
    });
