import type { Film } from "../data/result";
import { h } from "../dom";
import type { Signal } from "../signal";

const frameMs = 110;
const restMs = 900;

/** Number of stops of the slider: every frame, and the final shape. */
export function lastStop(film: Film): number {
    return film.frames.length;
}

function caption(film: Film, stop: number): string {
    const frame = film.frames[stop];
    if (!frame) return "Released: the final shape, on the full mesh";
    const [a, b] = frame.prestretch.map((s) => s.toFixed(3));
    const what = a === b ? a : `${a} × ${b}`;
    if (frame.share === 0) return "Flat, as printed: nothing pulls";
    return `Equilibrium at a pre-stretch of ${what}, on ${film.sheet.triangleCount.toLocaleString("en")} triangles`;
}

/** The slider that plays the release. Every stop is an equilibrium of its own; nothing is blended between them. */
export function filmBar(film: Film, stop: Signal<number>): { bar: HTMLElement; toggle: () => void } {
    const last = lastStop(film);
    let timer = 0;
    const slider = h("input", {
        type: "range",
        min: 0,
        max: last,
        step: 1,
        "aria-label": "release, from flat to final",
        input: () => {
            pause();
            stop.set(Number(slider.value));
        },
    });
    const text = h("output", {});
    const button = h("button", { type: "button", class: "play", "aria-label": "play the release", click: () => toggle() });
    const paint = () => {
        button.dataset.playing = String(timer !== 0);
        button.setAttribute("aria-pressed", String(timer !== 0));
    };
    const pause = () => {
        window.clearTimeout(timer);
        timer = 0;
        paint();
    };
    const step = () => {
        const next = stop.value + 1;
        stop.set(next);
        if (next >= last) pause();
        else timer = window.setTimeout(step, frameMs);
        paint();
    };
    const toggle = () => {
        if (timer !== 0) return pause();
        const again = stop.value >= last;
        if (again) stop.set(0);
        timer = window.setTimeout(step, again ? restMs : frameMs);
        paint();
    };
    stop.watch((value) => {
        slider.value = String(value);
        slider.setAttribute("aria-valuetext", caption(film, value));
        slider.style.setProperty("--share", `${(100 * value) / last}%`);
        text.textContent = caption(film, value);
    });
    paint();
    return { bar: h("div", { class: "film" }, button, h("div", {}, slider, text)), toggle };
}
