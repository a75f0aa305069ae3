// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkExtractMorphBoundary
 * @brief   extracts the outer boundary of a volume mesh as polygons that keep their node ids
 *
 * The output is a vtkPolyData of the faces that belong to one volume cell alone. Any filter that
 * keeps points (vtkTransformFilter, vtkWarpVector, ParaView's Calculator, ...) can move it; a
 * morphing filter takes the result as its displaced boundary.
 *
 * Points are all nodes on these faces, in ascending order of their ids, mid-side and face nodes of
 * quadratic cells included, in the precision of the input. Point arrays of the input are passed,
 * and two are added:
 * - `MorphPointId` (vtkIdType): the node's id in the input;
 * - `RestPosition` (double): its undeformed position X, Y, Z and 1. The morphing filter verifies
 *   the ids against it. It has four components because vtkTransformFilter, as ParaView's Transform
 *   runs it, takes each point array with three for a vector and rotates it.
 *
 * Polygons are wound so that their normals point out of valid cells. A face of a linear cell is one
 * triangle or quad. A face of a quadratic cell becomes linear pieces through all of its nodes: four
 * triangles for a triangle; four quads for a quad with a center node, four triangles and a quad
 * without, two quads where only two opposite edges have a mid-side node. Cell arrays of the cell
 * that owns the face are passed, except for global ids, since a cell may own several faces. The
 * cell array `MorphCellId` (vtkIdType) is added, the owning cell's id in the input.
 *
 * The blocks of composite data are one mesh, see vtkMorphAlgorithm; ids are those of the merged
 * mesh, and the cell array `MorphBlockId` has the flat index of the block.
 *
 * A mesh without any outer face, for instance with every cell twice, gives a warning. Errors, with
 * an empty output: overlapping AMR, no points, no volume cells, cells that a morph does not
 * support. Also arrays shorter than there are points or cells, coordinates that are not finite or
 * above 1e50, and an extent below 1e-50. An execution that is aborted gives an empty output and no
 * message. On several MPI ranks all of them have to execute it: cuts between pieces are no
 * boundary, ids are global, and each rank has its cells' faces. Cost: about 0.4 microseconds a
 * cell.
 *
 * @sa vtkMorphAlgorithm vtkDataSetSurfaceFilter
 */
#ifndef vtkExtractMorphBoundary_h
#define vtkExtractMorphBoundary_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro

#include <vtkPolyDataAlgorithm.h>

#include <memory> // for std::unique_ptr

namespace morph
{
class Monitor;
}

class vtkUnstructuredGrid;

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkExtractMorphBoundary : public vtkPolyDataAlgorithm
{
public:
  static vtkExtractMorphBoundary* New();
  vtkTypeMacro(vtkExtractMorphBoundary, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Threads to search with. 0 means all cores. The result does not depend on it. Default 0, range
   * [0, VTK_INT_MAX].
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, VTK_INT_MAX);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * Which points of the blocks of composite data are one node:
   * vtkMorphAlgorithm::CoincidentPointsType. The same in all filters of a pipeline. Default 0, one
   * node.
   */
  vtkSetClampMacro(CoincidentPoints, int, 0, 2);
  vtkGetMacro(CoincidentPoints, int);
  ///@}

protected:
  vtkExtractMorphBoundary();
  ~vtkExtractMorphBoundary() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkExtractMorphBoundary(const vtkExtractMorphBoundary&) = delete;
  void operator=(const vtkExtractMorphBoundary&) = delete;

  void Extract(vtkUnstructuredGrid* grid, vtkPolyData* output, morph::Monitor& monitor);

  class vtkInternals;
  std::unique_ptr<vtkInternals> Internals;

  int NumberOfThreads = 0;
  int CoincidentPoints = 0;
};

#endif
