// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkLBWarpMorph
 * @brief   morphs a mesh by convex combinations of each node's neighbors (LBWARP)
 *
 * On the undeformed mesh each interior node is a convex combination of all nodes that share a
 * volume cell with it. Its weights are those furthest from zero in the sense of a logarithmic
 * barrier. The same combinations, with the boundary's new positions, give the new interior
 * positions. No node leaves the convex hull of the boundary, and affine motions of the boundary are
 * reproduced exactly. Cells may still invert, which InvertedCells counts. Any volume cells, of
 * which the corners count; nodes of quadratic cells move with the linear cell.
 *
 * Each connected body needs at least one prescribed node. A node that does not lie inside the hull
 * of its neighbors, at an inverted or strongly concave place, has no such weights: see OutsideHull.
 *
 * Preparing computes the weights (equation (13) of Staten et al.), about 1 microsecond a node, and
 * sets up a multigrid preconditioner; evaluating solves for the three coordinates together in about
 * a dozen iterations. Memory: about 0.5 kB a node of a hexahedral mesh.
 *
 * S. M. Shontz, S. A. Vavasis, "A mesh warping algorithm based on weighted Laplacian smoothing",
 * Proc. 12th Int. Meshing Roundtable (2003) 147-158; M. L. Staten, S. J. Owen, S. M. Shontz, A. G.
 * Salinger, T. S. Coffey, "A comparison of mesh morphing methods for 3D shape optimization", Proc.
 * 20th Int. Meshing Roundtable (2011) 293-311.
 *
 * @sa vtkMorphAlgorithm vtkFEMWarpMorph vtkExtractMorphBoundary
 */
#ifndef vtkLBWarpMorph_h
#define vtkLBWarpMorph_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro
#include "vtkMorphAlgorithm.h"

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkLBWarpMorph : public vtkMorphAlgorithm
{
public:
  static vtkLBWarpMorph* New();
  vtkTypeMacro(vtkLBWarpMorph, vtkMorphAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Residual, relative to the right-hand side and for each coordinate, at which the solver stops.
   * Changing it does not prepare again. Default 1e-10, range [1e-15, 0.999].
   */
  virtual void SetTolerance(double value);
  vtkGetMacro(Tolerance, double);
  ///@}

  enum OutsideHullType
  {
    OUTSIDE_HULL_ERROR = 0,
    OUTSIDE_HULL_RELAX = 1
  };

  ///@{
  /**
   * What happens to a free node that does not lie inside the hull of its neighbors. Error: no
   * result, and a message with the number of such nodes and the first ids. Relax: the node takes
   * the first of these that exists: log-barrier weights among its neighbors and theirs; affine
   * weights of minimum norm, which reproduce affine motions exactly but may be negative, so nothing
   * bounds the node; FEMWARP's row of the matrix. Default Error.
   */
  vtkSetClampMacro(OutsideHull, int, OUTSIDE_HULL_ERROR, OUTSIDE_HULL_RELAX);
  vtkGetMacro(OutsideHull, int);
  void SetOutsideHullToError() { this->SetOutsideHull(OUTSIDE_HULL_ERROR); }
  void SetOutsideHullToRelax() { this->SetOutsideHull(OUTSIDE_HULL_RELAX); }
  ///@}

  ///@{
  /**
   * As of the last execution: free nodes outside the hull of their neighbors, and of these the
   * nodes with weights of two rings of neighbors, with affine weights, and with FEMWARP's row.
   */
  vtkIdType GetOutsideHullNodes() { return this->GetCount("OutsideHullNodes"); }
  vtkIdType GetTwoRingNodes() { return this->GetCount("TwoRingNodes"); }
  vtkIdType GetAffineNodes() { return this->GetCount("AffineNodes"); }
  vtkIdType GetStiffnessNodes() { return this->GetCount("StiffnessNodes"); }
  ///@}

protected:
  vtkLBWarpMorph();
  ~vtkLBWarpMorph() override;

  std::unique_ptr<morph::Morpher> CreateMorpher() override;
  std::string PrepareOptions() override;
  void SetEvaluateOptions(morph::Morpher& morpher) override;
  std::string EvaluateOptions() override;

private:
  vtkLBWarpMorph(const vtkLBWarpMorph&) = delete;
  void operator=(const vtkLBWarpMorph&) = delete;

  double Tolerance = 1e-10;
  int OutsideHull = OUTSIDE_HULL_ERROR;
};

#endif
