// SPDX-License-Identifier: BSD-3-Clause
// Writes a small grid and its boundary in the formats that morph-mesh reads and VTK writes, each
// in several encodings. The tests break these files.
#ifdef MESHMORPHING_HAS_CGNS
#include "CgnsSamples.h"
#endif

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkExodusIIWriter.h>
#include <vtkExtractMorphBoundary.h>
#include <vtkHexahedron.h>
#include <vtkIdList.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkOBJWriter.h>
#include <vtkPLYWriter.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataWriter.h>
#include <vtkSTLWriter.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <initializer_list>
#include <iostream>
#include <stdexcept>
#include <string>
#include <utility>

namespace
{
constexpr int Nodes = 4; // along each edge of the cube

vtkIdType node(int x, int y, int z)
{
  return x + Nodes * (y + Nodes * z);
}

/// A cube of hexahedra; with `polyhedron` its first cell is stored as one.
vtkSmartPointer<vtkUnstructuredGrid> makeGrid(bool polyhedron)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> heat;
  heat->SetName("Heat");
  for (int i = 0; i < Nodes * Nodes * Nodes; ++i)
  {
    points->InsertNextPoint(i % Nodes, i / Nodes % Nodes, i / (Nodes * Nodes));
    heat->InsertNextValue(0.1 * i);
  }
  grid->SetPoints(points);
  grid->GetPointData()->AddArray(heat);
  vtkNew<vtkIntArray> part;
  part->SetName("Part");
  for (int i = 0; i < (Nodes - 1) * (Nodes - 1) * (Nodes - 1); ++i)
  {
    const int x = i % (Nodes - 1), y = i / (Nodes - 1) % (Nodes - 1),
              z = i / (Nodes - 1) / (Nodes - 1);
    vtkNew<vtkHexahedron> cell;
    vtkIdType corner = 0;
    for (const auto& [dx, dy] :
      { std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1) })
    {
      cell->GetPointIds()->SetId(corner, node(x + dx, y + dy, z));
      cell->GetPointIds()->SetId(corner + 4, node(x + dx, y + dy, z + 1));
      ++corner;
    }
    if (polyhedron && i == 0)
    {
      vtkNew<vtkIdList> faces;
      faces->InsertNextId(6);
      for (int face = 0; face < 6; ++face)
      {
        faces->InsertNextId(4);
        for (int k = 0; k < 4; ++k)
        {
          faces->InsertNextId(cell->GetPointIds()->GetId(vtkHexahedron::GetFaceArray(face)[k]));
        }
      }
      grid->InsertNextCell(VTK_POLYHEDRON, faces);
    }
    else
    {
      grid->InsertNextCell(VTK_HEXAHEDRON, cell->GetPointIds());
    }
    part->InsertNextValue(i);
  }
  grid->GetCellData()->AddArray(part);
  return grid;
}

template <typename Writer>
void write(Writer* writer, vtkDataObject* data, const std::string& path)
{
  writer->SetFileName(path.c_str());
  writer->SetInputDataObject(data);
  if (!writer->Write())
  {
    throw std::runtime_error("Cannot write " + path);
  }
}

/// In all of VTK's encodings but raw appended data, which Debian's VTK cannot read.
template <typename Writer>
void writeXml(vtkDataObject* data, const std::string& stem, const std::string& extension)
{
  const auto one = [&](const std::string& name, auto set)
  {
    vtkNew<Writer> writer;
    set(writer.Get());
    write(writer.Get(), data, stem + "_" + name + extension);
  };
  one("ascii", [](auto* w) { w->SetDataModeToAscii(); });
  one("binary",
    [](auto* w)
    {
      w->SetDataModeToBinary();
      w->SetCompressorTypeToNone();
    });
  one("zlib", [](auto* w) { w->SetDataModeToBinary(); });
  one("lz4",
    [](auto* w)
    {
      w->SetDataModeToBinary();
      w->SetCompressorTypeToLZ4();
    });
  one("lzma64",
    [](auto* w)
    {
      w->SetDataModeToBinary();
      w->SetCompressorTypeToLZMA();
      w->SetHeaderTypeToUInt64();
    });
  one("appended",
    [](auto* w)
    {
      w->SetDataModeToAppended();
      w->EncodeAppendedDataOn();
    });
  one("raw",
    [](auto* w)
    {
      w->SetDataModeToAppended();
      w->EncodeAppendedDataOff();
      w->SetCompressorTypeToNone();
    });
}

template <typename Writer>
void writeLegacy(vtkDataObject* data, const std::string& stem)
{
  for (const int version :
    { Writer::VTK_LEGACY_READER_VERSION_4_2, Writer::VTK_LEGACY_READER_VERSION_5_1 })
  {
    for (const bool binary : { false, true })
    {
      vtkNew<Writer> writer;
      writer->SetFileVersion(version);
      binary ? writer->SetFileTypeToBinary() : writer->SetFileTypeToASCII();
      write(writer.Get(), data,
        stem + (binary ? "_binary" : "_ascii") + std::to_string(version) + ".vtk");
    }
  }
}

void writeSamples(const std::string& folder)
{
  const auto grid = makeGrid(false);
  writeXml<vtkXMLUnstructuredGridWriter>(grid, folder + "/grid", ".vtu");
  writeXml<vtkXMLUnstructuredGridWriter>(makeGrid(true), folder + "/polyhedron", ".vtu");
  writeLegacy<vtkUnstructuredGridWriter>(grid, folder + "/grid");
  write(vtkNew<vtkExodusIIWriter>().Get(), grid, folder + "/grid.exo");

  vtkNew<vtkExtractMorphBoundary> extract;
  extract->SetInputData(grid);
  extract->Update();
  vtkPolyData* boundary = extract->GetOutput();
  writeXml<vtkXMLPolyDataWriter>(boundary, folder + "/boundary", ".vtp");
  writeLegacy<vtkPolyDataWriter>(boundary, folder + "/boundary");
  for (const bool binary : { false, true })
  {
    const std::string name = folder + (binary ? "/boundary_binary" : "/boundary_ascii");
    vtkNew<vtkSTLWriter> stl;
    binary ? stl->SetFileTypeToBinary() : stl->SetFileTypeToASCII();
    write(stl.Get(), boundary, name + ".stl");
    vtkNew<vtkPLYWriter> ply;
    binary ? ply->SetFileTypeToBinary() : ply->SetFileTypeToASCII();
    write(ply.Get(), boundary, name + ".ply");
  }
  write(vtkNew<vtkOBJWriter>().Get(), boundary, folder + "/boundary.obj");
#ifdef MESHMORPHING_HAS_CGNS
  writeCgnsSamples(folder);
#endif
}
}

int main(int argc, char* argv[])
{
  if (argc != 2)
  {
    std::cerr << "Usage: MeshMorphingSampleFiles <folder>\n";
    return 2;
  }
  try
  {
    writeSamples(argv[1]);
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
