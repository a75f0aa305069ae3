// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkInversionFreeMorph
 * @brief   morphs a mesh so that no cell is inverted
 *
 * The filter minimises the foldover-free energy of all cells, from an initial guess. It first
 * removes all inverted cells, and then improves the worst cells. The target shape of a cell is its
 * shape in the undeformed mesh; cells other than tetrahedra are stretched to the sizes that the
 * moved boundary asks for. The minimum scaled Jacobian is never below that of FEMWARP's mesh if
 * that is valid. With the target Stretched, the same holds for simplex-linear's mesh. Where one of
 * these meshes has the higher minimum, it is the result. Tetrahedra, hexahedra, wedges, pyramids,
 * mixed meshes, and their quadratic forms, whose corners move as the linear cell. Polyhedra by
 * their pieces, without ImproveWorst and without the promise of a minimum, which would be that of
 * the pieces. Not linear in the boundary's motion: there is no adjoint.
 *
 * The default of Validity is VALIDITY_SUB_STEP here. A boundary that inverts cells by itself is
 * refused, with the ids of the cells. Where no valid mesh is found for the whole motion, there is
 * an error, and the output is the valid mesh of the largest step that was reached. See
 * vtkMorphAlgorithm.
 *
 * An undeformed mesh with inverted cells is untangled, even without motion. The minimisation then
 * starts from the undeformed mesh, or from the graph-Laplace mesh where that has fewer inverted
 * cells. Undeformed cells that are inverted or flat have the ideal shape as target. Middle nodes of
 * quadratic cells move where a cell is inverted between its corners.
 *
 * Preparing is FEMWARP's and simplex-linear's. Where one of their meshes is valid, evaluating takes
 * some passes over the cells, and some hundred over those around the worst ones. Otherwise it takes
 * 5 to 40 Newton steps, each 0.4 to 0.8 microseconds of processor time for a tetrahedron; a
 * hexahedron counts as ten. It uses about 6 kB a hexahedron meanwhile, with what it prepares.
 *
 * V. Garanzha, I. Kaporin, L. Kudryavtseva, F. Protais, N. Ray, D. Sokolov, "Foldover-free maps in
 * 50 lines of code", ACM Trans. Graph. 40(4) (2021), arXiv 2102.03069.
 *
 * @sa vtkMorphAlgorithm vtkFEMWarpMorph vtkExtractMorphBoundary
 */
#ifndef vtkInversionFreeMorph_h
#define vtkInversionFreeMorph_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro
#include "vtkMorphAlgorithm.h"

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkInversionFreeMorph : public vtkMorphAlgorithm
{
public:
  static vtkInversionFreeMorph* New();
  vtkTypeMacro(vtkInversionFreeMorph, vtkMorphAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum InitialGuessType
  {
    INITIAL_GUESS_FEMWARP = 0,
    INITIAL_GUESS_REST = 1,
    INITIAL_GUESS_LBWARP = 2,
    INITIAL_GUESS_WEIGHTED_RESIDUAL = 3,
    INITIAL_GUESS_SIMPLEX_LINEAR = 4,
    INITIAL_GUESS_SIMPLEX_NATURAL_NEIGHBOR = 5
  };

  ///@{
  /**
   * The mesh that the minimisation starts from: that of a method with its default options, or the
   * undeformed mesh with its boundary moved. Default FEMWARP.
   */
  vtkSetClampMacro(
    InitialGuess, int, INITIAL_GUESS_FEMWARP, INITIAL_GUESS_SIMPLEX_NATURAL_NEIGHBOR);
  vtkGetMacro(InitialGuess, int);
  void SetInitialGuessToFEMWARP() { this->SetInitialGuess(INITIAL_GUESS_FEMWARP); }
  void SetInitialGuessToRest() { this->SetInitialGuess(INITIAL_GUESS_REST); }
  void SetInitialGuessToLBWARP() { this->SetInitialGuess(INITIAL_GUESS_LBWARP); }
  void SetInitialGuessToWeightedResidual()
  {
    this->SetInitialGuess(INITIAL_GUESS_WEIGHTED_RESIDUAL);
  }
  void SetInitialGuessToSimplexLinear() { this->SetInitialGuess(INITIAL_GUESS_SIMPLEX_LINEAR); }
  void SetInitialGuessToSimplexNaturalNeighbor()
  {
    this->SetInitialGuess(INITIAL_GUESS_SIMPLEX_NATURAL_NEIGHBOR);
  }
  ///@}

  enum TargetShapeType
  {
    TARGET_SHAPE_INITIAL = 0,
    TARGET_SHAPE_STRETCHED = 1,
    TARGET_SHAPE_IDEAL = 2
  };

  ///@{
  /**
   * The target shape of the cells. Initial: the undeformed shape and size; affine motions of the
   * boundary are reproduced exactly. Stretched: the undeformed angles, with edge lengths that fit
   * the moved boundary; tetrahedra as Initial. Ideal: right angles or regular tetrahedra, whatever
   * the undeformed shape, so the mesh changes even without motion. Default Stretched.
   */
  vtkSetClampMacro(TargetShape, int, TARGET_SHAPE_INITIAL, TARGET_SHAPE_IDEAL);
  vtkGetMacro(TargetShape, int);
  void SetTargetShapeToInitial() { this->SetTargetShape(TARGET_SHAPE_INITIAL); }
  void SetTargetShapeToStretched() { this->SetTargetShape(TARGET_SHAPE_STRETCHED); }
  void SetTargetShapeToIdeal() { this->SetTargetShape(TARGET_SHAPE_IDEAL); }
  ///@}

  ///@{
  /**
   * Whether the minimum scaled Jacobian of a valid mesh is raised, at the expense of the average
   * cell. Has no effect with TargetShape Initial. Default on.
   */
  vtkSetMacro(ImproveWorst, bool);
  vtkGetMacro(ImproveWorst, bool);
  vtkBooleanMacro(ImproveWorst, bool);
  ///@}

  ///@{
  /**
   * Whether to minimise by L-BFGS instead of Newton's method. It needs no matrix, so a third of the
   * memory; it is as fast on some 10,000 cells, and slower on many. Default off.
   */
  vtkSetMacro(LowMemory, bool);
  vtkGetMacro(LowMemory, bool);
  vtkBooleanMacro(LowMemory, bool);
  ///@}

  ///@{
  /**
   * As of the last execution: steps of the minimiser, iterations of its linear solver, evaluations
   * of the energy; cells that the boundary itself inverts, and cells that stay inverted at folded
   * boundary faces; and whether FEMWARP's or simplex-linear's mesh was the better one.
   */
  vtkIdType GetNewtonSteps() { return this->GetCount("NewtonSteps"); }
  vtkIdType GetLinearIterations() { return this->GetCount("LinearIterations"); }
  vtkIdType GetEnergyEvaluations() { return this->GetCount("EnergyEvaluations"); }
  vtkIdType GetBoundaryDeterminedCells() { return this->GetCount("BoundaryDeterminedCells"); }
  vtkIdType GetFoldedBoundaryCells() { return this->GetCount("FoldedBoundaryCells"); }
  vtkIdType GetKeptLinear() { return this->GetCount("KeptLinear"); }
  ///@}

protected:
  vtkInversionFreeMorph();
  ~vtkInversionFreeMorph() override;

  std::unique_ptr<morph::Morpher> CreateMorpher() override;
  std::string PrepareOptions() override;
  void SetEvaluateOptions(morph::Morpher& morpher) override;

private:
  vtkInversionFreeMorph(const vtkInversionFreeMorph&) = delete;
  void operator=(const vtkInversionFreeMorph&) = delete;

  int InitialGuess = INITIAL_GUESS_FEMWARP;
  int TargetShape = TARGET_SHAPE_STRETCHED;
  bool ImproveWorst = true;
  bool LowMemory = false;
};

#endif
