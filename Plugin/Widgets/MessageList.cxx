// SPDX-License-Identifier: BSD-3-Clause
#include "MessageList.h"

#include "BelowField.h"
#include "PanelWords.h"

#include <pqApplicationCore.h>
#include <pqPVApplicationCore.h>
#include <pqPipelineSource.h>
#include <pqPropertiesPanel.h>
#include <pqPropertyWidget.h>
#include <pqProxyWidget.h>
#include <pqSMAdaptor.h>
#include <pqSelectionManager.h>
#include <pqServerManagerModel.h>
#include <pqView.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPVDataInformation.h>
#include <vtkSMEnumerationDomain.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkSMSelectionHelper.h>
#include <vtkSMSession.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMUncheckedPropertyHelper.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkSmartPointer.h>

#include <QLabel>
#include <QPushButton>
#include <QRegularExpression>
#include <QStringList>
#include <QVBoxLayout>

#include <functional>

namespace
{
constexpr int Most = 400; ///< characters that are shown; a tool tip has them all

/// "set `Property` to value" or "`Property` set to value".
const QRegularExpression& remedy()
{
  static const QRegularExpression found(
    "(?|[Ss]et `(\\w+)`|`(\\w+)` set) to ('[^']+'(?:, '[^']+')*|[\\w.-]*\\w)");
  return found;
}

/// The entry of `property` with which `text` begins, the longest of several, else `word`.
QString entryOf(vtkSMProperty* property, const QString& text, const QString& word)
{
  QString longest;
  if (const auto domain = property->FindDomain<vtkSMEnumerationDomain>())
  {
    for (unsigned int i = 0; i < domain->GetNumberOfEntries(); ++i)
    {
      const QString entry = domain->GetEntryText(i);
      longest = text.startsWith(entry, Qt::CaseInsensitive) && entry.size() > longest.size()
                  ? entry
                  : longest;
    }
  }
  return longest.isEmpty() ? word : longest;
}

/// What a role of surfaces is called, by its list.
QString roleOf(const QString& list)
{
  return list == "FixedSurfaces"     ? QObject::tr("stay")
         : list == "SlidingSurfaces" ? QObject::tr("slide")
         : list == "FreeSurfaces"    ? QObject::tr("be free")
                                     : QString();
}

QStringList namesIn(const QString& value)
{
  QStringList names;
  for (const QString& name : value.split("', '"))
  {
    names << QString(name).remove('\'');
  }
  return names;
}
}

MessageList::MessageList(pqPropertyWidget* owner)
  : QWidget(owner)
  , Owner(owner)
  , Rows(new QVBoxLayout(this))
{
  this->setObjectName("Messages");
  this->Rows->setContentsMargins(0, 0, 0, 0);
  this->Rows->setSpacing(0);
}

MessageList::~MessageList() = default;

vtkSMProxy* MessageList::filter() const
{
  return this->Owner->proxy();
}

void MessageList::showMessages()
{
  const vtkSMPropertyHelper messages(this->filter(), "Messages");
  bool isError = false;
  for (unsigned int i = 0; i + 1 < messages.GetNumberOfElements(); i += 2)
  {
    isError = isError || messages.GetAsString(i) == QString("Error");
  }
  // In a drag the panel's rows would jump with each step; what is said then is said on release.
  vtkSMProperty* const live = this->filter()->GetProperty("Live");
  const bool isDragged = live && vtkSMPropertyHelper(live).GetAsInt() != 0;
  if (isDragged && !isError && !this->IsError)
  {
    return;
  }
  this->IsError = isError;
  for (const QPointer<QWidget>& row : this->Shown)
  {
    if (row)
    {
      row->hide();
      row->deleteLater();
    }
  }
  this->Shown.clear();
  for (unsigned int i = 0; i + 1 < messages.GetNumberOfElements(); i += 2)
  {
    const QString message = QString::fromUtf8(messages.GetAsString(i + 1));
    QWidget* const row = this->rowOf(messages.GetAsString(i), message);
    this->place(row, message);
    this->Shown.append(row);
  }
}

QWidget* MessageList::rowOf(const QString& kind, const QString& message)
{
  auto* const row = new QWidget();
  row->setObjectName(QString("Message%1").arg(this->Shown.size()));
  auto* const layout = new QVBoxLayout(row);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(1);
  const QString words = inPanelWords(message).simplified();
  auto* const text = new QLabel(words.size() > Most ? words.left(Most) + "..." : words, row);
  text->setObjectName("Text");
  text->setTextFormat(Qt::PlainText);
  text->setTextInteractionFlags(Qt::TextSelectableByMouse);
  text->setToolTip(inPanelWords(message));
  text->setWordWrap(true);
  text->setMargin(3);
  text->setStyleSheet(kind == "Error" ? "background: #fbe3e4; color: #6d1014"
                                      : "background: #fff3d6; color: #5a3c00");
  layout->addWidget(text);
  this->addRemedies(message, row);
  return row;
}

void MessageList::addRemedies(const QString& message, QWidget* row)
{
  const auto add = [&](const QString& label, const std::function<void()>& action)
  {
    auto* const button = new QPushButton(label, row);
    button->setObjectName(QString("Remedy%1").arg(row->findChildren<QPushButton*>().size() - 1));
    button->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
    button->setToolTip(label); // it may be cut off
    QObject::connect(button, &QPushButton::clicked, this, action);
    row->layout()->addWidget(button);
  };
  for (auto found = remedy().globalMatch(message); found.hasNext();)
  {
    const QRegularExpressionMatch one = found.next();
    const QString property = one.captured(1);
    vtkSMProperty* const changed = this->filter()->GetProperty(qPrintable(property));
    if (!changed)
    {
      continue;
    }
    const QString value = entryOf(changed, message.mid(one.capturedStart(2)), one.captured(2));
    const QString role = roleOf(property);
    add(role.isEmpty()
          ? tr("Set %1 to %2").arg(inPanelWords("`" + property + "`"), QString(value).remove('\''))
          : tr("Let %1 %2").arg(namesIn(value).join(", "), role),
      [this, property, value] { this->set(property, value); });
  }
  static const QRegularExpression place("cell (\\d+) at \\(([^,]+), ([^,]+), ([^)]+)\\)");
  const QRegularExpressionMatch cell = place.match(message);
  if (cell.hasMatch())
  {
    const int id = cell.captured(1).toInt();
    const double x = cell.captured(2).toDouble(), y = cell.captured(3).toDouble(),
                 z = cell.captured(4).toDouble();
    add(tr("Go to cell %1").arg(id),
      [this, id, x, y, z]
      {
        const double at[] = { x, y, z };
        this->goTo(id, at);
      });
  }
}

void MessageList::place(QWidget* row, const QString& message)
{
  static const QRegularExpression named("`(\\w+)`");
  const QWidget* const panel = this->Owner->parentWidget();
  for (auto found = named.globalMatch(message); panel && found.hasNext();)
  {
    auto* const field = panel->findChild<pqPropertyWidget*>(found.next().captured(1));
    if (field && field->isVisibleTo(panel) && field->layout())
    {
      putBelow(field, row);
      return;
    }
  }
  this->Rows->addWidget(row);
}

void MessageList::set(const QString& property, const QString& value)
{
  vtkSMProperty* const changed = this->filter()->GetProperty(qPrintable(property));
  if (value.startsWith('\''))
  {
    const QStringList names = namesIn(value);
    auto ticks = pqSMAdaptor::getSelectionProperty(changed, pqSMAdaptor::UNCHECKED);
    for (QList<QVariant>& tick : ticks)
    {
      if (tick.size() == 2 && names.contains(tick[0].toString()))
      {
        tick[1] = 1;
      }
    }
    pqSMAdaptor::setSelectionProperty(changed, ticks, pqSMAdaptor::UNCHECKED);
  }
  else
  {
    vtkSMUncheckedPropertyHelper(changed).Set(qPrintable(value));
  }
  Q_EMIT this->Owner->changeAvailable();
  Q_EMIT this->Owner->changeFinished();
}

void MessageList::goTo(int cell, const double place[3])
{
  auto* const source =
    pqApplicationCore::instance()->getServerManagerModel()->findItem<pqPipelineSource*>(
      this->filter());
  vtkNew<vtkIdTypeArray> ids;
  ids->InsertNextValue(cell);
  vtkNew<vtkSelectionNode> node;
  node->SetContentType(vtkSelectionNode::INDICES);
  node->SetFieldType(vtkSelectionNode::CELL);
  node->SetSelectionList(ids);
  vtkNew<vtkSelection> selection;
  selection->AddNode(node);
  auto selected = vtk::TakeSmartPointer(
    vtkSMSourceProxy::SafeDownCast(vtkSMSelectionHelper::NewSelectionSourceFromSelection(
      this->filter()->GetSession(), selection)));
  auto appended = vtk::TakeSmartPointer(vtkSMSourceProxy::SafeDownCast(
    vtkSMSelectionHelper::NewAppendSelectionsFromSelectionSource(selected)));
  pqOutputPort* const mesh = source->getOutputPort(0);
  mesh->setSelectionInput(appended, 0);
  pqPVApplicationCore::instance()->selectionManager()->select(mesh);
  auto* const view = this->Owner->view();
  auto* const camera = vtkSMRenderViewProxy::SafeDownCast(view ? view->getViewProxy() : nullptr);
  if (camera)
  {
    constexpr double Near = 0.1; // of the mesh's extents
    double bounds[6];
    mesh->getDataInformation()->GetBounds(bounds);
    for (int d = 0; d < 3; ++d)
    {
      const double half = Near * (bounds[2 * d + 1] - bounds[2 * d]) / 2;
      bounds[2 * d] = place[d] - half;
      bounds[2 * d + 1] = place[d] + half;
    }
    camera->ResetCamera(bounds);
    view->render();
  }
}
