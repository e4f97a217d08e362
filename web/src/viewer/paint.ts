import type { Field } from "../colour/fields";
import { colourAt, parseColour, type Rgb } from "../colour/maps";
import type { Result } from "../data/result";
import type { DisplayMesh } from "./display_mesh";

/** sRGB to amounts of light, 0 to 65535: what the vertex colours of a renderer are in. */
const light = Uint16Array.from({ length: 256 }, (_, i) => {
    const c = i / 255;
    return Math.round(65535 * (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
});

function put(out: Uint16Array, i: number, [r, g, b]: Rgb): void {
    out[4 * i] = light[Math.round(r)]!;
    out[4 * i + 1] = light[Math.round(g)]!;
    out[4 * i + 2] = light[Math.round(b)]!;
    out[4 * i + 3] = 65535;
}

/** Fabric and plastic in their own colours; where the sheet passes through itself, the colour of alarm. */
export function paintMaterials(
    display: DisplayMesh,
    colours: Result["colours"],
    passesThrough: Uint8Array | undefined,
    out: Uint16Array,
): void {
    const parts = [colours.fabric, colours.plasticFront, colours.plasticBack].map(parseColour);
    // Plastic on the back shows through the fabric.
    parts.push(parts[0]!.map((c, k) => 0.66 * c + 0.2 * parts[2]![k]!) as Rgb);
    const alarm = parseColour(colours.alarm);
    for (let i = 0; i < display.count; ++i) {
        let wrong = false;
        if (passesThrough)
            for (let k = display.aroundStart[i]!; k < display.aroundStart[i + 1]!; ++k)
                wrong ||= passesThrough[display.around[k]!] !== 0;
        put(out, i, wrong ? alarm : parts[display.part[i]!]!);
    }
}

/** The field's colour at every display vertex: of triangles the mean over those of the same print around it. */
export function paintField(display: DisplayMesh, field: Field, out: Uint16Array): void {
    const [from, to] = field.range;
    const { values } = field;
    for (let i = 0; i < display.count; ++i) {
        let value = 0;
        if (field.on === "vertex") value = values[display.source[i]!]!;
        else {
            const begin = display.aroundStart[i]!;
            const end = display.aroundStart[i + 1]!;
            for (let k = begin; k < end; ++k) value += values[display.around[k]!]!;
            value /= end - begin;
        }
        put(out, i, colourAt(field.map, (value - from) / (to - from)));
    }
}
