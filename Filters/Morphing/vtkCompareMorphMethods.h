// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkCompareMorphMethods
 * @brief   runs morphing methods on one mesh and boundary, step by step, and compares them
 *
 * Ports 0 and 1 take an undeformed mesh and a displaced boundary, as vtkMorphAlgorithm does. Each
 * chosen method morphs the mesh in steps: those of a boundary that varies in time, or
 * NumberOfSteps. Steps start from the undeformed mesh (absolute), or from the mesh of the step
 * before (relative). Methods have their default options and Validity None, so that the inverted
 * cells are the method's own.
 *
 * Output 0 has a row for each method, stepping and step:
 * Method, Stepping, Step, Time, MinScaledJacobian, MeanScaledJacobian, LowScaledJacobian (see
 * Percentile), InvertedCells, DegenerateCells, BoundaryInvertedCells (those of them that no method
 * can avoid; see vtkMorphAlgorithm), PrepareSeconds, EvaluateSeconds, and PeakMegabytes, the
 * largest increase of memory during the method's run (Linux; NaN elsewhere). Behind these are four
 * columns for each of the Criteria.
 *
 * Output 1 is made for a line chart: Time, and a column of minimum scaled Jacobians for each method
 * and stepping.
 *
 * Output 2 has a row for each method and stepping, best first: Rank, Method, Stepping,
 * FirstInvertedStep (the first with an inverted or degenerate cell, or without a mesh; -1 for
 * none), LastValidTime (of the step before it, the largest motion that the method survives; NaN
 * where there is none), LastValidMinScaledJacobian (there), Seconds (of all steps) and
 * PeakMegabytes. The best stays valid for the most steps. Ties go to the higher minimum scaled
 * Jacobian at the last valid step, to 0.01, and then to the shorter time.
 *
 * Where a method fails, a warning gives the reason, and its run ends there. Errors of the filter
 * itself: a boundary or mesh that is missing or of a wrong type, and no chosen method or stepping.
 * The outputs are then empty, and so they are after an abort. Data sets and properties are checked
 * as vtkMorphAlgorithm checks them.
 *
 * On several MPI ranks all get the same tables: times and memory are the largest of the ranks.
 *
 * Cost: that of all methods and steps. All boundaries of a series are fetched first, from within
 * RequestData, for the reason that vtkMorphAlgorithm gives, and kept during the execution.
 *
 * M. L. Staten, S. J. Owen, S. M. Shontz, A. G. Salinger, T. S. Coffey, "A comparison of mesh
 * morphing methods for 3D shape optimization", Proc. 20th Int. Meshing Roundtable (2011) 293-311:
 * output 1 is what its figures 2, 4, 6 and 8 show.
 *
 * @sa vtkMorphAlgorithm vtkScaledJacobian
 */
#ifndef vtkCompareMorphMethods_h
#define vtkCompareMorphMethods_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro

#include <vtkSmartPointer.h>
#include <vtkTableAlgorithm.h>

#include <memory> // for std::unique_ptr
#include <string> // for the criteria
#include <vector> // for the boundaries

namespace morph
{
class Monitor;
}

class vtkDataObject;
class vtkMorphAlgorithm;
class vtkUnstructuredGrid;

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkCompareMorphMethods : public vtkTableAlgorithm
{
public:
  static vtkCompareMorphMethods* New();
  vtkTypeMacro(vtkCompareMorphMethods, vtkTableAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The displaced boundary, a vtkPointSet: the same as SetInputConnection() and SetInputData() on
   * port 1.
   */
  void SetBoundaryConnection(vtkAlgorithmOutput* output);
  void SetBoundaryData(vtkDataObject* boundary);
  ///@}

  ///@{
  /**
   * Which methods to run. Default: all.
   */
  vtkSetMacro(Smoothing, bool);
  vtkGetMacro(Smoothing, bool);
  vtkBooleanMacro(Smoothing, bool);
  vtkSetMacro(WeightedResidual, bool);
  vtkGetMacro(WeightedResidual, bool);
  vtkBooleanMacro(WeightedResidual, bool);
  vtkSetMacro(SimplexLinear, bool);
  vtkGetMacro(SimplexLinear, bool);
  vtkBooleanMacro(SimplexLinear, bool);
  vtkSetMacro(SimplexNaturalNeighbor, bool);
  vtkGetMacro(SimplexNaturalNeighbor, bool);
  vtkBooleanMacro(SimplexNaturalNeighbor, bool);
  vtkSetMacro(RadialBasis, bool);
  vtkGetMacro(RadialBasis, bool);
  vtkBooleanMacro(RadialBasis, bool);
  vtkSetMacro(FEMWARP, bool);
  vtkGetMacro(FEMWARP, bool);
  vtkBooleanMacro(FEMWARP, bool);
  vtkSetMacro(LBWARP, bool);
  vtkGetMacro(LBWARP, bool);
  vtkBooleanMacro(LBWARP, bool);
  vtkSetMacro(InversionFree, bool);
  vtkGetMacro(InversionFree, bool);
  vtkBooleanMacro(InversionFree, bool);
  ///@}

  ///@{
  /**
   * Whether steps start from the undeformed mesh, and from the mesh of the step before; see
   * vtkMorphAlgorithm::SetStepping(). Default: from the undeformed mesh alone.
   */
  vtkSetMacro(Absolute, bool);
  vtkGetMacro(Absolute, bool);
  vtkBooleanMacro(Absolute, bool);
  vtkSetMacro(Relative, bool);
  vtkGetMacro(Relative, bool);
  vtkBooleanMacro(Relative, bool);
  ///@}

  ///@{
  /**
   * Steps of a boundary that does not vary in time; see vtkMorphAlgorithm::SetNumberOfSteps().
   * Default 5; the paper takes 20. Range [1, 1000000]; values outside become the nearest bound.
   */
  vtkSetClampMacro(NumberOfSteps, int, 1, 1000000);
  vtkGetMacro(NumberOfSteps, int);
  ///@}

  ///@{
  /**
   * The percentile of LowScaledJacobian: this percentage of the cells lie below it. Default 1,
   * range [0, 100].
   */
  virtual void SetPercentile(double value);
  vtkGetMacro(Percentile, double);
  ///@}

  ///@{
  /**
   * More criteria for output 0, as vtkScaledJacobian::SetCriteria() has them: "NonOrthogonality=70"
   * adds NonOrthogonalityLimit, NonOrthogonalityWorst, NonOrthogonalityWorstCellId and
   * NonOrthogonalityCellsBeyond. Default: none.
   */
  void SetCriteria(const char* text);
  const char* GetCriteria() const { return this->Criteria.c_str(); }
  ///@}

  ///@{
  /**
   * The stiffness of the cells for FEMWARP: see vtkFEMWarpMorph. Defaults STIFFNESS_UNIFORM, 1.
   */
  vtkSetClampMacro(Stiffness, int, 0, 2);
  vtkGetMacro(Stiffness, int);
  virtual void SetStiffnessExponent(double value);
  vtkGetMacro(StiffnessExponent, double);
  ///@}

  ///@{
  /**
   * The options of vtkMorphAlgorithm with the same names and defaults. A ScaleFactor over 1
   * extrapolates the boundary's motion.
   */
  vtkSetStringMacro(BoundaryIdArray);
  vtkGetStringMacro(BoundaryIdArray);
  vtkSetStringMacro(DisplacementArray);
  vtkGetStringMacro(DisplacementArray);
  virtual void SetScaleFactor(double value);
  vtkGetMacro(ScaleFactor, double);
  virtual void SetMatchTolerance(double value);
  vtkGetMacro(MatchTolerance, double);
  vtkSetMacro(HoldUnnamedBoundary, bool);
  vtkGetMacro(HoldUnnamedBoundary, bool);
  vtkBooleanMacro(HoldUnnamedBoundary, bool);
  virtual void SetRestTime(double value);
  vtkGetMacro(RestTime, double);
  vtkSetClampMacro(NumberOfThreads, int, 0, VTK_INT_MAX);
  vtkGetMacro(NumberOfThreads, int);
  vtkSetClampMacro(CoincidentPoints, int, 0, 2);
  vtkGetMacro(CoincidentPoints, int);
  ///@}

  ///@{
  /**
   * The best method and stepping of the last execution: "FEMWARP", "Absolute". Empty where there
   * was no result.
   */
  const char* GetBestMethod() const;
  const char* GetBestStepping() const;
  ///@}

protected:
  vtkCompareMorphMethods();
  ~vtkCompareMorphMethods() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkCompareMorphMethods(const vtkCompareMorphMethods&) = delete;
  void operator=(const vtkCompareMorphMethods&) = delete;

  struct vtkInternals;
  std::unique_ptr<vtkInternals> Internals;

  /// `boundaries`: one for each time of a boundary that varies, or the one. `onRanks`: all MPI
  /// processes call it, each with its piece.
  void Compare(vtkUnstructuredGrid* grid,
    const std::vector<vtkSmartPointer<vtkDataObject>>& boundaries, bool onRanks,
    vtkInformationVector* outputVector, morph::Monitor& monitor);
  void Configure(vtkMorphAlgorithm* filter) const;

  bool Smoothing = true;
  bool WeightedResidual = true;
  bool SimplexLinear = true;
  bool SimplexNaturalNeighbor = true;
  bool RadialBasis = true;
  bool FEMWARP = true;
  bool LBWARP = true;
  bool InversionFree = true;
  int Stiffness = 0;
  double StiffnessExponent = 1;
  bool Absolute = true;
  bool Relative = false;
  int NumberOfSteps = 5;
  double Percentile = 1;
  std::string Criteria;
  char* BoundaryIdArray = nullptr;
  char* DisplacementArray = nullptr;
  double ScaleFactor = 1;
  double MatchTolerance = 1e-6;
  bool HoldUnnamedBoundary = true;
  double RestTime = -1e300;
  int NumberOfThreads = 0;
  int CoincidentPoints = 0;
};

#endif
