// SPDX-License-Identifier: BSD-3-Clause
#include "WholeNumber.h"

#include <pqCoreUtilities.h>
#include <vtkCommand.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>

#include <QHBoxLayout>
#include <QLineEdit>

WholeNumber::WholeNumber(vtkSMProxy* filter, vtkSMProperty* number, QWidget* parent)
  : Superclass(filter, parent)
  , Number(new QLineEdit(this))
{
  this->setProperty(number);
  this->Number->setObjectName("Number");
  this->Number->setReadOnly(true);
  auto* const layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(this->Number);
  pqCoreUtilities::connect(number, vtkCommand::ModifiedEvent, this, SLOT(showNumber()));
  this->showNumber();
}

WholeNumber::~WholeNumber() = default;

void WholeNumber::showNumber()
{
  const vtkSMPropertyHelper helper(this->property());
  this->Number->setText(
    helper.GetNumberOfElements() > 0 ? QString::number(helper.GetAsIdType()) : QString());
}
