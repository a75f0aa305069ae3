# SPDX-License-Identifier: BSD-3-Clause
"""Exodus II files of the models of solver_models, as text for netCDF's ncgen."""
import re

# Sides of Exodus II, by the corners of VTK's cells.
SIDES = {"hexahedron": ((0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (0, 4, 7, 3), (0, 3, 2, 1),
                        (4, 5, 6, 7)),
         "wedge": ((0, 1, 4, 3), (1, 2, 5, 4), (0, 3, 5, 2), (0, 2, 1), (3, 4, 5)),
         "tetra": ((0, 1, 3), (1, 2, 3), (0, 3, 2), (0, 2, 1))}
TYPES = {"hexahedron": "HEX8", "wedge": "WEDGE", "tetra": "TETRA4"}


def apart(model):
    """Gives each kind of cells nodes of its own, as some programs write each block."""
    kinds = sorted({what for what, _ in model.cells})
    copies = {}
    def own(what, node):
        if what == kinds[0]:
            return node
        if (what, node) not in copies:
            copies[what, node] = len(model.points)
            model.points.append(list(model.points[node]))
            model.numbers.append(max(model.numbers) + 1)
            model.order.append(copies[what, node])
        return copies[what, node]
    model.cells = [(what, [own(what, n) for n in nodes]) for what, nodes in model.cells]
    for faces in (model.wall, model.inlet, model.outlet):
        faces[:] = [(c, side, [own(model.cells[c][0], n) for n in nodes])
                    for c, side, nodes in faces]


def exodus(model, together=False, single=False, names=True,
           nodal=("displ_x", "displ_y", "displ_z")):
    """The text. `together`: coordinates in one variable, as old files have them; `names`: of blocks
    and sets, or none. Nodes and elements have the model's numbers. There are two time steps, and
    three `nodal` variables."""
    rank = {node: i + 1 for i, node in enumerate(model.order)}
    kinds = sorted({what for what, _ in model.cells})
    blocks = [[(c, nodes) for c, (what, nodes) in enumerate(model.cells) if what == kind]
              for kind in kinds]
    element = {c: i + 1 for i, c in enumerate(c for block in blocks for c, _ in block)}
    real = "float" if single else "double"
    faces = (("wall", model.wall), ("inlet", model.inlet), ("outlet", model.outlet))
    dimensions = {"len_string": 33, "num_dim": 3, "num_nodes": len(model.order),
                  "num_elem": len(model.cells), "num_el_blk": len(blocks), "num_side_sets": 3,
                  "num_node_sets": 1, "num_nod_ns1": len(model.wall_nodes), "num_nod_var": 3}
    variables, data = [], []

    def add(declaration, values):
        variables.append(declaration)
        data.append(re.match(r"\w+ (\w+)", declaration)[1] + " = " + values + " ;")

    numbers = lambda values: ", ".join(map(repr, values))
    strings = lambda values: ", ".join(f'"{v}"' for v in values)
    coordinates = [[model.points[n][axis] for n in model.order] for axis in range(3)]
    if together:
        add(f"{real} coord(num_dim, num_nodes) ;", numbers(sum(coordinates, [])))
    else:
        for name, values in zip(("coordx", "coordy", "coordz"), coordinates):
            add(f"{real} {name}(num_nodes) ;", numbers(values))
    add("int node_num_map(num_nodes) ;", numbers([model.numbers[n] for n in model.order]))
    add("int elem_num_map(num_elem) ;", numbers([model.elements[c] for c in element]))
    add("int eb_prop1(num_el_blk) ;", numbers([10 * (i + 1) for i in range(len(blocks))]))
    add("int ss_prop1(num_side_sets) ;", numbers([7, 8, 9]))
    add("int ns_prop1(num_node_sets) ;", "5")
    if names:
        add("char eb_names(num_el_blk, len_string) ;", strings(kinds))
        add("char ss_names(num_side_sets, len_string) ;", strings(name for name, _ in faces))
        add("char ns_names(num_node_sets, len_string) ;", strings(["wall nodes"]))
    for i, (kind, block) in enumerate(zip(kinds, blocks), 1):
        dimensions[f"num_el_in_blk{i}"] = len(block)
        dimensions[f"num_nod_per_el{i}"] = len(block[0][1])
        add(f"int connect{i}(num_el_in_blk{i}, num_nod_per_el{i}) ;\n"
            f"connect{i}:elem_type = \"{TYPES[kind]}\" ;",
            numbers([rank[n] for _, nodes in block for n in nodes]))
    for i, (_, sides) in enumerate(faces, 1):
        dimensions[f"num_side_ss{i}"] = len(sides)
        number = lambda c, nodes: 1 + [set(model.cells[c][1][k] for k in side) == set(nodes)
                                       for side in SIDES[model.cells[c][0]]].index(True)
        add(f"int elem_ss{i}(num_side_ss{i}) ;", numbers([element[c] for c, _, _ in sides]))
        add(f"int side_ss{i}(num_side_ss{i}) ;",
            numbers([number(c, nodes) for c, _, nodes in sides]))
    add("int node_ns1(num_nod_ns1) ;", numbers([rank[n] for n in model.wall_nodes]))
    add("double time_whole(time_step) ;", "0., 0.5")
    # By default displacements, which VTK's readers would add to the coordinates.
    for axis in (1, 2, 3):
        add(f"double vals_nod_var{axis}(time_step, num_nodes) ;",
            numbers([1e-3 * axis + 1e-5 * i for i in range(2 * len(model.order))]))
    add("char name_nod_var(num_nod_var, len_string) ;", strings(nodal))
    return ("netcdf model {\ndimensions:\n" +
            "".join(f"{name} = {length} ;\n" for name, length in dimensions.items()) +
            "time_step = UNLIMITED ;\nvariables:\n" + "\n".join(variables) +
            "\n// global attributes:\n:api_version = 5.14f ;\n:version = 5.14f ;\n"
            ":floating_point_word_size = " + ("4" if single else "8") +
            f" ;\n:file_size = {0 if together else 1} ;\n" + ":title = \"A model\" ;"
            "\ndata:\n" + "\n".join(data) + "\n}\n")
