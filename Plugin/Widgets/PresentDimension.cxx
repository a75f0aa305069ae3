// SPDX-License-Identifier: BSD-3-Clause
#include "PresentDimension.h"

#include "BelowField.h"
#include "PanelWords.h"
#include "SurfaceHighlight.h"
#include "TickedNames.h"

#include <pqCoreUtilities.h>
#include <pqPropertyWidget.h>
#include <vtkCommand.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSourceProxy.h>

#include <QEvent>
#include <QLabel>
#include <QStringList>
#include <QTimer>

PresentDimension::PresentDimension(vtkPVXMLElement* hint, pqPropertyWidget* widget)
  : Superclass(hint, widget)
  , Text(new QLabel(widget))
{
  this->Text->setObjectName("PresentDimension");
  this->Text->setWordWrap(true);
  putBelow(widget, this->Text);
  widget->installEventFilter(this);
  vtkSMProxy* const filter = widget->proxy();
  pqCoreUtilities::connect(filter->GetProperty("Surfaces"),
    vtkCommand::UncheckedPropertyModifiedEvent, this, SLOT(showLater()));
  pqCoreUtilities::connect(filter, vtkCommand::UpdateDataEvent, this, SLOT(showLater()));
}

PresentDimension::~PresentDimension() = default;

bool PresentDimension::eventFilter(QObject* object, QEvent* event)
{
  if (event->type() == QEvent::Show)
  {
    this->showLater();
  }
  return this->Superclass::eventFilter(object, event);
}

void PresentDimension::showLater()
{
  if (!this->IsDue)
  {
    this->IsDue = true;
    QTimer::singleShot(0, this, [this] { this->showDimension(); });
  }
}

void PresentDimension::showDimension()
{
  this->IsDue = false;
  if (!this->parentWidget()->isVisible())
  {
    return; // it costs a pass over the surfaces
  }
  vtkSMProxy* const filter = this->parentWidget()->proxy();
  if (!this->Source)
  {
    this->Source = SurfaceHighlight::SourceOf(filter);
  }
  const QStringList ticked = tickedNames(filter->GetProperty("Surfaces"));
  vtkSMPropertyHelper names(this->Source, "Surfaces");
  names.SetNumberOfElements(static_cast<unsigned int>(ticked.size()));
  for (int i = 0; i < ticked.size(); ++i)
  {
    names.Set(static_cast<unsigned int>(i), ticked[i].toUtf8().data());
  }
  this->Source->UpdateVTKObjects();
  this->Source->UpdatePropertyInformation(this->Source->GetProperty("Dimension"));
  this->Text->setText(inPanelWords(vtkSMPropertyHelper(this->Source, "Dimension").GetAsString()));
}
