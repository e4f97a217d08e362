import { h } from "../dom";
import { get, post, ServerError, type Form, type Job, type Run } from "./api";
import { PhotoMarks, type PhotoOptions } from "./photo_marks";

const largestMb = 17;  // in base64 within what the server takes

interface Measured {
    made: string;
    bytes?: string;
    photo?: PhotoOptions;
}

/** Bytes as a request can carry them. */
async function base64(file: File): Promise<string> {
    const address = await new Promise<string>((done, failed) => {
        const reader = new FileReader();
        reader.addEventListener("load", () => done(reader.result as string));
        reader.addEventListener("error", () => failed(reader.error));
        reader.readAsDataURL(file);
    });
    return address.slice(address.indexOf(",") + 1);
}

const isPhoto = (file: File) => /\.(png|jpe?g)$/i.test(file.name);
export const isMeasured = (file: File) => isPhoto(file) || /\.(obj|ply|stl)$/i.test(file.name);

/** Where a scan or a photo of what was made is chosen, to be compared with the result that is shown. */
export class MadeForm {
    readonly element: HTMLElement;
    private readonly known = h("select", { "aria-label": "scan in the folder", change: () => this.known.value && void this.compare({ made: this.known.value }) });
    private readonly unit = h("select", { "aria-label": "unit of the scan" }, h("option", { value: "" }, "guess its unit"), ...["mm", "cm", "m", "inch"].map((unit) => h("option", { value: unit }, unit)));
    private readonly marks = h("div", {});
    private readonly said = h("p", { class: "hint", role: "status" });
    private readonly trouble = h("p", { class: "trouble", role: "alert", hidden: true });
    private job: number | undefined;
    private ofPhoto = false;

    constructor(
        private readonly run: Run,
        private readonly done: (kind: "scan" | "photo") => void,
    ) {
        const file = h("input", { type: "file", accept: ".obj,.ply,.stl,.png,.jpg,.jpeg", class: "file", id: "made", "aria-label": "choose a scan or a photo", change: () => {
            const [chosen] = file.files ?? [];
            if (chosen) void this.take(chosen);
            file.value = "";
        } });
        this.element = h(
            "div",
            { class: "card made-form" },
            h("h2", {}, "Compare with what was made"),
            h("label", { class: "drop", for: "made" }, file, h("strong", {}, "Drop a scan or a photo here"), h("span", {}, "scan: OBJ, PLY or STL, of the whole or a part"), h("span", {}, "photo: PNG or JPEG, along the axis of a roll")),
            h("div", { class: "inputs" }, this.known, this.unit),
            this.marks,
            this.said,
            this.trouble,
        );
        void this.list();
    }

    async take(file: File): Promise<void> {
        this.marks.replaceChildren();
        if (!isMeasured(file)) return this.complain(`${file.name} is neither a scan (OBJ, PLY, STL) nor a photo (PNG, JPEG).`);
        if (file.size > 1e6 * largestMb) return this.complain(`${file.name} has ${Math.round(file.size / 1e6)} MB, at most ${largestMb} MB can be dropped. Copy a scan into the folder and choose it here; save a photo smaller.`);
        const bytes = await base64(file);
        if (!isPhoto(file)) return this.compare({ made: file.name, bytes });
        try {
            // As the file stores it: the program counts pixels like that, whatever a tag says about turning it.
            const picture = await createImageBitmap(file, { imageOrientation: "none" });
            this.say("");
            this.marks.replaceChildren(new PhotoMarks(picture, (photo) => void this.compare({ made: file.name, bytes, photo })).element);
        } catch {
            this.complain(`${file.name} is not a picture that this browser can read.`);
        }
    }

    /** Hears of every job. */
    follow(job: Job): void {
        if (job.id !== this.job) return;
        if (job.state === "running") this.say("Compares\u2026");
        if (job.state === "waiting") this.say("Waits until the release is done.");
        if (job.state === "failed" && job.error) this.complain([job.error.problem ?? job.error.message, job.error.advice].filter(Boolean).join(" \u2013 "));
        if (job.state === "done") {
            this.job = undefined;
            this.done(this.ofPhoto ? "photo" : "scan");
        }
    }

    private async compare(what: Measured): Promise<void> {
        this.say(`Takes ${what.made}\u2026`);
        this.ofPhoto = what.photo !== undefined;
        try {
            const { id } = await post<{ id: number }>("/api/compare", { run: this.run.folder, unit: this.unit.value, ...what });
            this.job = id;
            for (const job of await get<Job[]>("/api/jobs")) this.follow(job);
        } catch (error) {
            this.complain(error instanceof ServerError ? error.trouble.message : String(error));
        }
    }

    private say(text: string): void {
        this.said.textContent = text;
        this.trouble.hidden = true;
    }

    private complain(text: string): void {
        this.job = undefined;
        this.said.textContent = "";
        this.trouble.textContent = text;
        this.trouble.hidden = false;
    }

    private async list(): Promise<void> {
        const { scans } = await get<Form>("/api/form");
        this.known.replaceChildren(h("option", { value: "" }, scans.length > 0 ? "or a scan in the folder" : "no scan in the folder yet"), ...scans.map((name) => h("option", { value: name }, name)));
        this.known.disabled = scans.length === 0;
    }
}
