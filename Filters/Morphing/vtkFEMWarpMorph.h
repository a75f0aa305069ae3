// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkFEMWarpMorph
 * @brief   morphs a mesh by the finite element solution of Laplace's equation (FEMWARP)
 *
 * Interior nodes follow the finite element solution of Laplace's equation on the undeformed mesh.
 * The boundary's displacement is its Dirichlet data. Affine motions of the boundary are reproduced
 * exactly. Small or smooth motions keep the cells valid; large rotations and strong compressions
 * may invert some near the boundary, which InvertedCells counts. Tetrahedra, hexahedra, wedges,
 * pyramids, polyhedra, mixed meshes; corners of quadratic cells move as those of linear ones.
 *
 * Each connected body needs at least one prescribed node. Inverted or flat cells of the undeformed
 * mesh give a warning and get a positive stiffness, so that the mesh can still be morphed.
 *
 * Preparing assembles the stiffness matrix (equations (9) to (12) of Staten et al.) and sets up a
 * multigrid preconditioner; evaluating solves for the three coordinates together by conjugate
 * gradients in about a dozen iterations. Memory: about 0.5 kB a node of a hexahedral mesh, 0.35 kB
 * of a tetrahedral one.
 *
 * T. J. Baker, "Mesh movement and metamorphosis", Engineering with Computers 18 (2002)
 * 188-198; S. M. Shontz, S. A. Vavasis, "Analysis of and workarounds for element reversal for a
 * finite element-based algorithm for warping triangular and tetrahedral meshes", BIT 50 (2010)
 * 863-884.
 *
 * @sa vtkStiffnessMorph vtkMorphAlgorithm vtkExtractMorphBoundary
 */
#ifndef vtkFEMWarpMorph_h
#define vtkFEMWarpMorph_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro
#include "vtkStiffnessMorph.h"

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkFEMWarpMorph : public vtkStiffnessMorph
{
public:
  static vtkFEMWarpMorph* New();
  vtkTypeMacro(vtkFEMWarpMorph, vtkStiffnessMorph);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Residual, relative to the right-hand side and for each coordinate, at which the solver stops.
   * Changing it does not prepare again. Default 1e-10, range [1e-15, 0.999].
   */
  virtual void SetTolerance(double value);
  vtkGetMacro(Tolerance, double);
  ///@}

protected:
  vtkFEMWarpMorph();
  ~vtkFEMWarpMorph() override;

  std::unique_ptr<morph::Morpher> CreateMorpher() override;
  std::string PrepareOptions() override;
  void SetEvaluateOptions(morph::Morpher& morpher) override;
  std::string EvaluateOptions() override;

private:
  vtkFEMWarpMorph(const vtkFEMWarpMorph&) = delete;
  void operator=(const vtkFEMWarpMorph&) = delete;

  double Tolerance = 1e-10;
};

#endif
