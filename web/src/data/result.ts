import { PackedArrays, type ArrayInfo } from "./packed";
import type { Report } from "./report";

/** One number stands for "no strip" in the packed strip numbers. */
const noStrip = 0xffff_ffff;

/** A flat mesh of the printed sheet: what is where, seen from the front. */
export interface Sheet {
    vertexCount: number;
    triangleCount: number;
    triangles: Uint32Array;
    /** x, y of each vertex in the drawing, mm. */
    layout: Float32Array;
    /** Per triangle: printed thickness, mm, 0 for none. */
    frontMm: Float32Array;
    backMm: Float32Array;
    /** Per triangle: index into the report's strips, -1 for none. */
    frontStrip: Int32Array;
    backStrip: Int32Array;
}

/** A sheet with its released shape and what was measured on it. */
export interface ReleasedSheet extends Sheet {
    /** x, y, z per vertex, mm. */
    shape: Float32Array;
    /** Per vertex, 1/mm; positive when the concave side is the back. */
    curvatureMax: Float32Array;
    curvatureMin: Float32Array;
    /** Per triangle: principal stretches, released over printed length. */
    stretchMax: Float32Array;
    stretchMin: Float32Array;
    /** Per triangle, mJ per mm² of layout; absent when it was not computed. */
    energyDensity?: Float32Array;
    /** Per vertex: to a scan of what was made, mm; not a number where that has nothing. */
    scanDistance?: Float32Array;
    /** Per triangle: 1 where the sheet passes through itself. */
    passesThrough: Uint8Array;
}

export interface FilmFrame {
    /** How much of the mismatch between fabric and plastic acts, 0 to 1. */
    share: number;
    prestretch: [number, number];
    /** x, y, z per vertex, mm. */
    shape: Float32Array;
}

/** The way from flat to final: equilibria at growing pre-stretch, on a mesh of its own. */
export interface Film {
    sheet: Sheet;
    frames: FilmFrame[];
}

export interface Result {
    title: string;
    details: string;
    alarm: string;
    report: Report;
    /** Turns the shape so that z is up; rows of a 3 x 3 matrix. */
    rotation: number[];
    elevationDeg: number;
    fabricThicknessMm: number;
    colours: Record<"fabric" | "plasticFront" | "plasticBack" | "alarm", string>;
    sheet: ReleasedSheet;
    film?: Film;
    comparison?: ScanComparison;
}

/** What `ruche compare` found; compare.json in docs/file-formats.md. */
export interface ScanComparison {
    scan: string;
    unit: string;
    unit_guessed: boolean;
    skin: string;
    points: number;
    rms_mm: number;
    mean_mm: number;
    percentiles_mm: Record<string, number>;
    covered: number;
    placing: { scale: number };
    warnings: string[];
}

/** The page's own data beside report.json. */
export interface PageData {
    title: string;
    details: string;
    alarm: string;
    rotation: number[];
    elevation_deg: number;
    fabric_thickness_mm: number;
    colours: { fabric: string; plastic_front: string; plastic_back: string; alarm: string };
    arrays: Record<string, ArrayInfo>;
    film?: { frames: { share: number; prestretch: [number, number] }[] };
    comparison?: ScanComparison;
}

function strips(arrays: PackedArrays, name: string): Int32Array {
    const raw = arrays.integers(name);
    const none = raw instanceof Uint8Array ? 0xff : raw instanceof Uint16Array ? 0xffff : noStrip;
    return Int32Array.from(raw, (strip) => (strip === none ? -1 : strip));
}

export function readSheet(arrays: PackedArrays, prefix: string): Sheet {
    const triangles = Uint32Array.from(arrays.integers(prefix + "triangles"));
    const layout = arrays.numbers(prefix + "layout_mm");
    return {
        vertexCount: layout.length / 2,
        triangleCount: triangles.length / 3,
        triangles,
        layout,
        frontMm: arrays.numbers(prefix + "front_mm"),
        backMm: arrays.numbers(prefix + "back_mm"),
        frontStrip: strips(arrays, prefix + "front_strip"),
        backStrip: strips(arrays, prefix + "back_strip"),
    };
}

function readFilm(page: PageData, arrays: PackedArrays): Film | undefined {
    if (!page.film) return undefined;
    const sheet = readSheet(arrays, "film_");
    const all = arrays.numbers("film_frames_mm");
    const frames = page.film.frames.map(({ share, prestretch }, i) => ({
        share,
        prestretch,
        shape: all.subarray(3 * sheet.vertexCount * i, 3 * sheet.vertexCount * (i + 1)),
    }));
    return { sheet, frames };
}

/** A result from what the program wrote: its report, the page's data, and the packed arrays. */
export function readResult(report: Report, page: PageData, base64: string): Result {
    const arrays = new PackedArrays(page.arrays, base64);
    const sheet: ReleasedSheet = {
        ...readSheet(arrays, ""),
        shape: arrays.numbers("shape_mm"),
        curvatureMax: arrays.numbers("curvature_max_per_mm"),
        curvatureMin: arrays.numbers("curvature_min_per_mm"),
        stretchMax: arrays.numbers("stretch_max"),
        stretchMin: arrays.numbers("stretch_min"),
        passesThrough: arrays.integers("self_intersecting") as Uint8Array,
    };
    if (arrays.has("energy_density_mJ_per_mm2"))
        sheet.energyDensity = arrays.numbers("energy_density_mJ_per_mm2");
    if (arrays.has("scan_distance_mm")) sheet.scanDistance = arrays.numbers("scan_distance_mm");
    return {
        title: page.title,
        details: page.details,
        alarm: page.alarm,
        report,
        rotation: page.rotation,
        elevationDeg: page.elevation_deg,
        fabricThicknessMm: page.fabric_thickness_mm,
        colours: {
            fabric: page.colours.fabric,
            plasticFront: page.colours.plastic_front,
            plasticBack: page.colours.plastic_back,
            alarm: page.colours.alarm,
        },
        sheet,
        film: readFilm(page, arrays),
        comparison: page.comparison,
    };
}

/** The result that stands in a document: this one, or one that was fetched. The text of the arrays is dropped. */
export function resultInDocument(from: Document = document): Result {
    const text = (id: string) => {
        const element = from.getElementById(id);
        if (!element) throw new Error(`this page has no data: ${id} is missing`);
        const content = element.textContent ?? "";
        element.remove();
        return content;
    };
    return readResult(JSON.parse(text("ruche-report")), JSON.parse(text("ruche-page")), text("ruche-arrays"));
}
