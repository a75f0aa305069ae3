# SPDX-License-Identifier: BSD-3-Clause
"""Runs a script by pvbatch on MPI ranks."""
import os
import shutil
import subprocess


def run(ranks, script, *arguments, timeout=300):
    """Returns what the script printed on all ranks."""
    # This process is an MPI process of its own, and says so in its environment.
    environment = {name: value for name, value in os.environ.items()
                   if not name.startswith(("OMPI_", "PMIX_", "ORTE_", "OPAL_"))}
    environment.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    result = subprocess.run(
        [shutil.which("mpiexec"), "--oversubscribe", "-n", str(ranks), shutil.which("pvbatch"),
         os.path.abspath(script), *arguments],
        env=environment, capture_output=True, text=True, timeout=timeout)
    return result.stdout + result.stderr
