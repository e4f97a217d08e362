#!/usr/bin/python3
"""How long wrong input holds anybody up: processor time of every case of tests/pytest/bad_input_test.py, and of files of
other kinds given to `ruche calibrate` (tests/pytest/calibrate_test.py).

usage: bench/bad_input_times.py [--build build/release]

Prints the slowest five and, to compare with, what the program needs to say its version. Ends with 1 when one takes a
second or more.
"""

import argparse
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WANTED_SECONDS = 1.0


def processor_seconds(command, folder):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, cwd=folder, capture_output=True, timeout=60)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=ROOT / "build/release")
    program = parser.parse_args().build.resolve() / "ruche"
    os.environ |= {"RUCHE_PROGRAM": str(program), "RUCHE_SOURCE": str(ROOT)}
    sys.path.insert(0, str(ROOT / "tests/pytest"))
    from bad_input_test import CASES
    from calibrate_test import OTHER_FILES, campaign_of

    commands = {name: (files, ["simulate", *arguments, "-o", "out"]) for name, (files, arguments, _) in CASES.items()}
    for name in OTHER_FILES:
        for place in ("raw.csv", "campaign.toml"):
            calibrate = ["calibrate", "campaign.toml", "-o", "card.toml"]
            commands[f"{name} as {place}"] = (campaign_of(name, place), calibrate)
    times = {}
    for name, (files, arguments) in commands.items():
        with tempfile.TemporaryDirectory() as folder:
            for path, content in files.items():
                target = Path(folder, path)
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(content if isinstance(content, bytes) else content.encode("utf-8"))
            times[name] = processor_seconds([program, *arguments], folder)
    slowest = sorted(times, key=times.get, reverse=True)
    print(f"{len(times)} wrong inputs, processor seconds; ruche --version: {processor_seconds([program, '--version'], '/'):.3f}")
    for name in slowest[:5]:
        print(f"{times[name]:7.3f}  {name}")
    return 0 if times[slowest[0]] < WANTED_SECONDS else 1


if __name__ == "__main__":
    sys.exit(main())
