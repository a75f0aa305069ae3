// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkExtractMorphBoundary
 * @brief   the outer boundary of a volume mesh, as polygons that remember their nodes
 *
 * The faces of volume cells that belong to one cell alone, as vtkPolyData: made to be moved by any
 * filter that keeps points (vtkTransformFilter, vtkWarpVector, ParaView's Calculator, ...) and
 * given to a morphing filter as its displaced boundary.
 *
 * Points are all nodes on those faces, in ascending order of their ids, mid-side and face nodes of
 * quadratic cells included, in the precision of the input. Point arrays of the input are passed,
 * and added are
 * - `MorphPointId` (vtkIdType): the node's id in the input;
 * - `RestPosition` (double): its position X, Y, Z and 1. The ids are verified against it by the
 *   morphing filter. It has four components because vtkTransformFilter, as ParaView's Transform
 *   runs it, takes each point array with three for a vector and rotates it along.
 *
 * Polygons are wound so that their normals point out of valid cells. Faces of linear cells are one
 * triangle or quad each. Faces of quadratic cells become linear pieces through all of their nodes:
 * four triangles for a triangle; four quads for a quad with a center node, four triangles and a
 * quad without, two quads where only two opposite edges have a mid-side node. Cell arrays of the
 * cell that owns the face are passed (global ids excepted, since a cell may own several faces), and
 * added is `MorphCellId` (vtkIdType), that cell's id in the input.
 *
 * A mesh without any outer face, as where every cell is there twice, gives a warning. Errors, with
 * an empty output: composite data (use Merge Blocks first), no points, no volume cells, cells that
 * a morph does not support, arrays shorter than there are points or cells, coordinates that are not
 * finite or above 1e50, an extent below 1e-50, cells on more than one MPI rank. An execution that
 * is aborted gives an empty output and no message. With several MPI processes an execution is
 * collective. Cost: about 0.4 microseconds a cell.
 *
 * @sa vtkMorphAlgorithm vtkDataSetSurfaceFilter
 */
#ifndef vtkExtractMorphBoundary_h
#define vtkExtractMorphBoundary_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro

#include <vtkPolyDataAlgorithm.h>

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

  int NumberOfThreads = 0;
};

#endif
