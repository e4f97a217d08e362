"""The studio's server, spoken to directly: what it answers, and what it must refuse."""

import base64
import json
import os
import re
import resource
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "fuzz"))
import studio_fuzz  # noqa: E402
from metis_watch import wait_until_metis_orders  # noqa: E402
from studio_fuzz import DRAWING, SECRET  # noqa: E402

PROGRAM = os.environ["RUCHE_PROGRAM"]
SANITIZED = "RUCHE_SANITIZED" in os.environ


class Studio(studio_fuzz.Server):
    """A running server in a folder of its own, beside a secret that it must not give away."""

    def send(self, raw, timeout=600):
        """The bytes that come back until the server closes."""
        with socket.create_connection(("127.0.0.1", self.port), timeout) as connection:
            try:
                connection.sendall(raw if isinstance(raw, bytes) else raw.encode())
            except (BrokenPipeError, ConnectionResetError):
                pass  # refused while we still talk
            answer = b""
            try:
                while piece := connection.recv(65536):
                    answer += piece
            except ConnectionResetError:
                pass
            return answer

    def request(self, method, target, body=None, **headers):
        """Status and body of one request."""
        payload = body.encode() if isinstance(body, str) else body or b""
        lines = {"Host": f"127.0.0.1:{self.port}"}
        if body is not None:
            lines |= {"Content-Type": "application/json", "Content-Length": str(len(payload))}
        lines |= {key.replace("_", "-"): value for key, value in headers.items()}
        head = f"{method} {target} HTTP/1.1\r\n" + "".join(f"{k}: {v}\r\n" for k, v in lines.items() if v is not None)
        answer = self.send(head.encode() + b"\r\n" + payload)
        top, _, rest = answer.partition(b"\r\n\r\n")
        self.headers = top.decode()
        return int(top.split()[1]) if top else 0, rest

    def get(self, target, **headers):
        return self.request("GET", target, **headers)

    def post(self, target, value, **headers):
        status, body = self.request("POST", target, json.dumps(value), **headers)
        return status, json.loads(body)

    def alive(self):
        return self.process.poll() is None and self.get("/api/jobs")[0] == 200

    def job(self, number):
        return next(job for job in json.loads(self.get("/api/jobs")[1]) if job["id"] == number)

    def moving(self, job, seconds=600):
        """Waits until the job's sheet is meshed and can be seen."""
        until = time.monotonic() + seconds
        while json.loads(self.get("/api/shape?mesh=0")[1]).get("job") != job:
            assert time.monotonic() < until, "the job does not begin"
            time.sleep(0.05)

    def finished(self, job, seconds=600):
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            state = self.job(job)
            if state["state"] not in ("waiting", "running"):
                return state
            time.sleep(0.1)
        raise AssertionError("the job does not end")


@pytest.fixture
def studio(tmp_path):
    made = Studio(PROGRAM, tmp_path)
    yield made
    if made.process.poll() is None:
        assert made.close() == 0


SCENE = {"base": {"svg": "d.svg"}, "values": {"fabric.margin_mm": 1, "output.picture": False}, "rules": []}


def test_page_form_and_drawing_are_served(studio):
    status, page = studio.get("/")
    assert status == 200 and b"<!doctype html>" in page[:200]
    assert "Content-Security-Policy: default-src 'none'" in studio.headers and "nosniff" in studio.headers
    form = json.loads(studio.get("/api/form")[1])
    assert form["drawings"] == ["d.svg"]  # a link is none of the folder's own
    assert {g["name"] for g in form["generators"]} >= {"radial", "strip"}
    status, drawing = studio.post("/api/drawing", SCENE)
    assert status == 200 and drawing["strips"][0]["thickness_mm"] == 0.6
    assert drawing["box"] == pytest.approx([3, 3.5, 17, 6.5], abs=0.02)
    assert drawing["marks"] == [{"match": "#d9480f", "kind": "colour", "count": 1}]


def test_a_rule_and_a_value_change_the_drawing_and_mistakes_name_their_key(studio):
    rules = [{"match": "#d9480f", "thickness_mm": 0.9, "side": "back"}]
    _, drawing = studio.post("/api/drawing", SCENE | {"rules": rules})
    assert (drawing["strips"][0]["thickness_mm"], drawing["strips"][0]["side"]) == (0.9, "back")
    status, answer = studio.post("/api/drawing", SCENE | {"values": {"fabric.prestretch": 4}})
    assert status == 422 and answer["error"]["key"] == "fabric.prestretch"
    assert "[1, 3]" in answer["error"]["message"]
    _, answer = studio.post("/api/drawing", {"base": {"generator": "radial"}, "values": {"pattern.options.inner_mm": "900"}})
    assert answer["error"]["key"] == "pattern.options.inner_mm", answer


def test_a_release_leaves_a_result_that_the_command_line_reads_and_the_other_way(studio):
    status, answer = studio.post("/api/release", SCENE | {"values": SCENE["values"] | {"output.stl": True}})
    assert status == 200
    assert studio.finished(answer["id"])["outcome"] == "converged"
    again = [PROGRAM, "simulate", "d.out/scene.toml", "-o", "by hand", "--start", "d.out", "--quiet"]
    subprocess.run(again, cwd=studio.folder, check=True)
    runs = {run["folder"]: run for run in json.loads(studio.get("/api/runs")[1])}
    assert set(runs) == {"d.out", "by hand"}
    assert runs["d.out"]["summary"]["energy_mJ"] == pytest.approx(runs["by hand"]["summary"]["energy_mJ"])
    status, difference = studio.get("/api/difference?a=d.out&b=by%20hand")
    assert status == 200 and json.loads(difference)["rms_mm"] < 1e-6
    for name in "report.html", "shape.obj", "shape.stl", "shape.glb", "scene.toml", "drawing.svg":
        assert studio.get(f"/files/d.out/{name}")[0] == 200, name
    assert studio.get("/files/d.out/state.ruche")[0] == 404
    _, answer = studio.post("/api/release", SCENE | {"start": "d.out"})
    assert studio.finished(answer["id"])["folder"] == "d-2.out"


def test_a_report_cannot_use_the_server_that_hands_it_out(studio):
    (studio.folder / "evil.out").mkdir()
    (studio.folder / "evil.out/report.json").write_text("{}")
    (studio.folder / "evil.out/report.html").write_text("<script>fetch('/api/jobs')</script>")
    assert studio.get("/files/evil.out/report.html")[0] == 200
    assert "Content-Security-Policy: sandbox allow-scripts" in studio.headers


@pytest.mark.parametrize("path", [
    "../secret.toml", "%2e%2e/secret.toml", "..%2fsecret.toml", "%2e%2e%2fsecret.toml", "..%5csecret.toml",
    "%252e%252e%252fsecret.toml", "d.svg/../../secret.toml", "link.svg", "up/secret.toml", "up/secret.svg",
    "/etc/passwd", "%2fetc%2fpasswd", "./../secret.toml", "....//secret.toml", "secret.toml%00.svg", "d.svg%00",
    "", ".", "..", "%c0%ae%c0%ae/secret.toml",
])
def test_no_path_leads_out_of_the_folder(studio, path):
    status, body = studio.get("/files/" + path)
    assert status in (400, 403, 404), body
    assert SECRET.encode() not in body and b"root:" not in body


@pytest.mark.parametrize("change", [
    {"base": {"svg": "../secret.svg"}}, {"base": {"svg": "link.svg"}}, {"base": {"svg": "up/secret.svg"}},
    {"base": {"scene": "../secret.toml"}}, {"base": {"svg": "/etc/passwd"}}, {"base": {"scene": "/etc/passwd"}},
    {"values": {"pattern.svg": "../secret.svg"}}, {"values": {"fabric.card": "../secret.toml"}},
    {"values": {"fabric.card": "/etc/passwd.toml"}}, {"values": {"pattern.mesh": "../x.ply"}},
    {"base": {"generator": "curves"}, "values": {"pattern.options.file": "../secret.toml"}},
    {"base": {"generator": "traced"}, "values": {"pattern.options.field": "file", "pattern.options.file": "../secret.toml"}},
    {"base": {"generator": "curves"}, "values": {"pattern": {"options": {"file": "../secret.toml"}}}},
    {"base": {"generator": "curves"}, "values": {"pattern.options": {"file": "../secret.toml"}}},
    {"base": {"scene": "outward.toml"}}, {"values": {"pattern": '{svg = "../secret.svg"}'}},
    {"base": {"generator": "curves"}, "values": {'pattern.options."file"': "../secret.toml"}},
])
def test_no_scene_reads_outside_the_folder(studio, change):
    (studio.folder / "outward.toml").write_text('[pattern]\nsvg = "../secret.svg"\n')
    for address in "/api/drawing", "/api/release", "/api/preview":
        status, answer = studio.post(address, SCENE | change)
        if status == 200:  # some options are looked at only when their generator runs
            answer = studio.finished(answer["id"])
            assert answer["state"] == "failed"
        assert status in (200, 403, 422), answer
        assert SECRET not in json.dumps(answer)


def test_start_and_difference_stay_in_the_folder(studio):
    assert studio.post("/api/release", SCENE | {"start": "../elsewhere"})[0] == 403
    assert studio.get("/api/difference?a=../x&b=up")[0] in (403, 422)


def test_a_result_is_compared_with_a_scan_of_itself_and_nothing_outside_is_read(studio):
    _, answer = studio.post("/api/release", SCENE | {"values": SCENE["values"] | {"output.stl": True}})
    assert studio.finished(answer["id"])["outcome"] == "converged"
    scan = (studio.folder / "d.out/shape.stl").read_bytes()
    order = {"run": "d.out", "made": "../my scan.STL", "bytes": base64.b64encode(scan).decode(), "unit": "mm"}
    status, answer = studio.post("/api/compare", order)
    assert status == 200 and answer["made"] == "my-scan.stl"
    assert studio.finished(answer["id"])["outcome"] == "compared"
    assert (studio.folder / "my-scan.stl").read_bytes() == scan
    assert json.loads(studio.get("/files/d.out/compare.json")[1])["rms_mm"] < 0.46
    assert b"scan_distance_mm" in studio.get("/files/d.out/compare.html")[1]
    assert "sandbox" in studio.headers
    assert json.loads(studio.get("/api/runs")[1])[0]["compared"]
    assert json.loads(studio.get("/api/form")[1])["scans"] == ["my-scan.stl"]
    (studio.folder.parent / "secret.obj").write_text("v 0 0 0\n" * 20)
    for wrong in ({"run": ".."}, {"run": "up"}, {"run": "none"}, {"made": "s.txt"}, {"made": "s"}, {"bytes": "?"}, {"bytes": 3}):
        assert studio.post("/api/compare", order | wrong)[0] in (403, 422), wrong
    (studio.folder / "out of here").mkdir()
    for name in "report.json", "state.ruche", "scene.toml":
        (studio.folder / "out of here" / name).write_bytes((studio.folder / "d.out" / name).read_bytes().replace(b"d.svg", b"../secret.svg"))
    assert studio.post("/api/compare", {"run": "out of here", "made": "my-scan.stl"})[0] == 403
    for scan in "../secret.obj", "up/secret.obj", "/etc/passwd", "":
        status, answer = studio.post("/api/compare", {"run": "d.out", "made": scan})
        assert status in (403, 422), scan


def test_uploads_land_in_the_folder_under_a_plain_name(studio):
    for name in "../../evil.svg", "/etc/cron.d/evil.svg", "a/b/evil.svg", "..\\evil.svg", ".svg", "x" * 500 + ".svg", "link.svg":
        status, answer = studio.post("/api/upload", {"name": name, "text": DRAWING})
        assert status == 200 and re.fullmatch(r"[A-Za-z0-9_-]+\.svg", answer["name"]), answer
        assert not (studio.folder / answer["name"]).is_symlink()
    assert SECRET in (studio.folder.parent / "secret.svg").read_text()
    assert studio.post("/api/upload", {"name": "d.svg", "text": DRAWING})[1]["name"] == "d.svg"
    assert studio.post("/api/upload", {"name": "d.svg", "text": DRAWING + " "})[1]["name"] == "d-2.svg"
    assert studio.post("/api/upload", {"name": "x.svg", "text": "no drawing"})[0] == 422


@pytest.mark.parametrize("headers, status", [
    ({"Host": "evil.example"}, 421), ({"Host": "127.0.0.1"}, 421), ({"Host": None}, 421), ({"Host": "evil.example:{port}"}, 421),
    ({"Host": "127.0.0.1:{port}.evil.example"}, 421), ({"Host": "localhost:{port}"}, 200),
    ({"Origin": "http://evil.example"}, 403), ({"Origin": "null"}, 403), ({"Origin": "http://127.0.0.1:1"}, 403),
    ({"Origin": "https://127.0.0.1:{port}"}, 403), ({"Origin": "http://127.0.0.1:{port}"}, 200),
    ({"Sec-Fetch-Site": "cross-site"}, 403), ({"Sec-Fetch-Site": "same-origin"}, 200),
])
@pytest.mark.parametrize("target", ["/", "/api/jobs", "/files/d.svg"])
def test_foreign_hosts_and_origins_are_refused(studio, headers, status, target):
    given = {k.replace("-", "_"): v and v.format(port=studio.port) for k, v in headers.items()}
    assert studio.get(target, **given)[0] == status


def test_two_hosts_are_none(studio):
    line = f"Host: 127.0.0.1:{studio.port}\r\n"
    assert b" 421 " in studio.send(f"GET / HTTP/1.1\r\n{line}Host: evil.example\r\n\r\n")[:40]


def test_what_is_left_of_a_refused_request_is_not_read_as_another(studio):
    own = f"127.0.0.1:{studio.port}"
    inner = json.dumps(SCENE)
    smuggled = f"POST /api/release HTTP/1.1\r\nHost: {own}\r\nContent-Type: application/json\r\nContent-Length: {len(inner)}\r\n\r\n{inner}"
    outer = f"POST /api/release HTTP/1.1\r\nHost: {own}\r\nOrigin: http://evil.example\r\nContent-Type: text/plain\r\nContent-Length: {len(smuggled)}\r\n\r\n"
    answer = studio.send(outer + smuggled)
    assert answer.count(b"HTTP/1.1 ") == 1 and b" 403 " in answer[:40]
    assert json.loads(studio.get("/api/jobs")[1]) == []


def test_only_json_is_posted_and_only_known_methods_understood(studio):
    for kind in "text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x":
        assert studio.request("POST", "/api/cancel", '{"id": 1}', Content_Type=kind)[0] == 415
    for method in "PUT", "DELETE", "OPTIONS", "PATCH":
        assert studio.request(method, "/api/jobs")[0] in (400, 405)
    assert studio.request("HEAD", "/api/jobs")[0] == 200
    assert studio.request("HEAD", "/api/events")[0] == 404


def test_large_uploads_are_refused_whole_in_pieces_and_packed(studio):
    import gzip

    text = json.dumps({"name": "big.svg", "text": "<svg>" + "x" * (25 << 20)})
    assert studio.request("POST", "/api/upload", text)[0] in (0, 413)
    head = f"POST /api/upload HTTP/1.1\r\nHost: 127.0.0.1:{studio.port}\r\nContent-Type: application/json\r\n"
    chunk = "%x\r\n%s\r\n" % (1 << 20, "x" * (1 << 20))
    answer = studio.send(head + "Transfer-Encoding: chunked\r\n\r\n" + 30 * chunk + "0\r\n\r\n")
    assert answer == b"" or b" 413 " in answer[:40]
    packed = gzip.compress(b"x" * (400 << 20), 1)
    assert studio.request("POST", "/api/upload", packed, Content_Encoding="gzip")[0] in (0, 400, 413, 415)
    assert list(studio.folder.glob("big*")) == []
    memory = int(re.search(r"VmHWM:\s+(\d+)", open(f"/proc/{studio.process.pid}/status").read()).group(1))
    assert SANITIZED or memory < 400_000, f"{memory} kB"  # a few copies of 24 MB beside the program
    assert studio.alive()


def test_slow_clients_keep_nobody_waiting(studio):
    slow = []
    for i in range(30):
        connection = socket.create_connection(("127.0.0.1", studio.port))
        head = f"POST /api/upload HTTP/1.1\r\nHost: 127.0.0.1:{studio.port}\r\nContent-Type: application/json\r\nContent-Length: 1000\r\n"
        connection.sendall(b"GET / HT" if i % 2 else (head + "\r\n{").encode())
        slow.append(connection)
    assert studio.get("/api/jobs")[0] == 200
    for connection in slow:  # five seconds of silence are enough
        connection.settimeout(15)
        while connection.recv(4096):
            pass
    assert studio.alive()


def test_answers_come_while_ten_listen_and_a_release_runs(studio):
    release = {"base": {"generator": "radial"}, "values": {"mesh.size_mm": 0.15, "output.picture": False}}
    _, answer = studio.post("/api/release", release)
    listeners = [socket.create_connection(("127.0.0.1", studio.port)) for _ in range(10)]
    for listener in listeners:
        listener.sendall(f"GET /api/events HTTP/1.1\r\nHost: 127.0.0.1:{studio.port}\r\n\r\n".encode())
    times = []
    for _ in range(20):
        begin = time.monotonic()
        for target in "/api/jobs", "/api/runs", "/api/shape?mesh=0":
            assert studio.get(target)[0] == 200
        times.append(time.monotonic() - begin)
        time.sleep(0.1)
    print(f"slowest of 20 rounds of three requests: {max(times):.3f} s")
    assert studio.job(answer["id"])["state"] in ("waiting", "running")
    for listener in listeners:
        listener.settimeout(600)
        heard = b""
        while b"event: job" not in heard:
            heard += listener.recv(65536)
        listener.close()
    studio.post("/api/cancel", {"id": answer["id"]})
    assert studio.finished(answer["id"])["state"] == "cancelled"
    assert studio.alive()


def test_a_stopped_server_keeps_what_is_done_and_how_far_the_rest_got(studio):
    _, first = studio.post("/api/release", SCENE)
    studio.finished(first["id"])
    finished = (studio.folder / "d.out/report.json").read_bytes()
    radial = {"base": {"generator": "radial"}, "values": {"mesh.size_mm": 0.15, "output.picture": False}}
    _, second = studio.post("/api/release", radial)
    studio.moving(second["id"])
    wait_until_metis_orders(studio.process.pid)
    assert studio.close() == 0
    assert (studio.folder / "d.out/report.json").read_bytes() == finished
    assert json.loads((studio.folder / "radial.out/report.json").read_text())["status"] == "interrupted"


def test_a_killed_server_leaves_no_half_result(studio):
    _, first = studio.post("/api/release", SCENE)
    studio.finished(first["id"])
    studio.post("/api/release", SCENE | {"values": {"mesh.size_mm": 0.15}})
    time.sleep(0.7)
    studio.process.kill()
    studio.process.wait()
    for folder in studio.folder.glob("*.out"):
        if (folder / "report.json").exists():
            json.loads((folder / "report.json").read_text())
            assert (folder / "state.ruche").exists()


def test_a_full_disk_loses_nothing_finished_and_is_said(studio):
    _, first = studio.post("/api/release", SCENE)
    studio.finished(first["id"])
    finished = {path: path.read_bytes() for path in (studio.folder / "d.out").iterdir()}
    before = resource.prlimit(studio.process.pid, resource.RLIMIT_FSIZE)
    resource.prlimit(studio.process.pid, resource.RLIMIT_FSIZE, (1000, before[1]))  # bytes that a file may have
    _, second = studio.post("/api/release", SCENE)
    state = studio.finished(second["id"])
    assert state["state"] == "failed" and "d-2.out" in state["error"]["message"], state
    status, answer = studio.post("/api/upload", {"name": "large.svg", "text": DRAWING + " " * 2000})
    assert status >= 400 and "large.svg" in answer["error"]["message"]
    assert {path: path.read_bytes() for path in (studio.folder / "d.out").iterdir()} == finished
    assert [run["folder"] for run in json.loads(studio.get("/api/runs")[1])] == ["d.out"]
    resource.prlimit(studio.process.pid, resource.RLIMIT_FSIZE, before)
    _, third = studio.post("/api/release", SCENE)
    assert studio.finished(third["id"])["outcome"] == "converged"


def test_bad_folders_and_ports_are_said_so(studio, tmp_path):
    run = subprocess.run([PROGRAM, "studio", tmp_path / "none", "--no-browser"], capture_output=True, text=True, timeout=600)
    assert run.returncode == 2 and "is not a folder" in run.stderr
    taken = [PROGRAM, "studio", tmp_path, "--no-browser", "--port", str(studio.port)]
    run = subprocess.run(taken, capture_output=True, text=True, timeout=600)
    assert run.returncode == 1 and "in use" in run.stderr


def test_fuzzed_requests_do_not_bring_it_down(tmp_path):
    """A few seconds of tests/fuzz/studio_fuzz.py, always the same requests; run it by itself for minutes."""
    attack = studio_fuzz.Attack(studio_fuzz.Server(PROGRAM, tmp_path), seed=20261126, threads=3)
    attack.run(lambda number: number < 1500)
    print(attack.summary())
    assert attack.failures == []
    assert sum(attack.statuses.values()) == 1500
    assert attack.statuses[200] > 100 and attack.statuses[422] > 100, attack.summary()  # both sides of the fence
