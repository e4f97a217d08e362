import { ticks } from "d3";

import type { Field } from "../colour/fields";
import { colourAt, cssGradient } from "../colour/maps";
import type { Result } from "../data/result";
import { h, number } from "../dom";

function swatch(colour: string, label: string): HTMLElement {
    return h("li", {}, h("i", { style: `background:${colour}` }), label);
}

function materials(result: Result): HTMLElement {
    const { sheet, colours } = result;
    const has = (list: ArrayLike<number>) => Array.prototype.some.call(list, (v: number) => v > 0);
    return h(
        "ul",
        { class: "swatches" },
        swatch(colours.fabric, "fabric"),
        has(sheet.frontMm) && swatch(colours.plasticFront, "plastic, front"),
        has(sheet.backMm) && swatch(colours.plasticBack, "plastic, back"),
        has(sheet.passesThrough) && swatch(colours.alarm, "passes through itself"),
    );
}

function scale(field: Field): HTMLElement {
    const [from, to] = field.range;
    const place = (v: number) => `left:${(100 * (v - from)) / (to - from)}%`;
    const marks = ticks(from, to, 4);
    return h(
        "div",
        { class: "scale" },
        h("i", { style: `background:${cssGradient(field.map)}` }),
        h("div", {}, ...marks.map((v) => h("span", { style: place(v) }, number(v, 3)))),
    );
}

/** What the colours mean. */
export function legend(result: Result, field: Field | undefined, note?: string): HTMLElement {
    const heading = field && h("p", { title: field.about }, h("strong", {}, field.label), field.unit && ` ${field.unit}`);
    let body: HTMLElement;
    if (!field) body = materials(result);
    else if (field.categories) {
        const [from, to] = field.range;
        const colour = (v: number) => `rgb(${colourAt(field.map, (v - from) / (to - from)).join(" ")})`;
        body = h("ul", { class: "swatches" }, ...field.categories.map(({ value, label }) => swatch(colour(value), label)));
    } else body = scale(field);
    return h("div", { class: "legend" }, heading ? heading : undefined, body, note ? h("p", { class: "hint" }, note) : undefined);
}
