// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDisplacementAlgorithm
 * @brief   superclass of the filters that displace a mesh's boundary: how it moves, and zones
 *
 * It has the properties that vtkBoundaryDisplacement and vtkMorphMesh have in common: the motion,
 * what the rest of the boundary does, zones, layers, and how the geometry is found.
 *
 * Port 0 takes the mesh. The other ports are optional. Port 1 takes a vtkSelection of what moves,
 * port 2 the target surface, and port 3 the vtkSelection of a zone. Port 4 takes handles, or the
 * control points of a lattice.
 *
 * @sa vtkBoundaryDisplacement vtkMorphMesh
 */
#ifndef vtkDisplacementAlgorithm_h
#define vtkDisplacementAlgorithm_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro

#include <vtkDataObjectAlgorithm.h>

class vtkAbstractTransform;
class vtkExtractSelection;
class vtkImplicitFunction;
class vtkSelection;

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkDisplacementAlgorithm : public vtkDataObjectAlgorithm
{
public:
  vtkTypeMacro(vtkDisplacementAlgorithm, vtkDataObjectAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  vtkMTimeType GetMTime() override;

  ///@{
  /**
   * The selection (port 1): the same as SetInputConnection() and SetInputData() on that port.
   */
  void SetSelectionConnection(vtkAlgorithmOutput* output);
  void SetSelectionData(vtkSelection* selection);
  ///@}

  ///@{
  /**
   * The target surface (port 2) of MOTION_TARGET: the same as SetInputConnection() and
   * SetInputData() on that port. A null target removes it.
   */
  void SetTargetConnection(vtkAlgorithmOutput* output);
  void SetTargetData(vtkDataObject* target);
  ///@}

  /**
   * The filter that evaluates the selection, for applications whose selections vtkExtractSelection
   * does not support. Null: a vtkExtractSelection. Default: null.
   */
  virtual void SetSelectionExtractor(vtkExtractSelection* extractor);

  ///@{
  /**
   * Zones: parts of the mesh, inner nodes too, that a morph leaves as they are. Frozen zones stay
   * where they are; rigid ones each move as one body. A name is that of a point array or cell array
   * of the input, which marks nodes or cells by values other than 0, or of a block. A zone wins
   * over what moves; a node of several is in the first, frozen ones before rigid ones. The input
   * has to be the volume mesh. The output then has the inner nodes, too, as points without cells,
   * with Role 5, so that every morph filter prescribes them. Default: none.
   */
  void SetFrozenZoneStatus(const char* name, int status);
  void AddFrozenZone(const char* name) { this->SetFrozenZoneStatus(name, 1); }
  void RemoveAllFrozenZones();
  void SetRigidZoneStatus(const char* name, int status);
  void AddRigidZone(const char* name) { this->SetRigidZoneStatus(name, 1); }
  void RemoveAllRigidZones();
  ///@}

  enum ZoneType
  {
    ZONE_NONE = 0,
    ZONE_FROZEN = 1,
    ZONE_RIGID = 2,
    ZONE_SOFT = 3 // of vtkMorphMesh alone
  };

  ///@{
  /**
   * One more zone: the nodes where an implicit function, a box for instance, is zero or less.
   * Default: null, ZONE_NONE.
   */
  void SetZoneRegion(vtkImplicitFunction* region);
  vtkImplicitFunction* GetZoneRegion();
  virtual void SetZoneRegionType(int type);
  vtkGetMacro(ZoneRegionType, int);
  ///@}

  ///@{
  /**
   * One more zone: the selected points or cells (port 3) of the input. Default ZONE_NONE.
   */
  void SetZoneSelectionConnection(vtkAlgorithmOutput* output);
  void SetZoneSelectionData(vtkSelection* selection);
  virtual void SetZoneSelectionType(int type);
  vtkGetMacro(ZoneSelectionType, int);
  ///@}

  ///@{
  /**
   * The motion of all rigid zones, times ScaleFactor. Null: each zone takes the rigid motion that
   * fits, by least squares, its nodes that move. Where these are none, or on a line, those that are
   * held count, too; then all of its nodes on the mesh's boundary. Where these are none, or on a
   * line, it fits the zone's edge as FEMWARP would move it, for which this filter solves once. A
   * warning says how far what moves, is held or slides is then from where it should be. Default:
   * null.
   */
  void SetRigidTransform(vtkAbstractTransform* transform);
  vtkAbstractTransform* GetRigidTransform();
  ///@}

  ///@{
  /**
   * The most layers of hexahedra, and of wedges on triangles, that are kept on faces that move.
   * Their nodes follow the wall's displacement and local rotation, so that heights and angles to
   * the wall stay; a morph prescribes them (Role 6). Layers are found from the wall outwards: they
   * end at cells of other shapes, at other layers and before the opposite boundary. Nodes of layers
   * on other surfaces move in the tangent plane of these. An error where no layer is found. Default
   * 0, range [0, VTK_INT_MAX].
   */
  vtkSetClampMacro(KeepLayers, int, 0, VTK_INT_MAX);
  vtkGetMacro(KeepLayers, int);
  ///@}

  ///@{
  /**
   * Name of a cell array of the input: layers have only cells where it is not zero. Empty or
   * "None": all. Default: none.
   */
  vtkSetStringMacro(LayersArray);
  vtkGetStringMacro(LayersArray);
  ///@}

  ///@{
  /**
   * The implicit function of MOVE_REGION: nodes at which it is zero or less move. Default: null.
   */
  void SetRegion(vtkImplicitFunction* region);
  vtkImplicitFunction* GetRegion();
  ///@}

  ///@{
  /**
   * Name of the point array of MOVE_ARRAY: a node moves where one of its components is not zero.
   * Empty or "None": none. Default: none.
   */
  vtkSetStringMacro(MovingArray);
  vtkGetStringMacro(MovingArray);
  ///@}

  ///@{
  /**
   * The transform of the moving nodes; null is the identity. A scale of zero is allowed: a warning
   * names the faces that it collapses. Default: null.
   */
  void SetTransform(vtkAbstractTransform* transform);
  vtkAbstractTransform* GetTransform();
  ///@}

  ///@{
  /**
   * The displacement of all moving nodes, in the unit of the points: finite numbers. Default 0, 0,
   * 0.
   */
  virtual void SetVector(double x, double y, double z);
  virtual void SetVector(const double vector[3]);
  vtkGetVector3Macro(Vector, double);
  ///@}

  ///@{
  /**
   * How far nodes move along their normal, in the unit of the points. The normal points out of the
   * mesh; negative is inwards. Normals are area-weighted over the faces that move or, at nodes
   * without such a face, over all faces of the node. Default 0.
   */
  virtual void SetDistance(double value);
  vtkGetMacro(Distance, double);
  ///@}

  ///@{
  /**
   * Name of a point array of the input with three components, in the unit of the points. Nodes are
   * free where it is NaN, or vtkValidPointMask 0. Empty or "None": none. Default: none.
   */
  vtkSetStringMacro(DisplacementArray);
  vtkGetStringMacro(DisplacementArray);
  ///@}

  ///@{
  /**
   * The numbers of MOTION_PLACEMENT: a scale and a rotation about the centre, then a
   * translation. Translation: in the unit of the points. Rotation: degrees about the axes, z first,
   * then x, then y. Defaults 0 0 0, 0 0 0, 1 1 1.
   */
  virtual void SetTranslation(double x, double y, double z);
  virtual void SetTranslation(const double vector[3]);
  vtkGetVector3Macro(Translation, double);
  virtual void SetRotation(double x, double y, double z);
  virtual void SetRotation(const double vector[3]);
  vtkGetVector3Macro(Rotation, double);
  virtual void SetScale(double x, double y, double z);
  virtual void SetScale(const double vector[3]);
  vtkGetVector3Macro(Scale, double);
  ///@}

  ///@{
  /**
   * The centre about which it is scaled and turned. AutoCenter, the default: the centre of the
   * bounding box of what moves. Off: Center, by default the origin. It is that of
   * MOTION_PLACEMENT and, with TransformAboutCenter, of MOTION_TRANSFORM.
   */
  vtkSetMacro(AutoCenter, bool);
  vtkGetMacro(AutoCenter, bool);
  vtkBooleanMacro(AutoCenter, bool);
  virtual void SetCenter(double x, double y, double z);
  virtual void SetCenter(const double vector[3]);
  vtkGetVector3Macro(Center, double);
  ///@}

  ///@{
  /**
   * Whether Transform takes the centre as its origin: x goes to centre + Transform(x - centre), the
   * centre being that of AutoCenter and Center. Off: Transform is used as it is. Default off.
   */
  vtkSetMacro(TransformAboutCenter, bool);
  vtkGetMacro(TransformAboutCenter, bool);
  vtkBooleanMacro(TransformAboutCenter, bool);
  ///@}

  ///@{
  /**
   * How much the radius of the cylinders grows that move (MOTION_RADIUS), in the unit of the
   * points. A surface that is no cylinder, or that would lose its radius, is an error. Default 0.
   */
  virtual void SetRadiusChange(double value);
  vtkGetMacro(RadiusChange, double);
  ///@}

  ///@{
  /**
   * Whether the target is first rotated and shifted onto what moves, or onto the whole boundary
   * where the target says what moves. The mesh is not. Iterative closest points start from the
   * target's place, equal centres and equal principal axes. Default off.
   */
  vtkSetMacro(AlignTarget, bool);
  vtkGetMacro(AlignTarget, bool);
  vtkBooleanMacro(AlignTarget, bool);
  ///@}

  ///@{
  /**
   * How far a node may go to the target, in units of the diagonal of the boundary's bounding box.
   * Default 0.2, range [0, 10].
   */
  virtual void SetTargetReach(double value);
  vtkGetMacro(TargetReach, double);
  ///@}

  ///@{
  /**
   * The largest angle between the normals of the target and of the surface that goes there. The
   * target's normals may all point inwards. Degrees, default 60, range [0, 180].
   */
  virtual void SetTargetAngle(double value);
  vtkGetMacro(TargetAngle, double);
  ///@}

  enum ProjectionDirections
  {
    PROJECT_CLOSEST = 0,
    PROJECT_X = 1,
    PROJECT_Y = 2,
    PROJECT_Z = 3,
    PROJECT_NORMAL = 4,
    PROJECT_VECTOR = 5
  };
  ///@{
  /**
   * Where nodes go on the target: to the closest point, or along a direction, either way, to the
   * nearest place there. The direction is an axis, the node's normal (area-weighted over the faces
   * that move) or ProjectVector, whose length has no effect. Along a direction neither vertices nor
   * curves look for the target's. A node that misses the target follows the others (a vertex
   * stays), with a warning. Terrain and free surfaces need an axis. Nodes that are on sliding
   * surfaces, too, go to places on both. Defaults PROJECT_CLOSEST and 0 0 1; a vector of no length
   * is an error.
   */
  vtkSetClampMacro(ProjectAlong, int, PROJECT_CLOSEST, PROJECT_VECTOR);
  vtkGetMacro(ProjectAlong, int);
  void SetProjectAlongToClosest() { this->SetProjectAlong(PROJECT_CLOSEST); }
  void SetProjectAlongToX() { this->SetProjectAlong(PROJECT_X); }
  void SetProjectAlongToY() { this->SetProjectAlong(PROJECT_Y); }
  void SetProjectAlongToZ() { this->SetProjectAlong(PROJECT_Z); }
  void SetProjectAlongToNormal() { this->SetProjectAlong(PROJECT_NORMAL); }
  void SetProjectAlongToVector() { this->SetProjectAlong(PROJECT_VECTOR); }
  virtual void SetProjectVector(double x, double y, double z);
  virtual void SetProjectVector(const double vector[3]);
  vtkGetVector3Macro(ProjectVector, double);
  ///@}

  ///@{
  /**
   * Control points (port 4): the same as SetInputConnection() and SetInputData() on that port. Of
   * handles: a vtkPointSet with the point array `Displacement` (3 components) and, optional, the
   * array `Radius`; or a vtkTable with the columns x, y, z, dx, dy, dz and, optional, radius. Of a
   * lattice: a vtkPointSet with the point array `Displacement`, whose points are the control
   * points, those of the first direction first; or a vtkTable with the columns i, j, k, dx, dy, dz.
   * They count in addition to AddHandle() and AddLatticeDisplacement().
   */
  void SetControlPointsConnection(vtkAlgorithmOutput* output);
  void SetControlPointsData(vtkDataObject* points);
  ///@}

  ///@{
  /**
   * Handles: points, each with a displacement and a radius, all in the unit of the points. What
   * moves takes a smooth motion that has these displacements at the handles. Handles of radius 0,
   * without a limit, are interpolated by thin-plate splines r^2 log r with a linear polynomial: an
   * affine motion of four that are not in a plane moves all affinely. A positive radius limits a
   * handle: Wendland's C2 kernel ends there. Distinct points; at most 2,000 handles. Default: none.
   */
  void AddHandle(double x, double y, double z, double dx, double dy, double dz, double radius);
  void AddHandle(const double values[7]);
  void RemoveAllHandles();
  int GetNumberOfHandles() const;
  ///@}

  ///@{
  /**
   * Whether the selected points of the boundary (port 1) are handles too, each with the
   * displacement Vector and the radius HandleRadius. Defaults off and 0; radius in [0, 1e50].
   */
  vtkSetMacro(SelectedHandles, bool);
  vtkGetMacro(SelectedHandles, bool);
  vtkBooleanMacro(SelectedHandles, bool);
  virtual void SetHandleRadius(double value);
  vtkGetMacro(HandleRadius, double);
  ///@}

  enum LatticeBases
  {
    LATTICE_BERNSTEIN = 0,
    LATTICE_B_SPLINE = 1
  };
  ///@{
  /**
   * Lattice: a box of control points, whose displacements move what is inside. Outside nothing
   * moves. LATTICE_BERNSTEIN: a polynomial of degree l - 1 for l points in a direction; each point
   * moves the whole box. LATTICE_B_SPLINE: cubic pieces (of lower degree below four points), so
   * that a point moves its surroundings. Undeformed control points are those of the identity: in
   * equal distances for Bernstein, at the Greville abscissae for B-splines. An affine motion of all
   * moves what is inside affinely. T. W. Sederberg, S. R. Parry, "Free-form deformation of solid
   * geometric models", SIGGRAPH 1986, 151-160. Default LATTICE_BERNSTEIN.
   */
  vtkSetClampMacro(LatticeBasis, int, LATTICE_BERNSTEIN, LATTICE_B_SPLINE);
  vtkGetMacro(LatticeBasis, int);
  void SetLatticeBasisToBernstein() { this->SetLatticeBasis(LATTICE_BERNSTEIN); }
  void SetLatticeBasisToBSpline() { this->SetLatticeBasis(LATTICE_B_SPLINE); }
  ///@}

  ///@{
  /**
   * The number of control points in each direction. Default 3 3 3, each in [2, 30].
   */
  virtual void SetLatticeSize(int l, int m, int n);
  virtual void SetLatticeSize(const int size[3]);
  vtkGetVector3Macro(LatticeSize, int);
  ///@}

  ///@{
  /**
   * The lattice's box. AutoLattice, the default: the bounding box of what moves. Off:
   * LatticeBounds, six numbers as in vtkDataSet::GetBounds(), in the unit of the points. Default 0
   * 1 0 1 0 1.
   */
  vtkSetMacro(AutoLattice, bool);
  vtkGetMacro(AutoLattice, bool);
  vtkBooleanMacro(AutoLattice, bool);
  virtual void SetLatticeBounds(
    double xmin, double xmax, double ymin, double ymax, double zmin, double zmax);
  virtual void SetLatticeBounds(const double bounds[6]);
  vtkGetVector6Macro(LatticeBounds, double);
  ///@}

  ///@{
  /**
   * Displacements of control points i, j, k, from 0 and below LatticeSize, in the unit of the
   * points. Those of one point are added. Default: none.
   */
  void AddLatticeDisplacement(double i, double j, double k, double dx, double dy, double dz);
  void AddLatticeDisplacement(const double values[6]);
  void RemoveAllLatticeDisplacements();
  int GetNumberOfLatticeDisplacements() const;
  ///@}

  ///@{
  /**
   * The factor of the motion; 0 leaves the boundary where it is. Default 1, any finite number.
   */
  virtual void SetScaleFactor(double value);
  vtkGetMacro(ScaleFactor, double);
  ///@}

  enum SurroundingsMotions
  {
    SURROUNDINGS_STAY = 0,
    SURROUNDINGS_FOLLOW = 1,
    SURROUNDINGS_FADE = 2,
    SURROUNDINGS_FOLLOW_ALL = 3
  };

  ///@{
  /**
   * What the nodes do that neither move nor are held. They stay. Or the surfaces follow that touch
   * what moves along an edge, curves first, as with vtkMorphBoundary, vertices being held, and the
   * others stay: a surface that only shares a vertex does not touch. Where the motion allows it to
   * 1 % of the largest displacement, a following surface keeps its own shape (plane, cylinder, or
   * its facets); else a warning says how far it leaves it. Where a following surface folds, its
   * nodes slide along it until it does not (smoothSurfaceMeshes()), and a warning says how many
   * slid how far. Or nodes fade: they follow the motion the less, the farther they are from the
   * nearest moving node, up to FalloffRadius. Or all surfaces follow, whether they touch or not.
   * Default SURROUNDINGS_FOLLOW.
   */
  vtkSetClampMacro(Surroundings, int, SURROUNDINGS_STAY, SURROUNDINGS_FOLLOW_ALL);
  vtkGetMacro(Surroundings, int);
  void SetSurroundingsToStay() { this->SetSurroundings(SURROUNDINGS_STAY); }
  void SetSurroundingsToFollow() { this->SetSurroundings(SURROUNDINGS_FOLLOW); }
  void SetSurroundingsToFade() { this->SetSurroundings(SURROUNDINGS_FADE); }
  void SetSurroundingsToFollowAll() { this->SetSurroundings(SURROUNDINGS_FOLLOW_ALL); }
  ///@}

  enum SurfaceMethods
  {
    SURFACE_METHOD_WEIGHTED_RESIDUAL = 0,
    SURFACE_METHOD_SMOOTHING = 1,
    SURFACE_METHOD_MESH_SMOOTHING = 2
  };
  ///@{
  /**
   * How surfaces follow, with SURROUNDINGS_FOLLOW and SURROUNDINGS_FOLLOW_ALL: as those of
   * vtkMorphBoundary. Default SURFACE_METHOD_WEIGHTED_RESIDUAL.
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
   * The distance at which SURROUNDINGS_FADE reaches zero, in units of the diagonal of the
   * boundary's bounding box. At the distance d the displacement is that of the 20 nearest moving
   * nodes, by inverse squared distance, times (1 - t)^4 (4 t + 1) with t = d / radius. Default 0.1,
   * range [0, 10]; 0 is as SURROUNDINGS_STAY.
   */
  virtual void SetFalloffRadius(double value);
  vtkGetMacro(FalloffRadius, double);
  ///@}

  ///@{
  /**
   * How often the nodes of sliding surfaces are iterated with the volume. A round lets them go
   * along their surfaces to where FEMWARP, with uniform stiffness, pulls none of them along. It
   * solves for volume and surfaces together, linearised at the present places, and puts the nodes
   * back onto the surfaces. On planes one round is exact. Rounds end early where the pull is
   * rounding, or does not fall. A node slides so if all of its surfaces do, and if it neither
   * moves, nor is held, nor is of a zone or layer. Two arrays of the output's field data have a
   * value for each round. `SlideChange` is its largest move, in units of the diagonal of the
   * boundary's bounding box. `SlideForce` is the pull that is left, in parts of that before the
   * first. Errors: polyhedra, a surface as input. Cost: two to six solutions a
   * round. Default 0, no rounds; range [0, 20].
   */
  vtkSetClampMacro(SlideRounds, int, 0, 20);
  vtkGetMacro(SlideRounds, int);
  ///@}

  /**
   * What each round of SlideRounds has done in the last execution: the numbers of SlideChange and
   * SlideForce. "None" where there was no round.
   */
  const char* GetSlideReport() const;

  ///@{
  /**
   * How the geometry is found: see vtkClassifyBoundary. If port 0 takes a boundary, SurfaceIdArray
   * is one of its cell arrays.
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
  ///@}

  ///@{
  /**
   * Type of the output's points: vtkAlgorithm::SINGLE_PRECISION, DOUBLE_PRECISION, or
   * DEFAULT_PRECISION for that of the input's (double where they are neither). Default
   * DEFAULT_PRECISION.
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
protected:
  vtkDisplacementAlgorithm();
  ~vtkDisplacementAlgorithm() override;

  /// The properties that are objects and lists. A subclass owns them and sets the pointer.
  struct vtkShared;
  vtkShared* Shared = nullptr;
  /// The last of ZoneType that this class knows.
  int LargestZoneType = ZONE_RIGID;

  /// Sets all properties of this class as they are in `from`, without inputs and the precision of
  /// the output. Changes nothing where they are equal.
  void CopyDisplacement(vtkDisplacementAlgorithm* from);
  int FillInputPortInformation(int port, vtkInformation* info) override;

  char* MovingArray = nullptr;
  int ZoneRegionType = ZONE_NONE;
  int ZoneSelectionType = ZONE_NONE;
  int KeepLayers = 0;
  char* LayersArray = nullptr;
  double Vector[3] = { 0, 0, 0 };
  double Distance = 0;
  char* DisplacementArray = nullptr;
  double Translation[3] = { 0, 0, 0 };
  double Rotation[3] = { 0, 0, 0 };
  double Scale[3] = { 1, 1, 1 };
  bool AutoCenter = true;
  double Center[3] = { 0, 0, 0 };
  bool TransformAboutCenter = false;
  double RadiusChange = 0;
  bool AlignTarget = false;
  double TargetReach = 0.2;
  double TargetAngle = 60;
  int ProjectAlong = PROJECT_CLOSEST;
  double ProjectVector[3] = { 0, 0, 1 };
  bool SelectedHandles = false;
  double HandleRadius = 0;
  int LatticeBasis = LATTICE_BERNSTEIN;
  int LatticeSize[3] = { 3, 3, 3 };
  bool AutoLattice = true;
  double LatticeBounds[6] = { 0, 1, 0, 1, 0, 1 };
  double ScaleFactor = 1;
  int Surroundings = SURROUNDINGS_FOLLOW;
  int SurfaceMethod = SURFACE_METHOD_WEIGHTED_RESIDUAL;
  double FalloffRadius = 0.1;
  int SlideRounds = 0;
  double FeatureAngle = 25;
  double CornerAngle = 45;
  char* SurfaceIdArray = nullptr;
  bool UseGeometryArrays = true;
  int OutputPointsPrecision = DEFAULT_PRECISION;
  int NumberOfThreads = 0;
  int CoincidentPoints = 0;

private:
  vtkDisplacementAlgorithm(const vtkDisplacementAlgorithm&) = delete;
  void operator=(const vtkDisplacementAlgorithm&) = delete;
};

#endif
