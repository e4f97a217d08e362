import { h } from "../dom";
import type { Base, Drawing, FieldInfo, Form, Rule, SceneRequest, Trouble, Value } from "./api";
import { inputRow, type Row } from "./inputs";
import { MarkTable } from "./mark_table";

const inFront = ["fabric.card", "fabric.prestretch", "fabric.margin_mm", "plastic.thickness_mm", "plastic.side", "pattern.width_mm"];
const hiddenSections = ["pattern", "output"];

function baseText(base: Base): string {
    return JSON.stringify(base);
}

/** All that can be set, as a form; tells when something has changed. */
export class Settings {
    readonly element: HTMLElement;
    private base: Base;
    private values: Record<string, Value> = {};
    private rules: Rule[] = [];
    private readonly rows = new Map<string, Row>();
    private readonly source = h("select", { id: "source", "aria-label": "drawing", change: () => this.choose(JSON.parse(this.source.value) as Base) });
    private readonly options = h("div", { class: "options" });
    private readonly marks = new MarkTable((rules) => this.setRules(rules));
    private readonly general = h("p", { class: "trouble general", role: "alert", hidden: true });
    private readonly notes = h("ul", { class: "drawing-notes" });

    constructor(
        private form: Form,
        private readonly changed: () => void,
        upload: (file: File) => void,
    ) {
        this.base = form.drawings[0] ? { svg: form.drawings[0] } : { generator: form.generators[0]!.name };
        const file = h("input", { type: "file", accept: ".svg,image/svg+xml", class: "file", id: "file", "aria-label": "choose an SVG drawing", change: () => {
            const [chosen] = file.files ?? [];
            if (chosen) upload(chosen);
            file.value = "";
        } });
        this.element = h(
            "form",
            { class: "settings", "aria-label": "settings", submit: (event: Event) => event.preventDefault() },
            this.group("Drawing", h("label", { class: "drop", for: "file" }, file, h("strong", {}, "Drop an SVG here"), h("span", {}, "or choose a file")), h("div", { class: "row" }, h("label", { for: "source" }, "Drawing"), h("div", { class: "inputs" }, this.source)), this.options, this.row("pattern.width_mm"), this.notes),
            this.group("Fabric", this.row("fabric.prestretch"), this.row("fabric.card", { names: form.cards.map((c) => c.name) }), this.row("fabric.margin_mm")),
            this.group("Plastic", this.row("plastic.thickness_mm"), this.row("plastic.side"), this.marks.element),
            this.more(),
            this.general,
        );
        this.listSources();
        this.showOptions();
    }

    /** As the server wants it. */
    request(): SceneRequest {
        return { base: this.base, values: this.values, rules: this.rules };
    }

    /** Begins anew with another drawing, pattern or scene; what was set of fabric and plastic stays for drawings. */
    choose(base: Base): void {
        this.base = base;
        const kept = "scene" in base ? [] : Object.entries(this.values).filter(([key]) => !key.startsWith("pattern."));
        this.values = Object.fromEntries(kept);
        this.rules = [];
        this.marks.forget();
        this.listSources();
        this.showOptions();
        this.changed();
    }

    /** The folder's drawings, scenes and cards may have changed. */
    update(form: Form): void {
        this.form = form;
        this.listSources();
    }

    /** What the scene has come to: every row shows its value. */
    show(drawing: Drawing): void {
        for (const [key, row] of this.rows) {
            const value = drawing.values[key];
            if (value !== undefined) row.set(value);
        }
        if (this.rules.length === 0) this.rules = drawing.rules;
        this.marks.show(drawing, this.rules);
        this.notes.replaceChildren(...drawing.warnings.map((text) => h("li", {}, text)));
        this.complain(undefined);
    }

    /** Says what is wrong where it belongs. */
    complain(trouble: Trouble | undefined): void {
        for (const row of this.rows.values()) row.complain(undefined);
        const key = trouble?.key ?? "";
        const row = this.rows.get(key) ?? this.rows.get(`pattern.options.${key.split(".").at(-1)}`) ?? (key.startsWith("plastic.rule") ? this.marks : undefined);
        this.marks.complain(undefined);
        if (row) row.complain(trouble);
        this.general.hidden = !trouble || row !== undefined;
        this.general.textContent = trouble && !row ? trouble.message : "";
        if (trouble && row && "element" in row) row.element.closest("details")?.setAttribute("open", "");
    }

    private group(title: string, ...rows: HTMLElement[]): HTMLElement {
        return h("fieldset", {}, h("legend", {}, title), ...rows);
    }

    private field(key: string): FieldInfo {
        const [section, name] = key.split(".");
        const found = this.form.sections.find((s) => s.name === section)?.fields.find((f) => f.key === name);
        if (!found) throw new Error(`the program has no setting ${key}`);
        return found;
    }

    private row(key: string, more: { names?: string[] } = {}): HTMLElement {
        const row = inputRow(this.field(key), key, (value) => this.set(key, value), more);
        this.rows.set(key, row);
        return row.element;
    }

    private set(key: string, value: Value): void {
        this.values = { ...this.values, [key]: value };
        this.changed();
    }

    private setRules(rules: Rule[]): void {
        this.rules = rules;
        this.changed();
    }

    private more(): HTMLElement {
        const sections = this.form.sections.filter((s) => !hiddenSections.includes(s.name));
        return h(
            "details",
            { class: "more-settings" },
            h("summary", {}, "All settings"),
            ...sections.map(({ name, fields }) => {
                const keys = fields.map((field) => `${name}.${field.key}`).filter((key) => !inFront.includes(key));
                return keys.length > 0 ? this.group(name, ...keys.map((key) => this.row(key))) : "";
            }),
        );
    }

    private listSources(): void {
        const option = (base: Base, text: string) => h("option", { value: baseText(base) }, text);
        const list = (label: string, options: HTMLElement[]) => (options.length > 0 ? [h("optgroup", { label }, ...options)] : []);
        const known = [
            ...list("Drawings in this folder", this.form.drawings.map((svg) => option({ svg }, svg))),
            ...list("Scenes in this folder", this.form.scenes.map((scene) => option({ scene }, scene))),
            ...list("Built-in patterns", this.form.generators.map((g) => option({ generator: g.name }, g.name))),
        ];
        this.source.replaceChildren(...known);
        const wanted = baseText(this.base);
        if (![...this.source.options].some((o) => o.value === wanted)) this.source.prepend(option(this.base, Object.values(this.base)[0] as string));
        this.source.value = wanted;
    }

    private showOptions(): void {
        for (const key of [...this.rows.keys()]) if (key.startsWith("pattern.options.")) this.rows.delete(key);
        const { base } = this;
        const generator = "generator" in base ? this.form.generators.find((g) => g.name === base.generator) : undefined;
        const rows = (generator?.options ?? []).map((option) => {
            const key = `pattern.options.${option.key}`;
            const row = inputRow(option, key, (value) => this.set(key, value), { asText: true });
            this.rows.set(key, row);
            return row.element;
        });
        this.options.replaceChildren(...(generator ? [h("p", { class: "hint" }, generator.summary)] : []), ...rows);
        const width = this.rows.get("pattern.width_mm");
        if (width) width.element.hidden = !("svg" in base);
    }
}
