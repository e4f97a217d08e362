import type { Sheet } from "../data/result";

/** A run of the index buffer. */
export interface Range {
    start: number;
    count: number;
}

/**
 * What is drawn of a sheet: the fabric, and on it the plastic with its thickness as a cover and walls along its
 * rims. Vertices are the sheet's, once per kind of print around them, so that colours end sharply at rims but are
 * smooth elsewhere. Everything lies in one buffer: one draw call.
 */
export interface DisplayMesh {
    count: number;
    index: Uint32Array;
    /** Per display vertex: the sheet's vertex. */
    source: Uint32Array;
    /** Per display vertex: height above the fabric, mm along its normal; negative on the back. */
    offset: Float32Array;
    /** Per display vertex of a wall: the other end of its rim edge, to turn the normal outwards; else -1. */
    along: Int32Array;
    /** Per display vertex: 0 fabric, 1 front plastic, 2 back plastic, 3 fabric with plastic on its back only. */
    part: Uint8Array;
    /** Triangles of the sheet around each display vertex, as runs of `around`. */
    aroundStart: Uint32Array;
    around: Uint32Array;
    /** Of each strip: its cover, and the fabric below. */
    stripRanges: Range[][];
}

interface Class {
    triangles: number[];
    front: number;
    back: number;
    frontMm: number;
    backMm: number;
}

function classes(sheet: Sheet): Class[] {
    const found = new Map<string, Class>();
    for (let t = 0; t < sheet.triangleCount; ++t) {
        const front = sheet.frontStrip[t]!;
        const back = sheet.backStrip[t]!;
        const frontMm = sheet.frontMm[t]!;
        const backMm = sheet.backMm[t]!;
        const key = `${front} ${back} ${frontMm} ${backMm}`;
        let entry = found.get(key);
        if (!entry) found.set(key, (entry = { triangles: [], front, back, frontMm, backMm }));
        entry.triangles.push(t);
    }
    return [...found.values()].sort((a, b) => a.front - b.front || a.back - b.back);
}

class Builder {
    readonly source: number[] = [];
    readonly offset: number[] = [];
    readonly along: number[] = [];
    readonly part: number[] = [];
    readonly index: number[] = [];
    readonly owners: number[][] = [];

    constructor(private readonly sheet: Sheet) {}

    vertex(source: number, offset: number, part: number, triangle: number, along = -1): number {
        this.source.push(source);
        this.offset.push(offset);
        this.part.push(part);
        this.along.push(along);
        this.owners.push([triangle]);
        return this.source.length - 1;
    }

    /** The triangles with vertices of their own, shared among them. */
    patch(triangles: number[], offset: number, part: number, seen: Map<number, number>): Range {
        const start = this.index.length;
        for (const t of triangles) {
            const corners = [0, 1, 2].map((k) => {
                const v = this.sheet.triangles[3 * t + k]!;
                const known = seen.get(v);
                if (known === undefined) {
                    const made = this.vertex(v, offset, part, t);
                    seen.set(v, made);
                    return made;
                }
                this.owners[known]!.push(t);
                return known;
            });
            if (part === 2) corners.reverse();
            this.index.push(...corners);
        }
        return { start, count: this.index.length - start };
    }

    wall(a: number, b: number, low: number, high: number, part: number, triangle: number): void {
        const corners = [
            this.vertex(a, low, part, triangle, b),
            this.vertex(b, low, part, triangle, -2 - a),
            this.vertex(b, high, part, triangle, -2 - a),
            this.vertex(a, high, part, triangle, b),
        ];
        const order = part === 1 ? [0, 1, 2, 0, 2, 3] : [0, 2, 1, 0, 3, 2];
        this.index.push(...order.map((k) => corners[k]!));
    }
}

/** Walls stand where the print is higher than across the edge; edges between bare triangles do not matter. */
function addWalls(build: Builder, sheet: Sheet, printed: number[]): void {
    const t = sheet.triangles;
    const key = (a: number, b: number) => a * sheet.vertexCount + b;
    const edges = new Map<number, number>();
    for (const i of printed)
        for (let k = 0; k < 3; ++k) edges.set(key(t[3 * i + k]!, t[3 * i + ((k + 1) % 3)]!), i);
    for (const i of printed)
        for (let k = 0; k < 3; ++k) {
            const a = t[3 * i + k]!;
            const b = t[3 * i + ((k + 1) % 3)]!;
            const across = edges.get(key(b, a));
            const frontLow = across === undefined ? 0 : sheet.frontMm[across]!;
            const backLow = across === undefined ? 0 : sheet.backMm[across]!;
            if (sheet.frontMm[i]! > frontLow) build.wall(a, b, frontLow, sheet.frontMm[i]!, 1, i);
            if (sheet.backMm[i]! > backLow) build.wall(a, b, -backLow, -sheet.backMm[i]!, 2, i);
        }
}

export function displayMesh(sheet: Sheet, stripCount: number): DisplayMesh {
    const build = new Builder(sheet);
    const stripRanges: Range[][] = Array.from({ length: stripCount }, () => []);
    const printed: number[] = [];
    for (const group of classes(sheet)) {
        if (group.frontMm > 0 || group.backMm > 0) for (const t of group.triangles) printed.push(t);
        const keep = (range: Range) => {
            for (const strip of new Set([group.front, group.back])) stripRanges[strip]?.push(range);
        };
        const behind = group.backMm > 0 && !(group.frontMm > 0);
        keep(build.patch(group.triangles, 0, behind ? 3 : 0, new Map()));
        if (group.frontMm > 0) keep(build.patch(group.triangles, group.frontMm, 1, new Map()));
        if (group.backMm > 0) keep(build.patch(group.triangles, -group.backMm, 2, new Map()));
    }
    addWalls(build, sheet, printed);

    const aroundStart = new Uint32Array(build.owners.length + 1);
    build.owners.forEach((list, i) => (aroundStart[i + 1] = aroundStart[i]! + list.length));
    const around = new Uint32Array(aroundStart[build.owners.length]!);
    build.owners.forEach((list, i) => around.set(list, aroundStart[i]!));
    return {
        count: build.source.length,
        index: Uint32Array.from(build.index),
        source: Uint32Array.from(build.source),
        offset: Float32Array.from(build.offset),
        along: Int32Array.from(build.along),
        part: Uint8Array.from(build.part),
        aroundStart,
        around,
        stripRanges,
    };
}

/** Unit normals of the sheet's vertices at these positions, towards the front; weighted by area. */
export function sheetNormals(sheet: Sheet, positions: Float32Array): Float32Array {
    const normals = new Float32Array(positions.length);
    const t = sheet.triangles;
    for (let i = 0; i < t.length; i += 3) {
        const a = 3 * t[i]!;
        const b = 3 * t[i + 1]!;
        const c = 3 * t[i + 2]!;
        const ux = positions[b]! - positions[a]!;
        const uy = positions[b + 1]! - positions[a + 1]!;
        const uz = positions[b + 2]! - positions[a + 2]!;
        const vx = positions[c]! - positions[a]!;
        const vy = positions[c + 1]! - positions[a + 1]!;
        const vz = positions[c + 2]! - positions[a + 2]!;
        const x = uy * vz - uz * vy;
        const y = uz * vx - ux * vz;
        const z = ux * vy - uy * vx;
        for (const at of [a, b, c]) {
            normals[at]! += x;
            normals[at + 1]! += y;
            normals[at + 2]! += z;
        }
    }
    for (let i = 0; i < normals.length; i += 3) {
        const length = Math.hypot(normals[i]!, normals[i + 1]!, normals[i + 2]!) || 1;
        normals[i]! /= length;
        normals[i + 1]! /= length;
        normals[i + 2]! /= length;
    }
    return normals;
}

/** The flat drawing as positions in space. */
export function flatPositions(sheet: Sheet): Float32Array {
    const out = new Float32Array(3 * sheet.vertexCount);
    for (let v = 0; v < sheet.vertexCount; ++v) {
        out[3 * v] = sheet.layout[2 * v]!;
        out[3 * v + 1] = sheet.layout[2 * v + 1]!;
    }
    return out;
}

/** Writes positions and normals of the display vertices for a sheet at these positions. */
export function placeDisplay(
    display: DisplayMesh,
    sheet: Sheet,
    positions: Float32Array,
    outPositions: Float32Array,
    outNormals: Float32Array,
): void {
    const normals = sheetNormals(sheet, positions);
    for (let i = 0; i < display.count; ++i) {
        const v = 3 * display.source[i]!;
        const nx = normals[v]!;
        const ny = normals[v + 1]!;
        const nz = normals[v + 2]!;
        const h = display.offset[i]!;
        outPositions[3 * i] = positions[v]! + h * nx;
        outPositions[3 * i + 1] = positions[v + 1]! + h * ny;
        outPositions[3 * i + 2] = positions[v + 2]! + h * nz;
        const along = display.along[i]!;
        if (along === -1) {
            const sign = display.part[i] === 2 ? -1 : 1;
            outNormals[3 * i] = sign * nx;
            outNormals[3 * i + 1] = sign * ny;
            outNormals[3 * i + 2] = sign * nz;
            continue;
        }
        // A wall looks away from its triangle: along the edge (counter-clockwise) times the sheet's normal.
        const forward = along >= 0 ? 1 : -1;
        const w = 3 * (along >= 0 ? along : -2 - along);
        const ex = forward * (positions[w]! - positions[v]!);
        const ey = forward * (positions[w + 1]! - positions[v + 1]!);
        const ez = forward * (positions[w + 2]! - positions[v + 2]!);
        const x = ey * nz - ez * ny;
        const y = ez * nx - ex * nz;
        const z = ex * ny - ey * nx;
        const length = Math.hypot(x, y, z) || 1;
        outNormals[3 * i] = x / length;
        outNormals[3 * i + 1] = y / length;
        outNormals[3 * i + 2] = z / length;
    }
}
