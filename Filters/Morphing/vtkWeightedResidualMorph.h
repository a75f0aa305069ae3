// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkWeightedResidualMorph
 * @brief   morphs a mesh by an affine fit of its boundary's motion and the residuals nearby
 *
 * An affine map is fitted to the motion of all prescribed nodes. An interior node follows this map,
 * plus a weighted mean of the residuals of the prescribed nodes nearest to it. Weights are inverse
 * squared distances (equations (3) to (6) of Staten et al., equation (3) as a least-squares fit).
 * Affine motions of the boundary are reproduced exactly. The mesh's cells are not used, so any
 * volume mesh will do.
 *
 * The motion jumps where one neighbor replaces another. On fine meshes the nodes on either side of
 * the middle follow different walls: cells there are the first to invert.
 *
 * Prescribed nodes that all lie in one plane are fitted with the minimum change: nodes off the
 * plane keep their distance from it. A fit that mirrors the mesh gives a warning.
 *
 * Memory: 12 bytes an interior node and neighbor, about 1 kB a node with 80 neighbors.
 *
 * M. L. Staten, S. J. Owen, S. M. Shontz, A. G. Salinger, T. S. Coffey, "A comparison of mesh
 * morphing methods for 3D shape optimization", Proc. 20th Int. Meshing Roundtable (2011) 293-311,
 * section 3.2.
 *
 * @sa vtkMorphAlgorithm vtkExtractMorphBoundary
 */
#ifndef vtkWeightedResidualMorph_h
#define vtkWeightedResidualMorph_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro
#include "vtkMorphAlgorithm.h"

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkWeightedResidualMorph : public vtkMorphAlgorithm
{
public:
  static vtkWeightedResidualMorph* New();
  vtkTypeMacro(vtkWeightedResidualMorph, vtkMorphAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The number of nearest prescribed nodes that an interior node follows; all where there are
   * fewer. Those as far as the last of them count, too. Changing it prepares again. Default 80, the
   * paper's for volumes; range [1, VTK_INT_MAX].
   */
  vtkSetClampMacro(NumberOfNeighbors, int, 1, VTK_INT_MAX);
  vtkGetMacro(NumberOfNeighbors, int);
  ///@}

protected:
  vtkWeightedResidualMorph();
  ~vtkWeightedResidualMorph() override;

  std::unique_ptr<morph::Morpher> CreateMorpher() override;
  std::string PrepareOptions() override;

private:
  vtkWeightedResidualMorph(const vtkWeightedResidualMorph&) = delete;
  void operator=(const vtkWeightedResidualMorph&) = delete;

  int NumberOfNeighbors = 80;
};

#endif
