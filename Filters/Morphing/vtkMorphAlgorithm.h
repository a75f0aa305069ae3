// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkMorphAlgorithm
 * @brief   moves the nodes of a volume mesh so that it follows a displaced boundary
 *
 * It is the superclass of all morphing filters. Port 0 takes the undeformed mesh
 * (vtkUnstructuredGrid), port 1 the displaced boundary (vtkPointSet). Output 0 has the mesh's cells
 * and arrays, and new points. Boundary nodes go where port 1 puts them; interior nodes follow by
 * the subclass's method. The inputs are never modified.
 *
 * Port 0 also takes composite data (vtkMultiBlockDataSet, vtkPartitionedDataSetCollection, ...).
 * Output 0 is then composite data of the same structure, and GetOutput() is null;
 * GetOutputDataObject(0) has it. The blocks with volume cells are one mesh, whose nodes are the
 * points that coincide, see CoincidentPoints. Names, metadata, field data and arrays of the blocks
 * stay. Surfaces, side sets and node sets move with the nodes at their points. Blocks without a
 * point at a node pass unchanged, and a warning counts them. Volume cells of a vtkStructuredGrid,
 * vtkRectilinearGrid or vtkImageData come out as a vtkStructuredGrid. Cells of two blocks with the
 * same nodes, such as ghost cells, are one cell.
 *
 * All node and cell ids, in messages and arrays, are those of the merged mesh. Where all blocks
 * have global ids, nodes and cells are in the order of these, else in that of the blocks. The
 * blocks get them as the point array `MorphPointId` and the cell array `MorphCellId`; output 1
 * names the block by its flat index, in the cell array `MorphBlockId`. Numbers are field data of
 * output 0 itself, not of its blocks. Port 1 takes a moved copy of the blocks, or pieces of a
 * boundary, as composite data; points of one node have to move alike.
 *
 * Boundary points are matched to nodes by the first of these that exists:
 * 1. the point array named by BoundaryIdArray;
 * 2. the point array `MorphPointId`, which vtkExtractMorphBoundary writes;
 * 3. the point's own number, if port 1 has as many points as the mesh. Only nodes on the outer
 *    boundary are then prescribed, since the interior of a warped copy of the mesh is arbitrary;
 * 4. the point array `PointIds`, as ParaView's Generate Ids writes it;
 * 5. the point array `vtkOriginalPointIds`, with a warning, since filters pass it on after it has
 *    lost its meaning;
 * 6. if DisplacementArray is set, the node nearest to the point, within MatchTolerance. Nodes on
 *    the outer boundary within MatchTolerance of that node, as where two bodies touch, move with it
 *    unless they have a point of their own.
 *
 * If port 1 has a point array `RestPosition` (the first three components count), ids are verified
 * against it. Interior nodes may be prescribed too. A node may be named more than once if the
 * targets agree within MatchTolerance; the first one counts.
 *
 * Targets are the points of port 1; what differs by their rounding alone stays. With a
 * DisplacementArray they are the nodes plus it. NaN, or vtkValidPointMask 0, frees a node.
 *
 * Output 0 has the point vectors `MorphDisplacement`; the cell array `ScaledJacobian` (active
 * scalars; see vtkScaledJacobian), computed on the points as written; and the field data
 * MinScaledJacobian, MeanScaledJacobian, WorstMeanScaledJacobian, BoundaryMinimum, InvertedCells,
 * DegenerateCells, InvertedBefore, NewInvertedCells, WorstCellId, BoundaryInvertedCells,
 * MirroredBodies, PrepareSeconds, EvaluateSeconds, SolverIterations, MorphStatus and
 * LargestValidStep. The same numbers have getters after an execution. Mid-side, face and body nodes
 * of quadratic cells that are not prescribed keep their place in the cell. Nodes of shells, beams
 * and links that no volume cell uses follow the volume to which their cells attach them: rigidly
 * where that is at one node, else smoothly between these; those attached to nothing stay, with a
 * warning. Cells of lower dimension pass through. Normals do not.
 *
 * Output 1 holds the inverted and degenerate cells of output 0 (ScaledJacobian of 0 or less) with
 * their points and arrays. The cell array `MorphCellId` and the point array `MorphPointId` are
 * added, ids in output 0. It is empty if there are no such cells.
 *
 * Output 2 (vtkPolyData) is the outer boundary of output 0, to be shown in place of it: a view of
 * the mesh has to find its surface after each motion. Its polygons are the same object as long as
 * the mesh has the same cells, so that only points and colors change. It has the point array
 * MorphPointId and the cell arrays MorphCellId and ScaledJacobian, that of the cell behind each
 * face. After an error it is the undeformed boundary, or empty if there is none.
 *
 * What the method prepares (a matrix and its preconditioner, weights, ...) is kept. It is reused
 * while the undeformed points, the cells, the set of prescribed nodes and the method's options have
 * the same content, whatever their modification times. Moving the same boundary again then costs
 * only the evaluation; see GetPrepareCount().
 *
 * Time: the outputs have the time steps of port 1, or NumberOfSteps of their own if port 1 does not
 * vary in time. Port 0 is always asked for RestTime. Stepping defines whether a step starts from
 * the undeformed mesh or from the mesh of the step before.
 *
 * After an error there is one message, and output 0 is the undeformed mesh of port 0, or empty if
 * that cannot be read. MorphStatus is then "Failed", and InvertedCells and MinScaledJacobian are
 * -1. RequestData still returns 1: after a 0 VTK's executive adds a message of its own. Errors:
 * overlapping AMR; no points or no volume cells; cells other than tetrahedra, hexahedra, wedges,
 * pyramids, quadratic ones and polyhedra; no way to match the boundary; a node with two targets;
 * ids that RestPosition contradicts. On any port: an array with fewer values than there are points
 * or cells; cells that name points that do not exist; coordinates that are not finite or above
 * 1e50; an extent below 1e-50 other than 0; motions beyond 1e50, and in single precision beyond
 * 3.4e38. An execution that is aborted gives the undeformed mesh (MorphStatus "Cancelled", the same
 * -1) and no message. Inverted cells alone are no error: see Validity.
 *
 * A property that is a floating-point number accepts neither NaN, nor infinity, nor values outside
 * its range: the setter raises an error, and the old value stays. Integers outside their range
 * become the nearest bound, as usual in VTK.
 *
 * The pipeline may have left a port's data at another time than is needed: one reader feeds both
 * ports, or relative steps were skipped. The filter then updates its input from within RequestData.
 * CONTINUE_EXECUTING is not used: VTK's executive repeats without end if the input fails in a
 * repeated execution.
 *
 * With several MPI ranks all of them have to execute it. Results are those of the whole mesh.
 *
 * M. L. Staten, S. J. Owen, S. M. Shontz, A. G. Salinger, T. S. Coffey, "A comparison of mesh
 * morphing methods for 3D shape optimization", Proc. 20th Int. Meshing Roundtable (2011) 293-311.
 *
 * @sa vtkExtractMorphBoundary vtkFEMWarpMorph vtkScaledJacobian
 */
#ifndef vtkMorphAlgorithm_h
#define vtkMorphAlgorithm_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro

#include <vtkUnstructuredGridAlgorithm.h>

#include <memory> // for std::unique_ptr
#include <string> // for std::string

namespace morph
{
class Monitor;
class Morpher;
}

class vtkDataArray;
class vtkDoubleArray;
class vtkPointSet;

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkMorphAlgorithm : public vtkUnstructuredGridAlgorithm
{
public:
  vtkTypeMacro(vtkMorphAlgorithm, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The displaced boundary, a vtkPointSet: the same as SetInputConnection() and SetInputData() on
   * port 1.
   */
  void SetBoundaryConnection(vtkAlgorithmOutput* output);
  void SetBoundaryData(vtkDataObject* boundary);
  ///@}

  ///@{
  /**
   * Name of the point array of port 1 with the id of a node of port 0 for each point: one
   * component, whole numbers. Empty or "None": use the arrays named in the class description.
   * Default: none.
   */
  vtkSetStringMacro(BoundaryIdArray);
  vtkGetStringMacro(BoundaryIdArray);
  ///@}

  ///@{
  /**
   * Name of a point array of port 1 with three components, in the unit of the points: nodes go to
   * their undeformed position plus this vector. Empty or "None": they go to the points of port 1.
   * Default: none.
   */
  vtkSetStringMacro(DisplacementArray);
  vtkGetStringMacro(DisplacementArray);
  ///@}

  ///@{
  /**
   * The factor of the boundary's motion: target = rest + ScaleFactor (target - rest). 0 gives the
   * undeformed positions and 1 the targets, bit for bit. Default 1, any finite number.
   */
  virtual void SetScaleFactor(double value);
  vtkGetMacro(ScaleFactor, double);
  ///@}

  ///@{
  /**
   * The number of equal steps of a boundary that does not vary in time. The output then has the
   * time steps 0 (undeformed), 1, ..., NumberOfSteps, and at step i the boundary has made i /
   * NumberOfSteps of ScaleFactor's motion. Between steps the one before counts; without a time, the
   * last. A boundary with several time steps keeps them, and this has no effect. One with a time
   * range alone is taken at the ends of that many equal parts of it. Default 0: no steps. Range [0,
   * 1000000]; values outside become the nearest bound.
   */
  vtkSetClampMacro(NumberOfSteps, int, 0, 1000000);
  vtkGetMacro(NumberOfSteps, int);
  ///@}

  enum SteppingType
  {
    STEPPING_ABSOLUTE = 0,
    STEPPING_RELATIVE = 1
  };

  ///@{
  /**
   * The mesh from which a step starts. Absolute: the undeformed mesh. Relative: the mesh of the
   * step before, in double precision, for which the method is prepared again; the first step starts
   * from the undeformed mesh. The undeformed mesh remains the reference of the measures and of
   * vtkInversionFreeMorph's targets. A relative step does not depend on the steps that were asked
   * for: missing ones are computed, the boundary being asked for their times (on several MPI ranks
   * for a distributed mesh only). PrepareSeconds and EvaluateSeconds are those of the last step
   * alone, 0 where it was kept. Has no effect without steps. Default Absolute.
   */
  vtkSetClampMacro(Stepping, int, STEPPING_ABSOLUTE, STEPPING_RELATIVE);
  vtkGetMacro(Stepping, int);
  void SetSteppingToAbsolute() { this->SetStepping(STEPPING_ABSOLUTE); }
  void SetSteppingToRelative() { this->SetStepping(STEPPING_RELATIVE); }
  ///@}

  ///@{
  /**
   * The memory for the meshes of a relative run in megabytes (10^6 bytes), 24 bytes a node and
   * step. Beyond it every other mesh is dropped, and going back to it repeats some steps; the
   * result does not depend on it. The last mesh is always kept. Default 1000, range [0, 1e12].
   */
  virtual void SetStepMemoryLimit(double value);
  vtkGetMacro(StepMemoryLimit, double);
  ///@}

  ///@{
  /**
   * The largest distance of a boundary point from its node: of its RestPosition or, where nodes are
   * found by position, of the point itself. In units of the diagonal of the bounding box of the
   * volume cells' nodes. Default 1e-6, range [0, 1].
   */
  virtual void SetMatchTolerance(double value);
  vtkGetMacro(MatchTolerance, double);
  ///@}

  ///@{
  /**
   * Whether nodes on the mesh's outer faces that port 1 does not name are held. Mid-side and face
   * nodes of quadratic cells are held only where all corners of their edge or face are; the others
   * keep their place in the cell. Off: they are solved for like the interior nodes, and leave the
   * original surface. Default on.
   */
  vtkSetMacro(HoldUnnamedBoundary, bool);
  vtkGetMacro(HoldUnnamedBoundary, bool);
  vtkBooleanMacro(HoldUnnamedBoundary, bool);
  ///@}

  enum ValidityType
  {
    VALIDITY_NONE = 0,
    VALIDITY_REPORT = 1,
    VALIDITY_SUB_STEP = 2,
    VALIDITY_REPAIR = 3,
    VALIDITY_REFUSE = 4,
    VALIDITY_REPAIR_ALL = 5
  };

  ///@{
  /**
   * What to do where the method makes inverted or degenerate cells. Those that were so before, and
   * are no worse, count apart (GetInvertedBefore()), with a warning but for None and RepairAll.
   * None: nothing; InvertedCells counts them.
   * Report: a warning names the ten worst of them.
   * SubStep: halve the motion, and continue from the last valid mesh, for which the method is
   * prepared again at each step.
   * Repair: minimise the energy of vtkInversionFreeMorph, starting from the method's mesh; if that
   * fails, sub-steps of vtkInversionFreeMorph.
   * Refuse: an error that names them, and the undeformed mesh.
   * RepairAll: as Repair, also for cells that were inverted or degenerate before.
   *
   * All but the first two refuse at once a boundary that inverts cells by itself, at corners whose
   * nodes are all prescribed; the error names these cells. SubStep, Repair and RepairAll may find
   * no valid mesh for the whole motion. There is an error then, but the output is the valid mesh of
   * the largest step that was reached; see MorphStatus. Default Report.
   */
  vtkSetClampMacro(Validity, int, VALIDITY_NONE, VALIDITY_REPAIR_ALL);
  vtkGetMacro(Validity, int);
  void SetValidityToNone() { this->SetValidity(VALIDITY_NONE); }
  void SetValidityToReport() { this->SetValidity(VALIDITY_REPORT); }
  void SetValidityToSubStep() { this->SetValidity(VALIDITY_SUB_STEP); }
  void SetValidityToRepair() { this->SetValidity(VALIDITY_REPAIR); }
  void SetValidityToRefuse() { this->SetValidity(VALIDITY_REFUSE); }
  void SetValidityToRepairAll() { this->SetValidity(VALIDITY_REPAIR_ALL); }
  ///@}

  enum QualityType
  {
    QUALITY_ALL = 0,
    QUALITY_SURFACE = 1
  };
  ///@{
  /**
   * The cells that are measured: all, or those behind the outer faces alone, which is faster while
   * a boundary is dragged. With the latter output 0 has neither ScaledJacobian nor certificates,
   * output 1 is empty, MorphStatus is "Unmeasured", no cell is reported, and of the measures there
   * is SurfaceInvertedCells alone. Where Validity is neither None nor Report all cells are measured
   * always. Default QUALITY_ALL.
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
   * Whether to prove for each cell of the output that its Jacobian determinant is positive
   * everywhere, not only at its corners. The cell array JacobianCertificate is 1 certified, 0
   * undecided, -1 inverted; the field data are CertifiedCells, UncertifiedCells and UndecidedCells;
   * see vtkScaledJacobian. Cost: about a microsecond a cell. Default off, in vtkInversionFreeMorph
   * on.
   */
  vtkSetMacro(Certify, bool);
  vtkGetMacro(Certify, bool);
  vtkBooleanMacro(Certify, bool);
  ///@}

  ///@{
  /**
   * The maximum number of sub-steps, failed ones included. Default 64, range [1, VTK_INT_MAX].
   */
  vtkSetClampMacro(MaximumSubSteps, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaximumSubSteps, int);
  ///@}

  ///@{
  /**
   * Whether to smooth the method's mesh before Validity checks it. Prescribed nodes stay, inverted
   * cells are untangled if possible, and then cells are improved, on average, towards their
   * undeformed shapes (see vtkSmoothingMorph, TargetShape Initial). A smoothed mesh with more
   * inverted cells, or as many and a lower minimum scaled Jacobian, is discarded. The field data
   * PostSmoothSteps has the steps that led to the output, 0 where it was discarded. Default off.
   */
  vtkSetMacro(PostSmooth, bool);
  vtkGetMacro(PostSmooth, bool);
  vtkBooleanMacro(PostSmooth, bool);
  ///@}

  ///@{
  /**
   * The maximum number of steps of PostSmooth, in each of which every node moves once. It ends
   * earlier once no node moves farther than a thousandth of its edges. Default 20, range [1,
   * 100000].
   */
  vtkSetClampMacro(PostSmoothIterations, int, 1, 100000);
  vtkGetMacro(PostSmoothIterations, int);
  ///@}

  ///@{
  /**
   * The time at which port 0 is undeformed: the last of its time steps that is not after it, or the
   * first step if all are after it. Default -1e300, so the first. Has no effect if port 0 has no
   * time steps.
   */
  virtual void SetRestTime(double value);
  vtkGetMacro(RestTime, double);
  ///@}

  ///@{
  /**
   * Threads to compute with, by the backend of vtkSMPTools or, if that is Sequential (ParaView's
   * default), by std::threads. 0 means as many as the backend has, or all cores. The result depends
   * neither on it nor on the backend. Default 0, range [0, VTK_INT_MAX].
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, VTK_INT_MAX);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  enum CoincidentPointsType
  {
    COINCIDENT_POINTS_MERGE = 0,
    COINCIDENT_POINTS_MERGE_BY_POSITION = 1,
    COINCIDENT_POINTS_KEEP_APART = 2
  };

  ///@{
  /**
   * Which points of the blocks of composite data are one node; see the class description.
   * Merge: those with equal global ids, where blocks have them; else those with equal coordinates.
   * MergeByPosition: those with equal coordinates, whatever their ids.
   * KeepApart: none. Bodies in contact whose nodes coincide, and cracks between blocks, stay apart;
   * so do blocks that are one body.
   *
   * With Merge, bodies in contact stay apart if their nodes have global ids of their own. Points of
   * one unstructured block that coincide without a common id, such as the sides of a crack, are
   * never one node. Those of a structured block are, since it has no other way to close a seam.
   * Default COINCIDENT_POINTS_MERGE.
   */
  vtkSetClampMacro(CoincidentPoints, int, COINCIDENT_POINTS_MERGE, COINCIDENT_POINTS_KEEP_APART);
  vtkGetMacro(CoincidentPoints, int);
  void SetCoincidentPointsToMerge() { this->SetCoincidentPoints(COINCIDENT_POINTS_MERGE); }
  void SetCoincidentPointsToMergeByPosition()
  {
    this->SetCoincidentPoints(COINCIDENT_POINTS_MERGE_BY_POSITION);
  }
  void SetCoincidentPointsToKeepApart() { this->SetCoincidentPoints(COINCIDENT_POINTS_KEEP_APART); }
  ///@}

  ///@{
  /**
   * Type of the output's points: vtkAlgorithm::SINGLE_PRECISION, DOUBLE_PRECISION, or
   * DEFAULT_PRECISION for that of the input's (double where they are neither). Computation is
   * always in double. Default DEFAULT_PRECISION.
   */
  vtkSetClampMacro(OutputPointsPrecision, int, SINGLE_PRECISION, DEFAULT_PRECISION);
  vtkGetMacro(OutputPointsPrecision, int);
  ///@}

  ///@{
  /**
   * Quality of the output of the last execution; see vtkScaledJacobian. The worst mean is that of
   * the worst 1 % of the cells. Without a result the means are NaN and the others are -1, so that
   * no test for 0 passes after an error.
   */
  double GetMinScaledJacobian() const { return this->GetNumber("MinScaledJacobian"); }
  double GetMeanScaledJacobian() const { return this->GetNumber("MeanScaledJacobian"); }
  double GetWorstMeanScaledJacobian() const { return this->GetNumber("WorstMeanScaledJacobian"); }
  vtkIdType GetInvertedCells() const { return this->GetInteger("InvertedCells"); }
  vtkIdType GetDegenerateCells() const { return this->GetInteger("DegenerateCells"); }
  vtkIdType GetWorstCellId() const { return this->GetInteger("WorstCellId"); }
  ///@}

  ///@{
  /**
   * The cells that were inverted or degenerate before the last execution, and those that it has
   * made so: all that were valid before, and of the others those that are worse. A cell is worse
   * where a place that was positive, a corner for instance, is 0 or negative. -1 without a result.
   */
  vtkIdType GetInvertedBefore() const { return this->GetInteger("InvertedBefore"); }
  vtkIdType GetNewInvertedCells() const { return this->GetInteger("NewInvertedCells"); }
  ///@}

  /**
   * The minimum scaled Jacobian of the last execution's output at corners whose nodes are all
   * prescribed. The boundary alone sets it. NaN where there is no such corner or no result. Field
   * data BoundaryMinimum.
   */
  double GetBoundaryMinimum() const { return this->GetNumber("BoundaryMinimum"); }

  /**
   * Cells of the last execution's output that no method can keep valid. At one of their corners all
   * four nodes are prescribed and span no positive volume, or a single free node has no place where
   * its corners are positive. Also set where an execution is refused because of them. Field data
   * BoundaryInvertedCells.
   */
  vtkIdType GetSurfaceInvertedCells() const { return this->GetInteger("SurfaceInvertedCells"); }
  vtkIdType GetBoundaryInvertedCells() const { return this->GetInteger("BoundaryInvertedCells"); }

  /**
   * As of the last execution: bodies whose cells of a type are all inverted in VTK's order, as in a
   * mirrored mesh. They are morphed and measured as if they were not mirrored. InvertedCells does
   * not count them, and a warning is raised. Field data MirroredBodies; see vtkScaledJacobian.
   */
  vtkIdType GetMirroredBodies() const { return this->GetInteger("MirroredBodies"); }

  ///@{
  /**
   * Wall-clock seconds that the last execution spent preparing (0 where it used what an earlier one
   * prepared) and evaluating.
   */
  double GetPrepareSeconds() const { return this->GetNumber("PrepareSeconds"); }
  double GetEvaluateSeconds() const { return this->GetNumber("EvaluateSeconds"); }
  ///@}

  ///@{
  /**
   * As of the last execution, with Certify on: number of cells whose Jacobian determinant is
   * positive everywhere, of cells where it is not, and of cells where neither was proved.
   */
  vtkIdType GetCertifiedCells() const { return this->GetInteger("CertifiedCells"); }
  vtkIdType GetUncertifiedCells() const { return this->GetInteger("UncertifiedCells"); }
  vtkIdType GetUndecidedCells() const { return this->GetInteger("UndecidedCells"); }
  ///@}

  ///@{
  /**
   * How the last execution ended. "Valid", where the motion has inverted no cell; "Inverted",
   * where it has; "SubStepped" or "Repaired", valid with the help of Validity; "Partial", valid for
   * a part of the motion;
   * "Cancelled" or, after an error, "Failed", with the undeformed mesh; "None" before an execution.
   * Field data MorphStatus.
   */
  const char* GetMorphStatus() const;
  ///@}

  ///@{
  /**
   * As of the last execution: the part of the motion that the valid output has made, 1 for all of
   * it, and NaN if it has inverted cells (field data LargestValidStep); and the sub-steps tried.
   * With relative steps it is the part of the last step's motion.
   */
  double GetLargestValidStep() const { return this->GetNumber("LargestValidStep"); }
  vtkIdType GetSubSteps() const { return this->GetInteger("SubSteps"); }
  ///@}

  /**
   * Iterations of the solver in the last execution; 0 for methods without one.
   */
  int GetSolverIterations() const { return static_cast<int>(this->GetInteger("SolverIterations")); }

  /**
   * How often this object has prepared its method.
   */
  int GetPrepareCount() const { return static_cast<int>(this->GetInteger("PrepareCount")); }

  ///@{
  /**
   * As of the last execution: nodes whose positions were prescribed, held nodes included; points of
   * port 1 that were ignored because no node is near; and nodes that no volume cell uses, but that
   * move with the volume to which cells of lower dimension attach them.
   */
  vtkIdType GetPrescribedPoints() const { return this->GetInteger("PrescribedPoints"); }
  vtkIdType GetUnmatchedPoints() const { return this->GetInteger("UnmatchedPoints"); }
  vtkIdType GetAttachedPoints() const { return this->GetInteger("AttachedPoints"); }
  ///@}

  /**
   * The adjoint of a linear method, for shape optimisation. It takes the derivatives of an
   * objective with respect to the position of each node of the morphed mesh. It computes those with
   * respect to the position (or displacement) of each point of the boundary. `rest` and
   * `boundary`: as on the two ports, which are not used. `gradient`: #nodes tuples of 3.
   * `boundaryGradient`: becomes #points of the boundary tuples of 3, with the factor ScaleFactor; a
   * point that stands for no node gets 0, and so does each but the first of several points of one
   * node. What an execution prepared is reused, and the reverse; the further cost is that of an
   * evaluation. Returns false after an error, which is reported as in an execution: the errors of
   * an execution, a gradient of the wrong size or not finite, a method that is not linear, relative
   * steps. With absolute steps the adjoint is that of the whole motion.
   *
   * @sa vtkMorphAdjoint
   */
  bool ApplyTranspose(vtkUnstructuredGrid* rest, vtkPointSet* boundary, vtkDataArray* gradient,
    vtkDoubleArray* boundaryGradient);

  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

protected:
  vtkMorphAlgorithm();
  ~vtkMorphAlgorithm() override;

  /**
   * Reads what a method takes from its inputs beside points and cells, before PrepareOptions() and
   * CreateMorpher() are called for them. Throws morph::Error.
   */
  virtual void TakeInputs(
    vtkUnstructuredGrid* vtkNotUsed(rest), vtkDataObject* vtkNotUsed(boundary))
  {
  }

  /**
   * A new core object for the method, with the options that its prepare() reads.
   */
  virtual std::unique_ptr<morph::Morpher> CreateMorpher() = 0;

  /**
   * Text that tells apart any two settings of the options that prepare() reads: where it differs
   * from that of the last execution, the method is prepared again. Empty for a method without such
   * options.
   */
  virtual std::string PrepareOptions() { return {}; }

  /**
   * Hands the options that evaluate() alone reads to an object made by CreateMorpher(), before each
   * evaluation.
   */
  virtual void SetEvaluateOptions(morph::Morpher& vtkNotUsed(morpher)) {}

  /**
   * Text that tells apart any two settings of the options that a linear method's evaluate() reads.
   * Empty for a method without such options.
   */
  virtual std::string EvaluateOptions() { return {}; }

  /**
   * The number of that name in the method's report of the last execution (morph::Statistic), 0
   * where there is none. The output holds them as field data too.
   */
  vtkIdType GetCount(const char* name) const;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  int Validity = VALIDITY_REPORT;
  int Quality = QUALITY_ALL;
  bool FeatureLines = false;
  bool Certify = false;

private:
  vtkMorphAlgorithm(const vtkMorphAlgorithm&) = delete;
  void operator=(const vtkMorphAlgorithm&) = delete;

  class vtkInternals;
  std::unique_ptr<vtkInternals> Internals;

  friend class vtkMorphAdjoint;

  /// ApplyTranspose() that throws. `onRanks`: all MPI processes call it, each with its piece.
  void Transpose(vtkUnstructuredGrid* rest, vtkDataObject* boundary, vtkDataArray* gradient,
    vtkDoubleArray* boundaryGradient, bool onRanks, morph::Monitor& monitor);
  ///@{
  /// A result of the last execution, by its name in Results.txt.
  double GetNumber(const char* name) const;
  vtkIdType GetInteger(const char* name) const;
  ///@}

  char* BoundaryIdArray = nullptr;
  char* DisplacementArray = nullptr;
  double ScaleFactor = 1;
  int NumberOfSteps = 0;
  int Stepping = STEPPING_ABSOLUTE;
  double StepMemoryLimit = 1000;
  double MatchTolerance = 1e-6;
  bool HoldUnnamedBoundary = true;
  int MaximumSubSteps = 64;
  bool PostSmooth = false;
  int PostSmoothIterations = 20;
  double RestTime = -1e300;
  int NumberOfThreads = 0;
  int CoincidentPoints = COINCIDENT_POINTS_MERGE;
  int OutputPointsPrecision = DEFAULT_PRECISION;
};

#endif
