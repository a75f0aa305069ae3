// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkMorphMesh
 * @brief   morphs a volume mesh in one step: what moves, how it moves, and by which method
 *
 * It is vtkBoundaryDisplacement and a morph filter in one. Port 0 takes the mesh
 * (vtkUnstructuredGrid, or composite data, see vtkMorphAlgorithm); port 1, optional, takes a
 * vtkSelection, and port 2, optional, the target surface of DISPLACEMENT_TARGET. Output 0 is the
 * morphed mesh, and output 1 its inverted cells. Both have the arrays of vtkMorphAlgorithm. Output
 * 2 (vtkPolyData) is the outer boundary, which a view can show in less time; see vtkMorphAlgorithm.
 *
 * - Moving defines what moves: surfaces, a selection, the inside of a region, everything, or the
 *   nodes that an array marks.
 * - Displacement defines how: by a transform, a vector, along the normals, or by an array.
 * - Surroundings defines what the rest of the boundary does. FixedSurfaces stay.
 * - Method defines how the interior nodes follow.
 *
 * With MOVE_SURFACES (the default) and no surface chosen, the selection moves if there is one.
 * Without either nothing is morphed, and nothing is wrong. Output 0 then has the faces of the
 * boundary as cells, with the cell array `SurfaceId`, on the points of the mesh. MorphStatus is
 * "None". SurfaceList has the names of the surfaces.
 *
 * Inverted cells are repaired by default (Validity). With Live on, as while a box is dragged, they
 * are shown and counted, and not repaired.
 *
 * The boundary, its surfaces, and what the method prepares are kept from one motion to the next, as
 * the filters inside keep them. A result does not depend on what was kept.
 *
 * RequestInformation reads the input's data where they are up to date, so that a window can list
 * the surfaces before the first execution; see vtkBoundaryDisplacement.
 *
 * Time: a mesh that varies in time is taken at RestTime. The outputs have the time steps of
 * NumberOfSteps.
 *
 * After an error there is one message, and output 0 is the undeformed mesh. MorphStatus is then
 * "Failed", and InvertedCells and MinScaledJacobian are -1. The errors and warnings are those of
 * vtkBoundaryDisplacement and vtkMorphAlgorithm.
 *
 * With several MPI ranks all of them have to execute it. The mesh may be in pieces on them: results
 * are then those of the whole mesh, surfaces are listed after the first execution, and soft zones
 * are an error.
 *
 * @sa vtkDisplacementAlgorithm vtkBoundaryDisplacement vtkMorphAlgorithm vtkFEMWarpMorph
 */
#ifndef vtkMorphMesh_h
#define vtkMorphMesh_h

#include "vtkDisplacementAlgorithm.h"
#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro

#include <memory> // for std::unique_ptr

class vtkDataArraySelection;
class vtkDataObject;
class vtkDoubleArray;
class vtkMorphAlgorithm;
class vtkPolyData;
class vtkSelection;
class vtkStringArray;
class vtkUnstructuredGrid;

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkMorphMesh : public vtkDisplacementAlgorithm
{
public:
  static vtkMorphMesh* New();
  vtkTypeMacro(vtkMorphMesh, vtkDisplacementAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  vtkMTimeType GetMTime() override;

  ///@{
  /**
   * The morphed mesh, and its inverted cells.
   */
  vtkUnstructuredGrid* GetOutput();
  vtkUnstructuredGrid* GetOutput(int port);
  ///@}

  enum MovingParts
  {
    MOVE_SURFACES = 0,
    MOVE_SELECTION = 1,
    MOVE_REGION = 2,
    MOVE_EVERYTHING = 3,
    MOVE_ARRAY = 4
  };
  ///@{
  /**
   * What moves: the surfaces of AddSurface() or, where there is none, the selection; the selection;
   * what is inside Region; the whole boundary; nodes where MovingArray is not zero. Default
   * MOVE_SURFACES.
   */
  vtkSetClampMacro(Moving, int, MOVE_SURFACES, MOVE_ARRAY);
  vtkGetMacro(Moving, int);
  void SetMovingToSurfaces() { this->SetMoving(MOVE_SURFACES); }
  void SetMovingToSelection() { this->SetMoving(MOVE_SELECTION); }
  void SetMovingToRegion() { this->SetMoving(MOVE_REGION); }
  void SetMovingToEverything() { this->SetMoving(MOVE_EVERYTHING); }
  void SetMovingToArray() { this->SetMoving(MOVE_ARRAY); }
  ///@}

  ///@{
  /**
   * The surfaces (or curves) that move, by name: "Surface 3", "Curve 7", with the ids that
   * vtkClassifyBoundary writes, or a name of the mesh; see vtkBoundaryDisplacement. A status other
   * than 0 adds one, and 0 removes it. Default: none.
   */
  void SetSurfaceStatus(const char* name, int status);
  void AddSurface(const char* name) { this->SetSurfaceStatus(name, 1); }
  void RemoveAllSurfaces();
  ///@}

  ///@{
  /**
   * The surfaces (or curves) that stay, by name. A node that moves is not held. Default: none.
   */
  void SetFixedSurfaceStatus(const char* name, int status);
  void AddFixedSurface(const char* name) { this->SetFixedSurfaceStatus(name, 1); }
  void RemoveAllFixedSurfaces();
  ///@}

  ///@{
  /**
   * The surfaces that slide, by name: their nodes move along the surface's undeformed shape, moving
   * nodes too. For planes of symmetry. Default: none.
   */
  void SetSlidingSurfaceStatus(const char* name, int status);
  void AddSlidingSurface(const char* name) { this->SetSlidingSurfaceStatus(name, 1); }
  void RemoveAllSlidingSurfaces();
  ///@}

  ///@{
  /**
   * The surfaces that are free, by name: their nodes are solved with the interior. A node is free
   * only if all of its surfaces are, and if it neither moves nor is fixed. Default: none.
   */
  void SetFreeSurfaceStatus(const char* name, int status);
  void AddFreeSurface(const char* name) { this->SetFreeSurfaceStatus(name, 1); }
  void RemoveAllFreeSurfaces();
  ///@}

  ///@{
  /**
   * Zones that give way more than the rest, by the name of a point array, a cell array or a block.
   * ZoneRegionType and ZoneSelectionType may be ZONE_SOFT, too. The stiffness of soft cells is
   * multiplied by SoftStiffness; with methods other than FEMWARP, soft zones are an error. Default:
   * none.
   */
  void SetSoftZoneStatus(const char* name, int status);
  void AddSoftZone(const char* name) { this->SetSoftZoneStatus(name, 1); }
  void RemoveAllSoftZones();
  ///@}

  ///@{
  /**
   * The factor of the stiffness of soft zones. Default 0.01, range [1e-6, 1].
   */
  virtual void SetSoftStiffness(double value);
  vtkGetMacro(SoftStiffness, double);
  ///@}

  ///@{
  /**
   * The stiffness of the cells for FEMWARP: see vtkFEMWarpMorph. Other methods have none, and a
   * warning says so. Defaults STIFFNESS_UNIFORM, 1, none, none.
   */
  vtkSetClampMacro(Stiffness, int, 0, 2);
  vtkGetMacro(Stiffness, int);
  virtual void SetStiffnessExponent(double value);
  vtkGetMacro(StiffnessExponent, double);
  vtkSetStringMacro(StiffnessArray);
  vtkGetStringMacro(StiffnessArray);
  vtkSetStringMacro(WallArray);
  vtkGetStringMacro(WallArray);
  ///@}

  /**
   * Names of all surfaces and curves, surfaces first, as a list to choose from, with nothing
   * enabled. They are those of the last execution or, after an update of the information, of input
   * data that are up to date.
   */
  vtkDataArraySelection* GetSurfaceList();

  /**
   * Writes into `names` all names of GetSurfaceList(), and enables the surfaces that a selection
   * lies on. `shown`: the data that were selected on: the input or an output. See
   * vtkBoundaryDisplacement::FindPatches().
   */
  void FindSurfaces(vtkDataObject* shown, vtkSelection* selection, vtkDataArraySelection* names);

  /**
   * Makes `output` the polygons and lines of the surfaces and curves that are enabled in `names`,
   * where output 0 has them or, before the first execution, undeformed.
   */
  void CopySurfaces(vtkDataArraySelection* names, vtkPolyData* output);

  ///@{
  /**
   * FindSurfaces() for ParaView's window: an algorithm whose first output is the selection, and the
   * output of this filter that it is of, or -1, the default, for the input. Neither causes an
   * execution.
   */
  void SetPick(vtkAlgorithm* selection);
  void SetPickPort(int port);
  int GetPickPort() const;
  vtkDataArraySelection* GetPickedSurfaces();
  ///@}

  /**
   * The size of each entry of the list: its name, how many faces it has, and their area, three
   * strings each. Of a curve: edges and length.
   */
  vtkStringArray* GetSurfaceSizes();

  /**
   * The bounding box of each entry of the list, undeformed: six numbers as in
   * vtkDataSet::GetBounds().
   */
  vtkDoubleArray* GetSurfaceBounds();

  enum Displacements
  {
    DISPLACEMENT_TRANSFORM = 0,
    DISPLACEMENT_VECTOR = 1,
    DISPLACEMENT_NORMALS = 2,
    DISPLACEMENT_ARRAY = 3,
    DISPLACEMENT_PLACEMENT = 4,
    DISPLACEMENT_RADIUS = 5,
    DISPLACEMENT_TARGET = 6,
    DISPLACEMENT_HANDLES = 7,
    DISPLACEMENT_LATTICE = 8
  };
  ///@{
  /**
   * How it moves: by Transform, by Vector, by Distance along its normals, by DisplacementArray,
   * by Translation, Rotation and Scale, by RadiusChange, onto the target, by handles, or by a
   * lattice; each times ScaleFactor. See vtkBoundaryDisplacement. Default DISPLACEMENT_TRANSFORM.
   *
   * With handles or a lattice, MOVE_SURFACES, no surface chosen and no selection that moves,
   * everything moves.
   *
   * DISPLACEMENT_TARGET with no surface chosen and no selection moves the surfaces that the target
   * belongs to. The mesh then has the point arrays `TargetDistanceBefore` and
   * `TargetDistance`, NaN where nodes do not move.
   */
  vtkSetClampMacro(Displacement, int, DISPLACEMENT_TRANSFORM, DISPLACEMENT_LATTICE);
  vtkGetMacro(Displacement, int);
  void SetDisplacementToTransform() { this->SetDisplacement(DISPLACEMENT_TRANSFORM); }
  void SetDisplacementToVector() { this->SetDisplacement(DISPLACEMENT_VECTOR); }
  void SetDisplacementToNormals() { this->SetDisplacement(DISPLACEMENT_NORMALS); }
  void SetDisplacementToArray() { this->SetDisplacement(DISPLACEMENT_ARRAY); }
  void SetDisplacementToPlacement() { this->SetDisplacement(DISPLACEMENT_PLACEMENT); }
  void SetDisplacementToRadius() { this->SetDisplacement(DISPLACEMENT_RADIUS); }
  void SetDisplacementToTarget() { this->SetDisplacement(DISPLACEMENT_TARGET); }
  void SetDisplacementToHandles() { this->SetDisplacement(DISPLACEMENT_HANDLES); }
  void SetDisplacementToLattice() { this->SetDisplacement(DISPLACEMENT_LATTICE); }
  ///@}

  enum Methods
  {
    METHOD_FEMWARP = 0,
    METHOD_LBWARP = 1,
    METHOD_WEIGHTED_RESIDUAL = 2,
    METHOD_SIMPLEX_LINEAR = 3,
    METHOD_SIMPLEX_NATURAL_NEIGHBOR = 4,
    METHOD_SMOOTHING = 5,
    METHOD_INVERSION_FREE = 6,
    METHOD_RADIAL_BASIS = 7
  };
  ///@{
  /**
   * The method by which the interior nodes follow. Default METHOD_FEMWARP.
   */
  virtual void SetMethod(int method);
  vtkGetMacro(Method, int);
  ///@}

  /**
   * The filter of the method, for options of its own (vtkFEMWarpMorph::SetTolerance(), for
   * instance). The properties that this class has too are set by it at each execution. SetMethod()
   * to another method makes a new one.
   */
  vtkMorphAlgorithm* GetMethodFilter();

  ///@{
  /**
   * What to do where the method leaves inverted cells: vtkMorphAlgorithm::VALIDITY_NONE and so on.
   * Default VALIDITY_REPAIR.
   */
  vtkSetClampMacro(Validity, int, 0, 5);
  vtkGetMacro(Validity, int);
  ///@}

  ///@{
  /**
   * Whether the motion is being dragged: inverted cells are then shown and counted, whatever
   * Validity says, and there are no warnings. A window sets it while a box is dragged, and resets
   * it on release. Default off.
   */
  vtkSetMacro(Live, bool);
  vtkGetMacro(Live, bool);
  vtkBooleanMacro(Live, bool);
  ///@}

  enum QualityType
  {
    QUALITY_ALL = 0,
    QUALITY_SURFACE = 1
  };
  ///@{
  /**
   * The cells that are measured; see vtkMorphAlgorithm. Default QUALITY_ALL.
   */
  vtkSetClampMacro(Quality, int, QUALITY_ALL, QUALITY_SURFACE);
  vtkGetMacro(Quality, int);
  void SetQualityToAll() { this->SetQuality(QUALITY_ALL); }
  void SetQualityToSurface() { this->SetQuality(QUALITY_SURFACE); }
  ///@}

  ///@{
  /**
   * Whether output 2 has lines along the edges at which the undeformed faces turn by more than 25
   * degrees. They come before the polygons; their MorphCellId is -1 and their ScaledJacobian NaN.
   * Default off.
   */
  vtkSetMacro(FeatureLines, bool);
  vtkGetMacro(FeatureLines, bool);
  vtkBooleanMacro(FeatureLines, bool);
  ///@}

  ///@{
  /**
   * See vtkMorphAlgorithm. Defaults 0, Absolute.
   */
  vtkSetClampMacro(NumberOfSteps, int, 0, 1000000);
  vtkGetMacro(NumberOfSteps, int);
  vtkSetClampMacro(Stepping, int, 0, 1);
  vtkGetMacro(Stepping, int);
  ///@}

  ///@{
  /**
   * The time at which a mesh that varies in time is undeformed: the last of its time steps that is
   * not after it, or the first step. Default -1e300, so the first.
   */
  virtual void SetRestTime(double value);
  vtkGetMacro(RestTime, double);
  ///@}

  ///@{
  /**
   * Results of the last execution; see vtkMorphAlgorithm.
   */
  const char* GetMorphStatus() const;
  double GetMinScaledJacobian() const;
  double GetMeanScaledJacobian() const;
  double GetWorstMeanScaledJacobian() const;
  double GetBoundaryMinimum() const;
  vtkIdType GetInvertedCells() const;
  vtkIdType GetDegenerateCells() const;
  vtkIdType GetInvertedBefore() const;
  vtkIdType GetNewInvertedCells() const;
  vtkIdType GetWorstCellId() const;
  vtkIdType GetSurfaceInvertedCells() const;
  vtkIdType GetBoundaryInvertedCells() const;
  vtkIdType GetMirroredBodies() const;
  vtkIdType GetCertifiedCells() const;
  vtkIdType GetUncertifiedCells() const;
  vtkIdType GetUndecidedCells() const;
  double GetLargestValidStep() const;
  double GetPrepareSeconds() const;
  double GetEvaluateSeconds() const;
  vtkIdType GetSubSteps() const;
  int GetPrepareCount() const;
  vtkIdType GetPrescribedPoints() const;
  vtkIdType GetUnmatchedPoints() const;
  vtkIdType GetAttachedPoints() const;
  vtkIdType GetZonePoints() const;
  vtkIdType GetLayerPoints() const;
  int GetSolverIterations() const;
  ///@}

  /**
   * What to do where nothing moves yet, since no surface, selection, handle or target is given.
   * Else "None".
   */
  const char* GetAdvice() const;

  ///@{
  /**
   * The distance from the target (as aligned) of the nodes that move, before and after the motion,
   * in the unit of the points; each node counts once. -1 without DISPLACEMENT_TARGET.
   */
  double GetMaxTargetDistanceBefore() const;
  double GetMeanTargetDistanceBefore() const;
  double GetMaxTargetDistance() const;
  double GetMeanTargetDistance() const;
  ///@}

  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

protected:
  vtkMorphMesh();
  ~vtkMorphMesh() override;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkMorphMesh(const vtkMorphMesh&) = delete;
  void operator=(const vtkMorphMesh&) = delete;

  class vtkInternals;
  std::unique_ptr<vtkInternals> Internals;

  int Moving = MOVE_SURFACES;
  double SoftStiffness = 0.01;
  int Stiffness = 0;
  double StiffnessExponent = 1;
  char* StiffnessArray = nullptr;
  char* WallArray = nullptr;
  int Displacement = DISPLACEMENT_TRANSFORM;
  int Method = METHOD_FEMWARP;
  int Validity = 3;
  int Quality = QUALITY_ALL;
  bool FeatureLines = false;
  bool Live = false;
  int NumberOfSteps = 0;
  int Stepping = 0;
  double RestTime = -1e300;
};

#endif
