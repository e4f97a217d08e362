import { h, number } from "../dom";
import { fileAddress, type Run } from "./api";

/** compare.json of a photo, as docs/file-formats.md describes it: what is shown of it. */
export interface Silhouette {
    photo?: string;
    curvature_per_mm: number;
    uncertainty_per_mm: number;
    result_outline_curvature_per_mm: number;
    difference: number;
    circle_px: { arc_deg: number };
    warnings: string[];
}

/** The circle around what was made beside the result's own. */
export function silhouette(run: Run, found: Silhouette): HTMLElement {
    const facts: [string, string][] = [
        ["curvature in the photo", `${number(found.curvature_per_mm)} ± ${number(found.uncertainty_per_mm, 2)} /mm`],
        ["radius in the photo", `${number(1 / found.curvature_per_mm)} mm`],
        ["the result's outline", `${number(found.result_outline_curvature_per_mm)} /mm, ${number(1 / found.result_outline_curvature_per_mm)} mm`],
        ["difference", `${number(100 * found.difference, 3)} %: bent ${found.difference > 0 ? "more" : "less"} than simulated`],
        ["arc", `${number(found.circle_px.arc_deg, 3)}°`],
    ];
    return h(
        "section",
        { class: "card silhouette" },
        h("h2", {}, "Compared with a photo"),
        h("img", { src: `${fileAddress(run.folder, "silhouette.png")}?at=${Date.now()}`, alt: "the photo with the circle around the sheet, orange, and the result's, blue" }),
        h("dl", { class: "facts" }, ...facts.map(([key, value]) => h("div", {}, h("dt", {}, key), h("dd", {}, value)))),
        ...found.warnings.map((text) => h("p", { class: "alert" }, text)),
    );
}
