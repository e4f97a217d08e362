"""What must be true of the files themselves."""

import os
import re
import subprocess
from pathlib import Path

import pytest

SOURCE = Path(os.environ["RUCHE_SOURCE"])
CODE = {".cpp", ".hpp", ".py"}
MOST_LINES = 450
MOST_BYTES = 1_000_000


def tracked_files():
    try:
        listed = subprocess.run(
            ["git", "-C", str(SOURCE), "ls-files", "-z"], check=True, capture_output=True, text=True
        ).stdout
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("not a git work tree: a released archive has no list of tracked files")
    return [SOURCE / name for name in listed.split("\0") if name and (SOURCE / name).is_file()]


def test_no_code_file_is_too_long_to_be_one_thing():
    long = [
        f"{path.relative_to(SOURCE)}: {lines} lines"
        for path in tracked_files()
        if path.suffix in CODE and (lines := path.read_bytes().count(b"\n")) > MOST_LINES
    ]
    assert long == []


def test_no_file_is_too_big_for_a_repository():
    big = [str(path.relative_to(SOURCE)) for path in tracked_files() if path.stat().st_size > MOST_BYTES]
    assert big == []


def test_every_header_is_included_once():
    headers = [path for path in tracked_files() if path.suffix == ".hpp"]
    assert headers
    assert [str(h) for h in headers if not h.read_text(encoding="utf-8").startswith("#pragma once\n")] == []


def test_every_example_has_a_scene_and_a_story():
    folders = [path for path in sorted((SOURCE / "examples").iterdir()) if path.is_dir()]
    assert len(folders) >= 3
    for folder in folders:
        for name in ("scene.toml", "README.md"):
            assert (folder / name).is_file(), f"{folder.name} has no {name}"


def relative_links(text):
    """Targets of Markdown links and images that are files of the repository."""
    targets = re.findall(r"\]\(([^)\s]+)\)", text)
    return [t.split("#")[0] for t in targets if t.split("#")[0] and not re.match(r"[a-z]+:", t)]


def test_links_between_documents_lead_somewhere():
    broken = [
        f"{path.relative_to(SOURCE)}: {target}"
        for path in tracked_files()
        if path.suffix == ".md"
        for target in relative_links(path.read_text(encoding="utf-8"))
        if not (path.parent / target).exists()
    ]
    assert broken == []


def test_a_broken_link_would_be_seen():
    assert relative_links("see [a](docs/a.md#b), ![p](p.png), [w](https://x.org) and [h](#here)") == [
        "docs/a.md",
        "p.png",
    ]
