import type { Vector3 } from "three";

import type { Placing, SheetHit, SheetModel } from "./sheet_model";
import type { View } from "./view";

type Place = Pick<SheetHit, "triangle" | "weights">;

/** Distances between two points of the sheet, mm. */
export interface Measured {
    /** Straight through space, on the released shape. */
    released: number;
    /** Straight on the drawing. */
    printed: number;
}

/** Two points of the sheet, marked in every view, with the line between them. */
export class Measure {
    private readonly places: Place[] = [];
    private readonly overlays: { view: View; placing: Placing; svg: SVGSVGElement }[] = [];

    constructor(private model: SheetModel) {}

    addView(view: View, placing: Placing, host: HTMLElement): void {
        const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
        svg.setAttribute("class", "measure");
        svg.setAttribute("aria-hidden", "true");
        host.append(svg);
        this.overlays.push({ view, placing, svg });
        view.onDraw(() => this.redraw());
    }

    setModel(model: SheetModel): void {
        if (model.sheet !== this.model.sheet) this.places.length = 0;
        this.model = model;
        this.redraw();
    }

    /** The first point, the second, and then the first of the next pair. */
    add(place: Place): void {
        if (this.places.length === 2) this.places.length = 0;
        this.places.push({ triangle: place.triangle, weights: place.weights });
        this.redraw();
    }

    clear(): void {
        this.places.length = 0;
        this.redraw();
    }

    get count(): number {
        return this.places.length;
    }

    result(): Measured | undefined {
        const [a, b] = this.places;
        if (!a || !b) return undefined;
        const distance = (placing: Placing) => this.model.point(placing, a).distanceTo(this.model.point(placing, b));
        return { released: distance("shape"), printed: distance("flat") };
    }

    private redraw(): void {
        const measured = this.result();
        for (const { view, placing, svg } of this.overlays) {
            const points = this.places.map((place) => view.project(this.model.point(placing, place) as Vector3));
            const mm = measured && (placing === "flat" ? measured.printed : measured.released);
            svg.replaceChildren(...marks(points, mm));
        }
    }
}

function element(name: string, attributes: Record<string, string | number>, text?: string): SVGElement {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
    if (text) made.textContent = text;
    return made;
}

function marks(points: { x: number; y: number }[], mm: number | undefined): SVGElement[] {
    const made: SVGElement[] = [];
    const [a, b] = points;
    if (a && b) {
        made.push(element("line", { x1: a.x, y1: a.y, x2: b.x, y2: b.y }));
        const text = `${mm!.toFixed(mm! < 10 ? 2 : 1)} mm`;
        made.push(element("text", { x: 0.5 * (a.x + b.x), y: 0.5 * (a.y + b.y) - 8 }, text));
    }
    for (const { x, y } of points) made.push(element("circle", { cx: x, cy: y, r: 5 }));
    return made;
}
