#!/usr/bin/env python3
"""Attacks `ruche studio` with requests that are nearly right: spoilt bytes, spoilt JSON, broken-off connections.

    tests/fuzz/studio_fuzz.py build/release/ruche --seconds 300 [--seed 1] [--threads 4]
    tests/fuzz/studio_fuzz.py build/release/ruche --seed 1 --only 4711        one request again, with its answer

Request number i of a seed is the same on every machine. It is a failure when the server ends, does not answer a complete
request within a minute, answers with a status of 500 or more (other than 503, "too many"), gives away a file beside its
folder, or does not close in order. Failures are told with their numbers; the exit code is 1 then.
"""

import argparse
import base64
import collections
import errno
import json
import random
import re
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" width="20mm" height="10mm" viewBox="0 0 20 10">
<path id="strip" d="M 4 5 H 16" stroke="#d9480f" stroke-width="1" fill="none"/></svg>"""
SECRET = "what nobody may read"
PATIENCE_S = 60
SCENE = {
    "base": {"svg": "d.svg"},
    "values": {"fabric.margin_mm": 1, "fabric.prestretch": 1.5, "plastic.thickness_mm": 0.7, "output.picture": False, "solver.max_iterations": 5},
    "rules": [{"match": "#d9480f", "thickness_mm": 0.9, "side": "back"}],
    "owner": "fuzz",
    "start": "",
}
POSTS = [
    ("/api/drawing", SCENE, 8),
    ("/api/preview", SCENE, 3),
    ("/api/drawing", {"base": {"generator": "radial"}, "values": {"pattern.options.inner_mm": 12}, "rules": []}, 3),
    ("/api/release", SCENE, 1),
    ("/api/upload", {"name": "f.svg", "text": DRAWING}, 4),
    ("/api/cancel", {"id": 1}, 3),
    ("/api/compare", {"run": "d.out", "made": "p.png", "bytes": base64.b64encode(b"\x89PNG\r\n\x1a\n").decode(), "photo": {"known_length_mm": 50, "known_length_at_px": [1, 2, 300, 4], "seen_along_deg": 90}}, 1),
    ("/api/compare", {"run": "d.out", "made": "s.stl", "bytes": base64.b64encode(b"solid\n" + 12 * b"vertex 1 2 3\n").decode(), "unit": "mm"}, 2),
]
GETS = ["/", "/api/form", "/api/jobs", "/api/runs", "/api/shape?mesh=1", "/api/events", "/files/d.svg", "/files/d.out/report.html",
        "/files/d.out/drawing.svg", "/api/difference?a=d.out&b=d.out"]
ODD_VALUES = [None, True, -1, 0, 1e308, -1e-308, 2**63, "", "x" * 9000, [], {}, [[[]]], "../secret.svg", "link.svg", "up/secret.svg",
              "\u0000", "\U0001f41d", "inf", "nan", ".", "..", "d.svg/", "/etc/passwd", "fabric.prestretch", [1.5, 1.5], "#d9480f"]
ODD_KEYS = ["", "fabric", "fabric.prestretch", "fabric.", ".", "pattern.svg", "pattern", "base", "svg", "scene", "generator", "file", "\u0000", "__proto__", "x" * 3000]
ODD_BYTES = [b"\x00", b"..", b"%2e", b"%00", b"\r\n\r\n", b"-1", b"1e999", b"[" * 3000, b"\xff\xfe", b'"', b"{}", b"9" * 20, b"\\u0000", b"%c0%ae", b"Host: x\r\n"]


def spoilt_bytes(dice, sound):
    data = bytearray(sound)
    for _ in range(dice.randint(1, 6)):
        kind = dice.randrange(5)
        at = dice.randrange(len(data) + 1)
        if kind == 0 and data:
            data[min(at, len(data) - 1)] = dice.randrange(256)
        elif kind == 1:
            del data[at : at + dice.randint(1, 30)]
        elif kind == 2:
            data[at:at] = dice.randbytes(dice.randint(1, 20))
        elif kind == 3:
            data[at:at] = data[at : at + 40] * dice.randint(1, 20)
        else:
            data[at:at] = dice.choice(ODD_BYTES)
    return bytes(data)


def spoilt_value(dice, value, depth=0):
    """The same JSON with one thing in it changed, at any depth."""
    if isinstance(value, (dict, list)) and value and (depth == 0 or dice.random() < 0.8):
        made = dict(value) if isinstance(value, dict) else list(value)
        key = dice.choice(list(made) if isinstance(made, dict) else range(len(made)))
        kind = dice.randrange(8)
        if kind == 0:
            del made[key]
        elif kind == 1 and isinstance(made, dict):
            made[dice.choice(ODD_KEYS)] = made[key]
        else:
            made[key] = spoilt_value(dice, made[key], depth + 1)
        return made
    return dice.choice(ODD_VALUES)


def request(seed, number, port):
    """The bytes of one request."""
    dice = random.Random(f"{seed}/{number}")
    host = f"Host: 127.0.0.1:{port}\r\n"
    kind = dice.random()
    target, letter, _ = dice.choices(POSTS, [weight for _, _, weight in POSTS])[0]
    if kind < 0.2:
        sound = f"GET {dice.choice(GETS)} HTTP/1.1\r\n{host}\r\n".encode()
        return spoilt_bytes(dice, sound) if dice.random() < 0.8 else sound
    if kind < 0.7:  # a letter that can be read, most of it right
        for _ in range(dice.randint(1, 3)):
            letter = spoilt_value(dice, letter)
        body = json.dumps(letter).encode()
    else:
        body = spoilt_bytes(dice, json.dumps(letter).encode())
    head = f"POST {target} HTTP/1.1\r\n{host}Content-Type: application/json\r\nContent-Length: {len(body)}\r\n\r\n".encode()
    return spoilt_bytes(dice, head + body) if dice.random() < 0.15 else head + body


class Server:
    """A studio in a folder of its own, beside secrets."""

    def __init__(self, program, place):
        place = Path(place)
        self.folder = place / "work"
        self.folder.mkdir()
        (place / "secret.svg").write_text(DRAWING.replace("strip", SECRET))
        (place / "secret.toml").write_text(SECRET)
        (self.folder / "d.svg").write_text(DRAWING)
        (self.folder / "link.svg").symlink_to(place / "secret.svg")
        (self.folder / "up").symlink_to(place)
        self.process = subprocess.Popen([program, "studio", self.folder, "--no-browser"], stdout=subprocess.PIPE, text=True)
        self.port = int(re.search(r":(\d+)/", self.process.stdout.readline()).group(1))

    def ask(self, raw, dice):
        """What comes back first: up to 64 kB, or until the server closes."""
        with socket.create_connection(("127.0.0.1", self.port), PATIENCE_S) as connection:
            answer = b""
            try:
                if dice.random() < 0.1:  # in two pieces
                    cut = dice.randrange(len(raw) + 1)
                    connection.sendall(raw[:cut])
                    raw = raw[cut:]
                connection.sendall(raw)
                if dice.random() < 0.05:  # gone before the answer
                    return b""
                if dice.random() < 0.2:  # has nothing more to say; the server may take that for gone
                    connection.shutdown(socket.SHUT_WR)
                while len(answer) < 65536 and b"text/event-stream" not in answer:
                    piece = connection.recv(65536)
                    if not piece:
                        break
                    answer += piece
            except OSError as error:
                if error.errno not in (errno.EPIPE, errno.ECONNRESET, errno.ENOTCONN):  # refused while we still talk
                    raise
            return answer

    def close(self):
        """The exit code, 0 when it ends in order."""
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(600)


class Attack:
    def __init__(self, server, seed, threads):
        self.server, self.seed, self.threads = server, seed, threads
        self.statuses = collections.Counter()
        self.failures = []
        self.slowest = 0.0
        self.lock = threading.Lock()

    def one(self, number):
        begin = time.monotonic()
        failure = None
        answer = b""
        try:
            answer = self.server.ask(request(self.seed, number, self.server.port), random.Random(f"way {self.seed}/{number}"))
        except TimeoutError:
            failure = "no answer"
        except OSError as error:
            failure = str(error)
        status = int(match.group(1)) if (match := re.match(rb"HTTP/1\.1 (\d{3}) ", answer)) else 0
        if status >= 500 and status != 503:
            failure = answer[:2000].decode(errors="replace")
        if SECRET.encode() in answer or b"root:x:" in answer:
            failure = "gave away a file beside the folder"
        with self.lock:
            self.statuses[status] += 1
            self.slowest = max(self.slowest, time.monotonic() - begin)
            if failure:
                self.failures.append(f"request {number}: {failure}")
        return answer

    def run(self, goes_on):
        """`goes_on(number)` says whether there is a request of that number still."""
        def work(first):
            number = first
            while goes_on(number) and self.server.process.poll() is None and len(self.failures) < 20:
                self.one(number)
                number += self.threads

        workers = [threading.Thread(target=work, args=(i,)) for i in range(self.threads)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        code = self.server.process.poll()
        if code is not None:
            self.failures.append(f"the server ended by itself, with {code}")
        elif code := self.server.close():
            self.failures.append(f"the server closed with {code}")

    def summary(self):
        kinds = ", ".join(f"{count} x {status or 'none'}" for status, count in sorted(self.statuses.items()))
        return f"{sum(self.statuses.values())} requests, seed {self.seed}: {kinds}; slowest answer {self.slowest:.2f} s"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--seconds", type=float, default=300)
    parser.add_argument("--count", type=int, help="so many requests instead")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=4)
    parser.add_argument("--only", type=int, help="only the request of this number, shown")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="ruche-fuzz-") as place:
        attack = Attack(Server(arguments.program, place), arguments.seed, arguments.threads)
        if arguments.only is not None:
            print(request(arguments.seed, arguments.only, attack.server.port))
            print(attack.one(arguments.only).decode(errors="replace"))
            attack.run(lambda number: False)
        else:
            until = time.monotonic() + arguments.seconds
            attack.run((lambda number: number < arguments.count) if arguments.count else (lambda number: time.monotonic() < until))
    print(attack.summary())
    for failure in attack.failures:
        print(failure, file=sys.stderr)
    return 1 if attack.failures else 0


if __name__ == "__main__":
    sys.exit(main())
