// SPDX-License-Identifier: BSD-3-Clause
#include "Advice.h"

#include <pqCoreUtilities.h>
#include <vtkCommand.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>

#include <QLabel>
#include <QVBoxLayout>

Advice::Advice(vtkSMProxy* filter, vtkSMProperty* text, QWidget* parent)
  : Superclass(filter, parent)
  , Text(new QLabel(this))
{
  this->setShowLabel(false);
  this->setProperty(text);
  this->Text->setObjectName("Text");
  this->Text->setWordWrap(true);
  // ParaView gives it the colors of a field that cannot be edited: a frame makes it a note.
  this->Text->setFrameShape(QFrame::StyledPanel);
  this->Text->setMargin(3);
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(this->Text);
  pqCoreUtilities::connect(text, vtkCommand::ModifiedEvent, this, SLOT(showText()));
  this->showText();
}

Advice::~Advice() = default;

void Advice::showText()
{
  const vtkSMPropertyHelper helper(this->property());
  const QString text = helper.GetNumberOfElements() > 0 ? helper.GetAsString() : "";
  const bool isAny = !text.isEmpty() && text != "None";
  this->Text->setText(isAny ? text : QString());
  this->Text->setVisible(isAny);
}
