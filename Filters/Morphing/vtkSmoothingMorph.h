// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSmoothingMorph
 * @brief   morphs a mesh by moving its boundary and smoothing the interior
 *
 * The boundary moves, and the interior nodes follow by each body's affine map nearest to its
 * boundary's motion. Then the mesh is smoothed with its boundary fixed. Cells that are inverted are
 * untangled (Knupp's untangling, by L-BFGS). Newton's method on the inverse mean ratio of the cells
 * then improves the mesh, first around few bad cells, then everywhere. Around cells that stay bad
 * it lowers their condition number (Objective). This is the smoothing of
 * section 3.1 of Staten et al., which leaves the interior nodes where they were, with the stages of
 * Mesquite. Only the smoothing carries the rest of the motion inside. A motion that is not affine
 * over more than the cells next to the boundary tangles the mesh, and not every tangled mesh can be
 * untangled in this way. Many small steps, each from the mesh of the one before, reach farther.
 *
 * With TargetShape Ideal, the paper's and the default, cells become as regular as they can. A
 * graded mesh loses its grading, and a boundary that does not move does not leave the mesh as it
 * is. With Initial the target is the undeformed shape of each cell: no motion is then the identity,
 * and affine motions are reproduced to the tolerance of the iteration.
 *
 * All volume cells; quadratic cells by their corners, polyhedra by their pieces, mixed meshes. Not
 * linear in the boundary's motion: there is no adjoint. Cells that are valid before the improvement
 * stay valid, but the mean is improved: the worst cell may get worse. Where the boundary stays or
 * moves affinely the minimum does not fall: nodes around cells that became worse than the former
 * minimum are moved back.
 *
 * Preparing is one pass over the cells. Evaluating takes 3 microseconds of processor time a Newton
 * step for each tetrahedron, 25 for each hexahedron, and about 2.5 kB a hexahedron meanwhile.
 *
 * M. L. Staten, S. J. Owen, S. M. Shontz, A. G. Salinger, T. S. Coffey, "A comparison of mesh
 * morphing methods for 3D shape optimization", Proc. 20th Int. Meshing Roundtable (2011) 293-311;
 * P. M. Knupp, "Hexahedral and tetrahedral mesh untangling", Engineering with Computers 17 (2001)
 * 261-268; T. S. Munson, "Mesh shape-quality optimization using the inverse mean-ratio metric",
 * Math. Program. 110 (2007) 561-590; L. A. Freitag, P. M. Knupp, "Tetrahedral mesh improvement via
 * optimization of the element condition number", Int. J. Numer. Meth. Engng 53 (2002) 1377-1391.
 *
 * @sa vtkMorphAlgorithm vtkInversionFreeMorph vtkExtractMorphBoundary
 */
#ifndef vtkSmoothingMorph_h
#define vtkSmoothingMorph_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro
#include "vtkMorphAlgorithm.h"

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkSmoothingMorph : public vtkMorphAlgorithm
{
public:
  static vtkSmoothingMorph* New();
  vtkTypeMacro(vtkSmoothingMorph, vtkMorphAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum TargetShapeType
  {
    TARGET_SHAPE_INITIAL = 0,
    TARGET_SHAPE_IDEAL = 1
  };

  ///@{
  /**
   * The target shape of the cells. Initial: the undeformed shape. Ideal: regular tetrahedra, cubes,
   * and wedges and pyramids with all edges of one length. Default Ideal.
   */
  vtkSetClampMacro(TargetShape, int, TARGET_SHAPE_INITIAL, TARGET_SHAPE_IDEAL);
  vtkGetMacro(TargetShape, int);
  void SetTargetShapeToInitial() { this->SetTargetShape(TARGET_SHAPE_INITIAL); }
  void SetTargetShapeToIdeal() { this->SetTargetShape(TARGET_SHAPE_IDEAL); }
  ///@}

  enum ObjectiveType
  {
    OBJECTIVE_MEAN_RATIO = 0,
    OBJECTIVE_CONDITION_NUMBER = 1,
    OBJECTIVE_ADAPTIVE = 2
  };

  ///@{
  /**
   * The measure of shape that the improvement lowers. Mean ratio: the mean inverse mean ratio of
   * the whole mesh. Condition number: the mean condition number, which pays more for flat cells.
   * Adaptive: the mean ratio, and then the condition number on three rings of cells around those
   * with a scaled Jacobian below 0.2. Where the latter lowers the minimum, nodes move back.
   * Inverted cells are untangled first in all cases. Default Adaptive.
   */
  vtkSetClampMacro(Objective, int, OBJECTIVE_MEAN_RATIO, OBJECTIVE_ADAPTIVE);
  vtkGetMacro(Objective, int);
  void SetObjectiveToMeanRatio() { this->SetObjective(OBJECTIVE_MEAN_RATIO); }
  void SetObjectiveToConditionNumber() { this->SetObjective(OBJECTIVE_CONDITION_NUMBER); }
  void SetObjectiveToAdaptive() { this->SetObjective(OBJECTIVE_ADAPTIVE); }
  ///@}

  ///@{
  /**
   * The largest number of Newton steps, in each of which every node moves once. Untangling takes at
   * most twenty steps of L-BFGS for each of them. Default 50, range [1, 100000].
   */
  vtkSetClampMacro(IterationLimit, int, 1, 100000);
  vtkGetMacro(IterationLimit, int);
  ///@}

  ///@{
  /**
   * The step length at which the improvement ends, relative to the mean length of a node's edges:
   * it ends once no node moves farther. It also ends once a step improves the mean by less than a
   * millionth. Default 1e-3, range [1e-12, 1].
   */
  virtual void SetStopMove(double value);
  vtkGetMacro(StopMove, double);
  ///@}

  ///@{
  /**
   * As of the last execution: steps of L-BFGS and of Newton's method; rounds of the latter in which
   * only the nodes around bad cells moved; iterations of its linear solver; evaluations of the
   * objectives; nodes that were moved back to keep the minimum; of Newton's steps, those on the
   * condition number; cells that the boundary itself inverts.
   */
  vtkIdType GetUntangleSteps() { return this->GetCount("UntangleSteps"); }
  vtkIdType GetNewtonSteps() { return this->GetCount("NewtonSteps"); }
  vtkIdType GetSmoothingPatches() { return this->GetCount("SmoothingPatches"); }
  vtkIdType GetLinearIterations() { return this->GetCount("LinearIterations"); }
  vtkIdType GetEnergyEvaluations() { return this->GetCount("EnergyEvaluations"); }
  vtkIdType GetNodesTakenBack() { return this->GetCount("NodesTakenBack"); }
  vtkIdType GetConditionSteps() { return this->GetCount("ConditionSteps"); }
  vtkIdType GetBoundaryDeterminedCells() { return this->GetCount("BoundaryDeterminedCells"); }
  ///@}

protected:
  vtkSmoothingMorph();
  ~vtkSmoothingMorph() override;

  std::unique_ptr<morph::Morpher> CreateMorpher() override;
  void SetEvaluateOptions(morph::Morpher& morpher) override;

private:
  vtkSmoothingMorph(const vtkSmoothingMorph&) = delete;
  void operator=(const vtkSmoothingMorph&) = delete;

  int TargetShape = TARGET_SHAPE_IDEAL;
  int Objective = OBJECTIVE_ADAPTIVE;
  int IterationLimit = 50;
  double StopMove = 1e-3;
};

#endif
