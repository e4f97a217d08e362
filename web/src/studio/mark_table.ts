import { h } from "../dom";
import type { Drawing, Rule, Trouble } from "./api";

const roles: [string, string][] = [
    ["", "as drawn"],
    ["strip", "printed"],
    ["fabric_outline", "fabric's edge"],
    ["ignore", "left out"],
];

/** What each colour of the drawing means: printed or not, how thick, on which side. A rule for every one that was
 * touched. */
export class MarkTable {
    readonly element = h("div", { class: "marks", hidden: true });
    private readonly trouble = h("p", { class: "trouble", role: "alert", hidden: true });
    private shown = "";
    private rules: Rule[] = [];

    constructor(private readonly change: (rules: Rule[]) => void) {}

    forget(): void {
        this.shown = "";
        this.rules = [];
    }

    show(drawing: Drawing, rules: Rule[]): void {
        const marks = drawing.marks ?? [];
        const state = JSON.stringify([marks, rules, drawing.values["plastic.thickness_mm"]]);
        this.element.hidden = marks.length === 0;
        if (state === this.shown || this.element.contains(document.activeElement)) return;
        this.shown = state;
        this.rules = rules.map((rule) => ({ ...rule }));
        const body = (kind: string) => marks.filter((mark) => mark.kind === kind).map((mark) => this.row(mark, drawing));
        const layers = body("layer");
        const head = h("thead", {}, h("tr", {}, ...["", "is", "mm", "side"].map((text) => h("th", {}, text))));
        this.element.replaceChildren(
            h("table", { "aria-label": "meaning of the colours" }, head, h("tbody", {}, ...body("colour"))),
            ...(layers.length > 0 ? [h("details", {}, h("summary", {}, "By layer"), h("table", { "aria-label": "meaning of the layers" }, h("tbody", {}, ...layers)))] : []),
            this.trouble,
        );
    }

    complain(trouble: Trouble | undefined): void {
        this.trouble.hidden = !trouble;
        this.trouble.textContent = trouble ? [trouble.problem ?? trouble.message, trouble.advice].filter(Boolean).join(" – ") : "";
    }

    private set(match: string, part: Partial<Rule>): void {
        const rule: Rule = { ...(this.rules.find((r) => r.match === match) ?? { match }), ...part };
        for (const key of Object.keys(rule) as (keyof Rule)[]) if (rule[key] === undefined) delete rule[key];
        const others = this.rules.filter((r) => r.match !== match);
        this.rules = Object.keys(rule).length > 1 ? [...others, rule] : others;
        this.change(this.rules);
    }

    private row({ match, kind, count }: NonNullable<Drawing["marks"]>[number], drawing: Drawing): HTMLElement {
        const rule = this.rules.find((r) => r.match === match);
        const role = h("select", { "aria-label": `${match} is`, change: () => this.set(match, { role: (role.value || undefined) as Rule["role"] }) }, ...roles.map(([value, text]) => h("option", { value }, text)));
        role.value = rule?.role ?? "";
        const thick = h("input", {
            type: "number",
            step: "any",
            "aria-label": `thickness of ${match}, mm`,
            placeholder: String(drawing.values["plastic.thickness_mm"] ?? ""),
            value: rule?.thickness_mm ?? "",
            change: () => this.set(match, { thickness_mm: thick.value === "" ? undefined : Number(thick.value) }),
        });
        const side = h("select", { "aria-label": `side of ${match}`, change: () => this.set(match, { side: (side.value || undefined) as Rule["side"] }) }, h("option", { value: "" }, "–"), h("option", { value: "front" }, "front"), h("option", { value: "back" }, "back"));
        side.value = rule?.side ?? "";
        const name = kind === "colour" ? h("i", { class: "swatch", style: `background:${match}`, title: match }) : match;
        return h("tr", {}, h("th", { scope: "row" }, name, h("small", {}, ` ${count}`)), h("td", {}, role), h("td", {}, thick), h("td", {}, side));
    }
}
