// SPDX-License-Identifier: BSD-3-Clause
#include "Case.h"

#include "RandomExtras.h"
#include "SameData.h"
#include "VaryingBoundary.h"
#include "vtkBoundaryDisplacement.h"
#include "vtkClassifyBoundary.h"
#include "vtkCompareMorphMethods.h"
#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"
#include "vtkLBWarpMorph.h"
#include "vtkMorphAdjoint.h"
#include "vtkMorphAlgorithm.h"
#include "vtkMorphBoundary.h"
#include "vtkMorphMesh.h"
#include "vtkMorphShapes.h"
#include "vtkRadialBasisMorph.h"
#include "vtkSimplexLinearMorph.h"
#include "vtkSimplexNaturalNeighborMorph.h"
#include "vtkWeightedResidualMorph.h"

#include <vtkCallbackCommand.h>
#include <vtkExecutive.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>

namespace fuzz
{
namespace
{
/// Keeps what no observer hears.
class Window : public vtkOutputWindow
{
public:
  static Window* New();
  vtkTypeMacro(Window, vtkOutputWindow);
  void DisplayText(const char* text) override { this->Texts.emplace_back(text); }
  std::vector<std::string> Texts;
};
vtkStandardNewMacro(Window);

Window* window()
{
  static vtkNew<Window> instance;
  vtkOutputWindow::SetInstance(instance);
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  return instance;
}

/// Calls `heard` with the text or, of progress, null.
class Observer
{
public:
  Observer(vtkObject* subject, unsigned long event, std::function<void(const char*)> heard)
    : Subject(subject)
    , Heard(std::move(heard))
  {
    this->Command->SetClientData(&this->Heard);
    this->Command->SetCallback(
      [](vtkObject*, unsigned long event, void* data, void* text)
      {
        const bool isText = event == vtkCommand::ErrorEvent || event == vtkCommand::WarningEvent;
        (*static_cast<std::function<void(const char*)>*>(data))(
          isText ? static_cast<const char*>(text) : nullptr);
      });
    this->Tag = subject->AddObserver(event, this->Command);
  }
  ~Observer() { this->Subject->RemoveObserver(this->Tag); }
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;

private:
  vtkSmartPointer<vtkObject> Subject;
  std::function<void(const char*)> Heard;
  vtkNew<vtkCallbackCommand> Command;
  unsigned long Tag = 0;
};

/// Without the place in the code and the object's address.
std::function<void(const char*)> into(std::vector<std::string>& list)
{
  return [&list](const char* text)
  {
    const std::string all = text;
    const std::size_t end = all.find("): ");
    list.push_back(end == std::string::npos ? all : all.substr(end + 3));
    while (!list.back().empty() && list.back().back() == '\n')
    {
      list.back().pop_back();
    }
  };
}

vtkSmartPointer<vtkMorphAlgorithm> morphOfAdjoint(Choices& choices)
{
  switch (choices.pick("adjoint.method",
    { "FEMWARP", "LBWARP", "weighted residual", "simplex-linear", "natural neighbor", "none",
      "inversion-free", "radial basis" },
    { 3, 3, 3, 3, 3, 0.3, 0.3, 3 }))
  {
    case 0:
      return vtkSmartPointer<vtkFEMWarpMorph>::New();
    case 1:
      return vtkSmartPointer<vtkLBWarpMorph>::New();
    case 2:
      return vtkSmartPointer<vtkWeightedResidualMorph>::New();
    case 3:
      return vtkSmartPointer<vtkSimplexLinearMorph>::New();
    case 4:
      return vtkSmartPointer<vtkSimplexNaturalNeighborMorph>::New();
    case 6:
      return vtkSmartPointer<vtkInversionFreeMorph>::New();
    case 7:
      return vtkSmartPointer<vtkRadialBasisMorph>::New();
    default:
      return nullptr;
  }
}

template <typename F>
void setThreads(vtkAlgorithm* algorithm, int threads)
{
  if (auto* filter = F::SafeDownCast(algorithm))
  {
    filter->SetNumberOfThreads(threads);
  }
}

template <typename F>
void setBoundaryNames(vtkAlgorithm* algorithm, const std::string& ids, const std::string& vectors)
{
  if (auto* filter = F::SafeDownCast(algorithm))
  {
    filter->SetBoundaryIdArray(ids.empty() ? nullptr : ids.c_str());
    filter->SetDisplacementArray(vectors.empty() ? nullptr : vectors.c_str());
  }
}

template <typename F>
void setSurfaceName(vtkAlgorithm* algorithm, const char* name)
{
  if (auto* filter = F::SafeDownCast(algorithm))
  {
    filter->SetSurfaceIdArray(name);
  }
}
}

Case::Case(Choices& made, const Filter& ofFilter)
  : choices(made)
  , filter(ofFilter)
{
  window();
  this->grid = randomGrid(made);
  this->inputs = { this->grid.data };
  const std::string& name = ofFilter.name;
  vtkSmartPointer<vtkDataObject> more;
  if (ofFilter.isMorph || name == "MorphBoundary" || name == "CompareMorphMethods" ||
      name == "MorphAdjoint" || name == "MorphShapes")
  {
    this->boundary = randomBoundary(made, this->grid);
    this->inputs.push_back(this->boundary.data);
    this->vary();
  }
  if (name == "MorphShapes")
  {
    this->addShapes();
  }
  else if (name == "MorphBoundary")
  {
    this->isRegular = randomTarget(made, this->grid, 0.4, more) && this->isRegular;
    this->inputs.push_back(more);
  }
  else if (name == "MorphAdjoint")
  {
    this->isRegular = randomGradient(made, this->grid, more) && this->isRegular;
    this->inputs.push_back(more);
  }
  else if (vtkDisplacementAlgorithm::SafeDownCast(ofFilter.make()))
  {
    if (name == "BoundaryDisplacement" && made.chance("displace.surface", 0.3) &&
        this->grid.isAsMesh)
    {
      this->inputs[0] = boundaryOfGrid(made, this->grid);
      this->isRegular = made.value("hostile.surface") == 0 && this->isRegular;
    }
    vtkNew<vtkBoundaryDisplacement> unused;
    this->isRegular = setMotion(made, this->grid, unused, more) && this->isRegular;
    this->inputs.push_back(more);
    vtkSmartPointer<vtkDataObject> target;
    const double chance = name == "FitToSurface" ? 0.97 : 0.2;
    this->isRegular = randomTarget(made, this->grid, chance, target) && this->isRegular;
    this->inputs.push_back(target);
    this->inputs.push_back(more); // of zones
  }
}

/// More shapes: the first, shrunk along x.
void Case::addShapes()
{
  auto* first = vtkPointSet::SafeDownCast(this->boundary.data);
  const int more = this->choices.whole("with.shapes", 0, [](Random& r) { return r.below(3); });
  for (int i = 0; first && first->GetNumberOfPoints() > 0 && i < more; ++i)
  {
    const vtkSmartPointer<vtkDataObject> copy = deepCopy(first);
    vtkPoints* points = vtkPointSet::SafeDownCast(copy)->GetPoints();
    double center[3], x[3];
    points->GetPoint(i % points->GetNumberOfPoints(), center);
    for (vtkIdType p = 0; p < points->GetNumberOfPoints(); ++p)
    {
      points->GetPoint(p, x);
      points->SetPoint(p, center[0] + 0.9 * (x[0] - center[0]), x[1], x[2]);
    }
    this->inputs.push_back(copy);
  }
}

/// Makes the boundary one that varies in time, and its targets those of the time that is asked for.
void Case::vary()
{
  RandomBoundary& known = this->boundary;
  auto* data = vtkPointSet::SafeDownCast(known.data);
  const bool varies = this->choices.chance("boundary.varies", 0.06) && data && known.isRight &&
                      known.displacementArray.empty() &&
                      static_cast<vtkIdType>(known.targets.size()) == data->GetNumberOfPoints();
  if (!varies)
  {
    return;
  }
  auto source = vtkSmartPointer<VaryingBoundary>::New();
  source->Data = data;
  source->Rest.resize(data->GetNumberOfPoints(), 3);
  source->Steps =
    this->choices.whole("boundary.steps", 2, [](Random& r) { return 1 + r.below(4); });
  this->time = this->choices.whole(
    "time", source->Steps, [&](Random& r) { return r.below(source->Steps + 1); });
  const double part = this->time / source->Steps;
  morph::Index row = 0;
  for (auto& [node, target] : known.targets)
  {
    const Eigen::RowVector3d rest = this->grid.mesh.points.row(node);
    source->Rest.row(row++) = rest;
    target = part == 1 ? target : (rest + part * (target - rest)).eval();
  }
  known.isExact = known.isExact && part == 1;
  known.matrix = Eigen::Matrix3d::Identity() + part * (known.matrix - Eigen::Matrix3d::Identity());
  known.shift *= part;
  this->varying = source;
}

void Case::setNames(vtkAlgorithm* algorithm)
{
  std::string ids = this->boundary.idArray, vectors = this->boundary.displacementArray;
  if (this->choices.chance("names.wrong", 0.007))
  {
    ids = "NoSuchIds";
    this->isRegular = false;
  }
  if (this->choices.chance("names.wrongDisplacement", 0.007))
  {
    vectors = "NoSuchVectors";
    this->isRegular = false;
  }
  setBoundaryNames<vtkMorphAlgorithm>(algorithm, ids, vectors);
  setBoundaryNames<vtkMorphBoundary>(algorithm, ids, vectors);
  setBoundaryNames<vtkMorphShapes>(algorithm, ids, vectors);
  setBoundaryNames<vtkCompareMorphMethods>(algorithm, ids, vectors);
  const int surface = this->choices.pick("names.surface",
    { "none", "Surface", "Temperature", "NoSuchArray", "ScaledJacobian" },
    { 10, 0.3, 0.3, 0.1, 0.3 });
  constexpr const char* names[] = { nullptr, "Surface", "Temperature", "NoSuchArray",
    "ScaledJacobian" };
  setSurfaceName<vtkClassifyBoundary>(algorithm, names[surface]);
  setSurfaceName<vtkMorphBoundary>(algorithm, names[surface]);
  setSurfaceName<vtkDisplacementAlgorithm>(algorithm, names[surface]);
}

vtkSmartPointer<vtkAlgorithm> Case::makeFilter(int threads)
{
  return this->makeFilter(this->inputs, threads);
}

vtkSmartPointer<vtkAlgorithm> Case::makeFilter(
  const std::vector<vtkSmartPointer<vtkDataObject>>& data, int threads)
{
  vtkSmartPointer<vtkAlgorithm> algorithm = this->filter.make();
  auto* shapes = vtkMorphShapes::SafeDownCast(algorithm);
  for (std::size_t port = 0; port < data.size(); ++port)
  {
    if (data[port] && shapes && port > 0)
    {
      shapes->AddShapeData(data[port]);
    }
    else if (data[port])
    {
      algorithm->SetInputDataObject(static_cast<int>(port), data[port]);
    }
  }
  if (this->varying)
  {
    algorithm->SetInputConnection(1, this->varying->GetOutputPort());
  }
  const PropertiesSet properties =
    setProperties(this->choices, this->filter, this->grid.size, algorithm);
  this->isRegular = properties.areRegular && this->isRegular;
  this->acceptedProperty = properties.accepted;
  vtkSmartPointer<vtkAlgorithm> named = algorithm;
  if (auto* adjoint = vtkMorphAdjoint::SafeDownCast(algorithm))
  {
    if (auto morph = morphOfAdjoint(this->choices))
    {
      morph->SetNumberOfThreads(1);
      adjoint->SetMorph(morph);
      named = morph;
    }
    else
    {
      this->isRegular = false;
    }
    adjoint->SetGradientArray("Gradient");
  }
  if (auto* displacement = vtkDisplacementAlgorithm::SafeDownCast(algorithm))
  {
    vtkSmartPointer<vtkDataObject> known;
    setMotion(this->choices, this->grid, displacement, known);
  }
  if (shapes)
  {
    // The turn of a boundary, as a rotation.
    const bool isTurn = this->choices.value("motion") == 2;
    shapes->SetMotion(0, isTurn && this->choices.chance("with.rotation", 0.8));
  }
  this->setNames(named);
  if (threads > 0)
  {
    setThreads<vtkMorphAlgorithm>(named, threads);
    setThreads<vtkMorphBoundary>(named, threads);
    setThreads<vtkClassifyBoundary>(named, threads);
    setThreads<vtkDisplacementAlgorithm>(named, threads);
    setThreads<vtkMorphShapes>(named, threads);
    setThreads<vtkCompareMorphMethods>(named, threads);
  }
  return algorithm;
}

Run execute(vtkAlgorithm* filter, double time, double abortAt)
{
  Run run;
  Window* heard = window();
  heard->Texts.clear();
  {
    const Observer errors(filter, vtkCommand::ErrorEvent, into(run.errors));
    const Observer warnings(filter, vtkCommand::WarningEvent, into(run.warnings));
    const Observer pipeline(
      filter->GetExecutive(), vtkCommand::ErrorEvent, into(run.fromExecutive));
    const Observer progress(filter, vtkCommand::ProgressEvent,
      [&](const char*)
      {
        run.progress.push_back(filter->GetProgress());
        if (filter->GetProgress() >= abortAt)
        {
          filter->SetAbortExecute(1);
        }
      });
    if (time < 0)
    {
      filter->Update();
    }
    else
    {
      filter->UpdateTimeStep(time);
    }
    for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
    {
      run.outputs.push_back(deepCopy(filter->GetOutputDataObject(port)));
    }
  }
  run.fromOthers = heard->Texts;
  return run;
}
}
