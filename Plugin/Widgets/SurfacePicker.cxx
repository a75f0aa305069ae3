// SPDX-License-Identifier: BSD-3-Clause
#include "SurfacePicker.h"

#include "SurfaceHighlight.h"

#include <pqCoreUtilities.h>
#include <pqSMAdaptor.h>
#include <pqView.h>
#include <vtkCommand.h>
#include <vtkPVXMLElement.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMSourceProxy.h>

#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>
#include <QVariant>

namespace
{
using Ticks = QList<QList<QVariant>>; ///< a name and whether it is ticked

QStringList ticked(vtkSMProperty* list, pqSMAdaptor::PropertyValueType which)
{
  QStringList names;
  for (const QList<QVariant>& tick : pqSMAdaptor::getSelectionProperty(list, which))
  {
    if (tick.size() == 2 && tick[1].toInt() != 0)
    {
      names << tick[0].toString();
    }
  }
  return names;
}

/// The selection of a filter's outputs or, failing that, of its input, and its port: -1 for the
/// input.
vtkSMProxy* selectionOf(vtkSMProxy* filter, int& port)
{
  auto* source = vtkSMSourceProxy::SafeDownCast(filter);
  for (port = 0; source && port < static_cast<int>(source->GetNumberOfOutputPorts()); ++port)
  {
    if (vtkSMProxy* selection = source->GetSelectionInput(port))
    {
      return selection;
    }
  }
  port = -1;
  const vtkSMPropertyHelper input(filter, "Input");
  auto* producer =
    input.GetNumberOfElements() > 0 ? vtkSMSourceProxy::SafeDownCast(input.GetAsProxy()) : nullptr;
  return producer ? producer->GetSelectionInput(input.GetOutputPort()) : nullptr;
}
}

SurfacePicker::SurfacePicker(vtkSMProxy* filter, vtkSMProperty* pick, QWidget* parent)
  : Superclass(filter, parent)
  , Message(new QLabel(this))
  , Highlight(new SurfaceHighlight(filter))
{
  this->setShowLabel(false);
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  auto* const button = new QPushButton(tr("Add selected surfaces"), this);
  button->setObjectName("AddSelected");
  button->setToolTip(Superclass::getTooltip(pick));
  this->Message->setObjectName("Message");
  this->Message->setWordWrap(true);
  this->Message->hide();
  layout->addWidget(button);
  layout->addWidget(this->Message);
  this->setProperty(pick);
  QObject::connect(button, SIGNAL(clicked()), this, SLOT(addSelected()));
  vtkSMProperty* list = filter->GetProperty(this->propertyName("list").toUtf8().data());
  pqCoreUtilities::connect(
    list, vtkCommand::UncheckedPropertyModifiedEvent, this, SLOT(updateHighlight()));
  pqCoreUtilities::connect(list, vtkCommand::ModifiedEvent, this, SLOT(updateHighlight()));
}

SurfacePicker::~SurfacePicker() = default;

QString SurfacePicker::propertyName(const char* role) const
{
  vtkPVXMLElement* hints = this->property()->GetHints();
  vtkPVXMLElement* own = hints ? hints->FindNestedElementByName("SurfacePicker") : nullptr;
  return own ? own->GetAttribute(role) : "";
}

void SurfacePicker::select()
{
  this->Superclass::select();
  this->updateHighlight();
}

void SurfacePicker::deselect()
{
  this->Superclass::deselect();
  this->Highlight->hide();
}

void SurfacePicker::setView(pqView* view)
{
  this->Superclass::setView(view);
  this->updateHighlight();
}

void SurfacePicker::updateHighlight()
{
  vtkSMProperty* list = this->proxy()->GetProperty(this->propertyName("list").toUtf8().data());
  const QStringList names = ticked(list, pqSMAdaptor::UNCHECKED);
  // What is applied already, the view shows in another way.
  if (!this->isSelected() || !this->view() || names.isEmpty() ||
      names == ticked(list, pqSMAdaptor::CHECKED))
  {
    this->Highlight->hide();
    return;
  }
  this->Highlight->show(this->view(), names);
}

QStringList SurfacePicker::pickedNames(vtkSMProxy* selection, int port)
{
  vtkSMProxy* filter = this->proxy();
  const QByteArray portName = this->propertyName("port").toUtf8();
  const QByteArray pickedName = this->propertyName("picked").toUtf8();
  vtkSMPropertyHelper pick(this->property());
  vtkSMPropertyHelper pickPort(filter, portName.data());
  pick.Set(selection);
  pickPort.Set(port);
  filter->UpdateProperty(filter->GetPropertyName(this->property()));
  filter->UpdateProperty(portName.data());
  vtkSMProperty* picked = filter->GetProperty(pickedName.data());
  filter->UpdatePropertyInformation(picked);
  QStringList names;
  const vtkSMPropertyHelper pairs(picked);
  for (unsigned int i = 0; i + 1 < pairs.GetNumberOfElements(); i += 2)
  {
    if (QString(pairs.GetAsString(i + 1)).toInt() != 0)
    {
      names << pairs.GetAsString(i);
    }
  }
  // A state would keep the selection, which has done its work.
  pick.RemoveAllValues();
  pickPort.Set(-1);
  filter->UpdateProperty(filter->GetPropertyName(this->property()));
  filter->UpdateProperty(portName.data());
  return names;
}

void SurfacePicker::addSelected()
{
  this->Message->show();
  int port = -1;
  vtkSMProxy* selection = selectionOf(this->proxy(), port);
  if (!selection)
  {
    this->Message->setText(
      tr("Nothing is selected. Select cells or points of the mesh in the view, "
         "for instance with the key S, and press the button again."));
    return;
  }
  const QStringList names = this->pickedNames(selection, port);
  if (names.isEmpty())
  {
    this->Message->setText(tr("The selection touches no surface of the mesh."));
    return;
  }
  vtkSMProperty* list = this->proxy()->GetProperty(this->propertyName("list").toUtf8().data());
  Ticks ticks = pqSMAdaptor::getSelectionProperty(list, pqSMAdaptor::UNCHECKED);
  for (QList<QVariant>& tick : ticks)
  {
    if (tick.size() == 2 && names.contains(tick[0].toString()))
    {
      tick[1] = 1;
    }
  }
  pqSMAdaptor::setSelectionProperty(list, ticks, pqSMAdaptor::UNCHECKED);
  this->Message->setText(tr("Ticked: %1").arg(names.join(", ")));
  Q_EMIT this->changeAvailable();
}
