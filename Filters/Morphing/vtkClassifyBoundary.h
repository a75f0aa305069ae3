// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkClassifyBoundary
 * @brief   finds which vertex, curve or surface of the model owns each boundary node of a mesh
 *
 * Morphing in order (vertices, curves, surfaces, volumes) needs the geometric entity that owns each
 * node. This filter finds it on any volume mesh, from the angles between its boundary faces or from
 * ids in arrays of the grid.
 *
 * - Surfaces are patches of boundary faces. Neighbors that turn by no more than FeatureAngle are in
 *   one patch, so that a curved wall is one surface. SurfaceIdArray, or the point arrays
 *   GeometryDimension and GeometryId, take precedence over the angle.
 * - Curves are where surfaces meet, where other than two faces meet, and features that end inside a
 *   surface. They are ordered chains from vertex to vertex, with a parameter in [0, 1] by arc
 *   length, or that of CurveParameter.
 * - Vertices are where curves end or meet, turn by more than CornerAngle, or change the surfaces
 *   beside them. Closed curves without a vertex and closed surfaces without a curve occur.
 *
 * Output port 0 is the input with the point arrays
 * - `GeometryDimension` (signed char): 0 vertex, 1 curve, 2 surface, 3 volume, -1 in no volume
 *   cell;
 * - `GeometryId` (vtkIdType): of that vertex, curve or surface, as given, or counted from 0 in the
 *   order of their lowest node ids; of a volume node, the number of its body;
 * - `CurveParameter` (double): in [0, 1] where the dimension is 1, 0 elsewhere.
 *
 * Port 1 is the boundary as vtkExtractMorphBoundary writes it, with these point arrays and the cell
 * array `GeometryId`, the id of the face's surface. Port 2 holds the vertices and curves as
 * polygonal data, with the cell arrays `GeometryDimension` and `GeometryId`. A mid-side or face
 * node of a quadratic cell belongs to the entity of its edge or face.
 *
 * Output 0 of composite data is composite data of the same structure, see vtkMorphAlgorithm.
 *
 * A mesh without any outer face gives a warning. Errors, with empty outputs: overlapping AMR,
 * no volume cells, cells that a morph does not support, coordinates that are not finite or above
 * 1e50. Also an extent below 1e-50, and arrays of the wrong type or length or that contradict the
 * mesh. An execution that is aborted gives empty outputs and no message. Cost: a pass over the
 * cells, and a sort of the boundary's edges.
 *
 * With several MPI ranks all of them have to execute it. Of a mesh in pieces each rank gathers the
 * boundary, numbered by global ids, and keeps the part of its cells: a curve is where its first
 * node is. MorphPointId and MorphCellId are global ids.
 *
 * M. L. Staten et al., "A Comparison of Mesh Morphing Methods for 3D Shape Optimization", Proc.
 * 20th Int. Meshing Roundtable (2011) 293-311.
 *
 * @sa vtkExtractMorphBoundary vtkMorphAlgorithm vtkFeatureEdges
 */
#ifndef vtkClassifyBoundary_h
#define vtkClassifyBoundary_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro

#include <vtkUnstructuredGridAlgorithm.h>

#include <memory> // for std::unique_ptr

namespace morph
{
class Monitor;
}

class vtkPolyData;

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkClassifyBoundary
  : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkClassifyBoundary* New();
  vtkTypeMacro(vtkClassifyBoundary, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The boundary with its surface ids (port 1), and the vertices and curves (port 2).
   */
  vtkPolyData* GetSurfaces();
  vtkPolyData* GetCurves();
  ///@}

  ///@{
  /**
   * Neighboring boundary faces whose normals turn by more than this lie on different surfaces.
   * Degrees, default 25, range [0, 180].
   */
  virtual void SetFeatureAngle(double value);
  vtkGetMacro(FeatureAngle, double);
  ///@}

  ///@{
  /**
   * A curve that turns by more than this at a node has a vertex there. Degrees, default 45, range
   * [0, 180].
   */
  virtual void SetCornerAngle(double value);
  vtkGetMacro(CornerAngle, double);
  ///@}

  ///@{
  /**
   * Name of a cell array of one component with whole numbers: the surface ids. A boundary face
   * takes the id of the two-dimensional cell on it (Gmsh's physical or geometrical ids, for
   * instance). In a grid without two-dimensional cells it takes the id of the volume cell
   * behind it. Faces without a two-dimensional cell on them are grouped by FeatureAngle. Takes
   * precedence over UseGeometryArrays. Empty or "None": none. Default: none.
   */
  vtkSetStringMacro(SurfaceIdArray);
  vtkGetStringMacro(SurfaceIdArray);
  ///@}

  ///@{
  /**
   * Whether the point arrays GeometryDimension and GeometryId define the entity of each boundary
   * node, and CurveParameter its place on a curve, where the input has them. Default on.
   */
  vtkSetMacro(UseGeometryArrays, bool);
  vtkGetMacro(UseGeometryArrays, bool);
  vtkBooleanMacro(UseGeometryArrays, bool);
  ///@}

  ///@{
  /**
   * Whether FeatureAngle also splits surfaces whose ids are given. Default off.
   */
  vtkSetMacro(FeaturesInside, bool);
  vtkGetMacro(FeaturesInside, bool);
  vtkBooleanMacro(FeaturesInside, bool);
  ///@}

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

  ///@{
  /**
   * The numbers of vertices, curves and surfaces in the last execution. Several connected parts
   * with one given id count separately.
   */
  vtkGetMacro(NumberOfVertices, vtkIdType);
  vtkGetMacro(NumberOfCurves, vtkIdType);
  vtkGetMacro(NumberOfSurfaces, vtkIdType);
  ///@}

  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

protected:
  vtkClassifyBoundary();
  ~vtkClassifyBoundary() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkClassifyBoundary(const vtkClassifyBoundary&) = delete;
  void operator=(const vtkClassifyBoundary&) = delete;

  void Classify(
    vtkUnstructuredGrid* grid, vtkInformationVector* outputVector, morph::Monitor& monitor);
  void Clear(vtkInformationVector* outputVector);

  double FeatureAngle = 25;
  double CornerAngle = 45;
  char* SurfaceIdArray = nullptr;
  bool UseGeometryArrays = true;
  bool FeaturesInside = false;
  class vtkInternals;
  std::unique_ptr<vtkInternals> Internals;

  int NumberOfThreads = 0;
  int CoincidentPoints = 0;
  vtkIdType NumberOfVertices = 0;
  vtkIdType NumberOfCurves = 0;
  vtkIdType NumberOfSurfaces = 0;
};

#endif
