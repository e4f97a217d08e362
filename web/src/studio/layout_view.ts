import { h, number } from "../dom";
import { drawScale } from "../stage";
import type { Drawing, Form } from "./api";

const space = "http://www.w3.org/2000/svg";

function svg<K extends keyof SVGElementTagNameMap>(name: K, attributes: Record<string, string>): SVGElementTagNameMap[K] {
    const made = document.createElementNS(space, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    return made;
}

/** The printed layout to scale, before anything is released: fabric, strips, a bar of millimetres. */
export class LayoutView {
    readonly element = h("div", { class: "view layout" });
    private readonly scale = h("span", { class: "scalebar" }, h("i", {}), h("b", {}));
    private readonly card = h("div", { class: "hover", hidden: true });
    private picture: SVGSVGElement | undefined;
    private box: [number, number, number, number] = [0, 0, 1, 1];

    constructor(private readonly colours: Form["colours"]) {
        this.element.append(this.scale, this.card);
        new ResizeObserver(() => this.drawBar()).observe(this.element);
    }

    show(drawing: Drawing): void {
        this.picture?.remove();
        this.picture = undefined;
        this.card.hidden = true;
        if (!drawing.box || !drawing.fabric) return;
        this.box = drawing.box;
        const [left, low, right, high] = drawing.box;
        const margin = 0.06 * Math.max(right - left, high - low);
        const picture = svg("svg", {
            viewBox: `${left - margin} ${-high - margin} ${right - left + 2 * margin} ${high - low + 2 * margin}`,
            role: "img",
            "aria-label": `printed layout, ${number(right - left, 4)} by ${number(high - low, 4)} mm, ${drawing.strips?.length ?? 0} strips`,
        });
        const upright = svg("g", { transform: "scale(1 -1)" });
        upright.append(svg("path", { d: drawing.fabric, fill: this.colours.fabric, "fill-rule": "evenodd" }));
        for (const strip of drawing.strips ?? []) {
            const back = strip.side === "back";
            const path = svg("path", {
                d: strip.path,
                fill: back ? this.colours.plasticBack : this.colours.plasticFront,
                "fill-rule": "evenodd",
                ...(back ? { "fill-opacity": "0.6" } : {}),
            });
            path.classList.add("strip");
            path.addEventListener("pointerenter", () => this.tell(strip));
            path.addEventListener("pointerleave", () => (this.card.hidden = true));
            upright.append(path);
        }
        picture.append(upright);
        this.element.prepend(picture);
        this.picture = picture;
        this.drawBar();
    }

    private tell(strip: NonNullable<Drawing["strips"]>[number]): void {
        this.card.hidden = false;
        this.card.replaceChildren(h("strong", {}, strip.id), h("div", {}, `${number(strip.thickness_mm)} mm, ${strip.side}`));
        this.card.style.left = "18px";
        this.card.style.top = "8px";
    }

    private drawBar(): void {
        const { clientWidth: width, clientHeight: height } = this.element;
        const [left, low, right, high] = this.box;
        const margin = 0.12 * Math.max(right - left, high - low);
        if (width > 0 && height > 0) drawScale(this.scale, Math.max((right - left + margin) / width, (high - low + margin) / height));
    }
}
