// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkListedSurfaces
 * @brief   shows surfaces and curves from the list of a vtkDisplacementAlgorithm
 *
 * A source without inputs. Its output is the polygons of the surfaces and the lines of the curves
 * that are named, where the filter's output has them or, before its first execution, undeformed. A
 * window shows them while a user ticks names of the list, before the filter itself is executed. It
 * neither executes the filter nor depends on its pipeline, and keeps it alive.
 *
 * Points have the array `MorphPointId`. Names that the list does not have are left out. Without a
 * filter, or with one of another class, the output is empty. Cost: a pass over the boundary's
 * faces.
 *
 * @sa vtkDisplacementAlgorithm
 */
#ifndef vtkListedSurfaces_h
#define vtkListedSurfaces_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro

#include <vtkNew.h> // for vtkNew
#include <vtkPolyDataAlgorithm.h>
#include <vtkSmartPointer.h> // for vtkSmartPointer

#include <string> // for std::string

class vtkDataArraySelection;

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkListedSurfaces : public vtkPolyDataAlgorithm
{
public:
  static vtkListedSurfaces* New();
  vtkTypeMacro(vtkListedSurfaces, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  vtkMTimeType GetMTime() override;

  /**
   * The vtkDisplacementAlgorithm that has the list. Default: null.
   */
  void SetFilter(vtkAlgorithm* filter);

  /**
   * A vtkDisplacementAlgorithm whose motion the surfaces are shown to make, with arrows, before the
   * filter has it; see vtkDisplacementAlgorithm::CopyMovedSurfaces(). It has no inputs and is not
   * executed. Default: null, the surfaces as they are.
   */
  void SetMotion(vtkAlgorithm* motion);

  ///@{
  /**
   * The names of the surfaces and curves to show. A status other than 0 adds one, and 0 removes it.
   * Default: none.
   */
  void SetSurfaceStatus(const char* name, int status);
  void AddSurface(const char* name) { this->SetSurfaceStatus(name, 1); }
  void RemoveAllSurfaces();
  ///@}

  /**
   * The dimension of these surfaces; see vtkDisplacementAlgorithm::DescribeDimension().
   */
  const char* GetDimension();

protected:
  vtkListedSurfaces();
  ~vtkListedSurfaces() override;

  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkListedSurfaces(const vtkListedSurfaces&) = delete;
  void operator=(const vtkListedSurfaces&) = delete;

  vtkSmartPointer<vtkAlgorithm> Filter, Motion;
  vtkNew<vtkDataArraySelection> Names;
  std::string Dimension; ///< as GetDimension() has returned it
};

#endif
