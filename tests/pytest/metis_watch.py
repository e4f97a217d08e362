"""When METIS orders in another process: the moments in which it takes signals for itself."""

import re
import signal
import time
from pathlib import Path


def wait_until_metis_orders(pid):
    """METIS catches SIGABRT and SIGTERM meanwhile; nobody else here catches SIGABRT."""
    until = time.monotonic() + 600
    caught = 0
    while not caught >> (signal.SIGABRT - 1) & 1:
        status = Path(f"/proc/{pid}/status").read_text()
        assert not re.search(r"State:\s*Z", status), "the program has ended"
        assert time.monotonic() < until, "METIS does not begin"
        caught = int(re.search(r"SigCgt:\s*(\w+)", status).group(1), 16)
