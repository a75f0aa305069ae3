# SPDX-License-Identifier: BSD-3-Clause
"""What the paper prints: seconds per step by its Tables 2 to 5, sizes by Table 1, and the ranges of
its experiment (M. L. Staten, S. J. Owen, S. M. Shontz, A. G. Salinger, T. S. Coffey, "A Comparison
of Mesh Morphing Methods for 3D Shape Optimization", Proceedings of the 20th International Meshing
Roundtable, 2011). Its curves of quality are drawn only, so they are not here."""

#: Steps from S_0 to S_F.
STEPS = 20

#: As the paper names them, in the order of its tables.
METHODS = ("Smoothing", "Weighted residual", "FEMWARP", "LBWARP", "Simplex-linear",
           "Simplex-natural neighbor")

#: Figures of minimum scaled Jacobian and tables of seconds, by model.
FIGURES = {"bore": 2, "pipe": 4, "canister": 6, "courier": 8}
TABLES = {"bore": 2, "pipe": 3, "canister": 4, "courier": 5}

#: The panels of each figure, and the columns of each table.
PANELS = (("hex", "relative"), ("hex", "absolute"), ("tet", "relative"), ("tet", "absolute"))

STEPPINGS = ("relative", "absolute")

#: Seconds per step, with a direct solver (KLU) on two Intel X5570: by model, for each of METHODS,
#: in the order of PANELS.
SECONDS = {
    "bore": ((0.23, 0.75, 0.68, 1.75), (3.57, 3.65, 7.52, 7.40), (0.30, 0.29, 0.56, 0.58),
             (1.55, 1.36, 1.97, 1.96), (0.33, 0.40, 0.39, 0.36), (0.46, 0.38, 0.94, 0.56)),
    "pipe": ((1.08, 1.19, 2.56, 2.41), (3.39, 3.28, 6.08, 5.93), (0.31, 0.32, 0.55, 0.56),
             (1.53, 1.50, 1.88, 1.85), (0.16, 0.28, 0.31, 0.28), (0.29, 0.35, 0.53, 0.54)),
    "canister": ((5.10, 20.90, 3.88, 4.02), (76.24, 74.86, 46.00, 46.52),
                 (215.48, 216.39, 31.92, 31.81), (265.14, 266.96, 43.35, 44.50),
                 (0.55, 0.83, 0.57, 0.69), (54.25, 52.88, 23.43, 23.48)),
    "courier": ((5.13, 12.27, 37.61, 67.40), (39.70, 39.16, 69.26, 72.76),
                (4.75, 4.89, 14.92, 14.78), (18.55, 18.71, 28.44, 28.49),
                (1.07, 1.50, 1.95, 2.55), (6.69, 7.45, 13.23, 12.67)),
}


def seconds(model, method, kind, stepping):
    """The paper's seconds per step, or None for a method it does not have."""
    if method not in METHODS:
        return None
    return SECONDS[model][METHODS.index(method)][PANELS.index((kind, stepping))]
