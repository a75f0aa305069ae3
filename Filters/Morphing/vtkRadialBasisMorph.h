// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkRadialBasisMorph
 * @brief   morphs a mesh by radial basis functions and a linear polynomial
 *
 * The displacement is a sum of kernels, functions of the distance from a prescribed node each, and
 * a linear polynomial. It interpolates the displacements of all prescribed nodes. Affine motions of
 * the boundary are reproduced exactly. The mesh's cells are not used, so any volume mesh will do,
 * and bodies need not be connected: those without a prescribed node follow the field as well.
 *
 * Up to 4,000 distinct prescribed nodes, each is a center, in one dense system. Of more, 2,000
 * spread evenly are centers. Compact kernels correct what these leave at the others, so that the
 * result is exact at all of them. A matrix of prescribed by interior nodes is never stored. Moving
 * costs one kernel a center and interior node.
 *
 * It is an error if all prescribed nodes lie in one plane, or if rounding makes the system
 * singular. Memory: 128 MB for 4,000 centers, 32 MB for 2,000, and about 0.4 kB a node.
 *
 * D. Sieger, S. Menzel, M. Botsch, "RBF morphing techniques for simulation-based design
 * optimization", Engineering with Computers 30 (2014) 161-174; L. Kedward, C. B. Allen, T. C. S.
 * Rendall, "Efficient and exact mesh deformation using multiscale RBF interpolation", Journal of
 * Computational Physics 345 (2017) 732-751.
 *
 * @sa vtkMorphAlgorithm vtkExtractMorphBoundary
 */
#ifndef vtkRadialBasisMorph_h
#define vtkRadialBasisMorph_h

#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro
#include "vtkMorphAlgorithm.h"

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkRadialBasisMorph : public vtkMorphAlgorithm
{
public:
  static vtkRadialBasisMorph* New();
  vtkTypeMacro(vtkRadialBasisMorph, vtkMorphAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum KernelType
  {
    KERNEL_TRIHARMONIC = 0,
    KERNEL_THIN_PLATE = 1,
    KERNEL_WENDLAND_C2 = 2
  };
  ///@{
  /**
   * The kernel as a function of the distance r from its center. KERNEL_TRIHARMONIC, the default:
   * r^3, the smoothest. KERNEL_THIN_PLATE: r^2 log r. KERNEL_WENDLAND_C2: (1 - q)^4 (4 q + 1) with
   * q = r / support radius, 0 from q = 1 on. Changing it prepares again.
   */
  vtkSetClampMacro(Kernel, int, KERNEL_TRIHARMONIC, KERNEL_WENDLAND_C2);
  vtkGetMacro(Kernel, int);
  void SetKernelToTriharmonic() { this->SetKernel(KERNEL_TRIHARMONIC); }
  void SetKernelToThinPlate() { this->SetKernel(KERNEL_THIN_PLATE); }
  void SetKernelToWendlandC2() { this->SetKernel(KERNEL_WENDLAND_C2); }
  ///@}

  ///@{
  /**
   * The support radius of KERNEL_WENDLAND_C2, in units of the extent of the prescribed nodes: twice
   * their largest distance from their mean. Changing it prepares again. Default 1, range [1e-3,
   * 1e3].
   */
  virtual void SetSupportRadius(double value);
  vtkGetMacro(SupportRadius, double);
  ///@}

  ///@{
  /**
   * The number of centers: 0, the default, stands for all distinct prescribed nodes up to 4,000,
   * and for 2,000 of more. 1 to 3 mean 4. With fewer centers than prescribed nodes both preparing
   * and moving are faster, and the other nodes' residuals are corrected nearby. Changing it
   * prepares again. Range [0, 4000].
   */
  vtkSetClampMacro(NumberOfCenters, int, 0, 4000);
  vtkGetMacro(NumberOfCenters, int);
  ///@}

  ///@{
  /**
   * As of the last execution: the centers used; the other distinct prescribed nodes, whose
   * residuals were corrected; and the largest of these residuals before the correction, in
   * millionths of the extent that SupportRadius refers to, rounded up. In the output's field data
   * too.
   */
  vtkIdType GetCenters() { return this->GetCount("Centers"); }
  vtkIdType GetCorrectedSites() { return this->GetCount("CorrectedSites"); }
  vtkIdType GetLargestResidualPPM() { return this->GetCount("LargestResidualPPM"); }
  ///@}

protected:
  vtkRadialBasisMorph();
  ~vtkRadialBasisMorph() override;

  std::unique_ptr<morph::Morpher> CreateMorpher() override;
  std::string PrepareOptions() override;

private:
  vtkRadialBasisMorph(const vtkRadialBasisMorph&) = delete;
  void operator=(const vtkRadialBasisMorph&) = delete;

  int Kernel = KERNEL_TRIHARMONIC;
  double SupportRadius = 1;
  int NumberOfCenters = 0;
};

#endif
