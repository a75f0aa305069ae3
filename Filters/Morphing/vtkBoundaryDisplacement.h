// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkBoundaryDisplacement
 * @brief   moves a part of a mesh's boundary, and defines what the rest of the boundary does
 *
 * One filter makes the displaced boundary from a mesh: what moves, how it moves, and what the rest
 * does.
 *
 * - Moving defines what moves: all of the boundary, a selection of points or cells, patches (the
 *   surfaces and curves that vtkClassifyBoundary finds), or what is inside an implicit function, a
 *   box for instance.
 * - Motion defines how: by a transform, by a vector, along the normals, by a point vector array of
 *   the input, or onto a target surface; each times ScaleFactor.
 * - Surroundings defines what the rest does. It stays, follows as with vtkMorphBoundary (curves
 *   first, then surfaces; vertices are held), or fades out with the distance from what moves.
 *   HeldPatches stay in any case, except for the nodes that they share with what moves.
 *
 * Port 0 takes the mesh (vtkUnstructuredGrid, or composite data, see vtkMorphAlgorithm), or its
 * boundary (vtkPolyData) as vtkExtractMorphBoundary, vtkClassifyBoundary or this filter writes it: several of these filters
 * in a row move several parts, each in its own way. Such a boundary moves from its current
 * position. Its geometry is that of its point arrays GeometryDimension and GeometryId, or is found
 * at its RestPosition. Port 1, optional, takes the vtkSelection of MOVE_SELECTION. Selected cells
 * move all of their nodes that are on the boundary. Port 2, optional, takes the target of
 * MOTION_TARGET (vtkPolyData, an STL file for instance). Port 3, optional, takes the selection of
 * a zone.
 *
 * The output is the boundary as vtkClassifyBoundary writes it on its port 1, at its displaced
 * points: the input of port 1 of a morph filter. Two point arrays are added:
 * - `Role` (signed char, active scalars): 0 stays, 1 moves, 2 is held, 3 follows or fades,
 *   4 is free, 5 is of a zone, 6 of a layer;
 * - `BoundaryDisplacement` (active vectors): the point as written minus its RestPosition.
 * No motion gives the input's points bit for bit.
 *
 * The filter is made for dragging: it keeps boundary, geometry and weights while the input, the
 * chosen parts and the options that they depend on are the same (ClassifyCount, PrepareCount). The
 * result does not depend on what was kept.
 *
 * RequestInformation reads the input's data where they are up to date. It finds the boundary's
 * patches, so that a window can list their names before the first execution, and keeps what it
 * finds for that execution. On a large mesh this takes as long as the first execution would.
 *
 * Warnings: nodes that do not reach the target; faces that the motion leaves without area (a scale
 * of zero, for instance); surfaces that it would reflect; a mesh without any outer face, whose
 * boundary is empty. Errors: those of vtkClassifyBoundary; a surface without polygons, MorphPointId
 * or RestPosition; nothing chosen, or nothing on the boundary; a target without polygons, with
 * coordinates that are not finite, or that no node reaches; patches or arrays that do not exist;
 * positions that are not finite, beyond 1e50, or in single precision beyond 3.4e38; nodes without a
 * normal. The output is then empty: a morph would take an unchanged boundary for a motion of zero.
 * An execution that is aborted gives an empty output and no message. With several MPI ranks all of
 * them have to execute it. Cost, where everything is kept: a few passes over the boundary.
 *
 * M. L. Staten, S. J. Owen, S. M. Shontz, A. G. Salinger, T. S. Coffey, "A Comparison of Mesh
 * Morphing Methods for 3D Shape Optimization", Proc. 20th Int. Meshing Roundtable (2011) 293-311.
 *
 * @sa vtkMorphBoundary vtkClassifyBoundary vtkExtractMorphBoundary vtkMorphAlgorithm
 */
#ifndef vtkBoundaryDisplacement_h
#define vtkBoundaryDisplacement_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro

#include <vtkPolyDataAlgorithm.h>

#include <memory> // for std::unique_ptr

class vtkAbstractTransform;
class vtkDataArraySelection;
class vtkDataObject;
class vtkDoubleArray;
class vtkExtractSelection;
class vtkImplicitFunction;
class vtkPointSet;
class vtkPolyData;
class vtkSelection;
class vtkStringArray;

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkBoundaryDisplacement : public vtkPolyDataAlgorithm
{
public:
  static vtkBoundaryDisplacement* New();
  vtkTypeMacro(vtkBoundaryDisplacement, vtkPolyDataAlgorithm);
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
  void SetSelectionExtractor(vtkExtractSelection* extractor);

  enum MovingParts
  {
    MOVE_EVERYTHING = 0,
    MOVE_SELECTION = 1,
    MOVE_PATCHES = 2,
    MOVE_REGION = 3,
    MOVE_ARRAY = 4,
    MOVE_NOTHING = 5
  };
  ///@{
  /**
   * What moves: the whole boundary; what is selected; the patches of AddPatch(); what is inside
   * Region; nodes where MovingArray is not zero; or nothing, to see the boundary with its patches.
   * Default MOVE_EVERYTHING.
   */
  vtkSetClampMacro(Moving, int, MOVE_EVERYTHING, MOVE_NOTHING);
  vtkGetMacro(Moving, int);
  void SetMovingToEverything() { this->SetMoving(MOVE_EVERYTHING); }
  void SetMovingToSelection() { this->SetMoving(MOVE_SELECTION); }
  void SetMovingToPatches() { this->SetMoving(MOVE_PATCHES); }
  void SetMovingToRegion() { this->SetMoving(MOVE_REGION); }
  void SetMovingToArray() { this->SetMoving(MOVE_ARRAY); }
  void SetMovingToNothing() { this->SetMoving(MOVE_NOTHING); }
  ///@}

  ///@{
  /**
   * The patches that move, by name: "Surface 3" or "Curve 7", with the ids that vtkClassifyBoundary
   * writes, or a name of the input. The input's field data `SurfaceNames` (vtkStringArray) lists
   * these; a point array or cell array of each name marks its nodes or cells by values other than
   * 0. A status other than 0 adds one, and 0 removes it. Default: none.
   */
  void SetPatchStatus(const char* name, int status);
  void AddPatch(const char* name) { this->SetPatchStatus(name, 1); }
  void RemoveAllPatches();
  ///@}

  ///@{
  /**
   * The patches that are held, by name. A node that moves is not held. Default: none.
   */
  void SetHeldPatchStatus(const char* name, int status);
  void AddHeldPatch(const char* name) { this->SetHeldPatchStatus(name, 1); }
  void RemoveAllHeldPatches();
  ///@}

  ///@{
  /**
   * The surfaces that slide, by name: their nodes move along the undeformed shape of the surface (a
   * plane, a cylinder, or its facets), moving nodes too. For planes of symmetry. Default: none.
   */
  void SetSlidingPatchStatus(const char* name, int status);
  void AddSlidingPatch(const char* name) { this->SetSlidingPatchStatus(name, 1); }
  void RemoveAllSlidingPatches();
  ///@}

  ///@{
  /**
   * The surfaces that are free, by name: a morph solves their nodes with the interior. A node is
   * free only if all of its surfaces are, and if it neither moves nor is held. Where nodes are free
   * the output has the point array `MorphFree`. Default: none.
   */
  void SetFreePatchStatus(const char* name, int status);
  void AddFreePatch(const char* name) { this->SetFreePatchStatus(name, 1); }
  void RemoveAllFreePatches();
  ///@}

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
    ZONE_RIGID = 2
  };
  ///@{
  /**
   * One more zone: the nodes where an implicit function, a box for instance, is zero or less.
   * Default: null, ZONE_NONE.
   */
  void SetZoneRegion(vtkImplicitFunction* region);
  vtkImplicitFunction* GetZoneRegion();
  vtkSetClampMacro(ZoneRegionType, int, ZONE_NONE, ZONE_RIGID);
  vtkGetMacro(ZoneRegionType, int);
  ///@}

  ///@{
  /**
   * One more zone: the selected points or cells (port 3) of the input. Default ZONE_NONE.
   */
  void SetZoneSelectionConnection(vtkAlgorithmOutput* output);
  void SetZoneSelectionData(vtkSelection* selection);
  vtkSetClampMacro(ZoneSelectionType, int, ZONE_NONE, ZONE_RIGID);
  vtkGetMacro(ZoneSelectionType, int);
  ///@}

  ///@{
  /**
   * The motion of all rigid zones, times ScaleFactor. Null: each zone takes the rigid motion that
   * fits, by least squares, its nodes on the mesh's boundary as they move. Where these are none, or
   * on a line, it fits the zone's edge as FEMWARP would move it, for which this filter solves once.
   * Default: null.
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

  /**
   * Names of all patches, surfaces first, as a list to choose from, with nothing enabled. They are
   * those of the last execution or, after an update of the information, of input data that are up
   * to date. Empty after an error.
   */
  vtkDataArraySelection* GetPatchList();

  /**
   * Writes into `names` all names of GetPatchList(), and enables the surfaces that a selection lies
   * on, as a user who clicks on surfaces expects. `shown`: the data that were selected on: the
   * input, a morphed mesh, or the boundary. Where selected cells and points lie on several
   * surfaces, as at an edge, the fewest surfaces are taken that explain the selection. A selection
   * that cannot be evaluated is an error. Cost: that of the selection, and a pass over the
   * boundary's faces.
   */
  void FindPatches(vtkDataObject* shown, vtkSelection* selection, vtkDataArraySelection* names);

  /**
   * Makes `output` the polygons and lines of the patches that are enabled in `names`, where the
   * output has them or, before the first execution, undeformed. Unknown names are left out.
   */
  void CopyPatches(vtkDataArraySelection* names, vtkPolyData* output);

  ///@{
  /**
   * FindPatches() for ParaView's window, which knows objects of a server by name alone. Pick: an
   * algorithm whose first output is the selection. PickPort: the output of this filter that it is
   * of, or -1, the default, for the input. GetPickedPatches() finds them. Neither causes an
   * execution.
   */
  void SetPick(vtkAlgorithm* selection);
  void SetPickPort(int port);
  int GetPickPort() const;
  vtkDataArraySelection* GetPickedPatches();
  ///@}

  /**
   * The size of each patch of the list: its name, how many faces it has, and their area, three
   * strings each. Of a curve: edges and length.
   */
  vtkStringArray* GetPatchSizes();

  /**
   * The bounding box of each patch of the list, undeformed: six numbers as in
   * vtkDataSet::GetBounds().
   */
  vtkDoubleArray* GetPatchBounds();

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

  enum Motions
  {
    MOTION_TRANSFORM = 0,
    MOTION_VECTOR = 1,
    MOTION_ALONG_NORMALS = 2,
    MOTION_ARRAY = 3,
    MOTION_PLACEMENT = 4,
    MOTION_RADIUS = 5,
    MOTION_TARGET = 6,
    // The old names, until version 0.2.
    TRANSFORM = MOTION_TRANSFORM,
    VECTOR = MOTION_VECTOR,
    ALONG_NORMALS = MOTION_ALONG_NORMALS,
    ARRAY = MOTION_ARRAY
  };
  ///@{
  /**
   * How it moves: by Transform, by Vector, by Distance along its normals, by DisplacementArray, by
   * Translation, Rotation and Scale, by RadiusChange, or onto the target.
   *
   * MOTION_TARGET: vertices go to the target's vertices, then curves to its feature edges, then
   * surfaces follow and go to the target, as with vtkMorphBoundary. What has no such place within
   * TargetReach goes to the nearest place of the target. A warning names nodes that reach none. The
   * output has the point arrays `TargetDistanceBefore` and `TargetDistance`, NaN where nodes do not
   * move. With MOVE_PATCHES and no patch, the surfaces move that the target belongs to: each is
   * the nearest one for an area of the target of at least half its own. Default MOTION_TRANSFORM.
   */
  vtkSetClampMacro(Motion, int, MOTION_TRANSFORM, MOTION_TARGET);
  vtkGetMacro(Motion, int);
  void SetMotionToTransform() { this->SetMotion(MOTION_TRANSFORM); }
  void SetMotionToVector() { this->SetMotion(MOTION_VECTOR); }
  void SetMotionToAlongNormals() { this->SetMotion(MOTION_ALONG_NORMALS); }
  void SetMotionToArray() { this->SetMotion(MOTION_ARRAY); }
  void SetMotionToPlacement() { this->SetMotion(MOTION_PLACEMENT); }
  void SetMotionToRadius() { this->SetMotion(MOTION_RADIUS); }
  void SetMotionToTarget() { this->SetMotion(MOTION_TARGET); }
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
   * Name of a point array of the input with three components, in the unit of the points. Empty or
   * "None": none. Default: none.
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
   * bounding box of what moves. Off: Center, by default the origin.
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
   * How much the radius of the cylinders grows that move (MOTION_RADIUS), in the unit of the
   * points. A surface that is no cylinder, or that would lose its radius, is an error. Default 0.
   */
  virtual void SetRadiusChange(double value);
  vtkGetMacro(RadiusChange, double);
  ///@}

  ///@{
  /**
   * Whether the target is first rotated and shifted onto what moves, or onto the whole boundary
   * where the target says what moves. The mesh is not. See vtkIterativeClosestPointTransform; the
   * starts are the target's place, equal centres and equal principal axes. Default off.
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

  /**
   * The target of the last execution in triangles, as aligned; null without MOTION_TARGET.
   */
  vtkPolyData* GetFittedTarget();

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
    SURROUNDINGS_FOLLOW_ALL = 3,
    // The old names, until version 0.2.
    STAY = SURROUNDINGS_STAY,
    FOLLOW = SURROUNDINGS_FOLLOW,
    FADE = SURROUNDINGS_FADE
  };
  ///@{
  /**
   * What the nodes do that neither move nor are held. They stay. Or the surfaces follow that touch
   * what moves along an edge, curves first, as with vtkMorphBoundary, vertices being held, and the
   * others stay: a surface that only shares a vertex does not touch. Where the motion allows it to
   * 1 % of the largest displacement, a following surface keeps its own shape (plane, cylinder, or
   * its facets); else a warning says how far it leaves it. Or nodes fade: they follow the motion
   * the less, the farther they are from the nearest moving node, up to FalloffRadius. Or all
   * surfaces follow, whether they touch or not. Default SURROUNDINGS_FOLLOW.
   */
  vtkSetClampMacro(Surroundings, int, SURROUNDINGS_STAY, SURROUNDINGS_FOLLOW_ALL);
  vtkGetMacro(Surroundings, int);
  void SetSurroundingsToStay() { this->SetSurroundings(SURROUNDINGS_STAY); }
  void SetSurroundingsToFollow() { this->SetSurroundings(SURROUNDINGS_FOLLOW); }
  void SetSurroundingsToFade() { this->SetSurroundings(SURROUNDINGS_FADE); }
  void SetSurroundingsToFollowAll() { this->SetSurroundings(SURROUNDINGS_FOLLOW_ALL); }
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

  enum SurfaceMethods
  {
    SURFACE_METHOD_WEIGHTED_RESIDUAL = 0,
    SURFACE_METHOD_SMOOTHING = 1,
    // The old names, until version 0.2.
    WEIGHTED_RESIDUAL = SURFACE_METHOD_WEIGHTED_RESIDUAL,
    SMOOTHING = SURFACE_METHOD_SMOOTHING
  };
  ///@{
  /**
   * How surfaces follow; see vtkMorphBoundary. Default SURFACE_METHOD_WEIGHTED_RESIDUAL.
   */
  vtkSetClampMacro(SurfaceMethod, int, SURFACE_METHOD_WEIGHTED_RESIDUAL, SURFACE_METHOD_SMOOTHING);
  vtkGetMacro(SurfaceMethod, int);
  void SetSurfaceMethodToWeightedResidual()
  {
    this->SetSurfaceMethod(SURFACE_METHOD_WEIGHTED_RESIDUAL);
  }
  void SetSurfaceMethodToSmoothing() { this->SetSurfaceMethod(SURFACE_METHOD_SMOOTHING); }
  ///@}

  enum UnattachedMotions
  {
    UNATTACHED_AFFINELY = 0,
    UNATTACHED_RIGIDLY = 1,
    UNATTACHED_STAY = 2
  };
  ///@{
  /**
   * How closed curves without a vertex, and closed surfaces without a curve, follow if they have no
   * moving or held node; see vtkMorphBoundary. Default UNATTACHED_AFFINELY.
   */
  vtkSetClampMacro(UnattachedMotion, int, UNATTACHED_AFFINELY, UNATTACHED_STAY);
  vtkGetMacro(UnattachedMotion, int);
  void SetUnattachedMotionToFollowAffinely() { this->SetUnattachedMotion(UNATTACHED_AFFINELY); }
  void SetUnattachedMotionToFollowRigidly() { this->SetUnattachedMotion(UNATTACHED_RIGIDLY); }
  void SetUnattachedMotionToStay() { this->SetUnattachedMotion(UNATTACHED_STAY); }
  ///@}

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

  ///@{
  /**
   * The number of points with each Role in the last execution. 0 where there was no result.
   */
  vtkGetMacro(MovingPoints, vtkIdType);
  vtkGetMacro(HeldPoints, vtkIdType);
  vtkGetMacro(FollowingPoints, vtkIdType);
  vtkGetMacro(FreePoints, vtkIdType);
  vtkGetMacro(ZonePoints, vtkIdType);
  vtkGetMacro(LayerPoints, vtkIdType);
  ///@}

  ///@{
  /**
   * How often this object has found the boundary's geometry, evaluated the choice of what moves,
   * and computed the weights by which a surface follows or the boundary fades.
   */
  int GetClassifyCount() const;
  vtkGetMacro(ChooseCount, int);
  int GetPrepareCount() const;
  ///@}

protected:
  vtkBoundaryDisplacement();
  ~vtkBoundaryDisplacement() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkBoundaryDisplacement(const vtkBoundaryDisplacement&) = delete;
  void operator=(const vtkBoundaryDisplacement&) = delete;

  friend class vtkMorphMesh; // tells it the blocks of its mesh
  struct vtkInternals;
  std::unique_ptr<vtkInternals> Internals;

  void ResetResults();
  void Choose(vtkPointSet* input, vtkSelection* selection);

  int Moving = MOVE_EVERYTHING;
  char* MovingArray = nullptr;
  int ZoneRegionType = ZONE_NONE;
  int ZoneSelectionType = ZONE_NONE;
  int KeepLayers = 0;
  char* LayersArray = nullptr;
  int Motion = MOTION_TRANSFORM;
  double Vector[3] = { 0, 0, 0 };
  double Distance = 0;
  char* DisplacementArray = nullptr;
  double Translation[3] = { 0, 0, 0 };
  double Rotation[3] = { 0, 0, 0 };
  double Scale[3] = { 1, 1, 1 };
  bool AutoCenter = true;
  double Center[3] = { 0, 0, 0 };
  double RadiusChange = 0;
  bool AlignTarget = false;
  double TargetReach = 0.2;
  double TargetAngle = 60;
  double ScaleFactor = 1;
  int Surroundings = SURROUNDINGS_FOLLOW;
  double FalloffRadius = 0.1;
  int SurfaceMethod = SURFACE_METHOD_WEIGHTED_RESIDUAL;
  int UnattachedMotion = UNATTACHED_AFFINELY;
  double FeatureAngle = 25;
  double CornerAngle = 45;
  char* SurfaceIdArray = nullptr;
  bool UseGeometryArrays = true;
  int OutputPointsPrecision = DEFAULT_PRECISION;
  int NumberOfThreads = 0;
  int CoincidentPoints = 0;

  vtkIdType MovingPoints;
  vtkIdType HeldPoints;
  vtkIdType FollowingPoints;
  vtkIdType FreePoints;
  vtkIdType ZonePoints;
  vtkIdType LayerPoints;
  int ChooseCount = 0;
};

#endif
