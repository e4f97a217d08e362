import { BufferGeometry, DoubleSide, Group, Mesh, MeshBasicMaterial, type Plane } from "three";

import type { Placing, SheetModel } from "./sheet_model";

const styles = {
    hover: { colour: 0x2fa4ff, solid: 0.45, through: 0.12 },
    chosen: { colour: 0xff2f92, solid: 0.62, through: 0.2 },
};
type Kind = keyof typeof styles;

/** Strips that light up, faintly also through what covers them. Shares the sheet's buffers: costs nothing to change. */
export class Highlights {
    private readonly shown: Record<Kind, number> = { hover: -1, chosen: -1 };
    private readonly materials: Record<Kind, [MeshBasicMaterial, MeshBasicMaterial]>;
    private readonly meshes: Record<Kind, Mesh>;
    private model: SheetModel | undefined;

    constructor(
        private readonly parent: Group,
        private readonly changed: () => void,
    ) {
        const material = (kind: Kind, through: boolean) =>
            new MeshBasicMaterial({
                color: styles[kind].colour,
                opacity: through ? styles[kind].through : styles[kind].solid,
                transparent: true,
                depthTest: !through,
                depthWrite: false,
                side: DoubleSide,
                polygonOffset: true,
                polygonOffsetFactor: -1,
                polygonOffsetUnits: -2,
            });
        const both = (kind: Kind): [MeshBasicMaterial, MeshBasicMaterial] => [material(kind, false), material(kind, true)];
        this.materials = { hover: both("hover"), chosen: both("chosen") };
        const mesh = (kind: Kind) => {
            const made = new Mesh(new BufferGeometry(), this.materials[kind]);
            made.visible = false;
            made.frustumCulled = false;
            this.parent.add(made);
            return made;
        };
        this.meshes = { hover: mesh("hover"), chosen: mesh("chosen") };
    }

    show(model: SheetModel, placing: Placing): void {
        this.model = model;
        const from = model.geometry(placing);
        for (const kind of ["hover", "chosen"] as const) {
            const geometry = new BufferGeometry();
            geometry.setIndex(from.index);
            geometry.setAttribute("position", from.getAttribute("position"));
            this.meshes[kind].geometry = geometry;
            this.light(kind, this.shown[kind], true);
        }
    }

    /** -1 for none. */
    light(kind: Kind, strip: number, force = false): void {
        if (this.shown[kind] === strip && !force) return;
        this.shown[kind] = strip;
        const mesh = this.meshes[kind];
        mesh.geometry.clearGroups();
        for (const { start, count } of this.model?.display.stripRanges[strip] ?? []) {
            mesh.geometry.addGroup(start, count, 0);
            mesh.geometry.addGroup(start, count, 1);
        }
        mesh.visible = mesh.geometry.groups.length > 0;
        this.changed();
    }

    clip(planes: Plane[]): void {
        for (const list of Object.values(this.materials))
            for (const material of list) {
                material.clippingPlanes = planes;
                material.needsUpdate = true;
            }
    }
}
