import type { ReleasedSheet, Result, Sheet } from "../data/result";
import { diverging, sequential, type ColourMap } from "./maps";

/** Something that the sheet can be coloured by. */
export interface Field {
    id: string;
    label: string;
    unit: string;
    /** What it means, for a person. */
    about: string;
    map: ColourMap;
    /** Per triangle, or per vertex of the sheet. */
    on: "triangle" | "vertex";
    values: Float32Array;
    /** Ends of the legend. Values beyond take the end's colour. */
    range: [number, number];
    /** Distinct values with names, instead of a range. */
    categories?: { value: number; label: string }[];
}

interface Definition {
    id: string;
    label: string;
    unit: string;
    about: string;
    map: ColourMap;
    on: "triangle" | "vertex";
    values: (sheet: ReleasedSheet) => Float32Array | undefined;
    /** Where the diverging map is pale. */
    centre?: number;
    categories?: (values: Float32Array) => { value: number; label: string }[];
}

function combined(a: Float32Array, b: Float32Array, rule: (a: number, b: number) => number): Float32Array {
    return Float32Array.from(a, (x, i) => rule(x, b[i]!));
}

const sides = ["bare fabric", "front", "back", "both sides"];

const definitions: Definition[] = [
    {
        id: "scan",
        label: "Distance to the scan",
        unit: "mm",
        about: "How far what was made lies outside the simulated sheet (positive) or inside; grey where the scan has nothing",
        map: diverging,
        centre: 0,
        on: "vertex",
        values: (s) => s.scanDistance,
    },
    {
        id: "thickness",
        label: "Print thickness",
        unit: "mm",
        about: "Printed plastic, both sides together",
        map: sequential,
        on: "triangle",
        values: (s) => combined(s.frontMm, s.backMm, (a, b) => a + b),
        categories: (values) => {
            const found = [...new Set(Array.from(values, (v) => Number(v.toFixed(4))))].sort((a, b) => a - b);
            if (found.length > 6) return [];
            return found.map((value) => ({ value, label: value === 0 ? "bare" : `${value} mm` }));
        },
    },
    {
        id: "side",
        label: "Printed side",
        unit: "",
        about: "On which side of the fabric the plastic is",
        map: sequential,
        on: "triangle",
        values: (s) => combined(s.frontMm, s.backMm, (a, b) => (a > 0 ? 1 : 0) + (b > 0 ? 2 : 0)),
        categories: (values) =>
            sides.map((label, value) => ({ value, label })).filter(({ value }) => values.includes(value)),
    },
    {
        id: "stretch_max",
        label: "Stretch, largest",
        unit: "",
        about: "Largest principal stretch, released over printed length: 1 is as printed",
        map: sequential,
        on: "triangle",
        values: (s) => s.stretchMax,
    },
    {
        id: "stretch_min",
        label: "Stretch, smallest",
        unit: "",
        about: "Smallest principal stretch, released over printed length: below 1 the sheet has contracted",
        map: sequential,
        on: "triangle",
        values: (s) => s.stretchMin,
    },
    {
        id: "curvature_max",
        label: "Curvature, largest",
        unit: "/mm",
        about: "Largest principal curvature; positive where the concave side is the back",
        map: diverging,
        centre: 0,
        on: "vertex",
        values: (s) => s.curvatureMax,
    },
    {
        id: "curvature_min",
        label: "Curvature, smallest",
        unit: "/mm",
        about: "Smallest principal curvature; negative where the concave side is the front",
        map: diverging,
        centre: 0,
        on: "vertex",
        values: (s) => s.curvatureMin,
    },
    {
        id: "mean_curvature",
        label: "Mean curvature",
        unit: "/mm",
        about: "Mean of the two principal curvatures",
        map: diverging,
        centre: 0,
        on: "vertex",
        values: (s) => combined(s.curvatureMax, s.curvatureMin, (a, b) => 0.5 * (a + b)),
    },
    {
        id: "gauss_curvature",
        label: "Gauss curvature",
        unit: "/mm²",
        about: "Product of the principal curvatures: positive like a dome, negative like a saddle, zero like a roll",
        map: diverging,
        centre: 0,
        on: "vertex",
        values: (s) => combined(s.curvatureMax, s.curvatureMin, (a, b) => a * b),
    },
    {
        id: "energy",
        label: "Energy density",
        unit: "mJ/mm²",
        about: "Elastic energy stored per area of the drawing",
        map: sequential,
        on: "triangle",
        values: (s) => s.energyDensity,
    },
];

/** The range that leaves out a hundredth of the values at either end, so that a single spot does not decide. */
export function robustRange(values: Float32Array, centre?: number): [number, number] {
    const step = Math.max(1, Math.floor(values.length / 20000));
    const sample = values.filter((v, i) => i % step === 0 && Number.isFinite(v)).sort();
    if (sample.length === 0) return [0, 1];
    let from = sample[Math.floor(0.01 * (sample.length - 1))]!;
    let to = sample[Math.ceil(0.99 * (sample.length - 1))]!;
    if (centre !== undefined) {
        const reach = Math.max(Math.abs(from - centre), Math.abs(to - centre), 1e-9);
        from = centre - reach;
        to = centre + reach;
    }
    return to - from > 1e-9 * Math.abs(to) ? [from, to] : [from - 0.5e-3, to + 0.5e-3];
}

function evaluate(definition: Definition, sheet: ReleasedSheet): Field | undefined {
    const values = definition.values(sheet);
    if (!values) return undefined;
    const categories = definition.categories?.(values);
    const { id, label, unit, about, map, on } = definition;
    const known = categories && categories.length > 0;
    const range = known
        ? ([categories[0]!.value, Math.max(categories.at(-1)!.value, categories[0]!.value + 1e-6)] as [number, number])
        : robustRange(values, definition.centre);
    return { id, label, unit, about, map, on, values, range, ...(known ? { categories } : {}) };
}

/** What a result can be coloured by, computed when first asked for. */
export class Fields {
    private readonly known = new Map<string, Field>();

    constructor(private readonly result: Result) {}

    list(): { id: string; label: string }[] {
        const { energyDensity, scanDistance } = this.result.sheet;
        const without = [!energyDensity && "energy", !scanDistance && "scan"];
        return definitions.filter(({ id }) => !without.includes(id)).map(({ id, label }) => ({ id, label }));
    }

    /** Undefined for an id that is none of the list's: the sheet then shows its materials. */
    get(id: string): Field | undefined {
        const known = this.known.get(id);
        if (known) return known;
        const definition = definitions.find((d) => d.id === id);
        const field = definition && evaluate(definition, this.result.sheet);
        if (field) this.known.set(id, field);
        return field;
    }
}

/** The field's value where a ray met a triangle of the sheet. */
export function valueAt(field: Field, sheet: Sheet, triangle: number, weights: number[]): number {
    if (field.on === "triangle") return field.values[triangle]!;
    return weights.reduce((sum, w, k) => sum + w * field.values[sheet.triangles[3 * triangle + k]!]!, 0);
}
