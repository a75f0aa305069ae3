// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSolverFileReader
 * @brief   reads the mesh of a solver's own file, with its numbers and names
 *
 * The formats are those of Documentation/SolverFiles.md; extension and content tell which it is.
 * The output is one grid in the unit of the file. Its points are the nodes of the file in their
 * order, those that no cell uses included, at the file's own coordinates. SetsAsBlocks gives sets
 * and patches as blocks beside the mesh.
 *
 * - Point array `NodeNumber` (vtkIdType, the global ids): the number of each node in the file.
 * - Cell array `ElementNumber` (vtkIdType): the number of each element; -1 for a face that is no
 *   element, but belongs to a surface, a side set or a patch.
 * - For each named set of nodes a point array, and for each named set of elements or faces a cell
 *   array, of its name: 1 (unsigned char) in the set, 0 elsewhere.
 * - Point vectors of their name (`disp_`): the displacements of TimeStep, if an Exodus II or CGNS
 *   file has any. The points are undeformed.
 * - Field data `SurfaceNames`: the names of these sets. Boundary Displacement and Morph Mesh offer
 *   them as surfaces.
 * - Field data `SolverFile`: the path of the file, for vtkSolverFileWriter.
 *
 * Cost: the file is read into memory as a whole; time and memory are linear in its size.
 *
 * Errors (a file that is missing or damaged, what a format's page refuses) are
 * reported with file and line. The output is then empty.
 *
 * @sa vtkSolverFileWriter
 */
#ifndef vtkSolverFileReader_h
#define vtkSolverFileReader_h

#include "vtkMeshMorphingFiltersIOModule.h" // for export macro

#include <vtkUnstructuredGridAlgorithm.h>

class VTKMESHMORPHINGFILTERSIO_EXPORT vtkSolverFileReader : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkSolverFileReader* New();
  vtkTypeMacro(vtkSolverFileReader, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file, or the folder of a case. Default: none.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /**
   * Whether the output is a vtkPartitionedDataSetCollection in place of one grid. Default off. Its
   * first block, "Mesh", has all nodes and elements. A block for each named set has its cells, and
   * a vertex for each other node of it. Points of blocks coincide, and have equal node numbers, so
   * that morph filters move them as one. GetOutput() is null then: take GetOutputDataObject(0).
   */
  vtkSetMacro(SetsAsBlocks, bool);
  vtkGetMacro(SetsAsBlocks, bool);
  vtkBooleanMacro(SetsAsBlocks, bool);
  ///@}

  ///@{
  /**
   * The time step of the displacements, from 0 on; -1, the default: the last. A step that the file
   * does not have is an error.
   */
  vtkSetClampMacro(TimeStep, int, -1, VTK_INT_MAX);
  vtkGetMacro(TimeStep, int);
  ///@}

  /**
   * Whether this class reads the file: 1 or 0. It reads the first bytes.
   */
  static int CanReadFile(const char* name);

  /**
   * The name of the file's format ("Abaqus or CalculiX"); empty where this class does not read it,
   * or was built without the library that the format needs.
   */
  static std::string FormatOf(const char* name);

protected:
  vtkSolverFileReader();
  ~vtkSolverFileReader() override;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkSolverFileReader(const vtkSolverFileReader&) = delete;
  void operator=(const vtkSolverFileReader&) = delete;

  char* FileName = nullptr;
  bool SetsAsBlocks = false;
  int TimeStep = -1;
};

#endif
