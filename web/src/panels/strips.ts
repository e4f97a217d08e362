import type { StripReport } from "../data/report";
import type { Result } from "../data/result";
import { h, number } from "../dom";
import type { Attention } from "../signal";

interface Column {
    key: string;
    /** After the decimal point. */
    digits: number;
    label: string;
    unit: string;
    value: (strip: StripReport, index: number) => number | string | null;
}

const columns: Column[] = [
    { key: "id", digits: 0, label: "strip", unit: "", value: (s) => s.id },
    { key: "curvature", digits: 5, label: "curvature", unit: "1/mm", value: (s) => s.curvature_per_mm },
    { key: "radius", digits: 2, label: "radius", unit: "mm", value: (s) => s.radius_mm },
    { key: "stretch", digits: 4, label: "stretch", unit: "", value: (s) => s.stretch },
    { key: "length", digits: 1, label: "length", unit: "mm", value: (s) => s.printed_length_mm },
    { key: "fit", digits: 3, label: "fit", unit: "mm", value: (s) => s.fit_rms_mm },
];

const most = 400;

/** The same number of decimals in all of a column, so that it can be read downwards. */
function aligned(value: number | null, digits: number): string {
    return value === null ? "–" : value.toFixed(digits).replace("-", "\u2212");
}

/** "curvature 0.1524 /mm, radius 6.56 mm, stretch 0.950". */
export function stripFacts(strip: StripReport): [string, string][] {
    return [
        ["curvature", `${number(strip.curvature_per_mm)} /mm`],
        ["radius", strip.radius_mm === null ? "flat" : `${number(strip.radius_mm)} mm`],
        ["stretch", number(strip.stretch)],
    ];
}

/** All strips with what became of them; sorts by a click on a heading, chooses by a click or Enter on a row. */
export function stripTable(result: Result, attention: Attention): HTMLElement {
    const { strips } = result.report;
    let sortBy = columns[0]!;
    let ascending = true;
    let all = false;
    const body = h("tbody");
    const rows = new Map<number, HTMLTableRowElement>();
    const more = h("button", { type: "button", class: "more", click: () => { all = true; fill(); } });

    const fill = () => {
        const order = strips.map((_, i) => i);
        if (sortBy.key !== "id" || !ascending)
            order.sort((a, b) => (ascending ? 1 : -1) * compare(sortBy.value(strips[a]!, a), sortBy.value(strips[b]!, b)));
        const shown = all ? order : order.slice(0, most);
        rows.clear();
        body.replaceChildren(...shown.map((i) => row(i)));
        more.hidden = shown.length === strips.length;
        more.textContent = `Show all ${strips.length} strips`;
        mark();
    };
    const row = (i: number) => {
        const strip = strips[i]!;
        const made = h(
            "tr",
            {
                tabindex: 0,
                "data-strip": i,
                pointerenter: () => attention.hovered.set(i),
                pointerleave: () => attention.hovered.set(-1),
                focus: () => attention.hovered.set(i),
                blur: () => attention.hovered.set(-1),
                click: () => attention.chosen.set(attention.chosen.value === i ? -1 : i),
                keydown: (event: KeyboardEvent) => onKey(event, i),
            },
            ...columns.map((c) => {
                const value = c.value(strip, i);
                return typeof value === "string" ? h("th", { scope: "row" }, value) : h("td", {}, c.key === "radius" && value === null ? "flat" : aligned(value, c.digits));
            }),
        );
        rows.set(i, made);
        return made;
    };
    const onKey = (event: KeyboardEvent, i: number) => {
        const target = event.currentTarget as HTMLElement;
        if (event.key === "Enter" || event.key === " ") attention.chosen.set(attention.chosen.value === i ? -1 : i);
        else if (event.key === "ArrowDown") (target.nextElementSibling as HTMLElement | null)?.focus();
        else if (event.key === "ArrowUp") (target.previousElementSibling as HTMLElement | null)?.focus();
        else return;
        event.preventDefault();
        event.stopPropagation();
    };
    const mark = () => {
        for (const [i, made] of rows) {
            made.classList.toggle("hovered", i === attention.hovered.value);
            made.setAttribute("aria-selected", String(i === attention.chosen.value));
        }
    };
    const heads = columns.map((column) => {
        const sort = () => {
            ascending = sortBy === column ? !ascending : true;
            sortBy = column;
            for (const [k, other] of heads.entries())
                other.setAttribute("aria-sort", columns[k] === sortBy ? (ascending ? "ascending" : "descending") : "none");
            fill();
        };
        return h(
            "th",
            { scope: "col", "aria-sort": "none" },
            h("button", { type: "button", click: sort }, column.label, column.unit !== "" && h("small", {}, ` ${column.unit}`)),
        );
    });
    const table = h("table", { role: "grid" }, h("thead", {}, h("tr", {}, ...heads)), body);
    const scroll = h("div", { class: "scroll" }, table);
    fill();
    attention.hovered.watch(mark);
    attention.chosen.watch((i) => {
        mark();
        const row = rows.get(i);
        if (!row) return;
        // Only the table scrolls: the page stays where its reader is.
        const top = row.offsetTop - (table.tHead?.offsetHeight ?? 0);
        if (top < scroll.scrollTop) scroll.scrollTop = top;
        const low = row.offsetTop + row.offsetHeight - scroll.clientHeight;
        if (low > scroll.scrollTop) scroll.scrollTop = low;
    });
    return h(
        "section",
        { class: "card strips" },
        h("h2", {}, "Strips"),
        h("p", { class: "hint" }, "Point at a row, or at a strip above. Curvature is that of the centre line, positive where the back is concave; stretch is released over printed length; fit is how far the centre line is from a circle."),
        scroll,
        more,
    );
}

function compare(a: number | string | null, b: number | string | null): number {
    if (a === null || b === null) return a === b ? 0 : a === null ? 1 : -1;
    return typeof a === "string" ? a.localeCompare(String(b), "en", { numeric: true }) : a - (b as number);
}
