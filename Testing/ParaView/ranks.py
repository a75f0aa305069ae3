# SPDX-License-Identifier: BSD-3-Clause
"""Starts ParaView's programs on MPI ranks."""
import os
import shutil
import socket
import subprocess
import time


def environment():
    """That of a process that starts ranks."""
    # This process is an MPI process of its own, and says so in its environment.
    result = {name: value for name, value in os.environ.items()
              if not name.startswith(("OMPI_", "PMIX_", "ORTE_", "OPAL_"))}
    result.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    return result


def command(ranks, program, *arguments):
    return [shutil.which("mpiexec"), "--oversubscribe", "-n", str(ranks), shutil.which(program),
            *arguments]


def run(ranks, script, *arguments, timeout=300):
    """Runs a script by pvbatch; returns what it printed on all ranks."""
    result = subprocess.run(command(ranks, "pvbatch", os.path.abspath(script), *arguments),
                            env=environment(), capture_output=True, text=True, timeout=timeout)
    return result.stdout + result.stderr


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


def start_server(program):
    """Starts pvserver by `program`, a command; returns it and its port once it listens."""
    port = free_port()
    server = subprocess.Popen(program + [f"--server-port={port}"],
                              env=environment(), stdout=subprocess.DEVNULL)
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline and server.poll() is None:
        with socket.socket() as probe:
            # The server ends with its first client, so the probe must not be one: it asks the
            # kernel whether the port is taken.
            try:
                probe.bind(("localhost", port))
            except OSError:
                return server, port
        time.sleep(0.1)
    server.terminate()
    raise RuntimeError("pvserver does not listen")
