// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkMorphAlgorithm
 * @brief   moves the nodes of a volume mesh so that it follows a displaced boundary
 *
 * The superclass of all morphing filters. Port 0 takes the undeformed mesh (vtkUnstructuredGrid),
 * port 1 the displaced boundary (vtkPointSet). Output 0 has the mesh's cells and arrays, and new
 * points: those of the boundary lie where port 1 puts them, those inside follow by the subclass's
 * method. The inputs are never touched.
 *
 * Which node a boundary point stands for is told by the first of these that is there:
 * 1. the point array named by BoundaryIdArray;
 * 2. the point array `MorphPointId`, which vtkExtractMorphBoundary writes;
 * 3. the point's own number, where port 1 has as many points as the mesh: only nodes on the outer
 *    boundary are taken from it, for the inside of a warped copy of the mesh prescribes nothing;
 * 4. the point array `PointIds`, as ParaView's Generate Ids writes it;
 * 5. the point array `vtkOriginalPointIds`, with a warning, since filters pass it on after it has
 *    lost its meaning;
 * 6. where DisplacementArray is set, the node nearest to the point, within MatchTolerance; nodes on
 *    the outer boundary within MatchTolerance of that node, as where two bodies touch, go along
 *    unless they have a point of their own.
 *
 * Where port 1 has a point array `RestPosition` (the first three components count) ids are verified
 * against it. Nodes inside the mesh may be prescribed too. A node may be named more than once if
 * the targets agree within MatchTolerance; the first one counts.
 *
 * Target positions are the points of port 1 or, where DisplacementArray is set, the rest position
 * plus that vector.
 *
 * Output 0 has the point vectors `MorphDisplacement`; the cell array `ScaledJacobian` (active
 * scalars; see vtkScaledJacobian), computed on the points as written; and the field data
 * MinScaledJacobian, MeanScaledJacobian, InvertedCells, DegenerateCells, WorstCellId,
 * BoundaryInvertedCells, MirroredBodies, PrepareSeconds, EvaluateSeconds, SolverIterations,
 * MorphStatus and LargestValidStep. The same numbers are there as getters after an execution.
 * Mid-side, face and body nodes of quadratic cells that are not prescribed keep their place in the
 * cell. Cells of lower dimension pass through.
 *
 * Output 1 holds output 0's inverted and degenerate cells (ScaledJacobian of 0 or less) with their
 * points and arrays, to be looked at; added are the cell array `MorphCellId` and the point array
 * `MorphPointId`, ids in output 0. It is empty where there are none.
 *
 * What the method prepares (a matrix and its preconditioner, weights, ...) is kept, and used again
 * while the rest points, the cells, the set of prescribed nodes and the method's options have the
 * same content, whatever their modification times. So moving the same boundary again only costs the
 * evaluation; see GetPrepareCount().
 *
 * Time: the outputs have the time steps of port 1, or NumberOfSteps of its own where port 1 is
 * still. Port 0 is always asked for RestTime. Stepping tells whether a step starts from the
 * undeformed mesh or from the mesh of the step before.
 *
 * After an error there is one message, and output 0 is the undeformed mesh, as port 0 has it, or
 * empty where that cannot be read; MorphStatus is "Failed", and InvertedCells and MinScaledJacobian
 * are -1. RequestData still returns 1: after a 0 VTK's executive adds a message of its own. Among
 * the errors: composite data (use Merge Blocks first), no points, no volume cells, cells of other
 * types than tetrahedra, hexahedra, voxels, wedges, pyramids and their quadratic forms, no way to
 * match the boundary, a node with two targets, ids that RestPosition contradicts, cells on more
 * than one MPI rank, relative steps after a boundary that varies in time on several processes. Data
 * sets on any port are refused where an array has fewer values than there are points or cells,
 * where cells name points that do not exist, where coordinates are not finite or above 1e50, and
 * where their largest extent is below 1e-50 but not 0; so are motions beyond 1e50, and in single
 * precision beyond 3.4e38. An execution that is aborted gives the undeformed mesh (MorphStatus
 * "Cancelled", the same -1) and no message. Inverted cells are no error by themselves: see
 * Validity.
 *
 * A property that is a floating-point number takes no NaN, no infinity and nothing outside its
 * range: the setter raises an error, and the old value stays. Integers outside their range become
 * the nearest end of it, as usual in VTK.
 *
 * Where a port's data have to be had at another time than the pipeline has left them at (one reader
 * on both ports, relative steps that were skipped), this filter updates what is connected to it
 * from within RequestData. CONTINUE_EXECUTING is not used: VTK's executive repeats without end
 * where the input fails in a repeated execution.
 *
 * With several MPI processes an execution is collective: it has to take place on all of them.
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
   * Name of the point array of port 1 that holds, for each of its points, the id of a node of port
   * 0: one component, whole numbers. Empty or "None": look for the arrays named in the class
   * description. Default: none.
   */
  vtkSetStringMacro(BoundaryIdArray);
  vtkGetStringMacro(BoundaryIdArray);
  ///@}

  ///@{
  /**
   * Name of a point array of port 1 with three components, in the unit of the points: nodes go to
   * their rest position plus this vector. Empty or "None": they go to the points of port 1.
   * Default: none.
   */
  vtkSetStringMacro(DisplacementArray);
  vtkGetStringMacro(DisplacementArray);
  ///@}

  ///@{
  /**
   * How much of the boundary's motion to apply: target = rest + ScaleFactor (target - rest). 0
   * gives the rest positions and 1 the targets, bit for bit. Default 1, any finite number.
   */
  virtual void SetScaleFactor(double value);
  vtkGetMacro(ScaleFactor, double);
  ///@}

  ///@{
  /**
   * Steps that the motion of a boundary which does not vary in time is cut into, equal in length:
   * the output then has the time steps 0 (at rest), 1, ..., NumberOfSteps, and at step i the
   * boundary has made i / NumberOfSteps of ScaleFactor's motion. Between steps the one before
   * counts; where no time is asked for, the last. A boundary with several time steps has its own
   * and this is without effect; one with a time range alone is taken at the ends of that many equal
   * parts of it. Default 0: no steps. Range [0, 1000000]; what is beyond it becomes the nearest
   * end.
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
   * From which mesh a step starts. Absolute: from the undeformed mesh. Relative: from the mesh of
   * the step before, in double precision, for which the method is prepared again, and the first
   * from the undeformed mesh; cells are still measured against, and vtkInversionFreeMorph still
   * aims for, the undeformed mesh. A relative step is the same whether all steps before it were
   * asked for or none: those that are missing are computed, the boundary being asked for their
   * times (on one MPI process only, if it varies in time). PrepareSeconds and EvaluateSeconds are
   * those of the last step alone, 0 where it was kept. Has no effect without steps. Default
   * Absolute.
   */
  vtkSetClampMacro(Stepping, int, STEPPING_ABSOLUTE, STEPPING_RELATIVE);
  vtkGetMacro(Stepping, int);
  void SetSteppingToAbsolute() { this->SetStepping(STEPPING_ABSOLUTE); }
  void SetSteppingToRelative() { this->SetStepping(STEPPING_RELATIVE); }
  ///@}

  ///@{
  /**
   * Megabytes (10^6 bytes) that the meshes of a relative run may take, 24 bytes a node and step.
   * Beyond it every other one is dropped, and going back to it takes some steps again; the result
   * does not depend on it. The last one is kept in any case. Default 1000, range [0, 1e12].
   */
  virtual void SetStepMemoryLimit(double value);
  vtkGetMacro(StepMemoryLimit, double);
  ///@}

  ///@{
  /**
   * How far a boundary point may be from the node it stands for: its RestPosition or, where nodes
   * are found by position, the point itself. In units of the diagonal of the bounding box of the
   * volume cells' nodes. Default 1e-6, range [0, 1].
   */
  virtual void SetMatchTolerance(double value);
  vtkGetMacro(MatchTolerance, double);
  ///@}

  ///@{
  /**
   * Whether nodes on the mesh's outer faces that port 1 does not name stay where they are. Mid-side
   * and face nodes of quadratic cells stay only where all corners of their edge or face do; the
   * others keep their place in the cell. Off: they are solved for like the nodes inside, and leave
   * the original surface. Default on.
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
    VALIDITY_REFUSE = 4
  };

  ///@{
  /**
   * What to do where the method leaves inverted or degenerate cells.
   * None: nothing; InvertedCells counts them.
   * Report: a warning names the ten worst of them.
   * SubStep: halve the motion, and go on from the last valid mesh, whose method is prepared again
   * at each step.
   * Repair: minimise the energy of vtkInversionFreeMorph, starting from the method's mesh; where
   * that fails, sub-steps of vtkInversionFreeMorph.
   * Refuse: an error that names them, and the undeformed mesh.
   *
   * With the last three a boundary that inverts cells by itself, at corners whose nodes it all
   * prescribes, is refused at once, naming these cells. Where SubStep and Repair find no valid mesh
   * for the whole motion there is an error, but the output is the valid mesh of the largest step
   * that was reached; see MorphStatus. Default Report.
   */
  vtkSetClampMacro(Validity, int, VALIDITY_NONE, VALIDITY_REFUSE);
  vtkGetMacro(Validity, int);
  void SetValidityToNone() { this->SetValidity(VALIDITY_NONE); }
  void SetValidityToReport() { this->SetValidity(VALIDITY_REPORT); }
  void SetValidityToSubStep() { this->SetValidity(VALIDITY_SUB_STEP); }
  void SetValidityToRepair() { this->SetValidity(VALIDITY_REPAIR); }
  void SetValidityToRefuse() { this->SetValidity(VALIDITY_REFUSE); }
  ///@}

  ///@{
  /**
   * Whether to prove for each cell of the output that its Jacobian determinant is positive
   * everywhere, not at the corners alone (cell array JacobianCertificate: 1 certified, 0 undecided,
   * -1 inverted; field data CertifiedCells, UncertifiedCells, UndecidedCells; see
   * vtkScaledJacobian). Cost: about a microsecond a cell. Default off, in vtkInversionFreeMorph on.
   */
  vtkSetMacro(Certify, bool);
  vtkGetMacro(Certify, bool);
  vtkBooleanMacro(Certify, bool);
  ///@}

  ///@{
  /**
   * Most sub-steps to try, failed ones included. Default 64, range [1, VTK_INT_MAX].
   */
  vtkSetClampMacro(MaximumSubSteps, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaximumSubSteps, int);
  ///@}

  ///@{
  /**
   * Whether to smooth the mesh that the method made, before Validity looks at it: prescribed nodes
   * stay, inverted cells are untangled where that can be done, and then cells are brought closer,
   * on average, to their shapes at rest (see vtkSmoothingMorph, TargetShape Initial). A smoothed
   * mesh with more inverted cells, or as many and a lower minimum scaled Jacobian, is dropped. The
   * field data PostSmoothSteps has the steps that led to the output, 0 where it was dropped.
   * Default off.
   */
  vtkSetMacro(PostSmooth, bool);
  vtkGetMacro(PostSmooth, bool);
  vtkBooleanMacro(PostSmooth, bool);
  ///@}

  ///@{
  /**
   * Most steps of PostSmooth, in each of which every node moves once; it ends before that once no
   * node moves farther than a thousandth of its edges. Default 20, range [1, 100000].
   */
  vtkSetClampMacro(PostSmoothIterations, int, 1, 100000);
  vtkGetMacro(PostSmoothIterations, int);
  ///@}

  ///@{
  /**
   * The time at which port 0 is at rest: the last of its time steps that is not after it, or the
   * first step where all are after it. Default -1e300, so the first. Has no effect where port 0 has
   * no time steps.
   */
  virtual void SetRestTime(double value);
  vtkGetMacro(RestTime, double);
  ///@}

  ///@{
  /**
   * Threads to compute with, by the backend that vtkSMPTools uses, or, where that is Sequential (as
   * ParaView's is by default), by std::threads. 0 means as many as the backend has, or all cores.
   * The result depends neither on it nor on the backend. Default 0, range [0, VTK_INT_MAX].
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, VTK_INT_MAX);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * Type of the output's points: vtkAlgorithm::SINGLE_PRECISION, DOUBLE_PRECISION, or
   * DEFAULT_PRECISION for that of the input's (double where they are neither). Computed is always
   * in double. Default DEFAULT_PRECISION.
   */
  vtkSetClampMacro(OutputPointsPrecision, int, SINGLE_PRECISION, DEFAULT_PRECISION);
  vtkGetMacro(OutputPointsPrecision, int);
  ///@}

  ///@{
  /**
   * Quality of the output as of the last execution; see vtkScaledJacobian. Where there was no
   * result all are -1 but the mean, which is NaN: no test for 0 passes after an error.
   */
  double GetMinScaledJacobian() const { return this->GetNumber("MinScaledJacobian"); }
  double GetMeanScaledJacobian() const { return this->GetNumber("MeanScaledJacobian"); }
  vtkIdType GetInvertedCells() const { return this->GetInteger("InvertedCells"); }
  vtkIdType GetDegenerateCells() const { return this->GetInteger("DegenerateCells"); }
  vtkIdType GetWorstCellId() const { return this->GetInteger("WorstCellId"); }
  ///@}

  /**
   * Cells of the last execution's output that no method could have kept valid: at one of their
   * corners all four nodes are prescribed and span no positive volume, or a single free node has no
   * place where its corners are positive. Filled where an execution is refused because of them,
   * too. Field data BoundaryInvertedCells.
   */
  vtkIdType GetBoundaryInvertedCells() const { return this->GetInteger("BoundaryInvertedCells"); }

  /**
   * As of the last execution: bodies whose cells of a type are all inverted in VTK's order, as in a
   * mirrored mesh. They are morphed and measured as if they were not, InvertedCells does not count
   * them, and a warning says so. Field data MirroredBodies; see vtkScaledJacobian.
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
   * positive everywhere, of those where it is not, and of those for which neither was proved.
   */
  vtkIdType GetCertifiedCells() const { return this->GetInteger("CertifiedCells"); }
  vtkIdType GetUncertifiedCells() const { return this->GetInteger("UncertifiedCells"); }
  vtkIdType GetUndecidedCells() const { return this->GetInteger("UndecidedCells"); }
  ///@}

  ///@{
  /**
   * How the last execution ended: "Valid"; "Inverted", with cells that are; "SubStepped" or
   * "Repaired", valid with the help of Validity; "Partial", valid but not all the way; "Cancelled"
   * or, after an error, "Failed", with the undeformed mesh; "None" before there was an execution.
   * The field data MorphStatus holds it too.
   */
  const char* GetMorphStatus() const;
  ///@}

  ///@{
  /**
   * As of the last execution: the part of the motion, with relative steps of the last step's, that
   * the valid output has made, 1 for all of it, and NaN where it has inverted cells (field data
   * LargestValidStep); and the sub-steps tried.
   */
  double GetLargestValidStep() const { return this->GetNumber("LargestValidStep"); }
  vtkIdType GetSubSteps() const { return this->GetInteger("SubSteps"); }
  ///@}

  /**
   * Iterations of the solver in the last execution; 0 for methods without one.
   */
  int GetSolverIterations() const { return static_cast<int>(this->GetInteger("SolverIterations")); }

  /**
   * How often this object has prepared its method since it was made.
   */
  int GetPrepareCount() const { return static_cast<int>(this->GetInteger("PrepareCount")); }

  ///@{
  /**
   * As of the last execution: nodes whose positions were prescribed, held ones included, and points
   * of port 1 that were near no node and left out.
   */
  vtkIdType GetPrescribedPoints() const { return this->GetInteger("PrescribedPoints"); }
  vtkIdType GetUnmatchedPoints() const { return this->GetInteger("UnmatchedPoints"); }
  ///@}

  /**
   * The adjoint of a linear method, for shape optimisation: from the derivatives of an objective
   * with respect to the position of each node of the morphed mesh to those with respect to the
   * position (or displacement) of each point of the boundary. `rest` and `boundary`: as on the two
   * ports, which are not looked at. `gradient`: #nodes tuples of 3. `boundaryGradient`: becomes
   * #points of the boundary tuples of 3; a point that stands for no node gets 0, and so does each
   * but the first of several that stand for one. Times ScaleFactor. What an execution prepared is
   * used again, and the reverse, as between executions; the cost beyond that is that of an
   * evaluation. False after an error, which is reported as in an execution: those of an execution,
   * a gradient of the wrong size or not finite, a method that is not linear, relative steps. With
   * absolute steps it is that of the whole motion.
   *
   * @sa vtkMorphAdjoint
   */
  bool ApplyTranspose(vtkUnstructuredGrid* rest, vtkPointSet* boundary, vtkDataArray* gradient,
    vtkDoubleArray* boundaryGradient);

protected:
  vtkMorphAlgorithm();
  ~vtkMorphAlgorithm() override;

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
   * The number of that name in the method's report of the last execution (morph::Statistic), 0
   * where there is none. The output holds them as field data too.
   */
  vtkIdType GetCount(const char* name) const;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  int Validity = VALIDITY_REPORT;
  bool Certify = false;

private:
  vtkMorphAlgorithm(const vtkMorphAlgorithm&) = delete;
  void operator=(const vtkMorphAlgorithm&) = delete;

  class vtkInternals;
  std::unique_ptr<vtkInternals> Internals;

  friend class vtkMorphAdjoint;

  /// ApplyTranspose() that throws.
  void Transpose(vtkUnstructuredGrid* rest, vtkDataObject* boundary, vtkDataArray* gradient,
    vtkDoubleArray* boundaryGradient, morph::Monitor& monitor);
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
  int OutputPointsPrecision = DEFAULT_PRECISION;
};

#endif
