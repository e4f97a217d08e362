import { h } from "../dom";
import type { FieldInfo, Trouble, Value } from "./api";

/** Where a form's settings stand, and where to say what is wrong with one. */
export interface Row {
    element: HTMLElement;
    set(value: Value): void;
    complain(trouble: Trouble | undefined): void;
}

const spoken: Record<string, string> = {
    "fabric.prestretch": "Pre-stretch",
    "fabric.card": "Material card",
    "fabric.margin_mm": "Fabric around the print",
    "fabric.axis_deg": "Angle of the fabric",
    "plastic.thickness_mm": "Thickness",
    "plastic.side": "Side",
    "pattern.width_mm": "Page width (0: as drawn)",
};

/** "inner_mm" as a person reads it. */
export function label(key: string, unit: string): string {
    if (spoken[key]) return spoken[key];
    const bare = key.split(".").at(-1)!;
    const suffix = "_" + unit.toLowerCase().replaceAll("/", "_per_").replaceAll("^", "").replaceAll(" ", "_");
    const name = unit && bare.endsWith(suffix) ? bare.slice(0, -suffix.length) : bare;
    const words = name.replaceAll("_", " ").replace("youngs", "Young's").replace("poissons", "Poisson's");
    return words[0]!.toUpperCase() + words.slice(1);
}

/** A slider reaches where people usually go; the box beside it takes all that is allowed. */
function reach(field: FieldInfo, value: number): { low: number; high: number; step: number } {
    if (field.key.endsWith("prestretch")) return { low: 1, high: 1.71, step: 0.01 };
    const size = Math.abs(value) || 1;
    const whole = field.kind === "integer";
    const high = Math.min(field.high ?? Infinity, whole ? Math.max(4, 3 * size) : 3 * size);
    const low = Math.max(field.low ?? -Infinity, value < 0 ? -3 * size : 0);
    return { low, high, step: whole ? 1 : 10 ** Math.floor(Math.log10((high - low) / 50)) };
}

class Complaint {
    readonly element = h("p", { class: "trouble", role: "alert", hidden: true });

    say(trouble: Trouble | undefined): void {
        this.element.hidden = !trouble;
        this.element.textContent = trouble ? [trouble.problem ?? trouble.message, trouble.advice].filter(Boolean).join(" – ") : "";
    }
}

function framed(field: FieldInfo, id: string, ...inputs: HTMLElement[]): { element: HTMLElement; complaint: Complaint } {
    const complaint = new Complaint();
    const element = h(
        "div",
        { class: "row", "data-key": id },
        h("label", { for: id, title: field.meaning }, label(id, field.unit), field.unit && h("small", {}, ` ${field.unit}`)),
        h("div", { class: "inputs" }, ...inputs),
        complaint.element,
    );
    return { element, complaint };
}

function rowOf(framedRow: { element: HTMLElement; complaint: Complaint }, set: (value: Value) => void): Row {
    return { element: framedRow.element, set, complain: (trouble) => framedRow.complaint.say(trouble) };
}

function numberRow(field: FieldInfo, id: string, change: (value: Value) => void, asText: boolean): Row {
    const start = Number(Array.isArray(field.value) ? field.value[0] : field.value);
    const { low, high, step } = reach(field, start);
    const box = h("input", { id, type: "number", step: "any", inputmode: "decimal", change: () => give(box.value) });
    const slider = h("input", { type: "range", min: low, max: high, step, "aria-label": label(id, field.unit), tabindex: -1, input: () => (box.value = slider.value), change: () => give(slider.value) });
    const give = (text: string) => {
        box.value = text;
        slider.value = text;
        if (text.trim() !== "") change(asText ? text : Number(text));
    };
    return rowOf(framed(field, id, slider, box), (value) => {
        const one = Array.isArray(value) ? value[0]! : value;
        if (document.activeElement !== box) box.value = String(one);
        slider.value = String(one);
    });
}

/** Two numbers that are mostly one: the second appears when somebody wants it. */
function pairRow(field: FieldInfo, id: string, change: (value: Value) => void): Row {
    const first = numberRow(field, id, () => give(), false);
    const second = h("input", { type: "number", step: "any", "aria-label": `${label(id, field.unit)}, second axis`, hidden: true, change: () => give() });
    const apart = h("input", { type: "checkbox", change: () => give() });
    const box = first.element.querySelector<HTMLInputElement>("input[type=number]")!;
    const give = () => {
        second.hidden = !apart.checked;
        if (!apart.checked) second.value = box.value;
        change([Number(box.value), Number(second.value || box.value)]);
    };
    const extra = h("label", { class: "apart" }, apart, h("span", {}, "another along the second axis"), second);
    first.element.append(extra);
    return {
        ...first,
        set: (value) => {
            first.set(value);
            const [a, b] = value as number[];
            if (a !== b) apart.checked = true;
            second.hidden = !apart.checked;
            if (document.activeElement !== second) second.value = String(b);
        },
    };
}

function choiceRow(field: FieldInfo, id: string, names: string[], change: (value: Value) => void): Row {
    const select = h("select", { id, change: () => change(field.kind === "boolean" ? select.value === "true" : select.value) }, ...names.map((name) => h("option", { value: name }, name)));
    return rowOf(framed(field, id, select), (value) => {
        const text = String(value);
        if (![...select.options].some((o) => o.value === text)) select.append(h("option", { value: text }, text));
        select.value = text;
    });
}

function textRow(field: FieldInfo, id: string, change: (value: Value) => void): Row {
    const numbers = field.kind === "three_numbers" || field.kind === "two_numbers";
    const read = () => (numbers ? box.value.split(/[\s,;]+/).filter(Boolean).map(Number) : box.value);
    const box = h("input", { id, type: "text", spellcheck: "false", change: () => change(read()) });
    return rowOf(framed(field, id, box), (value) => {
        if (document.activeElement !== box) box.value = Array.isArray(value) ? value.join(", ") : String(value);
    });
}

/** An input for one setting, by its kind; `names` where more is known of what it may be. `asText`: options of
 * generators, which are texts whatever they mean. */
export function inputRow(field: FieldInfo, id: string, change: (value: Value) => void, more: { names?: string[]; asText?: boolean } = {}): Row {
    let row: Row;
    if (more.names ?? field.names) row = choiceRow(field, id, more.names ?? field.names!, change);
    else if (field.kind === "boolean") row = choiceRow(field, id, ["false", "true"], more.asText ? (v) => change(String(v)) : change);
    else if (field.kind === "number" || field.kind === "integer") row = numberRow(field, id, change, more.asText ?? false);
    else if (id === "fabric.prestretch") row = pairRow(field, id, change);
    else row = textRow(field, id, change);
    row.set(field.value);
    return row;
}
