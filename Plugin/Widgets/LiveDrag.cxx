// SPDX-License-Identifier: BSD-3-Clause
#include "LiveDrag.h"

#include "Ancestor.h"
#include "SurfaceTable.h"

#include <pqApplicationCore.h>
#include <pqDataRepresentation.h>
#include <pqOutputPort.h>
#include <pqPipelineSource.h>
#include <pqPropertiesPanel.h>
#include <pqPropertyWidget.h>
#include <pqProxyWidget.h>
#include <pqServerManagerModel.h>
#include <pqUndoStack.h>
#include <pqView.h>
#include <vtkNew.h>
#include <vtkPVXMLElement.h>
#include <vtkSMParaViewPipelineControllerWithRendering.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMRepresentationProxy.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMUncheckedPropertyHelper.h>
#include <vtkSMViewProxy.h>

#include <algorithm>
#include <cstdlib>

namespace
{
/// What is changed here is no step for undo.
class NoUndo
{
public:
  NoUndo()
    : Stack(pqApplicationCore::instance()->getUndoStack())
  {
    if (this->Stack)
    {
      this->Stack->beginNonUndoableChanges();
    }
  }
  ~NoUndo()
  {
    if (this->Stack)
    {
      this->Stack->endNonUndoableChanges();
    }
  }
  NoUndo(const NoUndo&) = delete;
  NoUndo& operator=(const NoUndo&) = delete;

private:
  pqUndoStack* Stack;
};

std::vector<double> valuesOf(const vtkSMPropertyHelper& helper)
{
  std::vector<double> values;
  for (unsigned int i = 0; i < helper.GetNumberOfElements(); ++i)
  {
    values.push_back(helper.GetAsDouble(i));
  }
  return values;
}

void setValues(vtkSMPropertyHelper& helper, const std::vector<double>& values)
{
  helper.SetNumberOfElements(static_cast<unsigned int>(values.size()));
  for (unsigned int i = 0; i < values.size(); ++i)
  {
    helper.Set(i, values[i]);
  }
}

std::vector<double> checkedValues(vtkSMProperty* property)
{
  return valuesOf(vtkSMPropertyHelper(property));
}

std::vector<double> panelValues(vtkSMProperty* property)
{
  return valuesOf(vtkSMUncheckedPropertyHelper(property));
}

void setChecked(vtkSMProperty* property, const std::vector<double>& values)
{
  vtkSMPropertyHelper helper(property);
  setValues(helper, values);
}

void setInPanel(vtkSMProperty* property, const std::vector<double>& values)
{
  vtkSMUncheckedPropertyHelper helper(property);
  setValues(helper, values);
}

/// The representation of an output in a view, made hidden if there is none.
vtkSMProxy* representationOf(pqOutputPort* port, pqView* view)
{
  if (pqDataRepresentation* known = port->getRepresentation(view))
  {
    return known->getProxy();
  }
  auto made = vtk::TakeSmartPointer(view->getViewProxy()->CreateDefaultRepresentation(
    port->getSource()->getProxy(), port->getPortNumber()));
  if (!made)
  {
    return nullptr;
  }
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  controller->PreInitializeProxy(made);
  vtkSMPropertyHelper(made, "Input").Set(port->getSource()->getProxy(), port->getPortNumber());
  controller->PostInitializeProxy(made);
  vtkSMPropertyHelper(made, "Visibility").Set(0);
  made->UpdateVTKObjects();
  vtkSMPropertyHelper(view->getViewProxy(), "Representations").Add(made);
  view->getViewProxy()->UpdateVTKObjects();
  controller->RegisterRepresentationProxy(made);
  return made;
}

/// Gives a representation the look of another one.
void copyLook(vtkSMProxy* from, vtkSMProxy* to)
{
  for (const char* name : { "ColorArrayName", "LookupTable", "AmbientColor", "DiffuseColor",
         "EdgeColor", "LineWidth", "PointSize", "Opacity", "Specular" })
  {
    if (from->GetProperty(name) && to->GetProperty(name))
    {
      to->GetProperty(name)->Copy(from->GetProperty(name));
    }
  }
  const std::string look = vtkSMPropertyHelper(from, "Representation", true).GetAsString();
  for (const char* known : { "Surface With Edges", "Wireframe", "Points" })
  {
    if (look == known)
    {
      vtkSMPropertyHelper(to, "Representation").Set(known);
    }
  }
  to->UpdateVTKObjects();
}
}

LiveDrag::LiveDrag(pqPropertyWidget* widget)
  : QObject(widget)
  , Widget(widget)
{
}

LiveDrag::~LiveDrag() = default;

vtkSMProxy* LiveDrag::filter() const
{
  return this->Widget->proxy();
}

pqPipelineSource* LiveDrag::source() const
{
  return pqApplicationCore::instance()->getServerManagerModel()->findItem<pqPipelineSource*>(
    this->filter());
}

vtkPVXMLElement* LiveDrag::hint() const
{
  vtkSMProperty* const tick = this->filter()->GetProperty("LiveDrag");
  vtkPVXMLElement* const hints = tick ? tick->GetHints() : nullptr;
  return hints ? hints->FindNestedElementByName("WhileDragging") : nullptr;
}

pqPropertiesPanel* LiveDrag::panel() const
{
  return ancestorOf<pqPropertiesPanel>(this->Widget);
}

void LiveDrag::blockPanel(bool block)
{
  for (QWidget* widget = this->Widget; widget; widget = widget->parentWidget())
  {
    if (auto* properties = qobject_cast<pqProxyWidget*>(widget))
    {
      properties->blockSignals(block);
    }
  }
}

bool LiveDrag::begin(vtkSMProxy* moved, const std::vector<std::string>& properties)
{
  pqPipelineSource* const applied = this->source();
  if (this->Running || !this->hint() || !this->panel() || !applied ||
      applied->modifiedState() == pqProxy::UNINITIALIZED ||
      vtkSMUncheckedPropertyHelper(this->filter(), "LiveDrag").GetAsInt() == 0)
  {
    return false;
  }
  this->Running = true;
  this->Moved = moved;
  this->Dragged.clear();
  for (const std::string& name : properties)
  {
    vtkSMProperty* const property = moved->GetProperty(name.c_str());
    this->Dragged.push_back({ property, checkedValues(property) });
  }
  this->blockPanel(true);
  for (SurfaceTable* const table : this->panel()->findChildren<SurfaceTable*>())
  {
    table->hidePreview(); // the mesh itself follows
  }
  const NoUndo noUndo;
  this->changeProperties();
  this->showInPlace();
  return true;
}

void LiveDrag::changeProperties()
{
  this->Changed.clear();
  vtkPVXMLElement* const hint = this->hint();
  for (unsigned int i = 0; i < hint->GetNumberOfNestedElements(); ++i)
  {
    vtkPVXMLElement* const element = hint->GetNestedElement(i);
    const char* const name = element->GetAttribute("name");
    const char* const value = element->GetAttribute("value");
    vtkSMProperty* const property = name ? this->filter()->GetProperty(name) : nullptr;
    if (property && value)
    {
      this->Changed.push_back({ property, checkedValues(property) });
      setChecked(property, { std::atof(value) });
    }
  }
  this->filter()->UpdateVTKObjects();
}

void LiveDrag::showInPlace()
{
  this->Views.clear();
  int port = 0;
  if (!this->hint()->GetScalarAttribute("port", &port))
  {
    return;
  }
  pqPipelineSource* const filter = this->source();
  for (pqView* view : filter->getViews())
  {
    pqDataRepresentation* const mesh = filter->getRepresentation(0, view);
    if (!mesh || !mesh->isVisible())
    {
      continue;
    }
    vtkSMProxy* const surface = representationOf(filter->getOutputPort(port), view);
    if (!surface || vtkSMPropertyHelper(surface, "Visibility").GetAsInt() != 0)
    {
      continue; // both are shown already
    }
    copyLook(mesh->getProxy(), surface);
    vtkSMPropertyHelper(mesh->getProxy(), "Visibility").Set(0);
    vtkSMPropertyHelper(surface, "Visibility").Set(1);
    mesh->getProxy()->UpdateVTKObjects();
    surface->UpdateVTKObjects();
    this->Views.push_back({ view, mesh->getProxy(), surface });
  }
}

void LiveDrag::follow(bool draws)
{
  if (!this->Running)
  {
    return;
  }
  const NoUndo noUndo;
  for (const SavedProperty& dragged : this->Dragged)
  {
    const Values values = panelValues(dragged.Property);
    if (values != checkedValues(dragged.Property))
    {
      setChecked(dragged.Property, values);
    }
  }
  this->Moved->UpdateVTKObjects();
  for (const Shown& shown : this->Views)
  {
    if (shown.View && draws)
    {
      shown.View->render(); // later, and once for several steps
    }
    else if (shown.View)
    {
      shown.View->getViewProxy()->Update();
    }
  }
}

void LiveDrag::restore()
{
  for (const SavedProperty& changed : this->Changed)
  {
    setChecked(changed.Property, changed.Before);
  }
  this->filter()->UpdateVTKObjects();
  for (const Shown& shown : this->Views)
  {
    if (shown.Hidden && shown.InPlace)
    {
      vtkSMPropertyHelper(shown.InPlace, "Visibility").Set(0);
      vtkSMPropertyHelper(shown.Hidden, "Visibility").Set(1);
      shown.InPlace->UpdateVTKObjects();
      shown.Hidden->UpdateVTKObjects();
    }
  }
}

void LiveDrag::end()
{
  if (!this->Running)
  {
    return;
  }
  this->Running = false;
  std::vector<Values> last;
  bool moved = false;
  {
    // Back to the start: then Apply makes one change of the whole drag, with its undo and trace.
    const NoUndo noUndo;
    for (const SavedProperty& dragged : this->Dragged)
    {
      last.push_back(panelValues(dragged.Property));
      moved |= last.back() != dragged.Before;
      setChecked(dragged.Property, dragged.Before);
    }
    this->Moved->UpdateVTKObjects();
    this->restore();
  }
  for (std::size_t i = 0; i < last.size(); ++i)
  {
    setInPanel(this->Dragged[i].Property, last[i]);
  }
  this->blockPanel(false);
  this->Moved = nullptr;
  this->Dragged.clear();
  this->Changed.clear();
  if (moved)
  {
    this->source()->setModifiedState(pqProxy::MODIFIED);
    this->panel()->apply();
  }
  for (const Shown& shown : this->Views)
  {
    if (shown.View)
    {
      shown.View->render();
    }
  }
  this->Views.clear();
}
