// What the program's server answers (src/ruche/studio).
import type { ArrayInfo } from "../data/packed";

export type Value = number | string | boolean | number[];

export interface FieldInfo {
    key: string;
    unit: string;
    kind: "number" | "integer" | "boolean" | "text" | "two_numbers" | "three_numbers" | "choice";
    meaning: string;
    low?: number;
    high?: number;
    names?: string[];
    value: Value;
}

export interface Form {
    version: string;
    folder: string;
    colours: { fabric: string; plasticFront: string; plasticBack: string; alarm: string };
    sections: { name: string; fields: FieldInfo[] }[];
    generators: { name: string; summary: string; options: FieldInfo[] }[];
    cards: { name: string; description: string }[];
    drawings: string[];
    scenes: string[];
    scans: string[];
}

export interface Rule {
    match: string;
    role?: "strip" | "fabric_outline" | "ignore";
    thickness_mm?: number;
    side?: "front" | "back";
}

export type Base = { svg: string } | { generator: string } | { scene: string };

/** What a page has set; the server makes a scene of it. */
export interface SceneRequest {
    base: Base;
    values: Record<string, Value>;
    rules: Rule[];
}

export interface Drawing {
    name: string;
    values: Record<string, Value>;
    rules: Rule[];
    warnings: string[];
    box?: [number, number, number, number];
    fabric?: string;
    strips?: { id: string; side: "front" | "back"; thickness_mm: number; path: string }[];
    marks?: { match: string; kind: "colour" | "layer"; count: number }[];
}

/** The program's own words about what went wrong; `key` is the setting that they are about. */
export interface Trouble {
    message: string;
    key?: string;
    problem?: string;
    advice?: string;
}

export interface Job {
    id: number;
    kind: "preview" | "release" | "comparison";
    owner: string;
    state: "waiting" | "running" | "done" | "failed" | "cancelled";
    folder: string;
    phase: string;
    text: string;
    outcome: string;
    seconds: number;
    share: number;
    left_s: number | null;
    error?: Trouble;
}

export interface Run {
    folder: string;
    written: number;
    page: boolean;
    compared: boolean;
    photographed: boolean;
    summary: {
        status: string;
        stable: boolean;
        message: string;
        triangles: number;
        seconds: number;
        energy_mJ: number;
        box_size_mm: number[];
        strips: number;
        curvature_per_mm: [number, number, number] | null;
        settings: Record<string, Value>;
        warnings: number;
    };
}

export interface Shape {
    job?: number;
    mesh: number;
    iteration: number;
    triangles: number;
    residual_N: number | null;
    history: [number, number][];
    arrays: Record<string, ArrayInfo>;
    bytes: string;
}

/** How two results' shapes lie to each other once the second is turned onto the first. */
export interface Difference {
    rotation: number[];
    translation: number[];
    rms_mm: number;
    largest_mm: number;
}

export class ServerError extends Error {
    constructor(readonly trouble: Trouble) {
        super(trouble.message);
    }
}

async function checked(response: Response): Promise<Response> {
    if (response.ok) return response;
    const body = (await response.json().catch(() => ({}))) as { error?: Trouble };
    throw new ServerError(body.error ?? { message: `the server answered ${response.status}` });
}

async function reach(address: string, options?: RequestInit): Promise<Response> {
    let response: Response;
    try {
        response = await fetch(address, options);
    } catch {
        throw new ServerError({ message: "The program does not answer: it was closed. Start `ruche studio` again; finished results are in the folder." });
    }
    return checked(response);
}

export async function get<T>(address: string): Promise<T> {
    return (await reach(address)).json() as Promise<T>;
}

export async function text(address: string): Promise<string> {
    return (await reach(address)).text();
}

export async function post<T>(address: string, body: unknown): Promise<T> {
    const response = await reach(address, {
        method: "POST",
        headers: { "Content-Type": "application/json" },
        body: JSON.stringify(body),
    });
    return (response.headers.get("Content-Type") ?? "").startsWith("application/json") ? response.json() : (response.text() as Promise<T>);
}

export const fileAddress = (folder: string, name: string) => `/files/${[...folder.split("/"), name].map(encodeURIComponent).join("/")}`;
