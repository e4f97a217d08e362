"""A folder of src/ruche includes only itself and the folders above it: data flows one way."""

import os
import re
from pathlib import Path

import pytest

LAYERS = ["core", "geometry", "pattern", "meshing", "material", "energy", "statics", "scene", "output", "study", "studio", "cli"]
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.MULTILINE)
SOURCES = {".hpp", ".cpp"}


def violations(source):
    """Every include under `source`/ruche that breaks the order, as text for a person."""
    found = []
    for path in sorted((source / "ruche").rglob("*")):
        if path.suffix not in SOURCES:
            continue
        place = path.relative_to(source)
        folder = place.parts[1]
        if len(place.parts) < 3 or folder not in LAYERS:
            found.append(f"{place}: not in one of the folders {', '.join(LAYERS)}")
            continue
        for quote, target in INCLUDE.findall(path.read_text(encoding="utf-8")):
            parts = target.split("/")
            if parts[0] != "ruche":
                if quote == '"':
                    found.append(f'{place}: "{target}": our own headers are included as "ruche/folder/file.hpp"')
                continue
            if len(parts) < 3 or parts[1] not in LAYERS:
                found.append(f"{place}: {target} is in no known folder")
            elif LAYERS.index(parts[1]) > LAYERS.index(folder):
                found.append(f"{place}: {folder} must not include {target}: {parts[1]} comes after it")
    return found


def test_source_tree_keeps_the_order_of_folders():
    source = Path(os.environ["RUCHE_SOURCE"]) / "src"
    assert len(list(source.rglob("*.hpp"))) > 10
    assert violations(source) == []


@pytest.mark.parametrize(
    "file, line, complaint",
    [
        ("geometry/a.hpp", '#include "ruche/statics/newton.hpp"', "statics comes after"),
        ("core/a.cpp", '  # include "ruche/geometry/mesh.hpp"', "geometry comes after"),
        ("scene/a.cpp", "#include <ruche/cli/verbs.hpp>", "cli comes after"),
        ("energy/a.hpp", '#include "model.hpp"', "included as"),
        ("energy/a.hpp", '#include "../statics/newton.hpp"', "included as"),
        ("energy/a.hpp", '#include "ruche/utils/misc.hpp"', "no known folder"),
        ("utils/a.hpp", "", "not in one of the folders"),
        ("a.hpp", "", "not in one of the folders"),
    ],
)
def test_an_include_that_points_the_other_way_is_found(tmp_path, file, line, complaint):
    path = tmp_path / "ruche" / file
    path.parent.mkdir(parents=True)
    path.write_text("#pragma once\n" + line + "\n")
    found = violations(tmp_path)
    assert len(found) == 1 and complaint in found[0]


def test_includes_of_the_same_folder_and_of_those_above_are_allowed(tmp_path):
    path = tmp_path / "ruche/statics/a.cpp"
    path.parent.mkdir(parents=True)
    path.write_text('#include "ruche/statics/a.hpp"\n#include "ruche/core/error.hpp"\n#include <vector>\n')
    assert violations(tmp_path) == []
