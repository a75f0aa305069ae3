# SPDX-License-Identifier: BSD-3-Clause
"""Grids, surfaces and series in time to files that ParaView opens."""

import xml.etree.ElementTree as xml

from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter


def write_grid(data, path, compression=1):
    """Writes a vtkUnstructuredGrid as compressed .vtu or a vtkPolyData as .vtp; `compression` from
    1, fast, to 9. Raises OSError where the file cannot be written."""
    is_surface = isinstance(data, vtkPolyData)
    writer = vtkXMLPolyDataWriter() if is_surface else vtkXMLUnstructuredGridWriter()
    # Appended data, VTK's default, cannot be read back by VTK 9.2 with an expat that defers
    # parsing, as Debian 12's does (https://gitlab.kitware.com/vtk/vtk/-/issues/19258).
    writer.SetDataModeToBinary()
    writer.SetCompressionLevel(compression)
    writer.SetFileName(str(path))
    writer.SetInputData(data)
    if writer.Write() != 1 or writer.GetErrorCode() != 0:
        raise OSError(f"cannot write {path}: VTK error code {writer.GetErrorCode()}")


def write_pvd(path, files, times):
    """A ParaView data file: these files, named relative to it, as one series in time."""
    root = xml.Element("VTKFile", type="Collection", version="1.0")
    collection = xml.SubElement(root, "Collection")
    for file, time in zip(files, times):
        name = str(file.relative_to(path.parent))
        xml.SubElement(collection, "DataSet", timestep=repr(time), file=name)
    xml.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)
