import type { Sheet } from "../data/result";

/** Principal stretches of every triangle at these positions, released over printed length: for a film's frames. */
export function principalStretches(sheet: Sheet, positions: Float32Array): { max: Float32Array; min: Float32Array } {
    const max = new Float32Array(sheet.triangleCount);
    const min = new Float32Array(sheet.triangleCount);
    const { triangles, layout } = sheet;
    for (let t = 0; t < sheet.triangleCount; ++t) {
        const [a, b, c] = [triangles[3 * t]!, triangles[3 * t + 1]!, triangles[3 * t + 2]!];
        const px = layout[2 * b]! - layout[2 * a]!;
        const py = layout[2 * b + 1]! - layout[2 * a + 1]!;
        const qx = layout[2 * c]! - layout[2 * a]!;
        const qy = layout[2 * c + 1]! - layout[2 * a + 1]!;
        const area = px * qy - py * qx;
        let xx = 0;
        let yy = 0;
        let xy = 0;
        for (let k = 0; k < 3; ++k) {
            const u = positions[3 * b + k]! - positions[3 * a + k]!;
            const v = positions[3 * c + k]! - positions[3 * a + k]!;
            const x = (qy * u - py * v) / area;
            const y = (px * v - qx * u) / area;
            xx += x * x;
            yy += y * y;
            xy += x * y;
        }
        const mean = 0.5 * (xx + yy);
        const spread = Math.hypot(0.5 * (xx - yy), xy);
        max[t] = Math.sqrt(mean + spread);
        min[t] = Math.sqrt(Math.max(0, mean - spread));
    }
    return { max, min };
}
