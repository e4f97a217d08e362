import { h } from "../dom";
import type { Signal } from "../signal";
import { standardViews, type StandardView, type View } from "../viewer/view";

const labels: Record<StandardView, string> = {
    home: "Home",
    front: "Front",
    back: "Back",
    left: "Left",
    right: "Right",
    top: "Top",
    bottom: "Bottom",
};

export type Cut = { axis: "x" | "y" | "z"; share: number } | undefined;

export interface ToolbarState {
    colour: Signal<string>;
    measuring: Signal<boolean>;
    cut: Signal<Cut>;
}

function colourChoice(fields: { id: string; label: string }[], colour: Signal<string>): HTMLElement {
    const select = h(
        "select",
        { "aria-label": "colour by", change: () => colour.set(select.value) },
        h("option", { value: "materials" }, "Materials"),
        ...fields.map(({ id, label }) => h("option", { value: id }, label)),
    );
    colour.watch((id) => (select.value = id));
    return h("label", { class: "field" }, h("span", {}, "Colour by"), select);
}

function viewChoice(view: View): HTMLElement {
    const select = h(
        "select",
        {
            "aria-label": "standard view",
            change: () => {
                view.look(select.value as StandardView);
                select.value = "";
            },
        },
        h("option", { value: "", hidden: true, selected: true }, "choose"),
        ...Object.keys(standardViews).map((name, i) => h("option", { value: name }, `${labels[name as StandardView]}  (${i})`)),
    );
    return h("label", { class: "field" }, h("span", {}, "View"), select);
}

function cutChoice(cut: Signal<Cut>): HTMLElement {
    const slider = h("input", {
        type: "range",
        min: 0,
        max: 1,
        step: 0.005,
        value: 0.5,
        "aria-label": "place of the cut",
        input: () => update(),
    });
    const select = h(
        "select",
        { "aria-label": "section plane", change: () => update() },
        h("option", { value: "" }, "none"),
        h("option", { value: "y" }, "from the front"),
        h("option", { value: "x" }, "from the side"),
        h("option", { value: "z" }, "from above"),
    );
    const update = () => {
        const axis = select.value as "x" | "y" | "z" | "";
        slider.hidden = axis === "";
        cut.set(axis === "" ? undefined : { axis, share: Number(slider.value) });
    };
    slider.hidden = true;
    return h("label", { class: "field" }, h("span", {}, "Section"), select, slider);
}

/** Colouring, standard views, section plane, measuring. */
export function toolbar(fields: { id: string; label: string }[], state: ToolbarState, view: View): HTMLElement {
    const measure = h("button", {
        type: "button",
        class: "tool",
        title: "Distance between two points (m)",
        click: () => state.measuring.set(!state.measuring.value),
    }, "Measure");
    state.measuring.watch((on) => measure.setAttribute("aria-pressed", String(on)));
    return h(
        "div",
        { class: "toolbar", role: "toolbar", "aria-label": "view" },
        colourChoice(fields, state.colour),
        viewChoice(view),
        cutChoice(state.cut),
        measure,
    );
}
