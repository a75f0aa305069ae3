// SPDX-License-Identifier: BSD-3-Clause
#include "ZoneList.h"

#include <pqArrayListDomain.h>
#include <pqArraySelectionWidget.h>
#include <pqCoreUtilities.h>
#include <pqTreeViewSelectionHelper.h>
#include <vtkCommand.h>
#include <vtkPVXMLElement.h>
#include <vtkSMArraySelectionDomain.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>

#include <QHeaderView>
#include <QHelpEvent>
#include <QLabel>
#include <QMap>
#include <QStringList>
#include <QToolTip>
#include <QVBoxLayout>

ZoneList::ZoneList(vtkSMProxy* filter, vtkSMProperty* list, QWidget* parent)
  : Superclass(filter, parent)
  , List(new pqArraySelectionWidget(3, this))
  , Sizes(nullptr)
  , Name(filter->GetPropertyName(list))
{
  vtkPVXMLElement* const hints = list->GetHints();
  vtkPVXMLElement* const own = hints ? hints->FindNestedElementByName("ZoneList") : nullptr;
  const char* const sizes = own ? own->GetAttribute("sizes") : nullptr;
  const QStringList columns = QString(own ? own->GetAttribute("columns") : "").split(' ');
  this->Sizes = sizes ? filter->GetProperty(sizes) : nullptr;

  const QByteArray name = this->Name.toUtf8();
  this->List->setObjectName("ArraySelectionWidget");
  this->List->setHeaderLabel(0, tr("Name"));
  this->List->setHeaderLabel(1, columns.value(0));
  this->List->setHeaderLabel(2, columns.value(1));
  this->List->setMaximumRowCountBeforeScrolling(
    pqPropertyWidget::hintsWidgetHeightNumberOfRows(hints));
  new pqTreeViewSelectionHelper(this->List);
  // ParaView shows such a list's other columns before the names.
  QHeaderView* const header = this->List->header();
  header->moveSection(header->visualIndex(0), 0);
  // As wide as what they show and not as the panel, which a narrow dock shows in part.
  header->setStretchLastSection(false);
  header->setMaximumSectionSize(24 * this->fontMetrics().averageCharWidth());
  // Its minimum is wider than ParaView's dock.
  this->List->setSizePolicy(QSizePolicy::Ignored, this->List->sizePolicy().verticalPolicy());
  this->List->viewport()->installEventFilter(this);
  header->setSectionResizeMode(QHeaderView::ResizeToContents);
  for (const int column : { 1, 2 })
  {
    this->List->setColumnItemData(
      column, Qt::TextAlignmentRole, static_cast<int>(Qt::AlignRight | Qt::AlignVCenter));
  }

  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  // Above the list: as the title of a column it would leave the others no room in a narrow dock.
  auto* const title = new QLabel(list->GetXMLLabel(), this);
  title->setObjectName("PanelLabel");
  layout->addWidget(title);
  layout->addWidget(this->List);
  this->setShowLabel(false);
  this->setChangeAvailableAsChangeFinished(true);

  auto* const names = list->FindDomain<vtkSMArraySelectionDomain>();
  if (names)
  {
    new pqArrayListDomain(this->List, this->Name, filter, list, names);
    pqCoreUtilities::connect(names, vtkCommand::DomainModifiedEvent, this, SLOT(showSizes()));
  }
  this->addPropertyLink(this->List, name.data(), SIGNAL(widgetModified()), list);
  this->showSizes();
}

ZoneList::~ZoneList() = default;

void ZoneList::showSizes()
{
  if (!this->Sizes)
  {
    return;
  }
  this->proxy()->UpdatePropertyInformation(this->Sizes);
  QMap<QString, QString> counts, measures;
  const vtkSMPropertyHelper sizes(this->Sizes);
  for (unsigned int i = 0; i + 2 < sizes.GetNumberOfElements(); i += 3)
  {
    const QString name = sizes.GetAsString(i);
    counts[name] = sizes.GetAsString(i + 1);
    measures[name] = sizes.GetAsString(i + 2);
  }
  this->List->setColumnData(1, this->Name, std::move(counts));
  this->List->setColumnData(2, this->Name, std::move(measures));
}

bool ZoneList::eventFilter(QObject* object, QEvent* event)
{
  if (event->type() == QEvent::ToolTip && object == this->List->viewport())
  {
    const auto* const help = static_cast<QHelpEvent*>(event);
    const QModelIndex index = this->List->indexAt(help->pos());
    if (index.isValid())
    {
      QStringList texts;
      for (const int column : { 0, 1, 2 })
      {
        texts << index.sibling(index.row(), column).data().toString();
      }
      QToolTip::showText(help->globalPos(), texts.join(", "), this->List->viewport());
      return true;
    }
  }
  return this->Superclass::eventFilter(object, event);
}
