import {
    AmbientLight,
    Box3,
    Color,
    DirectionalLight,
    DoubleSide,
    Group,
    Matrix4,
    Mesh,
    MeshStandardMaterial,
    OrthographicCamera,
    PerspectiveCamera,
    Plane,
    Raycaster,
    Scene,
    Vector2,
    Vector3,
    WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

import { Highlights } from "./highlights";
import type { Placing, SheetHit, SheetModel } from "./sheet_model";

/** Directions from which the shape is looked at; z is up, the camera of "front" stands at -y. */
export const standardViews = {
    home: undefined,
    front: [0, -1, 0],
    back: [0, 1, 0],
    left: [-1, 0, 0],
    right: [1, 0, 0],
    top: [0, 0, 1],
    bottom: [0, 0, -1],
} as const;
export type StandardView = keyof typeof standardViews;

export interface ViewOptions {
    placing: Placing;
    label: string;
    /** Turns the model so that z is up; rows of a 3 x 3 matrix. */
    rotation?: number[];
    elevationDeg?: number;
}

/** One look at a sheet: the drawing from above, or the shape from all sides. Draws only when something changed. */
export class View {
    readonly canvas = document.createElement("canvas");
    readonly highlights: Highlights;
    private readonly renderer: WebGLRenderer;
    private readonly scene = new Scene();
    private readonly group = new Group();
    private readonly camera: PerspectiveCamera | OrthographicCamera;
    private readonly controls: OrbitControls;
    private readonly material: MeshStandardMaterial;
    private readonly sun = new DirectionalLight(0xffffff, 1);
    private readonly sky = new AmbientLight(0xffffff, 1);
    private readonly flat: boolean;
    private mesh: Mesh | undefined;
    private model: SheetModel | undefined;
    private box = new Box3();
    private asked = false;
    private gone = false;
    private readonly resizing = new ResizeObserver(() => this.resize());
    private readonly drawn: (() => void)[] = [];
    private readonly turned: (() => void)[] = [];

    constructor(
        private readonly host: HTMLElement,
        private readonly options: ViewOptions,
    ) {
        this.flat = options.placing === "flat";
        this.renderer = new WebGLRenderer({ canvas: this.canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
        this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
        this.renderer.localClippingEnabled = true;
        this.canvas.tabIndex = 0;
        this.canvas.setAttribute("role", "img");
        this.canvas.setAttribute("aria-label", options.label);
        host.append(this.canvas);
        this.camera = this.flat ? new OrthographicCamera(-1, 1, 1, -1, -1e5, 1e5) : new PerspectiveCamera(28, 1, 0.1, 1e5);
        this.camera.up.set(0, 0, 1);
        this.material = new MeshStandardMaterial({ vertexColors: true, side: DoubleSide, roughness: 0.78, metalness: 0 });
        this.scene.add(this.group, this.camera, this.sky);
        this.camera.add(this.sun);
        this.sun.position.set(-0.6, 0.9, 1.1);
        this.shade(true);
        if (options.rotation) {
            const [a, b, c, d, e, f, g, h, i] = options.rotation as [number, number, number, number, number, number, number, number, number];
            this.group.quaternion.setFromRotationMatrix(new Matrix4().set(a, b, c, 0, d, e, f, 0, g, h, i, 0, 0, 0, 0, 1));
        }
        this.highlights = new Highlights(this.group, () => this.draw());
        this.controls = this.makeControls();
        this.resizing.observe(host);
        this.resize();
    }

    /** Gives the graphics memory back: a browser draws only so many views at a time. */
    dispose(): void {
        this.resizing.disconnect();
        this.controls.dispose();
        this.mesh?.removeFromParent();
        this.material.dispose();
        this.renderer.dispose();
        this.renderer.forceContextLoss();
        this.gone = true;
        this.canvas.remove();
    }

    /** Looks from where another view does. */
    lookLike(other: View): void {
        this.camera.position.copy(other.camera.position);
        this.controls.target.copy(other.controls.target);
        if (this.camera instanceof PerspectiveCamera && other.camera instanceof PerspectiveCamera) {
            this.camera.near = other.camera.near;
            this.camera.far = other.camera.far;
            this.camera.updateProjectionMatrix();
        }
        this.controls.update();
        this.draw();
    }

    /** Shows a sheet. `keepCamera` where it takes the place of another one of about the same extent. */
    show(model: SheetModel, keepCamera = false): void {
        this.model = model;
        this.mesh?.removeFromParent();
        this.mesh = new Mesh(model.geometry(this.options.placing), this.material);
        this.mesh.frustumCulled = false;
        this.group.add(this.mesh);
        this.highlights.show(model, this.options.placing);
        if (!keepCamera) this.look("home");
        this.draw();
    }

    /** Lit like a thing, or flatly, so that colours are read off as they stand in the legend. */
    shade(likeAThing: boolean): void {
        this.sun.intensity = likeAThing ? 2.1 : 0.9;
        this.sky.intensity = likeAThing ? 1.35 : 2.3;
        this.draw();
    }

    /** Tells when somebody looks from elsewhere. */
    onTurn(listener: () => void): void {
        this.turned.push(listener);
    }

    onDraw(listener: () => void): void {
        this.drawn.push(listener);
    }

    draw(): void {
        if (this.asked) return;
        this.asked = true;
        requestAnimationFrame(() => this.drawNow());
    }

    /** For printing and for measuring: without waiting for the next frame. */
    drawNow(): void {
        this.asked = false;
        if (this.gone) return;
        this.renderer.render(this.scene, this.camera);
        for (const listener of this.drawn) listener();
    }

    get cost(): { calls: number; triangles: number } {
        return { calls: this.renderer.info.render.calls, triangles: this.renderer.info.render.triangles };
    }

    look(name: StandardView): void {
        this.measureBox();
        const middle = this.box.getCenter(new Vector3());
        const radius = Math.max(1e-3, 0.5 * this.box.getSize(new Vector3()).length());
        const elevation = ((this.options.elevationDeg ?? 30) * Math.PI) / 180;
        const given = standardViews[name];
        const direction = this.flat
            ? new Vector3(0, 0, 1)
            : given
              ? new Vector3(...given)
              : new Vector3(0, -Math.cos(elevation), Math.sin(elevation));
        // Straight from above "up" on the screen is +y; a hair's breadth keeps the controls' poles away.
        if (Math.abs(direction.z) > 0.999) direction.set(0, -1e-4, direction.z);
        this.controls.target.copy(middle);
        const distance = this.flat ? radius : this.fittingDistance(direction);
        this.camera.position.copy(middle).addScaledVector(direction.normalize(), distance);
        if (this.camera instanceof PerspectiveCamera) {
            this.camera.near = distance / 100;
            this.camera.far = distance + 50 * radius;
        } else this.camera.zoom = 1;
        this.resize();
        this.controls.update();
        this.draw();
    }

    /** Steps back until all of the sheet is in the picture: a flat sheet is wider than what becomes of it. */
    makeRoom(): void {
        if (this.flat || !this.mesh) return;
        this.group.updateMatrixWorld();
        const arm = this.camera.position.clone().sub(this.controls.target);
        const needed = this.fittingDistance(arm.clone().normalize());
        if (needed <= arm.length()) return;
        this.camera.position.copy(this.controls.target).addScaledVector(arm.normalize(), needed);
        this.controls.update();
        this.draw();
    }

    /** Turns (or, of the drawing, shifts) by steps of the arrow keys. */
    turn(right: number, up: number): void {
        const arm = this.camera.position.clone().sub(this.controls.target);
        if (this.flat) {
            const size = (this.camera as OrthographicCamera).right / this.camera.zoom;
            const step = new Vector3(0.15 * size * right, 0.15 * size * up, 0);
            this.camera.position.add(step);
            this.controls.target.add(step);
        } else {
            arm.applyAxisAngle(new Vector3(0, 0, 1), 0.2 * right);
            const side = new Vector3(-arm.y, arm.x, 0).normalize();
            const tilted = arm.clone().applyAxisAngle(side, -0.2 * up);
            if (Math.hypot(tilted.x, tilted.y) > 0.05 * tilted.length()) arm.copy(tilted);
            this.camera.position.copy(this.controls.target).add(arm);
        }
        this.controls.update();
        this.draw();
    }

    zoom(factor: number): void {
        if (this.camera instanceof OrthographicCamera) {
            this.camera.zoom *= factor;
            this.camera.updateProjectionMatrix();
        } else {
            const arm = this.camera.position.clone().sub(this.controls.target);
            this.camera.position.copy(this.controls.target).addScaledVector(arm, 1 / factor);
        }
        this.controls.update();
        this.draw();
    }

    /** The strip and place under a point of the page, or nothing. */
    pick(clientX: number, clientY: number): SheetHit | undefined {
        if (!this.model || !this.mesh) return undefined;
        const frame = this.canvas.getBoundingClientRect();
        const at = new Vector2(
            (2 * (clientX - frame.left)) / frame.width - 1,
            1 - (2 * (clientY - frame.top)) / frame.height,
        );
        const caster = new Raycaster();
        this.camera.updateMatrixWorld();
        caster.setFromCamera(at, this.camera);
        this.group.updateMatrixWorld();
        const ray = caster.ray.clone().applyMatrix4(this.group.matrixWorld.clone().invert());
        const planes = (this.material.clippingPlanes ?? []) as Plane[];
        const visible = (point: Vector3) =>
            planes.every((plane) => plane.distanceToPoint(point.clone().applyMatrix4(this.group.matrixWorld)) >= 0);
        return this.model.hit(this.options.placing, ray, visible);
    }

    /** Where a point of the model lies on the canvas, CSS pixels. */
    project(point: Vector3): { x: number; y: number } {
        this.camera.updateMatrixWorld();
        const p = point.clone().applyMatrix4(this.group.matrixWorld).project(this.camera);
        return { x: 0.5 * (p.x + 1) * this.host.clientWidth, y: 0.5 * (1 - p.y) * this.host.clientHeight };
    }

    /** Cuts away what lies beyond `share` (0 to 1) of the extent along an axis of the stage. Nothing: whole. */
    cut(axis?: "x" | "y" | "z", share = 0.5): void {
        if (!axis) this.material.clippingPlanes = null;
        else {
            this.measureBox();
            const at = this.box.min[axis] + share * (this.box.max[axis] - this.box.min[axis]);
            // From the front one looks at what is behind the cut; from above, at what is below it.
            const normal = new Vector3();
            normal[axis] = axis === "y" ? 1 : -1;
            this.material.clippingPlanes = [new Plane(normal, -normal[axis] * at)];
        }
        this.highlights.clip(this.material.clippingPlanes ?? []);
        this.material.needsUpdate = true;
        this.draw();
    }

    setBackground(colour?: string): void {
        this.scene.background = colour ? new Color(colour) : null;
        this.draw();
    }

    /** Millimetres of the drawing per CSS pixel. */
    get mmPerPixel(): number {
        if (!(this.camera instanceof OrthographicCamera)) return NaN;
        return (this.camera.right - this.camera.left) / this.camera.zoom / Math.max(1, this.host.clientWidth);
    }

    private makeControls(): OrbitControls {
        const controls = new OrbitControls(this.camera, this.canvas);
        controls.zoomToCursor = true;
        controls.enableDamping = false;
        if (this.flat) {
            controls.enableRotate = false;
            controls.mouseButtons = { LEFT: 2, MIDDLE: 1, RIGHT: 2 };
            controls.touches = { ONE: 1, TWO: 2 };
        }
        controls.addEventListener("change", () => {
            this.draw();
            for (const listener of this.turned) listener();
        });
        return controls;
    }

    private measureBox(): void {
        if (!this.mesh) return;
        this.group.updateMatrixWorld();
        this.box = new Box3();
        const positions = this.mesh.geometry.getAttribute("position");
        const at = new Vector3();
        for (let i = 0; i < positions.count; ++i)
            this.box.expandByPoint(at.fromBufferAttribute(positions, i).applyMatrix4(this.group.matrixWorld));
    }

    /** From where every point is inside the picture. */
    private fittingDistance(direction: Vector3): number {
        const camera = this.camera as PerspectiveCamera;
        const positions = this.mesh!.geometry.getAttribute("position");
        const forward = direction.clone().normalize().negate();
        const right = new Vector3().crossVectors(forward, new Vector3(0, 0, 1)).normalize();
        const up = new Vector3().crossVectors(right, forward);
        const tall = Math.tan((camera.fov * Math.PI) / 360) * 0.9;
        const wide = tall * Math.max(0.2, this.host.clientWidth / Math.max(1, this.host.clientHeight));
        const middle = this.controls.target;
        const at = new Vector3();
        let distance = 1e-3;
        for (let i = 0; i < positions.count; ++i) {
            at.fromBufferAttribute(positions, i).applyMatrix4(this.group.matrixWorld).sub(middle);
            const reach = Math.max(Math.abs(at.dot(right)) / wide, Math.abs(at.dot(up)) / tall);
            distance = Math.max(distance, reach - at.dot(forward));
        }
        return distance;
    }

    private resize(): void {
        const width = Math.max(1, this.host.clientWidth);
        const height = Math.max(1, this.host.clientHeight);
        this.renderer.setSize(width, height, false);
        if (this.camera instanceof PerspectiveCamera) this.camera.aspect = width / height;
        else {
            const size = this.box.getSize(new Vector3());
            const half = 0.56 * Math.max(size.y, (size.x * height) / width, 1e-3);
            Object.assign(this.camera, { top: half, bottom: -half, left: (-half * width) / height, right: (half * width) / height });
        }
        this.camera.updateProjectionMatrix();
        this.draw();
    }
}
