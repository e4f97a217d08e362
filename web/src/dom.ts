type Child = Node | string | undefined | false;
type Attributes = Record<string, string | number | boolean | undefined | ((event: never) => void)>;

/** An element: functions become listeners, true an empty attribute, false and undefined none. Text is never markup. */
export function h<K extends keyof HTMLElementTagNameMap>(
    name: K,
    attributes: Attributes = {},
    ...children: Child[]
): HTMLElementTagNameMap[K] {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) {
        if (typeof value === "function") made.addEventListener(key, value as unknown as EventListener);
        else if (value === true) made.setAttribute(key, "");
        else if (value !== false && value !== undefined) made.setAttribute(key, String(value));
    }
    made.append(...children.filter((child): child is Node | string => child !== undefined && child !== false));
    return made;
}

/** A number with about `digits` significant digits and no exponent where that can be read. */
export function number(value: number | null | undefined, digits = 4): string {
    if (value === null || value === undefined || !Number.isFinite(value)) return "–";
    if (value === 0) return "0";
    const size = Math.abs(value);
    if (size >= 1e6 || size < 1e-4) return value.toExponential(Math.min(2, digits - 1)).replace("-", "\u2212");
    return String(Number(value.toPrecision(digits))).replace("-", "\u2212");
}

export function seconds(value: number): string {
    return value < 90 ? `${number(value, 3)} s` : `${number(value / 60, 3)} min`;
}
