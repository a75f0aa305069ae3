// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkStiffnessMorph
 * @brief   morphs a mesh by a method for which cells may be more or less stiff
 *
 * Superclass of the methods that treat the mesh as a continuum. Stiff cells keep their shape at the
 * expense of the others; only ratios count. With any stiffness the method stays linear, affine
 * motions stay exact, and it has an adjoint: the least-squares affine fit of the boundary's motion
 * is taken off first, and added to the answer to the rest.
 *
 * H. Jasak, Z. Tukovic, "Automatic mesh motion for the unstructured finite volume method", Trans.
 * FAMENA 30 (2006) 1-20, compares such stiffnesses.
 *
 * @sa vtkFEMWarpMorph vtkLBWarpMorph
 */
#ifndef vtkStiffnessMorph_h
#define vtkStiffnessMorph_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro
#include "vtkMorphAlgorithm.h"

#include <vtkSmartPointer.h> // for the values

class vtkDataArray;

namespace morph
{
class StiffMorpher;
}

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkStiffnessMorph : public vtkMorphAlgorithm
{
public:
  vtkTypeMacro(vtkStiffnessMorph, vtkMorphAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

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
  vtkStiffnessMorph();
  ~vtkStiffnessMorph() override;

  void TakeInputs(vtkUnstructuredGrid* rest, vtkDataObject* boundary) override;

  /// Gives the stiffness to an object of CreateMorpher().
  void GiveStiffness(morph::StiffMorpher& morpher) const;
  /// Of PrepareOptions().
  std::string StiffnessOptions() const;

private:
  vtkStiffnessMorph(const vtkStiffnessMorph&) = delete;
  void operator=(const vtkStiffnessMorph&) = delete;

  class vtkTaken;
  std::unique_ptr<vtkTaken> Taken;

  int Stiffness = STIFFNESS_UNIFORM;
  double StiffnessExponent = 1;
  char* StiffnessArray = nullptr;
  char* WallArray = nullptr;
  vtkSmartPointer<vtkDataArray> StiffnessValues;
};

#endif
