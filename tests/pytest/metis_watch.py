"""When METIS orders in another process: the moments in which it takes signals for itself."""

import re
import signal
from pathlib import Path


def wait_until_metis_orders(pid):
    """METIS catches SIGABRT and SIGTERM meanwhile; nobody else here catches SIGABRT."""
    caught = 0
    while not caught >> (signal.SIGABRT - 1) & 1:
        status = Path(f"/proc/{pid}/status").read_text()
        caught = int(re.search(r"SigCgt:\s*(\w+)", status).group(1), 16)
