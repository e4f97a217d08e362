/** What the program packs numbers into: a run of bytes and, per array, how to read it. */
export interface ArrayInfo {
    /** f16 and unsigned integers, little endian. */
    type: "u8" | "u16" | "u32" | "f16";
    count: number;
    components: number;
    /** First byte. */
    at: number;
    /** With these a number q stands for origin[k] + scale[k] q, k its component. */
    origin?: number[];
    scale?: number[];
}

const word = { u8: Uint8Array, u16: Uint16Array, u32: Uint32Array, f16: Uint16Array };

function halfFloats(): Float32Array {
    const table = new Float32Array(65536);
    for (let bits = 0; bits < 65536; ++bits) {
        const sign = bits & 0x8000 ? -1 : 1;
        const exponent = (bits >> 10) & 0x1f;
        const fraction = bits & 0x3ff;
        if (exponent === 31) table[bits] = fraction ? NaN : sign * Infinity;
        else if (exponent === 0) table[bits] = sign * fraction * 2 ** -24;
        else table[bits] = sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
    }
    return table;
}
let halfTable: Float32Array | undefined;

function bytesOf(base64: string): Uint8Array<ArrayBuffer> {
    const ready = (Uint8Array as unknown as { fromBase64?: (text: string) => Uint8Array<ArrayBuffer> }).fromBase64;
    if (ready) return ready(base64);
    const text = atob(base64);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    return bytes;
}

/** Named arrays in one run of bytes. */
export class PackedArrays {
    private readonly bytes: ArrayBuffer;

    constructor(
        private readonly index: Record<string, ArrayInfo>,
        base64: string,
    ) {
        this.bytes = bytesOf(base64).buffer;
    }

    has(name: string): boolean {
        return name in this.index;
    }

    /** The integers as they are stored. */
    integers(name: string): Uint8Array | Uint16Array | Uint32Array {
        const about = this.index[name];
        if (!about) throw new Error(`this file has no array ${name}`);
        return new word[about.type](this.bytes, about.at, about.count * about.components);
    }

    /** The numbers that they stand for. */
    numbers(name: string): Float32Array {
        const raw = this.integers(name);
        const { type, components, origin, scale } = this.index[name]!;
        const out = new Float32Array(raw.length);
        if (type === "f16") {
            halfTable ??= halfFloats();
            for (let i = 0; i < raw.length; ++i) out[i] = halfTable[raw[i]!]!;
            return out;
        }
        for (let k = 0; k < components; ++k) {
            const from = origin?.[k] ?? 0;
            const step = scale?.[k] ?? 1;
            for (let i = k; i < raw.length; i += components) out[i] = from + step * raw[i]!;
        }
        return out;
    }
}
