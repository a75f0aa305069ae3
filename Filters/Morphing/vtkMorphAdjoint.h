// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkMorphAdjoint
 * @brief   computes derivatives of an objective on a morphed mesh with respect to its boundary
 *
 * The filter is the adjoint of a linear morphing method, for shape optimisation. Such a method
 * moves the interior nodes by a fixed matrix times the displacement of the boundary, x_free = M
 * x_prescribed. From the derivatives g of an objective with respect to the position of every node
 * of the morphed mesh the filter computes those with respect to every boundary point, g_prescribed
 * + M^T g_free. The cost is that of one evaluation, whatever the number of boundary points.
 *
 * Port 0 takes the undeformed mesh, port 1 the displaced boundary, both as the morphing filter's
 * ports do. The derivatives are the point vectors GradientArray of port 2 (for instance the morphed
 * mesh, on which the objective was evaluated) or, where that is not connected, of port 0. The
 * output is the boundary with the point vectors `MorphGradient`: the derivatives with respect to
 * the points of port 1 or, where the method has a DisplacementArray, to that array. They contain
 * the factor ScaleFactor. Nodes that are held contribute nothing. A point that stands for no node
 * gets 0, and so does each but the first of several points that stand for one node.
 *
 * The method and its options are those of the filter Morph or, where that is not set, of the
 * nearest vtkMorphAlgorithm in the pipeline upstream of port 2. What that filter has prepared is
 * reused. Morph need not be connected to anything.
 *
 * After vtkMorphShapes the derivatives are those with respect to the weights of its shapes: the
 * filter that is nearest upstream of port 2, or MorphShapes, decides. Port 1 is then not needed,
 * and the output has no points, but the field data `ShapeNames` and `ShapeGradient`, a number a
 * shape.
 *
 * Where PostSmooth or Validity has changed the mesh after the method, the derivatives are those of
 * the method alone, and a warning is raised.
 *
 * On several MPI ranks each gives the derivatives at its piece's points, the same at copies of a
 * node. Points of several ranks that stand for one node all get its derivatives: count them once.
 *
 * Time: as vtkMorphAlgorithm's, updates from within RequestData included; port 2 is asked for the
 * output's time.
 *
 * Errors give no result: one message, and an empty output. Among them: no method, one that is not
 * linear, no gradient or one of the wrong size or not finite, and the errors of vtkMorphAlgorithm.
 *
 * A. Jameson, "Aerodynamic design via control theory", J. Sci. Comput. 3 (1988) 233-260;
 * M. L. Staten et al. (2011), as in vtkMorphAlgorithm.
 *
 * @sa vtkMorphAlgorithm
 */
#ifndef vtkMorphAdjoint_h
#define vtkMorphAdjoint_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro

#include <vtkPointSetAlgorithm.h>
#include <vtkSmartPointer.h> // for vtkSmartPointer

#include <memory> // for std::unique_ptr

namespace morph
{
class Monitor;
}

class vtkMorphAlgorithm;
class vtkMorphShapes;
class vtkPointSet;
class vtkUnstructuredGrid;

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkMorphAdjoint : public vtkPointSetAlgorithm
{
public:
  static vtkMorphAdjoint* New();
  vtkTypeMacro(vtkMorphAdjoint, vtkPointSetAlgorithm);
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
   * The data set that carries the derivatives, with as many points as the mesh: the same as
   * SetInputConnection() and SetInputData() on port 2. Optional: the undeformed mesh may carry
   * them.
   */
  void SetGradientConnection(vtkAlgorithmOutput* output);
  void SetGradientData(vtkDataObject* gradient);
  ///@}

  ///@{
  /**
   * The morphing filter whose method, options and array names are used. Default: none, so the
   * nearest one in the pipeline upstream of port 2; it is an error if there is none.
   */
  void SetMorph(vtkMorphAlgorithm* morph);
  vtkMorphAlgorithm* GetMorph();
  ///@}

  ///@{
  /**
   * The blend of shapes whose weights the derivatives are for, as of its last execution. Default:
   * none, so the nearest vtkMorphShapes upstream of port 2, if it is nearer than a morphing filter
   * and Morph is not set.
   */
  void SetMorphShapes(vtkMorphShapes* shapes);
  vtkMorphShapes* GetMorphShapes();
  ///@}

  ///@{
  /**
   * Name of the point array with the derivatives, three components: the unit of the objective over
   * that of the points. Default: none, which is an error.
   */
  vtkSetStringMacro(GradientArray);
  vtkGetStringMacro(GradientArray);
  ///@}

  /**
   * The later of the modification times of this filter and the method.
   */
  vtkMTimeType GetMTime() override;

  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

protected:
  vtkMorphAdjoint();
  ~vtkMorphAdjoint() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkMorphAdjoint(const vtkMorphAdjoint&) = delete;
  void operator=(const vtkMorphAdjoint&) = delete;

  vtkMorphAlgorithm* FindMorph();
  vtkMorphShapes* FindShapes();
  void ExecuteShapes(vtkMorphShapes* shapes, vtkUnstructuredGrid* rest, vtkDataObject* carrier,
    vtkPointSet* output, bool onRanks, morph::Monitor& monitor);
  void Execute(vtkMorphAlgorithm* morph, vtkUnstructuredGrid* rest, vtkDataObject* boundary,
    vtkDataObject* carrier, vtkPointSet* output, bool onRanks, morph::Monitor& monitor);

  class vtkInternals;
  std::unique_ptr<vtkInternals> Internals;

  vtkSmartPointer<vtkMorphAlgorithm> Morph;
  vtkSmartPointer<vtkMorphShapes> MorphShapes;
  char* GradientArray = nullptr;
};

#endif
