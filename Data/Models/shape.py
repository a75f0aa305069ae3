# SPDX-License-Identifier: BSD-3-Clause
"""The numbers a model's geometry is made of, and the way from one set of them to another."""

from dataclasses import astuple, dataclass


@dataclass(frozen=True)
class Shape:
    """Base of a model's parameters: a subclass names them and refuses, with ValueError, those that
    make no such solid. Lengths in the model's unit, angles in degrees."""

    def toward(self, final, t):
        """S_t = S_0 + t (S_F - S_0), each parameter by itself, where self is S_0; `final` itself at
        t = 1. `t` may leave [0, 1] while the solid exists."""
        if t == 1:
            return final
        return type(self)(*(a + t * (b - a) for a, b in zip(astuple(self), astuple(final))))
