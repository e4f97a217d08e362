import type { Result } from "../data/result";
import { h, seconds } from "../dom";

interface Trouble {
    title: string;
    text: string;
}

/** Why the shape is not to be trusted, worst first; empty when it is. */
export function troubles({ report }: Result): Trouble[] {
    const found: Trouble[] = [];
    if (report.status === "interrupted")
        found.push({ title: "Interrupted", text: "The run was stopped before it came to rest: this is an intermediate state. `ruche simulate … --resume` goes on from here." });
    if (report.status === "not_converged") found.push({ title: "Not converged", text: report.message });
    if (report.status === "converged" && !report.stable)
        found.push({ title: "Not stable", text: "The forces balance, but the energy is no minimum: a real sheet would move on to another shape. " + report.message });
    if (report.health.tangled)
        found.push({ title: "Tangled", text: "Somewhere the mesh has become a knot that no sheet could form. Try smaller elements or a smaller pre-stretch." });
    if (report.health.self_intersections > 0)
        found.push({
            title: "Passes through itself",
            text: `${report.health.self_intersections} pairs of triangles cross (red in both views). A real sheet cannot do that: --set model.contact=true keeps the parts from each other.`,
        });
    const margin = report.health.max_strain_margin;
    if (report.health.elements_beyond_law > 0 || (margin !== null && margin > 0))
        found.push({
            title: "Beyond the measured fabric",
            text: `${report.health.elements_beyond_law} pieces of fabric are stretched to the limit of what was measured of it, or beyond.`,
        });
    return found;
}

export function header(result: Result): HTMLElement {
    const { report } = result;
    const wrong = troubles(result);
    const badge = wrong.length === 0
        ? h("span", { class: "badge good" }, "converged, stable")
        : h("span", { class: "badge bad" }, wrong[0]!.title.toLowerCase());
    const [x, y, z] = report.shape.box_size_mm.map((mm) => mm.toFixed(0));
    return h(
        "header",
        {},
        h("div", { class: "title" }, h("h1", {}, result.title), badge),
        h("p", { class: "details" }, result.details),
        h(
            "dl",
            { class: "facts" },
            fact("size released", `${x} × ${y} × ${z} mm`),
            fact("strips", String(report.strips.length)),
            fact("triangles", report.mesh.triangles.toLocaleString("en")),
            fact("energy", `${report.energy_mJ.total.toPrecision(5)} mJ`),
            fact("solved in", seconds(report.solver.seconds)),
        ),
        wrong.length > 0 && alertOf(wrong),
        report.warnings.length > 0 && notes(report.warnings, wrong.length > 0),
    );
}

function fact(label: string, value: string): HTMLElement {
    return h("div", {}, h("dt", {}, label), h("dd", {}, value));
}

function alertOf(list: Trouble[]): HTMLElement {
    return h(
        "section",
        { class: "alert", role: "alert" },
        h("h2", {}, "Do not trust this shape as it is"),
        h("ul", {}, ...list.map(({ title, text }) => h("li", {}, h("strong", {}, title), h("span", {}, text)))),
    );
}

function notes(warnings: string[], open: boolean): HTMLElement {
    return h(
        "details",
        { class: "notes", open },
        h("summary", {}, warnings.length === 1 ? "1 warning" : `${warnings.length} warnings`),
        h("ul", {}, ...warnings.map((text) => h("li", {}, text))),
    );
}
