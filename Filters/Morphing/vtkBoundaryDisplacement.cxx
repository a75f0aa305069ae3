// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBoundaryDisplacement.h"

#include "Private/Displace/Internals.h"
#include "Private/Displace/Pick.h"
#include "Private/Options.h"
#include "Private/Pipeline/CrewMonitor.h"
#include "Private/Pipeline/Execution.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Ranks.h"
#include "Private/Pipeline/UpToDateInput.h"
#include "Support/Error.h"

#include <vtkAbstractTransform.h>
#include <vtkDataArraySelection.h>
#include <vtkDoubleArray.h>
#include <vtkExtractSelection.h>
#include <vtkImplicitFunction.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkSelection.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>

namespace filters = morph::filters;

vtkStandardNewMacro(vtkBoundaryDisplacement);

vtkBoundaryDisplacement::vtkBoundaryDisplacement()
  : Internals(new vtkInternals)
{
  this->Shared = this->Internals.get();
  this->Options->Moving = morph::BoundaryDisplacementDefaults::Moving;
  this->ResetResults();
}

vtkBoundaryDisplacement::~vtkBoundaryDisplacement() = default;

vtkPolyData* vtkBoundaryDisplacement::GetOutput()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(0));
}

int vtkBoundaryDisplacement::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkPolyData");
  return 1;
}

vtkPolyData* vtkBoundaryDisplacement::GetFittedTarget()
{
  return this->Options->Displacement == DISPLACEMENT_TARGET ? this->Internals->Fit.Surface()
                                                            : nullptr;
}

void vtkBoundaryDisplacement::SetSelectionExtractor(vtkExtractSelection* extractor)
{
  if (this->Internals->Extractor != extractor)
  {
    this->Internals->Extractor = extractor;
    this->Internals->ChosenVersion = -1;
    this->Modified();
  }
}

vtkDataArraySelection* vtkBoundaryDisplacement::GetSurfaceList()
{
  return this->Internals->SurfaceList;
}

void vtkBoundaryDisplacement::FindSurfaces(
  vtkDataObject* shown, vtkSelection* selection, vtkDataArraySelection* names)
{
  vtkInternals& own = *this->Internals;
  try
  {
    const bool isPicked = own.Whole && selection && selection->GetNumberOfNodes() > 0;
    filters::Pick::Find(
      shown, isPicked ? nullptr : selection, own.Extractor, own.Blocks, own.Model, names);
    if (isPicked)
    {
      throw morph::Error("The mesh is on several MPI ranks, each of which shows a part. Choose "
                         "surfaces by their names.");
    }
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro("Cannot find the surfaces of this selection: " << error.what());
  }
}

void vtkBoundaryDisplacement::CopySurfaces(vtkDataArraySelection* names, vtkPolyData* output)
{
  const vtkInternals& own = *this->Internals;
  filters::Pick::Write(
    own.Model, names, own.Whole ? own.WholeOutput.Get() : this->GetOutput(), output);
  if (own.Whole && !filters::Ranks::IsFirst())
  {
    output->Initialize(); // the first rank has it all
  }
}

void vtkBoundaryDisplacement::SetPick(vtkAlgorithm* selection)
{
  this->Internals->Picker.Selection = selection;
}

void vtkBoundaryDisplacement::SetPickPort(int port)
{
  this->Internals->Picker.Port = std::max(port, -1);
}

int vtkBoundaryDisplacement::GetPickPort() const
{
  return this->Internals->Picker.Port;
}

vtkDataArraySelection* vtkBoundaryDisplacement::GetPickedSurfaces()
{
  filters::Picker& picker = this->Internals->Picker;
  this->FindSurfaces(picker.Shown(this), picker.Update(), picker.Names);
  return picker.Names;
}

vtkStringArray* vtkBoundaryDisplacement::GetSurfaceSizes()
{
  return this->Internals->SurfaceSizes;
}

vtkDataArraySelection* vtkBoundaryDisplacement::GetZoneList()
{
  return this->Internals->ZoneList;
}

vtkStringArray* vtkBoundaryDisplacement::GetZoneSizes()
{
  return this->Internals->ZoneSizes;
}

vtkDoubleArray* vtkBoundaryDisplacement::GetSurfaceBounds()
{
  return this->Internals->SurfaceBounds;
}

int vtkBoundaryDisplacement::GetClassifyCount() const
{
  return this->Internals->Model.ClassifyCount();
}

int vtkBoundaryDisplacement::GetPrepareCount() const
{
  return this->Internals->Mover.surroundings().prepareCount();
}

int vtkBoundaryDisplacement::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  // A user who is about to choose patches wants to see their names before the first execution. On
  // several ranks they are known after it: a request for information need not come to all of them.
  if (filters::Ranks::Processes() > 1)
  {
    return 1;
  }
  filters::Monitor monitor(nullptr, this->Options->NumberOfThreads);
  try
  {
    vtkDataObject* data = this->Internals->Blocks.Gather(filters::upToDateInput(this, inputVector),
      this->Options->CoincidentPoints, filters::GridMesh::UnknownCells::Refuse, monitor);
    monitor.TakeWarnings(); // the execution gives them
    auto* input = vtkPointSet::SafeDownCast(data);
    if (input && input->GetNumberOfCells() > 0)
    {
      this->Internals->Classify(this,
        filters::Input::RequireGridOrPolyData(input, "The input", this->Internals->Checked),
        monitor);
    }
  }
  catch (const std::exception&)
  {
    // The execution raises the error again, and reports it.
    this->Internals->ClearList();
  }
  return 1;
}

int vtkBoundaryDisplacement::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* data = vtkDataObject::GetData(inputVector[0]);
  vtkSelection* selection = vtkSelection::GetData(inputVector[1]);
  vtkDataObject* given = vtkDataObject::GetData(inputVector[2]);
  vtkSelection* zone = vtkSelection::GetData(inputVector[3]);
  vtkDataObject* control = vtkDataObject::GetData(inputVector[4]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  this->ResetResults();
  filters::CrewMonitor monitor(this, this->Options->NumberOfThreads);
  const auto displace = [&]
  {
    const filters::Input::Mesh mesh =
      filters::Input::TakeMesh(data, this->Internals->Blocks, this->Options->CoincidentPoints,
        filters::Input::Use::ToMorphOnRanks, this->GetClassName(), monitor);
    vtkPointSet* input = nullptr;
    vtkPolyData* target = nullptr;
    const auto check = [&]
    {
      input =
        filters::Input::RequireGridOrPolyData(mesh.Data, "The input", this->Internals->Checked);
      const bool fits = this->Options->Displacement == DISPLACEMENT_TARGET &&
                        this->Options->Moving != MOVING_NOTHING;
      target = fits && given ? filters::Input::RequirePolyData(given, "The target") : nullptr;
      if (fits && !target && (mesh.IsDistributed || !mesh.IsElsewhere))
      {
        throw morph::Error("There is no target to move onto. Set one (Target, port 2): a surface, "
                           "from an STL file for instance.");
      }
    };
    if (mesh.IsDistributed)
    {
      filters::Ranks::Together(check);
      this->Internals->DisplaceOnRanks(
        this, input, { selection, target, zone, control }, output, monitor);
      return;
    }
    check();
    this->Internals->Whole.reset();
    this->Internals->WholeOutput->Initialize();
    if (!mesh.IsElsewhere)
    {
      this->Internals->Displace(this, input, vtkUnstructuredGrid::SafeDownCast(input),
        { selection, target, zone, control }, output, monitor);
    }
  };
  const auto clear = [&]
  {
    output->Initialize();
    this->ResetResults();
  };
  filters::Execution::Run(this, "displace this mesh's boundary", displace, clear);
  const bool isTeller = !this->Internals->Whole || filters::Ranks::IsFirst();
  for (const std::string& warning : monitor.TakeWarnings())
  {
    if (isTeller)
    {
      vtkWarningMacro(<< warning);
    }
  }
  return 1;
}

void vtkBoundaryDisplacement::ResetResults()
{
  this->MovingPoints = this->FixedPoints = this->FollowingPoints = this->FreePoints = 0;
  this->ZonePoints = this->LayerPoints = 0;
  this->Internals->SlideReport = "None";
}

void vtkBoundaryDisplacement::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "PickPort: " << this->GetPickPort() << "\n";
  os << indent << "MovingPoints: " << this->MovingPoints << "\n";
  os << indent << "FixedPoints: " << this->FixedPoints << "\n";
  os << indent << "FollowingPoints: " << this->FollowingPoints << "\n";
  os << indent << "FreePoints: " << this->FreePoints << "\n";
  os << indent << "ZonePoints: " << this->ZonePoints << "\n";
  os << indent << "LayerPoints: " << this->LayerPoints << "\n";
  os << indent << "ClassifyCount: " << this->GetClassifyCount() << "\n";
  os << indent << "ChooseCount: " << this->ChooseCount << "\n";
  os << indent << "PrepareCount: " << this->GetPrepareCount() << "\n";
}
