# SPDX-License-Identifier: BSD-3-Clause
"""Rows of numbers taken apart into their columns."""

import numpy as np


def columns(rows):
    """(k, n): the columns of `rows`, (n, k), each contiguous.

    With AVX-512 the sines of NumPy 1.24 differ in the last bit from call to call where an array is
    strided. Places and positions must be the same at each call."""
    return np.ascontiguousarray(rows.T)
