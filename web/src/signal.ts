/** A value that others are told of when it changes. */
export class Signal<T> {
    private readonly listeners: ((value: T) => void)[] = [];

    constructor(private current: T) {}

    get value(): T {
        return this.current;
    }

    set(value: T): void {
        if (Object.is(value, this.current)) return;
        this.current = value;
        for (const listener of this.listeners) listener(value);
    }

    /** Calls the listener with the present value, too. */
    watch(listener: (value: T) => void): void {
        this.listeners.push(listener);
        listener(this.current);
    }
}

/** What the reader of a page has pointed at and chosen; -1 is no strip. */
export interface Attention {
    hovered: Signal<number>;
    chosen: Signal<number>;
}

export function attention(): Attention {
    return { hovered: new Signal(-1), chosen: new Signal(-1) };
}
