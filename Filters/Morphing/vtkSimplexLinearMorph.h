// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSimplexLinearMorph
 * @brief   morphs a mesh by linear interpolation in tetrahedra between its boundary nodes
 *
 * Each interior node follows the tetrahedron that contains it, by its barycentric coordinates
 * (equation (7) of Staten et al.). The tetrahedra are a Delaunay tessellation of the prescribed
 * nodes alone. It is the fastest method: one search, then four weights a node. Affine motions of
 * the boundary are reproduced exactly. The mesh's cells are not used, so any volume mesh will do,
 * and bodies need not be connected.
 *
 * Where the mesh is not convex, tetrahedra span its holes, slots and gaps and couple the walls that
 * face each other there. Where the motion inverts tetrahedra, which FoldedTetrahedra counts, cells
 * in them are inverted.
 *
 * On structured meshes many sets of boundary nodes lie on one sphere, and the tessellation is not
 * unique. The convex cell of such a set is then divided from the mean of its corners. So neither
 * renumbering the nodes nor rotating the mesh moves a node in the prescribed nodes' convex hull
 * elsewhere, but for rounding. Outside it can change the tetrahedron that a node follows.
 *
 * It is an error if all prescribed nodes lie in one plane. Memory: 56 bytes an interior node, and
 * some 300 a prescribed node.
 *
 * M. L. Staten, S. J. Owen, S. M. Shontz, A. G. Salinger, T. S. Coffey, "A comparison of mesh
 * morphing methods for 3D shape optimization", Proc. 20th Int. Meshing Roundtable (2011) 293-311,
 * section 3.3.
 *
 * @sa vtkMorphAlgorithm vtkSimplexNaturalNeighborMorph vtkExtractMorphBoundary
 */
#ifndef vtkSimplexLinearMorph_h
#define vtkSimplexLinearMorph_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro
#include "vtkMorphAlgorithm.h"

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkSimplexLinearMorph : public vtkMorphAlgorithm
{
public:
  static vtkSimplexLinearMorph* New();
  vtkTypeMacro(vtkSimplexLinearMorph, vtkMorphAlgorithm);

  ///@{
  /**
   * As of the last execution: tetrahedra with nodes in them that have no positive volume after the
   * motion; and nodes outside the prescribed nodes' convex hull by more than rounding, which are
   * extrapolated. The last are those of them that follow the affine fit to the nearest prescribed
   * nodes, since a tetrahedron would give them a weight above 10. In the output's field data too.
   */
  vtkIdType GetFoldedTetrahedra() { return this->GetCount("FoldedTetrahedra"); }
  vtkIdType GetExtrapolatedNodes() { return this->GetCount("ExtrapolatedNodes"); }
  vtkIdType GetAffineNodes() { return this->GetCount("AffineNodes"); }
  ///@}

protected:
  vtkSimplexLinearMorph();
  ~vtkSimplexLinearMorph() override;

  std::unique_ptr<morph::Morpher> CreateMorpher() override;

private:
  vtkSimplexLinearMorph(const vtkSimplexLinearMorph&) = delete;
  void operator=(const vtkSimplexLinearMorph&) = delete;
};

#endif
