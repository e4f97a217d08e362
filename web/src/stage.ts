import { Fields, valueAt, type Field } from "./colour/fields";
import { principalStretches } from "./colour/stretch";
import type { Result } from "./data/result";
import { h, number } from "./dom";
import { filmBar, lastStop } from "./panels/film_bar";
import { legend } from "./panels/legend";
import { stripFacts } from "./panels/strips";
import { toolbar, type Cut, type ToolbarState } from "./panels/toolbar";
import { Signal, type Attention } from "./signal";
import { Measure } from "./viewer/measure";
import { paintField, paintMaterials } from "./viewer/paint";
import { SheetModel, type Placing, type SheetHit } from "./viewer/sheet_model";
import { standardViews, View, type StandardView } from "./viewer/view";

/** The drawing and the shape side by side, linked, with the means to look at them. */
export class Stage {
    readonly element: HTMLElement;
    private readonly fields: Fields;
    private readonly views: Record<Placing, View>;
    private readonly hosts: Record<Placing, HTMLElement>;
    private readonly cards: Record<Placing, HTMLElement>;
    private readonly model: SheetModel;
    private filmModel: SheetModel | undefined;
    private readonly measure: Measure;
    private readonly state: ToolbarState = {
        colour: new Signal("materials"),
        measuring: new Signal(false),
        cut: new Signal<Cut>(undefined),
    };
    private readonly stop: Signal<number>;
    private readonly legendHost = h("div", {});
    private readonly readout = h("p", { class: "readout", role: "status" });
    private togglePlay: () => void = () => {};

    constructor(
        private readonly result: Result,
        private readonly attention: Attention,
    ) {
        this.fields = new Fields(result);
        this.model = new SheetModel(result.sheet, result.sheet.shape, result.report.strips.length);
        this.hosts = { flat: h("div", { class: "view flat" }), shape: h("div", { class: "view shape" }) };
        this.cards = { flat: h("div", { class: "hover", hidden: true }), shape: h("div", { class: "hover", hidden: true }) };
        this.views = {
            flat: new View(this.hosts.flat, { placing: "flat", label: "the drawing, seen from the printed front" }),
            shape: new View(this.hosts.shape, {
                placing: "shape",
                label: "the released shape; arrow keys turn it",
                rotation: result.rotation,
                elevationDeg: result.elevationDeg,
            }),
        };
        this.measure = new Measure(this.model);
        for (const placing of ["flat", "shape"] as const) {
            this.hosts[placing].append(this.cards[placing]);
            this.measure.addView(this.views[placing], placing, this.hosts[placing]);
            this.listen(placing);
        }
        if (result.sheet.scanDistance) this.state.colour.set("scan");
        this.stop = new Signal(result.film ? lastStop(result.film) : 0);
        this.element = this.layOut();
        this.follow();
    }

    /** Chosen from outside, as the keyboard and tests do. */
    get colour(): Signal<string> {
        return this.state.colour;
    }

    get view(): View {
        return this.views.shape;
    }

    /** Fits both views; to be called when the element has its place in the page. */
    begin(): void {
        for (const view of Object.values(this.views)) view.show(this.model);
    }

    dispose(): void {
        for (const view of Object.values(this.views)) view.dispose();
    }

    /** At once, for printing. */
    drawNow(): void {
        for (const view of Object.values(this.views)) view.drawNow();
    }

    get canvases(): HTMLCanvasElement[] {
        return Object.values(this.views).map((view) => view.canvas);
    }

    /** The strip under a point of the page in one of the views, -1 for bare fabric or nothing. */
    stripAt(placing: Placing, clientX: number, clientY: number): number {
        const hit = this.views[placing].pick(clientX, clientY);
        return hit ? this.modelOf(placing).strip(hit) : -1;
    }

    private layOut(): HTMLElement {
        const scale = h("span", { class: "scalebar" }, h("i", {}), h("b", {}));
        this.views.flat.onDraw(() => drawScale(scale, this.views.flat.mmPerPixel));
        this.hosts.flat.append(scale);
        const film = this.result.film && filmBar(this.result.film, this.stop);
        if (film) this.togglePlay = film.toggle;
        return h(
            "section",
            { class: "stage", "aria-label": "drawing and shape" },
            h("figure", { class: "drawing" }, h("figcaption", {}, "Printed flat, on stretched fabric"), this.hosts.flat),
            h("figure", { class: "released" }, h("figcaption", {}, "Released"), this.hosts.shape, this.legendHost, this.readout),
            h("div", { class: "controls" }, toolbar(this.fields.list(), this.state, this.views.shape), film?.bar),
        );
    }

    /** Draws what the signals say. */
    private follow(): void {
        this.state.colour.watch(() => this.paint());
        this.state.cut.watch((cut) => this.views.shape.cut(cut?.axis, cut?.share));
        this.stop.watch(() => this.showStop());
        this.state.measuring.watch((on) => {
            if (on && this.result.film) this.stop.set(lastStop(this.result.film));
            if (!on) this.measure.clear();
            for (const host of Object.values(this.hosts)) host.classList.toggle("measuring", on);
            this.tellMeasured();
        });
        for (const view of Object.values(this.views)) {
            this.attention.hovered.watch((strip) => view.highlights.light("hover", strip));
            this.attention.chosen.watch((strip) => view.highlights.light("chosen", strip));
        }
        this.attention.chosen.watch(() => this.tellMeasured());
    }

    private get atEnd(): boolean {
        return !this.result.film || this.stop.value >= lastStop(this.result.film);
    }

    private showStop(): void {
        const { film } = this.result;
        if (!film) return;
        const frame = film.frames[this.stop.value];
        if (!frame) {
            this.views.shape.show(this.model, true);
            this.paint();
            return;
        }
        if (this.state.measuring.value) this.state.measuring.set(false);
        if (!this.filmModel) this.filmModel = new SheetModel(film.sheet, frame.shape, this.result.report.strips.length);
        else this.filmModel.setShape(frame.shape);
        this.views.shape.show(this.filmModel, true);
        this.views.shape.makeRoom();
        this.paint();
    }

    private paint(): void {
        const field = this.fields.get(this.state.colour.value);
        const { colours, sheet } = this.result;
        this.model.paint((display, out) =>
            field ? paintField(display, field, out) : paintMaterials(display, colours, sheet.passesThrough, out),
        );
        const onFilm = this.atEnd ? field : this.filmField(field);
        if (!this.atEnd)
            this.filmModel?.paint((display, out) =>
                onFilm ? paintField(display, onFilm, out) : paintMaterials(display, colours, undefined, out),
            );
        for (const view of Object.values(this.views)) view.shade(!field);
        const note = field && !onFilm ? "Measured at the end of the release only: shown on the drawing." : undefined;
        this.legendHost.replaceChildren(legend(this.result, field, note));
    }

    /** The same field on a frame of the film, where it can be had from its positions. */
    private filmField(field: Field | undefined): Field | undefined {
        const { film } = this.result;
        const frame = film?.frames[this.stop.value];
        if (!field || !film || !frame) return undefined;
        const { frontMm, backMm } = film.sheet;
        const each = (rule: (front: number, back: number) => number) =>
            Float32Array.from(frontMm, (front, t) => rule(front, backMm[t]!));
        switch (field.id) {
            case "thickness":
                return { ...field, values: each((a, b) => a + b) };
            case "side":
                return { ...field, values: each((a, b) => (a > 0 ? 1 : 0) + (b > 0 ? 2 : 0)) };
            case "stretch_max":
                return { ...field, values: principalStretches(film.sheet, frame.shape).max };
            case "stretch_min":
                return { ...field, values: principalStretches(film.sheet, frame.shape).min };
            default:
                return undefined;
        }
    }

    private listen(placing: Placing): void {
        const view = this.views[placing];
        const { canvas } = view;
        let waiting = false;
        let last: PointerEvent | undefined;
        let pressed: { x: number; y: number } | undefined;
        canvas.addEventListener("pointermove", (event) => {
            last = event;
            if (waiting || event.buttons !== 0) return;
            waiting = true;
            requestAnimationFrame(() => {
                waiting = false;
                if (last) this.point(placing, last);
            });
        });
        canvas.addEventListener("pointerleave", (event) => {
            last = undefined;
            if (event.pointerType !== "mouse") return;  // what a finger has asked for stays after it is lifted
            this.attention.hovered.set(-1);
            this.cards[placing].hidden = true;
        });
        canvas.addEventListener("pointerdown", (event) => (pressed = { x: event.clientX, y: event.clientY }));
        canvas.addEventListener("pointerup", (event) => {
            const moved = !pressed || Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) > 4;
            pressed = undefined;
            if (!moved && event.button === 0) this.press(placing, event);
        });
        canvas.addEventListener("keydown", (event) => {
            if (this.key(view, event)) event.preventDefault();
        });
    }

    /** The model that a view shows: the drawing always shows the full mesh. */
    private modelOf(placing: Placing): SheetModel {
        return placing === "shape" && !this.atEnd && this.filmModel ? this.filmModel : this.model;
    }

    private point(placing: Placing, event: PointerEvent): void {
        const hit = this.views[placing].pick(event.clientX, event.clientY);
        const card = this.cards[placing];
        card.hidden = !hit;
        if (!hit) return this.attention.hovered.set(-1);
        this.attention.hovered.set(this.modelOf(placing).strip(hit));
        card.replaceChildren(...this.facts(placing, hit));
        const frame = this.hosts[placing].getBoundingClientRect();
        const x = event.clientX - frame.left;
        const y = event.clientY - frame.top;
        card.style.left = `${Math.max(0, Math.min(x + 14, frame.width - card.offsetWidth - 4))}px`;
        card.style.top = `${Math.max(0, y + 14 + card.offsetHeight > frame.height ? y - card.offsetHeight - 10 : y + 14)}px`;
    }

    private press(placing: Placing, event: PointerEvent): void {
        const hit = this.views[placing].pick(event.clientX, event.clientY);
        if (this.state.measuring.value) {
            if (hit) this.measure.add(hit);
            this.tellMeasured();
            for (const view of Object.values(this.views)) view.draw();
            return;
        }
        const strip = hit ? this.modelOf(placing).strip(hit) : -1;
        this.attention.chosen.set(strip === this.attention.chosen.value ? -1 : strip);
        if (event.pointerType !== "mouse") this.point(placing, event);
    }

    private facts(placing: Placing, hit: SheetHit): HTMLElement[] {
        const model = this.modelOf(placing);
        const index = model.strip(hit);
        const strip = this.result.report.strips[index];
        const lines: [string, string][] = [];
        if (strip) {
            const { frontMm, backMm } = model.sheet;
            const [front, back] = [frontMm[hit.triangle]!, backMm[hit.triangle]!];
            const print = [front > 0 && `${number(front)} mm front`, back > 0 && `${number(back)} mm back`];
            lines.push(["print", print.filter(Boolean).join(", ")], ...stripFacts(strip));
        }
        const field = this.fields.get(this.state.colour.value);
        if (field && model === this.model) {
            const value = valueAt(field, model.sheet, hit.triangle, hit.weights);
            lines.push([field.label.toLowerCase(), `${number(value)} ${field.unit}`]);
        }
        return [
            h("strong", {}, strip ? strip.id : "bare fabric"),
            h("dl", {}, ...lines.flatMap(([key, value]) => [h("dt", {}, key), h("dd", {}, value)])),
        ];
    }

    private tellMeasured(): void {
        const measured = this.measure.result();
        const strip = this.result.report.strips[this.attention.chosen.value];
        if (measured)
            this.readout.textContent = `${number(measured.released)} mm straight through space; ${number(measured.printed)} mm on the drawing`;
        else if (this.state.measuring.value)
            this.readout.textContent = this.measure.count === 0 ? "Click the first point, on either side" : "Click the second point";
        else this.readout.textContent = strip ? `${strip.id}: ${stripFacts(strip).map((f) => f.join(" ")).join(", ")}` : "";
    }

    /** Whether the key meant something. */
    private key(view: View, event: KeyboardEvent): boolean {
        const turns: Record<string, [number, number]> = {
            ArrowLeft: [-1, 0],
            ArrowRight: [1, 0],
            ArrowUp: [0, 1],
            ArrowDown: [0, -1],
        };
        const turn = turns[event.key];
        const names = Object.keys(standardViews) as StandardView[];
        if (event.ctrlKey || event.metaKey || event.altKey) return false;
        if (turn) view.turn(...turn);
        else if (event.key === "+" || event.key === "=") view.zoom(1.2);
        else if (event.key === "-") view.zoom(1 / 1.2);
        else if (/^[0-6]$/.test(event.key)) this.views.shape.look(names[Number(event.key)]!);
        else if (event.key === "m") this.state.measuring.set(!this.state.measuring.value);
        else if (event.key === " ") this.togglePlay();
        else if (event.key === "Escape") {
            this.attention.chosen.set(-1);
            this.state.measuring.set(false);
        } else return false;
        return true;
    }
}

/** Makes a bar as long as a round number of millimetres. */
export function drawScale(bar: HTMLElement, mmPerPixel: number): void {
    if (!(mmPerPixel > 0)) return;
    const longest = 120 * mmPerPixel;
    const decade = 10 ** Math.floor(Math.log10(longest));
    const length = decade * ([5, 2].find((digit) => digit * decade <= longest) ?? 1);
    (bar.firstElementChild as HTMLElement).style.width = `${length / mmPerPixel}px`;
    bar.lastElementChild!.textContent = `${number(length)} mm`;
}


