import { resultInDocument, type Result } from "./data/result";
import { h } from "./dom";
import { alternatives, convergence, distribution, energy } from "./panels/charts";
import { header } from "./panels/header";
import { scanComparison } from "./panels/scan_comparison";
import { assumptions, parameters } from "./panels/parameters";
import { stripTable } from "./panels/strips";
import { attention } from "./signal";
import { Stage } from "./stage";
import "./style.css";

function webglMissing(reason: unknown): HTMLElement {
    return h("section", { class: "alert" }, h("h2", {}, "This browser cannot draw the shape"), h("p", {}, `WebGL is missing or switched off (${String(reason)}). The numbers below are complete.`));
}

/** Canvases print badly: while the page is printed, pictures of them stand in their place. */
function printable(stage: Stage): void {
    let pictures: HTMLImageElement[] = [];
    window.addEventListener("beforeprint", () => {
        stage.drawNow();
        pictures = stage.canvases.map((canvas) => {
            const picture = h("img", { class: "printed", src: canvas.toDataURL("image/png"), alt: canvas.getAttribute("aria-label") ?? "" });
            canvas.after(picture);
            return picture;
        });
    });
    window.addEventListener("afterprint", () => {
        for (const picture of pictures) picture.remove();
    });
}

function show(result: Result): void {
    document.title = `${result.title} – Ruche`;
    const shared = attention();
    let stage: Stage | undefined;
    let trouble: HTMLElement | undefined;
    try {
        stage = new Stage(result, shared);
    } catch (reason) {
        trouble = webglMissing(reason);
    }
    const { version, scene } = result.report;
    document.body.replaceChildren(
        header(result),
        stage?.element ?? trouble!,
        h(
            "main",
            {},
            result.comparison ? scanComparison(result.comparison) : "",
            stripTable(result, shared),
            h("div", { class: "column" }, distribution(result, shared), energy(result)),
            h("div", { class: "column" }, convergence(result), alternatives(result) ?? "", assumptions(result) ?? ""),
            parameters(result),
        ),
        h(
            "footer",
            {},
            h("p", {}, `Ruche ${version}${scene ? `, from ${scene}` : ""}. All lengths in mm.`),
            h("p", { class: "keys" }, "Keys in a view: arrows turn, + and \u2212 zoom, 0 to 6 standard views, m measures, space plays the release, Escape lets go."),
        ),
    );
    if (stage) {
        stage.begin();
        printable(stage);
        Object.assign(window, { rucheStage: stage });
    }
    document.documentElement.dataset.ready = String(Math.round(performance.now()));
}

show(resultInDocument());
