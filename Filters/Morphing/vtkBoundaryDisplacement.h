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
 *   the input, onto a target surface, by handles, or by a lattice; each times ScaleFactor.
 * - Surroundings defines what the rest does. It stays, follows as with vtkMorphBoundary (curves
 *   first, then surfaces; vertices are held), or fades out with the distance from what moves.
 *   HeldPatches stay in any case, except for the nodes that they share with what moves. Mid-side
 *   and face nodes next to these keep their place between their corners.
 *
 * Port 0 takes the mesh (vtkUnstructuredGrid, or composite data, see vtkMorphAlgorithm), or its
 * boundary (vtkPolyData) as vtkExtractMorphBoundary, vtkClassifyBoundary or this filter writes it:
 * several of these filters in a row move several parts, each in its own way. Such a boundary moves
 * from its current position. Its geometry is that of its point arrays GeometryDimension and
 * GeometryId, or is found at its RestPosition. Port 1, optional, takes the vtkSelection of
 * MOVE_SELECTION. Selected cells move all of their nodes that are on the boundary. Port 2,
 * optional, takes the target of MOTION_TARGET (vtkPolyData, an STL file for instance). Port 3,
 * optional, takes the selection of a zone. Port 4, optional, takes the control points of
 * MOTION_HANDLES and MOTION_LATTICE.
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
 * An execution that is aborted gives an empty output and no message. Cost, where everything is
 * kept: a few passes over the boundary.
 *
 * With several MPI ranks all of them have to execute it. Of a mesh in pieces each rank gathers the
 * whole boundary, and keeps the part of its cells; ids are global, and the target is gathered, too.
 * Patches are then listed after the first execution. Errors there: zones, KeepLayers, picking in a
 * view, and a boundary instead of the mesh on port 0.
 *
 * M. L. Staten, S. J. Owen, S. M. Shontz, A. G. Salinger, T. S. Coffey, "A Comparison of Mesh
 * Morphing Methods for 3D Shape Optimization", Proc. 20th Int. Meshing Roundtable (2011) 293-311.
 *
 * Errors of handles and lattices: none at all, those in the same place, arrays or columns that are
 * missing, not numeric or of the wrong length, and control points outside of LatticeSize.
 *
 * @sa vtkDisplacementAlgorithm vtkMorphBoundary vtkClassifyBoundary vtkExtractMorphBoundary
 * vtkMorphAlgorithm
 */
#ifndef vtkBoundaryDisplacement_h
#define vtkBoundaryDisplacement_h

#include "vtkDisplacementAlgorithm.h"
#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro

#include <memory> // for std::unique_ptr

class vtkDataArraySelection;
class vtkDataObject;
class vtkDoubleArray;
class vtkExtractSelection;
class vtkPointSet;
class vtkPolyData;
class vtkSelection;
class vtkStringArray;

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkBoundaryDisplacement
  : public vtkDisplacementAlgorithm
{
public:
  static vtkBoundaryDisplacement* New();
  vtkTypeMacro(vtkBoundaryDisplacement, vtkDisplacementAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  vtkMTimeType GetMTime() override;
  void SetSelectionExtractor(vtkExtractSelection* extractor) override;

  /**
   * The displaced boundary.
   */
  vtkPolyData* GetOutput();

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

  enum Motions
  {
    MOTION_TRANSFORM = 0,
    MOTION_VECTOR = 1,
    MOTION_ALONG_NORMALS = 2,
    MOTION_ARRAY = 3,
    MOTION_PLACEMENT = 4,
    MOTION_RADIUS = 5,
    MOTION_TARGET = 6,
    MOTION_HANDLES = 7,
    MOTION_LATTICE = 8
  };
  ///@{
  /**
   * How it moves: by Transform, by Vector, by Distance along its normals, by DisplacementArray, by
   * Translation, Rotation and Scale, by RadiusChange, onto the target, by handles, or by a lattice.
   *
   * MOTION_TARGET: vertices go to the target's vertices, then curves to its feature edges, then
   * surfaces follow and go to the target, as with vtkMorphBoundary. What has no such place within
   * TargetReach goes to the nearest place of the target. A warning names nodes that reach none. The
   * output has the point arrays `TargetDistanceBefore` and `TargetDistance`, NaN where nodes do not
   * move. With MOVE_PATCHES and no patch, the surfaces move that the target belongs to: each is
   * the nearest one for an area of the target of at least half its own. Default MOTION_TRANSFORM.
   */
  vtkSetClampMacro(Motion, int, MOTION_TRANSFORM, MOTION_LATTICE);
  vtkGetMacro(Motion, int);
  void SetMotionToTransform() { this->SetMotion(MOTION_TRANSFORM); }
  void SetMotionToVector() { this->SetMotion(MOTION_VECTOR); }
  void SetMotionToAlongNormals() { this->SetMotion(MOTION_ALONG_NORMALS); }
  void SetMotionToArray() { this->SetMotion(MOTION_ARRAY); }
  void SetMotionToPlacement() { this->SetMotion(MOTION_PLACEMENT); }
  void SetMotionToRadius() { this->SetMotion(MOTION_RADIUS); }
  void SetMotionToTarget() { this->SetMotion(MOTION_TARGET); }
  void SetMotionToHandles() { this->SetMotion(MOTION_HANDLES); }
  void SetMotionToLattice() { this->SetMotion(MOTION_LATTICE); }
  ///@}

  /**
   * The target of the last execution in triangles, as aligned; null without MOTION_TARGET.
   */
  vtkPolyData* GetFittedTarget();

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

  int FillOutputPortInformation(int port, vtkInformation* info) override;
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
  int Motion = MOTION_TRANSFORM;
  int UnattachedMotion = UNATTACHED_AFFINELY;

  vtkIdType MovingPoints;
  vtkIdType HeldPoints;
  vtkIdType FollowingPoints;
  vtkIdType FreePoints;
  vtkIdType ZonePoints;
  vtkIdType LayerPoints;
  int ChooseCount = 0;
};

#endif
