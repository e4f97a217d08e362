import type { ScanComparison } from "../data/result";
import { h, number } from "../dom";

/** How far what was made is from what was simulated, in numbers. */
export function scanComparison(found: ScanComparison): HTMLElement {
    const { placing, covered } = found;
    const rows: [string, string][] = [
        ["root mean square", `${number(found.rms_mm, 3)} mm`],
        ["on average", `${number(found.mean_mm, 3)} mm (positive: outside)`],
        ...Object.entries(found.percentiles_mm).map(([percent, mm]): [string, string] => [`${percent} % within`, `${number(mm, 3)} mm`]),
        ["covered by the scan", `${number(100 * covered, 3)} %`],
        ["unit of the scan", found.unit + (found.unit_guessed ? ", guessed from the sizes" : "")],
        ["compared with", found.skin === "both" ? "both skins of the sheet" : `the ${found.skin} of the sheet`],
    ];
    if (placing.scale !== 1) rows.push(["scale of the scan", `${number(placing.scale, 5)}, let free`]);
    return h(
        "section",
        { class: "card wide scan" },
        h("h2", {}, "Compared with a scan"),
        h("p", { class: "hint" }, `${found.scan}, ${found.points.toLocaleString("en")} points`),
        h("dl", { class: "facts" }, ...rows.map(([key, value]) => h("div", {}, h("dt", {}, key), h("dd", {}, value)))),
        ...found.warnings.map((text) => h("p", { class: "alert" }, text)),
    );
}
