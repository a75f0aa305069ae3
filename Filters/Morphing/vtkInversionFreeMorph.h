// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkInversionFreeMorph
 * @brief   morphs a mesh so that no cell is inverted
 *
 * The filter starts from the better of FEMWARP's and simplex-linear's mesh. The foldover-free
 * energy removes its inverted cells, up to the first valid mesh. Then quasi-isometric stiffening
 * raises the minimum scaled Jacobian, up to what the boundary allows. There are never more inverted
 * cells than in FEMWARP's and simplex-linear's meshes and, with as many, no lower minimum.
 * Tetrahedra, hexahedra, wedges, pyramids, mixed meshes, and their quadratic forms, whose corners
 * move as the linear cell. Polyhedra by their pieces. Not linear in the boundary's motion: there is
 * no adjoint.
 *
 * The default of Validity is VALIDITY_SUB_STEP here. A boundary that inverts cells by itself is
 * refused, with the ids of the cells. Where no valid mesh is found for the whole motion, there is
 * an error, and the output is the valid mesh of the largest step that was reached. See
 * vtkMorphAlgorithm.
 *
 * An undeformed mesh with inverted cells is untangled, even without motion. It starts from the
 * undeformed mesh, or from the graph-Laplace mesh where that is better. Undeformed cells that are
 * inverted or flat have the ideal shape as target. Middle nodes of quadratic cells move where a
 * cell is inverted between its corners.
 *
 * Preparing is FEMWARP's and simplex-linear's. Evaluating takes steps with a linear solution each,
 * of the cells near the worst ones and, where that is not enough, of all: 3 microseconds of
 * processor time a hexahedron.
 *
 * V. Garanzha, I. Kaporin, L. Kudryavtseva, F. Protais, N. Ray, D. Sokolov, "Foldover-free maps in
 * 50 lines of code", ACM Trans. Graph. 40(4) (2021), arXiv 2102.03069. V. Garanzha, I. Kaporin, L.
 * Kudryavtseva, F. Protais, D. Sokolov, ACM Trans. Graph. 43(1) (2024), arXiv 2201.12112.
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

  enum EffortType
  {
    EFFORT_QUICK = 0,
    EFFORT_DEFAULT = 1,
    EFFORT_THOROUGH = 2
  };

  ///@{
  /**
   * How many steps may raise the minimum scaled Jacobian: 24, 40 or 200. Fewer are taken where the
   * boundary bounds the minimum, or where steps gain little. Default EFFORT_DEFAULT.
   */
  vtkSetClampMacro(Effort, int, EFFORT_QUICK, EFFORT_THOROUGH);
  vtkGetMacro(Effort, int);
  void SetEffortToQuick() { this->SetEffort(EFFORT_QUICK); }
  void SetEffortToDefault() { this->SetEffort(EFFORT_DEFAULT); }
  void SetEffortToThorough() { this->SetEffort(EFFORT_THOROUGH); }
  ///@}

  ///@{
  /**
   * As of the last execution: steps of the minimiser, iterations of its linear solver, evaluations
   * of the energy; cells that the boundary itself inverts, and cells that stay inverted at folded
   * boundary faces.
   */
  vtkIdType GetNewtonSteps() { return this->GetCount("NewtonSteps"); }
  vtkIdType GetLinearIterations() { return this->GetCount("LinearIterations"); }
  vtkIdType GetEnergyEvaluations() { return this->GetCount("EnergyEvaluations"); }
  vtkIdType GetBoundaryDeterminedCells() { return this->GetCount("BoundaryDeterminedCells"); }
  vtkIdType GetFoldedBoundaryCells() { return this->GetCount("FoldedBoundaryCells"); }
  ///@}

protected:
  vtkInversionFreeMorph();
  ~vtkInversionFreeMorph() override;

  std::unique_ptr<morph::Morpher> CreateMorpher() override;
  void SetEvaluateOptions(morph::Morpher& morpher) override;

private:
  vtkInversionFreeMorph(const vtkInversionFreeMorph&) = delete;
  void operator=(const vtkInversionFreeMorph&) = delete;

  int Effort = EFFORT_DEFAULT;
};

#endif
