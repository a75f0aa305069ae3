// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkMorphShapes
 * @brief   blends saved shapes of a mesh's boundary, each with a weight, and moves the mesh
 *
 * A shape is a displaced boundary. The mesh moves by the weighted sum of the shapes' motions: with
 * all weights 0 it is undeformed, and with one weight of 1 its boundary is that shape. Weights
 * below 0 and above 1 extrapolate.
 *
 * Port 0 takes the undeformed mesh (vtkUnstructuredGrid, or composite data, see
 * vtkMorphAlgorithm). Port 1 takes the shapes, one connection
 * each: the output of vtkBoundaryDisplacement or vtkMorphBoundary, or any other displaced boundary
 * (vtkPointSet). Its points are matched to nodes as vtkMorphAlgorithm does. A node that any shape
 * names is prescribed; where a shape does not name it, it stays in that shape. Output 0 is the
 * morphed mesh with the arrays MorphDisplacement and ScaledJacobian, and output 1 its inverted and
 * degenerate cells, both as vtkMorphAlgorithm has them. The field data of output 0 also has the
 * arrays ShapeNames and ShapeWeights.
 *
 * Output 2 (vtkPolyData) is the outer boundary of the morphed mesh, to be shown in place of it. Its
 * polygons are the same object from execution to execution, so that only points and colors change.
 * It has the point array MorphPointId and the cell arrays MorphCellId and ScaledJacobian, that of
 * the cell behind each face.
 *
 * The method is linear: each shape has one displacement field of the whole mesh, solved once and
 * kept. Adding or removing a shape solves only that one; changing a weight solves nothing and costs
 * one pass over the nodes. See SolveCount. A shape that changes the set of prescribed nodes
 * prepares the method again and solves all. The result does not depend on what was kept.
 *
 * Rotations do not blend linearly: halfway to a displacement of 180 degrees a part has shrunk to
 * its axis. A shape that rotates may be taken as a rotation about its axis (SetMotion()): its
 * weight is then the factor of the angle, and it has two displacement fields, sin(s a) m1 + (1 -
 * cos(s a)) m2. The shape's moving nodes have to be rotated as one, without a slide along the axis.
 *
 * Port 2, optional, takes a table of designs (vtkTable): a column of weights for each shape, of the
 * shape's name, and a row for each design. The outputs then have the time steps 0, 1, ..., one a
 * row, and at each the weights are those of its row. A shape without a column has its own weight.
 *
 * On several MPI ranks each blends the nodes of its piece. Numbers, ranges and derivatives are
 * those of the whole mesh, the same on each rank. One rank alone may have the table.
 *
 * A shape is taken at its input's own time. Errors are those of vtkMorphAlgorithm, with the shape's
 * name; output 0 is then the undeformed mesh, MorphStatus is "Failed", and InvertedCells and
 * MinScaledJacobian are -1. Memory: 24 bytes a node and displacement field, besides the method's.
 *
 * @sa vtkMorphAlgorithm vtkBoundaryDisplacement vtkMorphBoundary
 */
#ifndef vtkMorphShapes_h
#define vtkMorphShapes_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro

#include <vtkUnstructuredGridAlgorithm.h>

#include <memory> // for std::unique_ptr
#include <string> // for std::string
#include <vector> // for std::vector

namespace morph
{
class Monitor;
}

class vtkDataArray;
class vtkDoubleArray;

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkMorphShapes : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkMorphShapes* New();
  vtkTypeMacro(vtkMorphShapes, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Adds a shape, a vtkPointSet: the same as AddInputConnection() and AddInputDataObject() on port
   * 1. Remove one with RemoveInputConnection().
   */
  void AddShapeConnection(vtkAlgorithmOutput* output);
  void AddShapeData(vtkDataObject* boundary);
  void RemoveAllShapes();
  ///@}

  /**
   * The number of shapes: connections of port 1.
   */
  int GetNumberOfShapes();

  ///@{
  /**
   * The weight of each shape, in the order of port 1's connections: any finite number. A shape
   * without a weight has 0; weights beyond the last shape have no effect. SetWeight() makes the
   * list longer if need be, by zeros. Default: one weight, 0.
   */
  void SetNumberOfWeights(int number);
  int GetNumberOfWeights() const { return static_cast<int>(this->Weights.size()); }
  void SetWeight(int shape, double weight);
  double GetWeight(int shape) const;
  ///@}

  ///@{
  /**
   * The name of each shape, for messages and the field data. Default, and where it is empty: "Shape
   * 1" and so on.
   */
  void SetNumberOfShapeNames(int number);
  void SetShapeName(int shape, const char* name);
  std::string GetShapeName(int shape) const;
  ///@}

  enum MotionType
  {
    MOTION_AS_DISPLACEMENT = 0,
    MOTION_AS_ROTATION = 1
  };
  ///@{
  /**
   * How a shape's weight scales its motion: the displacement, or the angle of the rotation about
   * its axis. A shape without an entry has MOTION_AS_DISPLACEMENT, the default.
   */
  void SetNumberOfMotions(int number);
  void SetMotion(int shape, int motion);
  int GetMotion(int shape) const;
  ///@}

  enum MethodType
  {
    METHOD_FEMWARP = 0,
    METHOD_LBWARP = 1,
    METHOD_WEIGHTED_RESIDUAL = 2,
    METHOD_SIMPLEX_LINEAR = 3,
    METHOD_SIMPLEX_NATURAL_NEIGHBOR = 4,
    METHOD_RADIAL_BASIS = 5
  };
  ///@{
  /**
   * The linear method that moves the interior nodes, with the default options of its own filter.
   * LBWARP relaxes nodes outside the hull of their neighbors. Default METHOD_FEMWARP.
   */
  vtkSetClampMacro(Method, int, METHOD_FEMWARP, METHOD_RADIAL_BASIS);
  vtkGetMacro(Method, int);
  void SetMethodToFEMWARP() { this->SetMethod(METHOD_FEMWARP); }
  void SetMethodToLBWARP() { this->SetMethod(METHOD_LBWARP); }
  void SetMethodToWeightedResidual() { this->SetMethod(METHOD_WEIGHTED_RESIDUAL); }
  void SetMethodToSimplexLinear() { this->SetMethod(METHOD_SIMPLEX_LINEAR); }
  void SetMethodToSimplexNaturalNeighbor() { this->SetMethod(METHOD_SIMPLEX_NATURAL_NEIGHBOR); }
  void SetMethodToRadialBasis() { this->SetMethod(METHOD_RADIAL_BASIS); }
  ///@}

  ///@{
  /**
   * Residual at which the solvers of FEMWARP and LBWARP stop, relative to each shape's right-hand
   * side and for each coordinate. Changing it prepares again. Default 1e-10, range [1e-15, 0.999].
   */
  virtual void SetTolerance(double value);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /**
   * Whether to find the valid range of each weight: the open interval around 0 in which no cell is
   * inverted, the other weights at their present values. Its ends are roots of the determinants
   * that ScaledJacobian measures: polynomials of degree 3 in a weight, and for a rotation the
   * limits of steps in which these stay positive. The ends are on the safe side by rounding, for
   * quadratic cells by more (morph::validRange()). The field data have ShapeLowestWeight and
   * ShapeHighestWeight; both are NaN where cells are inverted at a weight of 0. Those of polyhedra
   * are near the exact ends, on either side: their centres keep the weights that they have at a
   * weight of 0. Cost: one pass over the cells a shape. Default on.
   */
  vtkSetMacro(FindValidRanges, bool);
  vtkGetMacro(FindValidRanges, bool);
  vtkBooleanMacro(FindValidRanges, bool);
  ///@}

  ///@{
  /**
   * The table of designs, a vtkTable: the same as SetInputConnection() and SetInputData() on port
   * 2. The number of rows is needed for the time steps, so an update of the information updates the
   * pipeline before this port.
   */
  void SetTableConnection(vtkAlgorithmOutput* output);
  void SetTableData(vtkDataObject* table);
  ///@}

  ///@{
  /**
   * Whether to find all rows of the table that leave inverted or degenerate cells; see
   * GetInvertingDesigns(). The answer is kept while table and shapes are the same. Cost: an
   * evaluation and a measure of quality for each row. Default on.
   */
  vtkSetMacro(CheckDesigns, bool);
  vtkGetMacro(CheckDesigns, bool);
  vtkBooleanMacro(CheckDesigns, bool);
  ///@}

  ///@{
  /**
   * How the points of every shape are matched to nodes; see vtkMorphAlgorithm.
   */
  vtkSetStringMacro(BoundaryIdArray);
  vtkGetStringMacro(BoundaryIdArray);
  vtkSetStringMacro(DisplacementArray);
  vtkGetStringMacro(DisplacementArray);
  virtual void SetMatchTolerance(double value);
  vtkGetMacro(MatchTolerance, double);
  vtkSetMacro(HoldUnnamedBoundary, bool);
  vtkGetMacro(HoldUnnamedBoundary, bool);
  vtkBooleanMacro(HoldUnnamedBoundary, bool);
  ///@}

  enum QualityType
  {
    QUALITY_ALL = 0,
    QUALITY_SURFACE = 1
  };
  ///@{
  /**
   * The cells that are measured: all, or those behind the outer faces alone, which is faster while
   * weights are dragged. With the latter output 0 has no ScaledJacobian, output 1 is empty,
   * MorphStatus is "Unmeasured", and of the measures there is SurfaceInvertedCells alone. Default
   * QUALITY_ALL.
   */
  vtkSetClampMacro(Quality, int, QUALITY_ALL, QUALITY_SURFACE);
  vtkGetMacro(Quality, int);
  void SetQualityToAll() { this->SetQuality(QUALITY_ALL); }
  void SetQualityToSurface() { this->SetQuality(QUALITY_SURFACE); }
  ///@}

  ///@{
  /**
   * Whether output 2 has lines along the edges at which the undeformed faces turn by more than 25
   * degrees. They come before the polygons; their MorphCellId is -1 and their ScaledJacobian NaN.
   * Default off.
   */
  vtkSetMacro(FeatureLines, bool);
  vtkGetMacro(FeatureLines, bool);
  vtkBooleanMacro(FeatureLines, bool);
  ///@}

  ///@{
  /**
   * Threads to compute with. 0 means all cores. The result does not depend on it. Default 0, range
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
   * Type of the output's points: vtkAlgorithm::SINGLE_PRECISION, DOUBLE_PRECISION, or
   * DEFAULT_PRECISION for that of the input's (double where they are neither). Default
   * DEFAULT_PRECISION.
   */
  vtkSetClampMacro(OutputPointsPrecision, int, SINGLE_PRECISION, DEFAULT_PRECISION);
  vtkGetMacro(OutputPointsPrecision, int);
  ///@}

  ///@{
  /**
   * Results of the last execution, as vtkMorphAlgorithm has them; MorphStatus is "Valid",
   * "Inverted", "Unmeasured", "Cancelled", "Failed" or "None". SurfaceInvertedCells are the
   * inverted and degenerate cells behind the outer faces.
   */
  vtkIdType GetSurfaceInvertedCells() const { return this->GetInteger("SurfaceInvertedCells"); }
  double GetMinScaledJacobian() const { return this->GetNumber("MinScaledJacobian"); }
  double GetMeanScaledJacobian() const { return this->GetNumber("MeanScaledJacobian"); }
  vtkIdType GetInvertedCells() const { return this->GetInteger("InvertedCells"); }
  vtkIdType GetDegenerateCells() const { return this->GetInteger("DegenerateCells"); }
  vtkIdType GetInvertedBefore() const { return this->GetInteger("InvertedBefore"); }
  vtkIdType GetNewInvertedCells() const { return this->GetInteger("NewInvertedCells"); }
  vtkIdType GetWorstCellId() const { return this->GetInteger("WorstCellId"); }
  vtkIdType GetMirroredBodies() const { return this->GetInteger("MirroredBodies"); }
  vtkIdType GetPrescribedPoints() const { return this->GetInteger("PrescribedPoints"); }
  const char* GetMorphStatus() const;
  ///@}

  ///@{
  /**
   * As of the last execution, with FindValidRanges on: the ends of a shape's valid range, NaN for a
   * shape that there was not; all ranges as text; and the largest factor of all weights together
   * with which no cell is inverted. With several shapes and a rotation among them the factor is on
   * the safe side, and infinite where no cell is inverted up to one full turn. All are those of the
   * mesh in double precision.
   */
  double GetLowestWeight(int shape) const;
  double GetHighestWeight(int shape) const;
  const char* GetValidRanges() const;
  /**
   * The same ends as an array: #shapes tuples of the lowest and the highest weight, both 0 for an
   * empty range. No tuples where ranges were not searched.
   */
  vtkDoubleArray* GetValidWeights();
  double GetLargestFactor() const { return this->GetNumber("LargestFactor"); }
  ///@}

  /**
   * As of the last execution, with a table of designs and CheckDesigns on: the numbers of the rows,
   * from 0, that leave inverted or degenerate cells in double precision, at most 100 of them.
   */
  const char* GetInvertingDesigns() const;

  /**
   * The derivatives of an objective with respect to the weights of the last execution. `gradient`:
   * its derivatives with respect to the position of each node, #nodes tuples of 3. `derivatives`:
   * becomes a tuple of 1 for each shape. On several MPI ranks all of them call this, each with the
   * gradient of its piece. Cost: one pass over the displacement fields. Returns false after an
   * error, which is reported: no execution before, or a gradient of the wrong size or not finite.
   * See vtkMorphAdjoint.
   */
  bool ComputeDerivatives(vtkDataArray* gradient, vtkDoubleArray* derivatives);

  ///@{
  /**
   * Wall-clock seconds of the last execution: for preparing the method and solving for new shapes
   * (0 where all were kept), and for adding the shapes. Iterations of the solver for new shapes.
   */
  double GetPrepareSeconds() const { return this->GetNumber("PrepareSeconds"); }
  double GetEvaluateSeconds() const { return this->GetNumber("EvaluateSeconds"); }
  int GetSolverIterations() const { return static_cast<int>(this->GetInteger("SolverIterations")); }
  ///@}

  ///@{
  /**
   * How often this object has prepared its method, and for how many displacement fields it has
   * solved: one a shape, two a shape taken as a rotation.
   */
  int GetPrepareCount() const { return static_cast<int>(this->GetInteger("PrepareCount")); }
  int GetSolveCount() const { return static_cast<int>(this->GetInteger("SolveCount")); }
  ///@}

  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

protected:
  vtkMorphShapes();
  ~vtkMorphShapes() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkMorphShapes(const vtkMorphShapes&) = delete;
  void operator=(const vtkMorphShapes&) = delete;

  friend class vtkMorphAdjoint;

  /// ComputeDerivatives() that throws.
  void Differentiate(vtkDataArray* gradient, vtkDoubleArray* derivatives, morph::Monitor& monitor);

  class vtkInternals;
  std::unique_ptr<vtkInternals> Internals;

  ///@{
  /// A result of the last execution, by its name in Results.txt.
  double GetNumber(const char* name) const;
  vtkIdType GetInteger(const char* name) const;
  ///@}

  std::vector<double> Weights = { 0. };
  std::vector<std::string> ShapeNames = { std::string() };
  std::vector<int> Motions = { MOTION_AS_DISPLACEMENT };
  int Method = METHOD_FEMWARP;
  double Tolerance = 1e-10;
  char* BoundaryIdArray = nullptr;
  char* DisplacementArray = nullptr;
  double MatchTolerance = 1e-6;
  bool HoldUnnamedBoundary = true;
  bool FindValidRanges = true;
  bool CheckDesigns = true;
  int Quality = QUALITY_ALL;
  bool FeatureLines = false;
  int NumberOfThreads = 0;
  int CoincidentPoints = 0;
  int OutputPointsPrecision = DEFAULT_PRECISION;
};

#endif
