import { interpolateLab, interpolateViridis, rgb } from "d3";

export type Rgb = [number, number, number];

export interface ColourMap {
    name: "sequential" | "diverging";
    /** Colours at even steps from 0 to 1, sRGB, each component 0 to 255. */
    steps: Rgb[];
}

const count = 256;

function sampled(at: (t: number) => string): Rgb[] {
    return Array.from({ length: count }, (_, i) => {
        const colour = rgb(at(i / (count - 1)));
        return [colour.r, colour.g, colour.b];
    });
}

/** Viridis: perceptually uniform, ordered by lightness, safe for colour-blind readers. */
export const sequential: ColourMap = { name: "sequential", steps: sampled(interpolateViridis) };

/**
 * Blue, pale, rust: two straight lines in CIELAB from one pale grey to ends of equal lightness, so that equal
 * steps look equal and both halves weigh the same; blue against orange stays apart for colour-blind readers.
 */
const low = interpolateLab("#f0ece6", "#0a5da8");
const high = interpolateLab("#f0ece6", "#a8440a");
export const diverging: ColourMap = {
    name: "diverging",
    steps: sampled((t) => (t < 0.5 ? low(1 - 2 * t) : high(2 * t - 1))),
};

export function colourAt(map: ColourMap, t: number): Rgb {
    if (!Number.isFinite(t)) return [150, 150, 150];
    const i = Math.round(Math.min(1, Math.max(0, t)) * (count - 1));
    return map.steps[i]!;
}

/** A colour map as CSS paints it. */
export function cssGradient(map: ColourMap, direction = "to right"): string {
    const stops = map.steps.filter((_, i) => i % 15 === 0).map(([r, g, b]) => `rgb(${r} ${g} ${b})`);
    return `linear-gradient(${direction}, ${stops.join(", ")})`;
}

export function parseColour(text: string): Rgb {
    const colour = rgb(text);
    return [colour.r, colour.g, colour.b];
}
