// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSimplexNaturalNeighborMorph
 * @brief   morphs a mesh by natural-neighbor interpolation between its boundary nodes
 *
 * Each interior node follows its natural neighbors among the prescribed nodes: the nodes whose
 * Voronoi cells its own would border on. Weights are Sibson's coordinates (equation (8) of Staten
 * et al.). Affine motions of the boundary are reproduced exactly. The mesh's cells are not used.
 * The coordinates depend on the Voronoi diagram, which is unique: structured meshes move
 * symmetrically, and rotating a mesh changes nothing. They vary smoothly with the node's position.
 * In quality the method is near vtkSimplexLinearMorph, at many times the cost.
 *
 * A node within a cube whose surface has 15,000 nodes has about 1000 natural neighbors. Weights are
 * kept where they fit into MemoryLimit; otherwise they are recomputed for each motion, and a
 * warning is raised.
 *
 * It is an error if all prescribed nodes lie in one plane.
 *
 * M. L. Staten, S. J. Owen, S. M. Shontz, A. G. Salinger, T. S. Coffey, "A comparison of mesh
 * morphing methods for 3D shape optimization", Proc. 20th Int. Meshing Roundtable (2011) 293-311,
 * section 3.4; R. Sibson, "A vector identity for the Dirichlet tessellation", Math. Proc. Camb.
 * Phil. Soc. 87 (1980) 151-155.
 *
 * @sa vtkMorphAlgorithm vtkSimplexLinearMorph vtkExtractMorphBoundary
 */
#ifndef vtkSimplexNaturalNeighborMorph_h
#define vtkSimplexNaturalNeighborMorph_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro
#include "vtkMorphAlgorithm.h"

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkSimplexNaturalNeighborMorph
  : public vtkMorphAlgorithm
{
public:
  static vtkSimplexNaturalNeighborMorph* New();
  vtkTypeMacro(vtkSimplexNaturalNeighborMorph, vtkMorphAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The memory for the weights in megabytes (10^6 bytes), 12 bytes each; the result does not depend
   * on it. Changing it prepares again. Default 4000, range [0, 1e12]; 0 keeps none.
   */
  virtual void SetMemoryLimit(double value);
  vtkGetMacro(MemoryLimit, double);
  ///@}

  ///@{
  /**
   * As of the last execution: nodes that took the coordinates of vtkSimplexLinearMorph because they
   * lie on or outside the prescribed nodes' convex hull, or because rounding spoilt their own;
   * nodes outside the hull by more than rounding, which are extrapolated; and whether the weights
   * were kept (1) or recomputed (0). In the output's field data too.
   */
  vtkIdType GetBarycentricNodes() { return this->GetCount("BarycentricNodes"); }
  vtkIdType GetExtrapolatedNodes() { return this->GetCount("ExtrapolatedNodes"); }
  vtkIdType GetWeightsStored() { return this->GetCount("WeightsStored"); }
  ///@}

protected:
  vtkSimplexNaturalNeighborMorph();
  ~vtkSimplexNaturalNeighborMorph() override;

  std::unique_ptr<morph::Morpher> CreateMorpher() override;
  std::string PrepareOptions() override;

private:
  vtkSimplexNaturalNeighborMorph(const vtkSimplexNaturalNeighborMorph&) = delete;
  void operator=(const vtkSimplexNaturalNeighborMorph&) = delete;

  double MemoryLimit = 4000;
};

#endif
