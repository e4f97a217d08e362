import { BufferAttribute, BufferGeometry, Ray, Vector3 } from "three";
import { MeshBVH } from "three-mesh-bvh";

import type { Sheet } from "../data/result";
import { displayMesh, flatPositions, placeDisplay, type DisplayMesh } from "./display_mesh";

/** Where a ray met the sheet. */
export interface SheetHit {
    triangle: number;
    /** Whether the ray came from the front. */
    fromFront: boolean;
    /** Of the triangle's three corners. */
    weights: [number, number, number];
    /** mm, in the coordinates of the positions that were asked. */
    point: Vector3;
}

export type Placing = "flat" | "shape";

/** Positions of a sheet, drawn and asked for hits. */
class Placed {
    readonly geometry = new BufferGeometry();
    private readonly drawnPositions: BufferAttribute;
    private readonly drawnNormals: BufferAttribute;
    private tree: MeshBVH | undefined;

    constructor(
        private readonly sheet: Sheet,
        private readonly display: DisplayMesh,
        public positions: Float32Array,
        index: BufferAttribute,
        colours: BufferAttribute,
    ) {
        this.drawnPositions = new BufferAttribute(new Float32Array(3 * display.count), 3);
        this.drawnNormals = new BufferAttribute(new Float32Array(3 * display.count), 3);
        this.geometry.setIndex(index);
        this.geometry.setAttribute("position", this.drawnPositions);
        this.geometry.setAttribute("normal", this.drawnNormals);
        this.geometry.setAttribute("color", colours);
        this.place(positions);
    }

    place(positions: Float32Array): void {
        this.positions = positions;
        this.tree = undefined;
        placeDisplay(
            this.display,
            this.sheet,
            positions,
            this.drawnPositions.array as Float32Array,
            this.drawnNormals.array as Float32Array,
        );
        this.drawnPositions.needsUpdate = true;
        this.drawnNormals.needsUpdate = true;
        this.geometry.computeBoundingSphere();
        this.geometry.computeBoundingBox();
    }

    /** The search tree is built when it is first needed: a page that is only read does not pay for it. */
    hit(ray: Ray, visible: (point: Vector3) => boolean): SheetHit | undefined {
        if (!this.tree) {
            const bare = new BufferGeometry();
            bare.setAttribute("position", new BufferAttribute(this.positions, 3));
            bare.setIndex(new BufferAttribute(this.sheet.triangles, 1));
            this.tree = new MeshBVH(bare, { indirect: true });
        }
        const hits = this.tree.raycast(ray, 2).filter((h) => visible(h.point));
        hits.sort((a, b) => a.distance - b.distance);
        const first = hits[0];
        if (!first || first.faceIndex == null) return undefined;
        return {
            triangle: first.faceIndex,
            fromFront: this.normal(first.faceIndex).dot(ray.direction) <= 0,
            weights: this.weights(first.faceIndex, first.point),
            point: first.point.clone(),
        };
    }

    private corner(triangle: number, k: number): Vector3 {
        return new Vector3().fromArray(this.positions, 3 * this.sheet.triangles[3 * triangle + k]!);
    }

    private normal(triangle: number): Vector3 {
        const [a, b, c] = [0, 1, 2].map((k) => this.corner(triangle, k)) as [Vector3, Vector3, Vector3];
        return b.sub(a).cross(c.sub(a));
    }

    private weights(triangle: number, point: Vector3): [number, number, number] {
        const corners = [0, 1, 2].map((k) => this.corner(triangle, k).sub(point));
        const areas = [0, 1, 2].map((k) => corners[(k + 1) % 3]!.clone().cross(corners[(k + 2) % 3]!).length());
        const whole = areas[0]! + areas[1]! + areas[2]! || 1;
        return [areas[0]! / whole, areas[1]! / whole, areas[2]! / whole];
    }
}

/** A sheet as both views show it: the same triangles and colours, once flat and once released. */
export class SheetModel {
    readonly display: DisplayMesh;
    readonly colours: BufferAttribute;
    private readonly placed: Record<Placing, Placed>;

    constructor(
        readonly sheet: Sheet,
        shape: Float32Array,
        stripCount: number,
    ) {
        this.display = displayMesh(sheet, stripCount);
        this.colours = new BufferAttribute(new Uint16Array(4 * this.display.count), 4, true);
        const index = new BufferAttribute(this.display.index, 1);
        const place = (positions: Float32Array) => new Placed(sheet, this.display, positions, index, this.colours);
        this.placed = { flat: place(flatPositions(sheet)), shape: place(shape) };
    }

    geometry(placing: Placing): BufferGeometry {
        return this.placed[placing].geometry;
    }

    setShape(positions: Float32Array): void {
        this.placed.shape.place(positions);
    }

    /** Colours every display vertex anew. */
    paint(painter: (display: DisplayMesh, out: Uint16Array) => void): void {
        painter(this.display, this.colours.array as Uint16Array);
        this.colours.needsUpdate = true;
    }

    hit(placing: Placing, ray: Ray, visible: (point: Vector3) => boolean): SheetHit | undefined {
        return this.placed[placing].hit(ray, visible);
    }

    /** A point of the sheet, given by a triangle and weights, in either placing. */
    point(placing: Placing, at: Pick<SheetHit, "triangle" | "weights">): Vector3 {
        const { positions } = this.placed[placing];
        const out = new Vector3();
        at.weights.forEach((w, k) =>
            out.addScaledVector(new Vector3().fromArray(positions, 3 * this.sheet.triangles[3 * at.triangle + k]!), w),
        );
        return out;
    }

    /** The strip that was hit, -1 for bare fabric: where both sides are printed the one that was looked at. */
    strip({ triangle, fromFront }: Pick<SheetHit, "triangle" | "fromFront">): number {
        const front = this.sheet.frontStrip[triangle]!;
        const back = this.sheet.backStrip[triangle]!;
        const [near, far] = fromFront ? [front, back] : [back, front];
        return near >= 0 ? near : far;
    }
}
