// SPDX-License-Identifier: BSD-3-Clause
#include "Fold.h"

#include "Folds.h"
#include "TickedNames.h"

#include <pqCoreUtilities.h>
#include <pqPropertyWidget.h>
#include <vtkCommand.h>
#include <vtkPVXMLElement.h>
#include <vtkSMArraySelectionDomain.h>
#include <vtkSMBooleanDomain.h>
#include <vtkSMDoubleVectorProperty.h>
#include <vtkSMEnumerationDomain.h>
#include <vtkSMInputProperty.h>
#include <vtkSMProperty.h>
#include <vtkSMProxy.h>
#include <vtkSMSessionProxyManager.h>
#include <vtkSMUncheckedPropertyHelper.h>
#include <vtkSMVectorProperty.h>

#include <QStringList>

#include <cmath>

namespace
{
bool isList(vtkSMProperty* property)
{
  return property->FindDomain<vtkSMArraySelectionDomain>() != nullptr;
}

/// The values as the panel has them, before they are applied.
QStringList valuesOf(vtkSMProperty* property)
{
  if (isList(property))
  {
    return tickedNames(property);
  }
  QStringList values;
  if (vtkSMVectorProperty::SafeDownCast(property))
  {
    const vtkSMUncheckedPropertyHelper helper(property);
    for (unsigned int i = 0; i < helper.GetNumberOfElements(); ++i)
    {
      values << helper.GetAsVariant(i).ToString().c_str();
    }
  }
  return values;
}

/// The same property with its default.
vtkSMProperty* defaultOf(const pqPropertyWidget* widget)
{
  vtkSMProxy* const proxy = widget->proxy();
  vtkSMProxy* const prototype =
    proxy->GetSessionProxyManager()->GetPrototypeProxy(proxy->GetXMLGroup(), proxy->GetXMLName());
  return prototype ? prototype->GetProperty(proxy->GetPropertyName(widget->property())) : nullptr;
}
}

Fold::Fold(vtkPVXMLElement* hint, pqPropertyWidget* widget)
  : Superclass(hint, widget)
  , Panel(Folds::Of(widget->QWidget::parentWidget()))
  , Title(hint->GetAttribute("title"))
{
  this->Panel->add(this->Title, this);
  for (const auto event : { vtkCommand::ModifiedEvent, vtkCommand::UncheckedPropertyModifiedEvent })
  {
    pqCoreUtilities::connect(
      this->given(), static_cast<int>(event), this->Panel, SLOT(refreshLater()));
  }
  if (this->given()->GetInformationOnly() != 0)
  {
    pqCoreUtilities::connect(
      this->given(), vtkCommand::ModifiedEvent, this, SIGNAL(visibilityChanged()));
  }
}

Fold::~Fold() = default;

vtkSMProperty* Fold::given() const
{
  return this->parentWidget()->property();
}

bool Fold::hasResult() const
{
  vtkSMProperty* const status = this->parentWidget()->proxy()->GetProperty("MorphStatus");
  if (status && status != this->given() &&
      QStringList{ "", "None", "Failed", "Cancelled" }.contains(valuesOf(status).value(0)))
  {
    return false;
  }
  const QString value = valuesOf(this->given()).value(0);
  const QString none = valuesOf(defaultOf(this->parentWidget())).value(0);
  return !value.isEmpty() && value != "None" && !std::isnan(value.toDouble()) &&
         !(value == "-1" && none == "-1");
}

bool Fold::canShowWidget(bool) const
{
  return this->Panel->isOpen(this->Title) &&
         (this->given()->GetInformationOnly() == 0 || this->hasResult());
}

bool Fold::isOffered(bool withAdvanced) const
{
  if (!withAdvanced && QString(this->given()->GetPanelVisibility()) == "advanced")
  {
    return false;
  }
  if (this->given()->GetInformationOnly() != 0)
  {
    return this->hasResult();
  }
  for (const auto& decorator : this->parentWidget()->decorators())
  {
    if (decorator && !qobject_cast<const Fold*>(decorator) &&
        !decorator->canShowWidget(withAdvanced))
    {
      return false;
    }
  }
  return true;
}

bool Fold::isDefault() const
{
  if (this->given()->GetInformationOnly() != 0)
  {
    return true;
  }
  if (vtkSMInputProperty::SafeDownCast(this->given()))
  {
    const vtkSMUncheckedPropertyHelper inputs(this->given());
    return inputs.GetNumberOfElements() == 0 || !inputs.GetAsProxy();
  }
  return valuesOf(this->given()) == valuesOf(defaultOf(this->parentWidget()));
}

QString Fold::told() const
{
  vtkSMProperty* const property = this->given();
  vtkPVXMLElement* const hints = property->GetHints();
  vtkPVXMLElement* const hint = hints ? hints->FindNestedElementByName("Told") : nullptr;
  const QString words = hint ? hint->GetAttribute("text") : "";
  const QStringList values = valuesOf(property);
  if (property->GetInformationOnly() != 0)
  {
    if (words.isEmpty() || !this->hasResult() ||
        values == valuesOf(defaultOf(this->parentWidget())))
    {
      return {};
    }
    const bool isDouble = vtkSMDoubleVectorProperty::SafeDownCast(property) != nullptr;
    return words.arg(isDouble ? QString::number(values[0].toDouble(), 'g', 3) : values[0]);
  }
  if (this->isDefault())
  {
    return {};
  }
  const QString label = property->GetXMLLabel();
  if (auto* const entries = property->FindDomain<vtkSMEnumerationDomain>())
  {
    const char* const entry = entries->GetEntryTextForValue(values.value(0).toInt());
    return QStringList{ entry, words }.join(' ').trimmed();
  }
  if (words.contains("%1"))
  {
    return words.arg(values.join(' '));
  }
  if (!words.isEmpty())
  {
    const int count = isList(property) ? values.size() : values.value(0).toInt();
    return QString(count == 1 ? "%1 %2" : "%1 %2s").arg(count).arg(words);
  }
  if (property->FindDomain<vtkSMBooleanDomain>())
  {
    return values.value(0) == "0" ? tr("no %1").arg(label.toLower()) : label.toLower();
  }
  return QStringList{ label, values.join(' ') }.join(' ').trimmed();
}
