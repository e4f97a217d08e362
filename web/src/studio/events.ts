// News from the server. A browser keeps at most six connections to one server open, over all tabs: so one tab listens
// and tells the others.
type Listener = (type: string, data: string) => void;

const types = ["job", "shape", "runs"];
const name = "ruche-studio-events";

function listenToServer(tell: Listener): EventSource {
    const source = new EventSource("/api/events");
    for (const type of types) source.addEventListener(type, (event) => tell(type, (event as MessageEvent<string>).data));
    source.addEventListener("open", () => tell("open", ""));
    source.addEventListener("error", () => tell("closed", ""));
    return source;
}

/** `tell` hears of every event, and of "open" and "closed", whichever tab it is that listens. */
export function listen(tell: Listener): void {
    const channel = new BroadcastChannel(name);
    channel.addEventListener("message", ({ data }: MessageEvent<[string, string]>) => tell(...data));
    // Held until this tab is closed; then the next one in the queue gets it.
    void navigator.locks.request(name, () => {
        listenToServer((type, data) => {
            tell(type, data);
            channel.postMessage([type, data]);
        });
        return new Promise(() => {});
    });
}
