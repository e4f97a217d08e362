"""What several of the tests need."""

import os
import subprocess
import sys

import pytest


@pytest.fixture(scope="session")
def german(tmp_path_factory):
    """An environment with decimal commas, from a locale made here: hardly a machine has it installed."""
    place = tmp_path_factory.mktemp("locales")
    subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", place / "de_DE.UTF-8"], check=True)
    environment = {**os.environ, "LOCPATH": str(place), "LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8"}
    comma = "import locale; locale.setlocale(locale.LC_ALL, ''); print(locale.localeconv()['decimal_point'])"
    assert subprocess.check_output([sys.executable, "-c", comma], env=environment, text=True) == ",\n"
    return environment
