import type { Parameter } from "../data/report";
import type { Result } from "../data/result";
import { h, number } from "../dom";

function isParameter(value: unknown): value is Parameter {
    return typeof value === "object" && value !== null && "value" in value && "source" in value;
}

function shown(value: unknown): string {
    if (typeof value === "number") return number(value, 7);
    if (typeof value === "boolean") return value ? "yes" : "no";
    if (Array.isArray(value)) return value.map(shown).join(", ");
    if (value === "" || value === null || value === undefined) return "–";
    return typeof value === "object" ? JSON.stringify(value) : String(value);
}

type Kind = "given" | "assumed" | "default" | "card";

/** Where a value comes from, in one word: what a reader has to check first is what was assumed. */
function kindOf(source: string): Kind {
    if (source === "default") return "default";
    if (/^assum/i.test(source)) return "assumed";
    return /:\d+$|^--|command line/.test(source) ? "given" : "card";
}

function section(name: string, content: Record<string, unknown>): HTMLElement[] {
    const rows = Object.entries(content).flatMap(([key, value]) => {
        if (!isParameter(value)) {
            const text = shown(value);
            if (text === "–" || text === "{}" || text === "no") return [];
            return [h("tr", { "data-kind": "given" }, h("th", { scope: "row" }, key), h("td", {}, text), h("td"), h("td"))];
        }
        const kind = kindOf(value.source);
        return [
            h(
                "tr",
                { "data-kind": kind },
                h("th", { scope: "row" }, key),
                h("td", {}, shown(value.value)),
                h("td", {}, value.unit),
                h("td", {}, kind === "assumed" ? h("mark", {}, value.source) : value.source),
            ),
        ];
    });
    if (rows.length === 0) return [];
    return [h("tbody", {}, h("tr", { class: "group" }, h("th", { colspan: 4, scope: "rowgroup" }, `[${name}]`)), ...rows)];
}

/** Every value that went in, with its unit and where it comes from. */
export function parameters({ report }: Result): HTMLElement {
    const groups = Object.entries(report.parameters).flatMap(([name, content]) =>
        Array.isArray(content)
            ? content.flatMap((entry, i) => section(`${name} ${i + 1}`, entry as Record<string, unknown>))
            : section(name, content),
    );
    const table = h(
        "table",
        { class: "plain parameters" },
        h("thead", {}, h("tr", {}, ...["parameter", "value", "unit", "source"].map((t) => h("th", { scope: "col" }, t)))),
        ...groups,
    );
    const hideDefaults = h("input", {
        type: "checkbox",
        change: () => table.classList.toggle("without-defaults", hideDefaults.checked),
    });
    return h(
        "section",
        { class: "card wide" },
        h("h2", {}, "Parameters"),
        h("label", { class: "switch" }, hideDefaults, " only what was given, assumed or taken from the card"),
        h("div", { class: "scroll" }, table),
    );
}

export function assumptions({ report }: Result): HTMLElement | undefined {
    if (report.assumptions.length === 0) return undefined;
    return h(
        "section",
        { class: "card" },
        h("h2", {}, "What was assumed"),
        h("p", { class: "hint" }, "Nobody measured these. Pre-stretch, then printed thickness, then the fabric's thickness matter most."),
        h("ul", { class: "assumptions" }, ...report.assumptions.map((text) => h("li", {}, text))),
    );
}
