// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkScaledJacobian
 * @brief   measures the scaled Jacobian of every cell, and counts the cells that are inverted
 *
 * The scaled Jacobian of a corner is the determinant of its three edges, each scaled to length 1.
 * The scaled Jacobian of a cell is the minimum over its corners (and the centre of a hexahedron),
 * normalised so that the ideal cell has 1. At or below 0 the cell is inverted. The conventions are
 * Verdict's, and on valid tetrahedra and hexahedra the numbers are those of vtkMeshQuality. They
 * differ on purpose in three cases. A cell with a corner whose edges have no length gets 0 and is
 * counted as degenerate; inverted pyramids get their negative value; cells that cannot be measured
 * get NaN. vtkMeshQuality also has neither mirrored bodies nor certificates (below), which a morph
 * needs.
 *
 * Cells of the highest dimension in the grid are measured: tetrahedra, hexahedra, voxels (as
 * hexahedra in VTK's order), wedges, pyramids and polyhedra, or triangles, quads and pixels where
 * there is no volume cell. A quadratic volume cell has the value of its corners, unless the
 * determinant of its true map is found negative inside: then it has a value below 0 and is
 * inverted. (Where the corners alone are inverted and the cell is positive everywhere, it has the
 * minimum over its nodes.) Quadratic faces are measured by their corners. Cells of lower dimension
 * and ghost cells get NaN and are not counted. Cells of the highest dimension that have no scaled
 * Jacobian here (polygons, Lagrange cells, ...) get NaN and are counted in UnmeasuredCells; one
 * warning names their types.
 *
 * A polyhedron has the minimum over the edges of its faces: of the edge and the lines from its
 * middle and from the cell's centre to the face's centre, scaled to length 1. A positive value
 * means that the tetrahedra of edge and centres are positive, and so OpenFOAM's face pyramids.
 * Certify tests the same tetrahedra.
 *
 * Volume cells of one shape in one connected body share a sign, that of their summed volume. So a
 * body that is mirrored as a whole, or wedges in VTK's older node order, are measured as valid (and
 * reported as MirroredBodies). A cell that is inverted among valid neighbors has a negative value.
 *
 * The scaled Jacobian samples a few points of each linear cell only: a hexahedron or wedge that is
 * positive there may still be inverted inside. Certify proves the sign of the Jacobian determinant
 * for the whole of every volume cell, in the cell array `JacobianCertificate`. It is 1 where the
 * determinant is positive everywhere, and -1 where it is zero or negative somewhere, corners
 * included. It is 0 where neither was proved, and for cells that were not examined (lower
 * dimension, ghosts). The proof is exact for linear tetrahedra and pyramids, and by bounds with
 * subdivision for the others. Quadratic cells are proved with VTK's own maps through all of their
 * nodes. The field data CertifiedCells, UncertifiedCells (the cells with -1) and UndecidedCells
 * count them. With Certify off, arrays of these names in the input are removed.
 *
 * The output is the input with the cell array `ScaledJacobian` (double, active cell scalars) and
 * the field data MinScaledJacobian, MeanScaledJacobian, InvertedCells, DegenerateCells, WorstCellId
 * and MirroredBodies. With several MPI ranks the numbers are those of the whole mesh, or of each
 * rank's own piece in a build without MESHMORPHING_USE_MPI. All ranks then have to execute the
 * filter.
 *
 * The input may be composite data, see vtkMorphAlgorithm: its blocks are measured as one mesh, and
 * come out with their own types.
 *
 * A grid without cells gives a warning. Errors: overlapping AMR, cells but no points, node ids or
 * coordinates that are not valid, and arrays shorter than there are points or cells. Also
 * coordinates above 1e50, and a largest extent below 1e-50. The output is then empty, and
 * InvertedCells and MinScaledJacobian are -1. The same holds, without a message, for an execution
 * that was aborted. Cost: one pass over the cells, about 0.1 microseconds each (5 for a quadratic
 * volume cell), and a copy of the connectivity; with Certify 0.1 to 1.5 microseconds more, 5 for a
 * curved quadratic cell.
 *
 * P. M. Knupp, "Achieving finite element mesh quality via optimization of the Jacobian matrix norm
 * and associated quantities. Part II", Int. J. Numer. Meth. Engng 48 (2000) 1165-1185; C. J.
 * Stimpson et al., "The Verdict geometric quality library", Sandia report SAND2007-1751.
 *
 * @sa vtkMeshQuality vtkCellQuality vtkFEMWarpMorph
 */
#ifndef vtkScaledJacobian_h
#define vtkScaledJacobian_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro

#include <vtkUnstructuredGridAlgorithm.h>

#include <memory> // for std::unique_ptr
#include <string> // for the criteria

namespace morph
{
class Monitor;
}

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkScaledJacobian : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkScaledJacobian* New();
  vtkTypeMacro(vtkScaledJacobian, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Threads to measure with. 0 means all cores. The numbers do not depend on it. Default 0, range
   * [0, VTK_INT_MAX].
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, VTK_INT_MAX);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * Which points of the blocks of composite data are one node:
   * vtkMorphAlgorithm::CoincidentPointsType. The same in all filters of a pipeline. Default 0, one
   * node.
   */
  vtkSetClampMacro(CoincidentPoints, int, 0, 2);
  vtkGetMacro(CoincidentPoints, int);
  ///@}

  ///@{
  /**
   * Whether to prove for each volume cell that its Jacobian determinant is positive everywhere.
   * Default off.
   */
  vtkSetMacro(Certify, bool);
  vtkGetMacro(Certify, bool);
  vtkBooleanMacro(Certify, bool);
  ///@}

  ///@{
  /**
   * More criteria by which to measure, with or without a limit: "NonOrthogonality=70, AspectRatio".
   * Without one the limit is the usual one. Default: none.
   *
   * | criterion | of | limit |
   * |---|---|---|
   * | AspectRatio | longest edge / shortest edge; linear triangles, quads, tets: Verdict's | 100 |
   * | Skewness | equiangle skewness, the worst face | 0.95 |
   * | Warpage | the worst face | 0.7 |
   * | JacobianRatio | smallest / largest determinant at corners; not of polyhedra | 0.03 |
   * | Taper | quads and hexahedra | 0.5 |
   * | NonOrthogonality | degrees, the worst inner face | 70 |
   * | FaceSkewness | OpenFOAM's skewness, the worst face | 4 |
   * | FacePyramid | volume, the smallest pyramid of a face and the cell's centre | 0 |
   * | FirstHeight | mean distance of the other corners from a face on the boundary | 0 |
   *
   * "FirstHeight:BLADE" takes the faces of one surface. Their corners are marked by the point array
   * BLADE, or the surface's two-dimensional cells by the cell array BLADE, with values that are not
   * 0.
   *
   * Cells are beyond the limit above it; for JacobianRatio, FacePyramid and FirstHeight at it or
   * below. Each criterion adds a cell array of its name, as given, NaN where the cell has none. The
   * field data Criterion, CriterionLimit, CriterionWorst, CriterionWorstCellId and
   * CriterionCellsBeyond have a row for each. Quadratic cells are measured by their corners. The
   * last four are of volume cells alone; with pieces on several MPI ranks they take the cells
   * across. A name or a limit that is not valid is an error.
   */
  void SetCriteria(const char* text);
  const char* GetCriteria() const { return this->Criteria.c_str(); }
  ///@}

  ///@{
  /**
   * Minimum and mean scaled Jacobian over the measured cells; NaN before the first execution and
   * where no cell was measured. After an error the minimum is -1 and the mean NaN.
   */
  double GetMinScaledJacobian() const { return this->GetNumber("MinScaledJacobian"); }
  double GetMeanScaledJacobian() const { return this->GetNumber("MeanScaledJacobian"); }
  ///@}

  /**
   * Number of cells that were measured.
   */
  vtkIdType GetMeasuredCells() const { return this->GetInteger("MeasuredCells"); }

  /**
   * Number of cells with a scaled Jacobian of 0 or less, without the degenerate ones; -1 after an
   * error.
   */
  vtkIdType GetInvertedCells() const { return this->GetInteger("InvertedCells"); }

  /**
   * Number of cells with a corner whose edges have no length. Their value is 0.
   */
  vtkIdType GetDegenerateCells() const { return this->GetInteger("DegenerateCells"); }

  /**
   * The lowest id among the cells at the minimum, or -1 where no cell was measured.
   */
  vtkIdType GetWorstCellId() const { return this->GetInteger("WorstCellId"); }

  /**
   * Number of cells of the highest dimension, without ghosts, that have no scaled Jacobian here.
   */
  vtkIdType GetUnmeasuredCells() const { return this->GetInteger("UnmeasuredCells"); }

  /**
   * Number of bodies that hold cells whose nodes are in the mirror image of VTK's order.
   */
  vtkIdType GetMirroredBodies() const { return this->GetInteger("MirroredBodies"); }

  ///@{
  /**
   * Number of cells proved positive everywhere, of cells found zero or negative somewhere, and of
   * cells where neither was proved. All 0 unless Certify is on.
   */
  vtkIdType GetCertifiedCells() const { return this->GetInteger("CertifiedCells"); }
  vtkIdType GetUncertifiedCells() const { return this->GetInteger("UncertifiedCells"); }
  vtkIdType GetUndecidedCells() const { return this->GetInteger("UndecidedCells"); }
  ///@}

  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

protected:
  vtkScaledJacobian();
  ~vtkScaledJacobian() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkScaledJacobian(const vtkScaledJacobian&) = delete;
  void operator=(const vtkScaledJacobian&) = delete;

  class vtkInternals;
  std::unique_ptr<vtkInternals> Internals;

  void Measure(vtkUnstructuredGrid* input, vtkUnstructuredGrid* output, morph::Monitor& monitor);
  ///@{
  /// A result of the last execution, by its name in Results.txt.
  double GetNumber(const char* name) const;
  vtkIdType GetInteger(const char* name) const;
  ///@}

  int NumberOfThreads = 0;
  int CoincidentPoints = 0;
  bool Certify = false;
  std::string Criteria;
};

#endif
