"""Pictures and films of a result, taken by the program without a display."""

import os
import struct
import subprocess
import zlib

import pytest

PROGRAM = os.environ["RUCHE_PROGRAM"]
DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" width="20mm" height="10mm" viewBox="0 0 20 10">
<path id="strip" d="M 2 5 H 18" stroke="black" stroke-width="1" fill="none"/></svg>"""
SIZE = ["--width-px", "120", "--height-px", "90"]


def ruche(*arguments, cwd):
    without_display = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    return subprocess.run([PROGRAM, *arguments], cwd=cwd, capture_output=True, text=True, timeout=600, env=without_display)


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    folder = tmp_path_factory.mktemp("render")
    (folder / "d.svg").write_text(DRAWING)
    run = ruche("simulate", "d.svg", "-o", "out", "--set", "fabric.margin_mm=1", "--set", "output.picture=false",
                "--set", "output.page=false", cwd=folder)
    assert run.returncode == 0, run.stderr
    return folder


def png_header(path):
    data = path.read_bytes()
    assert data.startswith(b"\x89PNG\r\n\x1a\n")
    width, height, _, colour_type = struct.unpack(">IIBB", data[16:26])
    return width, height, {2: "rgb", 6: "rgba"}[colour_type]


def test_a_picture_lies_in_the_result_unless_told_otherwise(place):
    run = ruche("render", "out", *SIZE, cwd=place)
    assert run.returncode == 0, run.stderr
    assert run.stdout == "out/render.png\n"
    assert png_header(place / "out/render.png") == (120, 90, "rgb")
    assert ruche("render", "out", *SIZE, "--transparent", "-o", "clear.png", cwd=place).returncode == 0
    assert png_header(place / "clear.png") == (120, 90, "rgba")


def test_views_and_colours_make_different_pictures(place):
    pictures = set()
    for options in [], ["--view", "top"], ["--azimuth-deg", "50"], ["--elevation-deg", "70"], ["--colour", "stretch_min"]:
        run = ruche("render", "out", *SIZE, *options, "-o", "v.png", cwd=place)
        assert run.returncode == 0, run.stderr
        pictures.add((place / "v.png").read_bytes())
    assert len(pictures) == 5


@pytest.mark.parametrize("kind", ["turntable", "release"])
def test_films_have_the_frames_that_were_asked_for(place, kind):
    run = ruche("render", "out", *SIZE, f"--{kind}", "--frames", "5", "--seconds", "2", cwd=place)
    assert run.returncode == 0, run.stderr
    data = (place / f"out/{kind}.webp").read_bytes()
    assert data[:4] == b"RIFF" and data[8:12] == b"WEBP"
    assert data.count(b"ANMF") == {"turntable": 5, "release": 6}[kind]


def chunks(data):
    """Kind and contents of a PNG's chunks, their sums checked."""
    at = 8
    while at < len(data):
        size, = struct.unpack(">I", data[at : at + 4])
        body = data[at + 4 : at + 8 + size]
        assert struct.unpack(">I", data[at + 8 + size : at + 12 + size])[0] == zlib.crc32(body)
        yield body[:4], body[4:]
        at += 12 + size


@pytest.mark.parametrize("transparent", [False, True])
def test_a_film_as_animated_png_has_whole_frames_in_order(place, transparent):
    run = ruche("render", "out", *SIZE, "--turntable", "--frames", "4", "--seconds", "2", "-o", "t.png", *["--transparent"] * transparent, cwd=place)
    assert run.returncode == 0, run.stderr
    width, height, kind = png_header(place / "t.png")
    assert (width, height, kind) == (120, 90, "rgba" if transparent else "rgb")
    found = list(chunks((place / "t.png").read_bytes()))
    assert [k for k, _ in found] == [b"IHDR", b"acTL", b"fcTL", b"IDAT"] + 3 * [b"fcTL", b"fdAT"] + [b"IEND"]
    assert found[1][1] == struct.pack(">II", 4, 0)
    ordered = [struct.unpack(">I", data[:4])[0] for k, data in found if k in (b"fcTL", b"fdAT")]
    assert ordered == list(range(7))
    assert all(data[4:] == struct.pack(">IIIIHHBB", 120, 90, 0, 0, 500, 1000, 0, 0) for k, data in found if k == b"fcTL")
    frames = [zlib.decompress(data[4 * (k == b"fdAT") :]) for k, data in found if k in (b"IDAT", b"fdAT")]
    assert {len(f) for f in frames} == {90 * (1 + 120 * (3 + transparent))} and len(set(frames)) == 4


def test_mistakes_are_named(place):
    (place / "empty").mkdir(exist_ok=True)
    for arguments, text in [
        (["empty"], "holds no result"),
        (["out", "--colour", "stretch"], "is none of"),
        (["out", "--turntable", "-o", "x.gif"], "ends neither in .webp nor in .png or .apng"),
        (["out", "-o", "x.webp"], "another ending than .png"),
        (["out", "--view", "below"], "--view"),
    ]:
        run = ruche("render", *arguments, cwd=place)
        assert run.returncode == 2, run.stdout + run.stderr
        assert text in run.stderr
    assert not list(place.glob("x.*"))


def test_a_drawing_that_has_changed_is_noticed(place, tmp_path):
    (tmp_path / "d.svg").write_text(DRAWING)
    assert ruche("simulate", "d.svg", "-o", "out", "--set", "fabric.margin_mm=1", "--set", "output.picture=false",
                 "--set", "output.page=false", cwd=tmp_path).returncode == 0
    (tmp_path / "d.svg").write_text(DRAWING.replace("H 18", "H 12"))
    run = ruche("render", "out", *SIZE, cwd=tmp_path)
    assert run.returncode == 2 and "another mesh" in run.stderr
