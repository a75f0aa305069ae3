// SPDX-License-Identifier: BSD-3-Clause
// Improves a mesh by MFEM as its miniapp mesh-optimizer does: metric 352 untangles it if necessary,
// and then metric 303 aims for ideal shapes. The boundary stays. For optimizers.py.
#include <mfem.hpp>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>

namespace
{
constexpr int Order = 8, Steps = 200, LinearSteps = 100;
constexpr double LinearTolerance = 1e-12, Tolerance = 1e-10;

class Optimization
{
public:
  explicit Optimization(mfem::Mesh& mesh)
    : mesh_(mesh)
    , basis_(1, 3)
    , space_(&mesh, &this->basis_, 3)
    , rules_(0, mfem::Quadrature1D::GaussLobatto)
  {
    mesh.SetNodalFESpace(&this->space_);
    this->nodes_.SetSpace(&this->space_);
    mesh.SetNodalGridFunction(&this->nodes_);
  }

  double leastDeterminant()
  {
    double least = mfem::infinity();
    for (int e = 0; e < this->mesh_.GetNE(); ++e)
    {
      mfem::ElementTransformation& map = *this->mesh_.GetElementTransformation(e);
      for (const mfem::IntegrationPoint& point : this->rules_.Get(map.GetGeometryType(), Order))
      {
        map.SetIntPoint(&point);
        least = std::min<double>(least, map.Jacobian().Det());
      }
    }
    return least;
  }

  /// `least`: the determinant that the metric keeps below; null: none.
  void minimize(mfem::TMOP_QualityMetric& metric, double* least)
  {
    const mfem::GridFunction start(this->nodes_);
    mfem::TargetConstructor target(mfem::TargetConstructor::IDEAL_SHAPE_UNIT_SIZE);
    target.SetNodes(start);
    auto* const energy = new mfem::TMOP_Integrator(&metric, &target); // owned by the form
    energy->SetIntegrationRules(this->rules_, Order);
    mfem::NonlinearForm form(&this->space_);
    form.AddDomainIntegrator(energy);
    mfem::Array<int> fixed(this->mesh_.bdr_attributes.Max());
    fixed = 1;
    form.SetEssentialBC(fixed);
    mfem::MINRESSolver linear;
    linear.SetMaxIter(LinearSteps);
    linear.SetRelTol(LinearTolerance);
    mfem::TMOPNewtonSolver newton(this->rules_.Get(this->mesh_.GetElementBaseGeometry(0), Order));
    newton.SetIntegrationRules(this->rules_, Order);
    newton.SetPreconditioner(linear);
    newton.SetMaxIter(Steps);
    newton.SetRelTol(Tolerance);
    newton.SetMinDetPtr(least);
    newton.SetOperator(form);
    this->nodes_.SetTrueVector();
    newton.Mult(mfem::Vector(), this->nodes_.GetTrueVector());
    this->nodes_.SetFromTrueVector();
  }

private:
  mfem::Mesh& mesh_;
  mfem::H1_FECollection basis_;
  mfem::FiniteElementSpace space_;
  mfem::IntegrationRules rules_;
  mfem::GridFunction nodes_;
};
}

int main(int argc, char** argv)
{
  if (argc != 3)
  {
    std::fputs("Usage: mfem-optimizer MESH.vtk RESULT.vtk\nPrints processor seconds.\n", stderr);
    return 2;
  }
  mfem::Mesh mesh(argv[1], 1, 1, false);
  Optimization optimization(mesh);
  const std::clock_t start = std::clock();
  double least = optimization.leastDeterminant();
  if (least <= 0)
  {
    least *= 1.01; // below all determinants, as the metric divides by what is above
    mfem::TMOP_Metric_352 untangling(least);
    optimization.minimize(untangling, &least);
  }
  if (optimization.leastDeterminant() > 0)
  {
    mfem::TMOP_Metric_303 shape;
    optimization.minimize(shape, nullptr);
  }
  std::printf("seconds=%.3f\n", static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  std::ofstream result(argv[2]);
  mesh.PrintVTK(result);
  return 0;
}
