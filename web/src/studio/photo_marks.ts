import { h } from "../dom";

/** What a photo of a rolled sheet has to say beside itself. */
export interface PhotoOptions {
    known_length_mm: number;
    known_length_at_px: number[];
    seen_along_deg: number;
}

/** A photo on which the two ends of a known length are pointed at. */
export class PhotoMarks {
    readonly element: HTMLElement;
    private readonly canvas = h("canvas", { tabindex: 0, role: "img", "aria-label": "the photo; point at both ends of a known length", click: (event: MouseEvent) => this.mark(event) });
    private readonly length = h("input", { type: "number", step: "any", min: 0, value: 50, id: "known-length", inputmode: "decimal", input: () => this.show() });
    private readonly along = h("select", { "aria-label": "the photo looks along" }, h("option", { value: "90" }, "the drawing's y axis"), h("option", { value: "0" }, "the drawing's x axis"));
    private readonly button: HTMLButtonElement;
    private readonly told = h("p", { class: "hint", role: "status" });
    private ends: [number, number][] = [];

    constructor(
        private readonly photo: ImageBitmap,
        measure: (options: PhotoOptions) => void,
    ) {
        this.canvas.width = photo.width;
        this.canvas.height = photo.height;
        this.button = h("button", { type: "button", click: () => measure(this.options()) }, "Measure the circle");
        this.element = h(
            "div",
            { class: "photo-marks" },
            this.canvas,
            this.told,
            h("div", { class: "row" }, h("label", { for: "known-length" }, "Known length", h("small", {}, " mm")), h("div", { class: "inputs" }, this.length)),
            h("div", { class: "row" }, h("span", {}, "Looks along"), h("div", { class: "inputs" }, this.along)),
            this.button,
        );
        this.show();
    }

    private options(): PhotoOptions {
        return { known_length_mm: Number(this.length.value), known_length_at_px: this.ends.flat(), seen_along_deg: Number(this.along.value) };
    }

    /** A third point begins anew. */
    private mark(event: MouseEvent): void {
        const box = this.canvas.getBoundingClientRect();
        const at: [number, number] = [((event.clientX - box.left) * this.photo.width) / box.width, ((event.clientY - box.top) * this.photo.height) / box.height];
        this.ends = this.ends.length === 2 ? [at] : [...this.ends, at];
        this.show();
    }

    private show(): void {
        const ink = this.canvas.getContext("2d")!;
        ink.drawImage(this.photo, 0, 0);
        const size = Math.max(this.photo.width, this.photo.height) / 60;
        ink.lineWidth = size / 5;
        ink.strokeStyle = "#0072b2";
        ink.beginPath();
        for (const [x, y] of this.ends) {
            ink.moveTo(x + size, y);
            ink.arc(x, y, size, 0, 2 * Math.PI);
        }
        if (this.ends.length === 2) {
            ink.moveTo(...this.ends[0]!);
            ink.lineTo(...this.ends[1]!);
        }
        ink.stroke();
        this.told.textContent = ["Point at one end of a length that you know, as on a ruler beside the roll\u2019s near rim.", "Now at its other end.", "Say how long it is."][this.ends.length]!;
        this.button.disabled = this.ends.length < 2 || !(Number(this.length.value) > 0);
    }
}
