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
 * Cells may be more or less stiff: stiff ones keep their shape at the expense of the others, and
 * only ratios count. With any stiffness the method stays linear, affine motions stay exact, and it
 * has an adjoint: the least-squares affine fit of the boundary's motion is taken off first, and
 * added to the answer to the rest. H. Jasak, Z. Tukovic, "Automatic mesh motion for the
 * unstructured finite volume method", Trans. FAMENA 30 (2006) 1-20, compares such stiffnesses.
 *
 * T. J. Baker, "Mesh movement and metamorphosis", Engineering with Computers 18 (2002)
 * 188-198; S. M. Shontz, S. A. Vavasis, "Analysis of and workarounds for element reversal for a
 * finite element-based algorithm for warping triangular and tetrahedral meshes", BIT 50 (2010)
 * 863-884.
 *
 * @sa vtkMorphAlgorithm vtkExtractMorphBoundary
 */
#ifndef vtkFEMWarpMorph_h
#define vtkFEMWarpMorph_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro
#include "vtkMorphAlgorithm.h"

#include <vtkSmartPointer.h> // for the values

class vtkDataArray;

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkFEMWarpMorph : public vtkMorphAlgorithm
{
public:
  static vtkFEMWarpMorph* New();
  vtkTypeMacro(vtkFEMWarpMorph, vtkMorphAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Residual, relative to the right-hand side and for each coordinate, at which the solver stops.
   * Changing it does not prepare again. Default 1e-10, range [1e-15, 0.999].
   */
  virtual void SetTolerance(double value);
  vtkGetMacro(Tolerance, double);
  ///@}

  enum StiffnessType
  {
    STIFFNESS_UNIFORM = 0,
    STIFFNESS_INVERSE_VOLUME = 1,
    STIFFNESS_WALL_DISTANCE = 2
  };
  ///@{
  /**
   * The stiffness of a cell: the same for all, as published; 1 / volume; or 1 / distance from the
   * walls, each to the power of StiffnessExponent. The distance is that of the cell's centre from
   * the nearest wall node. Walls are the nodes that move (Role 1) where port 1 comes from
   * vtkBoundaryDisplacement, else all prescribed nodes, unless WallArray names them. Ratios to the
   * stiffest cell below 1e-10 count as this. Default STIFFNESS_UNIFORM.
   */
  vtkSetClampMacro(Stiffness, int, STIFFNESS_UNIFORM, STIFFNESS_WALL_DISTANCE);
  vtkGetMacro(Stiffness, int);
  void SetStiffnessToUniform() { this->SetStiffness(STIFFNESS_UNIFORM); }
  void SetStiffnessToInverseVolume() { this->SetStiffness(STIFFNESS_INVERSE_VOLUME); }
  void SetStiffnessToWallDistance() { this->SetStiffness(STIFFNESS_WALL_DISTANCE); }
  ///@}

  ///@{
  /**
   * The power of volume or distance. Default 1, range [0, 4].
   */
  virtual void SetStiffnessExponent(double value);
  vtkGetMacro(StiffnessExponent, double);
  ///@}

  ///@{
  /**
   * Name of a cell array of port 0 with one positive number a volume cell, which multiplies the
   * stiffness. Empty or "None": none. Default: none.
   */
  vtkSetStringMacro(StiffnessArray);
  vtkGetStringMacro(StiffnessArray);
  ///@}

  ///@{
  /**
   * Name of a point array of port 0: nodes where it is not zero are the walls of
   * STIFFNESS_WALL_DISTANCE. Empty or "None": none. Default: none.
   */
  vtkSetStringMacro(WallArray);
  vtkGetStringMacro(WallArray);
  ///@}

  /**
   * As StiffnessArray, for programs: an array that port 0 does not have. Null: none.
   */
  void SetStiffnessValues(vtkDataArray* values);

protected:
  vtkFEMWarpMorph();
  ~vtkFEMWarpMorph() override;

  void TakeInputs(vtkUnstructuredGrid* rest, vtkDataObject* boundary) override;
  std::unique_ptr<morph::Morpher> CreateMorpher() override;
  std::string PrepareOptions() override;
  void SetEvaluateOptions(morph::Morpher& morpher) override;
  std::string EvaluateOptions() override;

private:
  vtkFEMWarpMorph(const vtkFEMWarpMorph&) = delete;
  void operator=(const vtkFEMWarpMorph&) = delete;

  class vtkTaken;
  std::unique_ptr<vtkTaken> Taken;

  double Tolerance = 1e-10;
  int Stiffness = STIFFNESS_UNIFORM;
  double StiffnessExponent = 1;
  char* StiffnessArray = nullptr;
  char* WallArray = nullptr;
  vtkSmartPointer<vtkDataArray> StiffnessValues;
};

#endif
