/** report.json as docs/file-formats.md describes it: what this page shows of it. */
export interface StripReport {
    id: string;
    curvature_per_mm: number | null;
    radius_mm: number | null;
    fit_rms_mm: number | null;
    stretch: number | null;
    printed_length_mm: number | null;
}

export interface Parameter {
    value: unknown;
    unit: string;
    source: string;
}

export interface AlternativeShape {
    folder: string;
    energy_mJ: number;
    above_lowest: number;
    ordinary: boolean;
    found_from: string[];
}

/** What the solve on one mesh took; residuals before each iteration and at the end. */
export interface Level {
    triangles: number;
    iterations: number;
    factorizations: number;
    residuals_N: (number | null)[];
}

export interface Report {
    status: "converged" | "not_converged" | "interrupted";
    stable: boolean;
    message: string;
    energy_mJ: Record<"total" | "fabric_membrane" | "fabric_bending" | "plastic" | "gravity" | "contact", number>;
    residual_N: number;
    typical_force_N: number;
    mesh: { vertices: number; triangles: number; unknowns: number };
    solver: {
        iterations: number;
        factorizations: number;
        seconds: number;
        levels: Level[];
    };
    health: {
        max_strain_margin: number | null;
        min_area_ratio: number;
        max_dihedral_deg: number;
        max_edge_rotation_deg: number;
        elements_beyond_law: number;
        tangled: boolean;
        self_intersections: number;
        contact_pairs: number;
        smallest_gap_mm: number | null;
    };
    shape: {
        box_size_mm: number[];
        area_mm2: number;
        layout_area_mm2: number;
        printed_area_mm2: number;
    };
    strips: StripReport[];
    alternatives?: { shapes: AlternativeShape[]; starts: number; symmetries: string[]; interrupted: boolean };
    assumptions: string[];
    warnings: string[];
    parameters: Record<string, Record<string, unknown> | unknown[]>;
    seconds: Record<string, number>;
    scene: string;
    version: string;
}
