// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkMorphBoundary
 * @brief   moves a mesh's boundary from its vertices or curves: curves first, then surfaces
 *
 * The filter completes the motion of a boundary that is known at a model's vertices and curves
 * alone. It follows the paper's order: vertices as given, then curves, then surfaces, each with the
 * nodes of lower dimension fixed. Its output is the displaced boundary that a morph filter takes on
 * its port 1, which then moves the volume.
 *
 * - Curves: nodes keep their parameter between the given ones. On a straight curve displacements
 *   are linear in the arc length. A curved one follows the affine map nearest to the motion around
 *   it, so affine motions are reproduced exactly.
 * - Surfaces: by weighted residual, the paper's equations (3) to (6) with NumberOfNeighbors nearest
 *   nodes; by Laplacian smoothing of the displacements; or by the same and smoothing of the surface
 *   mesh itself.
 * - Closed curves and surfaces on which nothing is given follow their surroundings, or stay.
 * - With a target surface on port 2, curve nodes go to the nearest place on its feature edges.
 *   Surface nodes, after their surface has followed, go to the nearest place on it whose normal
 *   fits; if one surface of the target holds most of their surface's curve nodes, on that surface.
 *   Given nodes and vertices keep their positions. Where faces fold, nodes are spread out on the
 *   target. Where this does not help, they keep their unprojected position, and a warning names
 *   them.
 *
 * Port 0 takes the undeformed mesh (vtkUnstructuredGrid, or composite data, see
 * vtkMorphAlgorithm). Its geometry is found as
 * vtkClassifyBoundary finds it; the output of that filter is accepted too. Port 1 takes the moved
 * nodes (vtkPointSet), matched to the mesh as vtkMorphAlgorithm matches a boundary. Nodes on
 * geometry of a dimension up to PrescribedDimension are given; the others are ignored. Vertices
 * that port 1 does not name are held. Port 2, optional, takes the target (vtkPolyData, an STL file
 * for instance).
 *
 * The output is the boundary as vtkExtractMorphBoundary writes it, at its moved points, with the
 * arrays of vtkClassifyBoundary, the point vectors `MorphDisplacement`, and the cell array
 * `ScaledJacobian` (active scalars). This is the quality of the face, signed by its surface's
 * normal, which follows the motion: 1 is the ideal triangle or quad, and a face at or below 0 is
 * folded. (A face of a quadratic cell is measured by its corners, and all its polygons have its
 * value.) Field data: MinScaledJacobian, MeanScaledJacobian, FoldedFaces, ProjectedPoints,
 * UnprojectedPoints, SmoothedSurfaces, KeptSurfaces. No motion gives the undeformed positions bit
 * for bit.
 *
 * Time: the output has the time steps of port 1. Port 0 is always asked for RestTime. If one reader
 * feeds both ports, it is updated from within RequestData, for the reason that vtkMorphAlgorithm
 * gives.
 *
 * Errors: those of vtkClassifyBoundary and of vtkMorphAlgorithm's ports, the target's included;
 * port 1 names no node of a dimension up to PrescribedDimension; a target without polygons. The
 * output is then empty: a morph would take an unchanged boundary for a motion of zero.
 * MinScaledJacobian and FoldedFaces are then -1. An execution that is aborted gives the same, and
 * no message. Cost: for each surface node a search for the nearest curve nodes, and a few searches
 * in the target.
 *
 * With several MPI ranks all of them have to execute it. Of a mesh in pieces each rank gathers the
 * whole boundary, what is given of it, and the target, and keeps the part of its cells.
 *
 * M. L. Staten, S. J. Owen, S. M. Shontz, A. G. Salinger, T. S. Coffey, "A Comparison of Mesh
 * Morphing Methods for 3D Shape Optimization", Proc. 20th Int. Meshing Roundtable (2011) 293-311.
 *
 * @sa vtkClassifyBoundary vtkExtractMorphBoundary vtkMorphAlgorithm
 */
#ifndef vtkMorphBoundary_h
#define vtkMorphBoundary_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro

#include <vtkPolyDataAlgorithm.h>

#include <memory> // for std::unique_ptr

class vtkDataObject;
class vtkUnstructuredGrid;

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkMorphBoundary : public vtkPolyDataAlgorithm
{
public:
  static vtkMorphBoundary* New();
  vtkTypeMacro(vtkMorphBoundary, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The moved nodes (port 1) and the target surface (port 2): the same as SetInputConnection() and
   * SetInputData() on those ports. A null target removes it.
   */
  void SetBoundaryConnection(vtkAlgorithmOutput* output);
  void SetBoundaryData(vtkDataObject* boundary);
  void SetTargetConnection(vtkAlgorithmOutput* output);
  void SetTargetData(vtkDataObject* target);
  ///@}

  ///@{
  /**
   * The highest dimension of geometry on which the nodes of port 1 are given: 0 vertices, 1 also
   * curves, 2 also surfaces. Default 1.
   */
  vtkSetClampMacro(PrescribedDimension, int, 0, 2);
  vtkGetMacro(PrescribedDimension, int);
  ///@}

  enum SurfaceMethods
  {
    SURFACE_METHOD_WEIGHTED_RESIDUAL = 0,
    SURFACE_METHOD_SMOOTHING = 1,
    SURFACE_METHOD_MESH_SMOOTHING = 2
  };
  ///@{
  /**
   * How surfaces follow. SURFACE_METHOD_SMOOTHING also improves faces that become poor (scaled
   * Jacobian below 0.2, and below half of the undeformed value) by moving nodes along the surface.
   * SURFACE_METHOD_MESH_SMOOTHING does the same. Then it smooths the surface's mesh towards its
   * undeformed faces, which also opens folds, and keeps the better mesh of both. Default
   * SURFACE_METHOD_WEIGHTED_RESIDUAL.
   */
  vtkSetClampMacro(
    SurfaceMethod, int, SURFACE_METHOD_WEIGHTED_RESIDUAL, SURFACE_METHOD_MESH_SMOOTHING);
  vtkGetMacro(SurfaceMethod, int);
  void SetSurfaceMethodToWeightedResidual()
  {
    this->SetSurfaceMethod(SURFACE_METHOD_WEIGHTED_RESIDUAL);
  }
  void SetSurfaceMethodToSmoothing() { this->SetSurfaceMethod(SURFACE_METHOD_SMOOTHING); }
  void SetSurfaceMethodToMeshSmoothing() { this->SetSurfaceMethod(SURFACE_METHOD_MESH_SMOOTHING); }
  ///@}

  ///@{
  /**
   * The number of nearest fixed nodes of its surface from which a node's residual is weighted.
   * Default 20, range [1, VTK_INT_MAX].
   */
  vtkSetClampMacro(NumberOfNeighbors, int, 1, VTK_INT_MAX);
  vtkGetMacro(NumberOfNeighbors, int);
  ///@}

  enum UnattachedMotions
  {
    UNATTACHED_AFFINELY = 0,
    UNATTACHED_RIGIDLY = 1,
    UNATTACHED_STAY = 2
  };
  ///@{
  /**
   * What closed curves without a vertex, and closed surfaces without a curve, do if none of their
   * nodes is given. They follow the affine map nearest to the motion around them, or the rigid one,
   * which keeps a round hole round, or stay. Default UNATTACHED_AFFINELY.
   */
  vtkSetClampMacro(UnattachedMotion, int, UNATTACHED_AFFINELY, UNATTACHED_STAY);
  vtkGetMacro(UnattachedMotion, int);
  void SetUnattachedMotionToFollowAffinely() { this->SetUnattachedMotion(UNATTACHED_AFFINELY); }
  void SetUnattachedMotionToFollowRigidly() { this->SetUnattachedMotion(UNATTACHED_RIGIDLY); }
  void SetUnattachedMotionToStay() { this->SetUnattachedMotion(UNATTACHED_STAY); }
  ///@}

  ///@{
  /**
   * How the geometry is found: see vtkClassifyBoundary. FeatureAngle also defines the feature edges
   * of the target.
   */
  virtual void SetFeatureAngle(double value);
  vtkGetMacro(FeatureAngle, double);
  virtual void SetCornerAngle(double value);
  vtkGetMacro(CornerAngle, double);
  vtkSetStringMacro(SurfaceIdArray);
  vtkGetStringMacro(SurfaceIdArray);
  vtkSetMacro(UseGeometryArrays, bool);
  vtkGetMacro(UseGeometryArrays, bool);
  vtkBooleanMacro(UseGeometryArrays, bool);
  vtkSetMacro(FeaturesInside, bool);
  vtkGetMacro(FeaturesInside, bool);
  vtkBooleanMacro(FeaturesInside, bool);
  ///@}

  ///@{
  /**
   * How port 1 is matched: see vtkMorphAlgorithm.
   */
  vtkSetStringMacro(BoundaryIdArray);
  vtkGetStringMacro(BoundaryIdArray);
  vtkSetStringMacro(DisplacementArray);
  vtkGetStringMacro(DisplacementArray);
  virtual void SetScaleFactor(double value);
  vtkGetMacro(ScaleFactor, double);
  virtual void SetMatchTolerance(double value);
  vtkGetMacro(MatchTolerance, double);
  ///@}

  ///@{
  /**
   * How far a node may go to the target, in units of the diagonal of the bounding box of the volume
   * cells' nodes. Default 0.1, range [0, 10].
   */
  virtual void SetProjectionDistance(double value);
  vtkGetMacro(ProjectionDistance, double);
  ///@}

  ///@{
  /**
   * The largest angle between the normals of the target and of the moved surface where a node is
   * projected. It keeps nodes of a thin wall from the wall's other side. The target's normals may
   * all point inwards. Degrees, default 60, range [0, 180].
   */
  virtual void SetProjectionAngle(double value);
  vtkGetMacro(ProjectionAngle, double);
  ///@}

  ///@{
  /**
   * The time at which port 0 is undeformed; see vtkMorphAlgorithm. Default -1e300, so the first.
   */
  virtual void SetRestTime(double value);
  vtkGetMacro(RestTime, double);
  ///@}

  ///@{
  /**
   * Type of the output's points: vtkAlgorithm::SINGLE_PRECISION, DOUBLE_PRECISION, or
   * DEFAULT_PRECISION for that of port 0 (double where that is neither). Default DEFAULT_PRECISION.
   */
  vtkSetClampMacro(OutputPointsPrecision, int, SINGLE_PRECISION, DEFAULT_PRECISION);
  vtkGetMacro(OutputPointsPrecision, int);
  ///@}

  ///@{
  /**
   * Threads to compute with. 0 means all cores. The result does not depend on it. Default 0, range
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
   * Quality of the moved faces in the last execution. Where there was no result, the mean is NaN
   * and the others are -1.
   */
  double GetMinScaledJacobian() const { return this->GetNumber("MinScaledJacobian"); }
  double GetMeanScaledJacobian() const { return this->GetNumber("MeanScaledJacobian"); }
  vtkIdType GetFoldedFaces() const { return this->GetInteger("FoldedFaces"); }
  ///@}

  ///@{
  /**
   * As of the last execution: nodes that port 1 gave, vertices that it did not name and that were
   * held, nodes that were projected to the target, and nodes whose projection failed.
   */
  vtkIdType GetGivenPoints() const { return this->GetInteger("GivenPoints"); }
  vtkIdType GetHeldVertices() const { return this->GetInteger("HeldVertices"); }
  vtkIdType GetProjectedPoints() const { return this->GetInteger("ProjectedPoints"); }
  vtkIdType GetUnprojectedPoints() const { return this->GetInteger("UnprojectedPoints"); }
  ///@}

  ///@{
  /**
   * As of the last execution with SURFACE_METHOD_MESH_SMOOTHING: the number of surfaces whose mesh
   * became better, and the ids of those that were better before, and stayed so. "None" without one.
   */
  vtkIdType GetSmoothedSurfaces() const { return this->GetInteger("SmoothedSurfaces"); }
  const char* GetKeptSurfaces() const;
  ///@}

protected:
  vtkMorphBoundary();
  ~vtkMorphBoundary() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkMorphBoundary(const vtkMorphBoundary&) = delete;
  void operator=(const vtkMorphBoundary&) = delete;

  class vtkInternals;
  std::unique_ptr<vtkInternals> Internals;

  ///@{
  /// A result of the last execution, by its name in Results.txt.
  double GetNumber(const char* name) const;
  vtkIdType GetInteger(const char* name) const;
  ///@}

  int PrescribedDimension = 1;
  int SurfaceMethod = SURFACE_METHOD_WEIGHTED_RESIDUAL;
  int NumberOfNeighbors = 20;
  int UnattachedMotion = UNATTACHED_AFFINELY;
  double FeatureAngle = 25;
  double CornerAngle = 45;
  char* SurfaceIdArray = nullptr;
  bool UseGeometryArrays = true;
  bool FeaturesInside = false;
  char* BoundaryIdArray = nullptr;
  char* DisplacementArray = nullptr;
  double ScaleFactor = 1;
  double MatchTolerance = 1e-6;
  double ProjectionDistance = 0.1;
  double ProjectionAngle = 60;
  double RestTime = -1e300;
  int OutputPointsPrecision = DEFAULT_PRECISION;
  int NumberOfThreads = 0;
  int CoincidentPoints = 0;
};

#endif
