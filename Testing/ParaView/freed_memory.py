# SPDX-License-Identifier: BSD-3-Clause
"""The plugin leaves malloc as it is: what ParaView frees goes back to the system.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython freed_memory.py
"""
import ctypes
import os
import unittest
from pathlib import Path

from paraview import simple

simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())
SIZE = 200 << 20


def resident():
    """Bytes of memory that this process holds."""
    pages = Path("/proc/self/statm").read_text(encoding="ascii").split()[1]
    return int(pages) * os.sysconf("SC_PAGE_SIZE")


class FreedMemory(unittest.TestCase):
    def test_large_arrays_leave_the_process(self):
        libc = ctypes.CDLL(None)
        libc.malloc.restype = ctypes.c_void_p
        libc.malloc.argtypes = [ctypes.c_size_t]
        libc.free.argtypes = [ctypes.c_void_p]
        before = resident()
        # The second array keeps the first from lying at the end of the heap.
        first, second = libc.malloc(SIZE), libc.malloc(SIZE)
        ctypes.memset(first, 1, SIZE)
        ctypes.memset(second, 1, SIZE)
        self.assertGreater(resident() - before, 1.9 * SIZE)
        libc.free(first)
        self.assertLess(resident() - before, 1.1 * SIZE)
        libc.free(second)
        self.assertLess(resident() - before, 0.1 * SIZE)


if __name__ == "__main__":
    unittest.main()
