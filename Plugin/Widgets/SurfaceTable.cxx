// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTable.h"

#include "Ancestor.h"
#include "MotionPreview.h"
#include "SurfaceColors.h"
#include "SurfaceHighlight.h"

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqComboBoxDomain.h>
#include <pqCoreUtilities.h>
#include <pqOutputPort.h>
#include <pqPVApplicationCore.h>
#include <pqPipelineSource.h>
#include <pqProxyWidget.h>
#include <pqSMAdaptor.h>
#include <pqSelectionManager.h>
#include <pqServerManagerModel.h>
#include <pqSignalAdaptors.h>
#include <pqView.h>
#include <vtkCollection.h>
#include <vtkCommand.h>
#include <vtkNew.h>
#include <vtkSMArraySelectionDomain.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMUncheckedPropertyHelper.h>

#include <QComboBox>
#include <QDockWidget>
#include <QGridLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QMainWindow>
#include <QMenu>
#include <QMouseEvent>
#include <QPainter>
#include <QPushButton>
#include <QRegularExpression>
#include <QScrollArea>
#include <QSet>
#include <QStyledItemDelegate>
#include <QTimer>
#include <QTreeWidget>
#include <QVariant>

#include <algorithm>
#include <tuple>

namespace
{
using Ticks = QList<QList<QVariant>>; ///< a name and whether it is in the list

enum Column
{
  NameColumn,
  FacesColumn,
  AreaColumn,
  ShapeColumn,
  RoleColumn
};
constexpr int FewestRows = 4;
constexpr int MostRows = 8;
const char* const RoleNames[] = { "Moves", "Follows", "Stays", "Slides", "Free" };

/// Draws a role as a drop-down; that of most surfaces in gray.
class RoleDelegate : public QStyledItemDelegate
{
public:
  using QStyledItemDelegate::QStyledItemDelegate;

  void paint(
    QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override
  {
    const QString role = index.data().toString();
    if (role.isEmpty())
    {
      QStyledItemDelegate::paint(painter, option, index);
      return;
    }
    const QWidget* const table = option.widget;
    QStyleOptionComboBox box;
    box.initFrom(table);
    box.rect = option.rect.adjusted(1, 0, -1, 0);
    box.currentText = role;
    box.subControls = QStyle::SC_ComboBoxFrame | QStyle::SC_ComboBoxArrow;
    if (role == RoleNames[1])
    {
      box.palette.setColor(
        QPalette::ButtonText, table->palette().color(QPalette::Disabled, QPalette::Text));
    }
    table->style()->drawComplexControl(QStyle::CC_ComboBox, &box, painter, table);
    table->style()->drawControl(QStyle::CE_ComboBoxLabel, &box, painter, table);
  }
};

QIcon chipOf(const QColor& color)
{
  QPixmap chip(10, 10);
  chip.fill(color.isValid() ? color : QColor(Qt::transparent));
  return QIcon(chip);
}

/// Empty: the row that says how many curves there are.
QString nameOf(const QTreeWidgetItem* row)
{
  return row->data(NameColumn, Qt::UserRole).toString();
}

QString fourDigits(const QString& text)
{
  bool isWhole = false;
  text.toLongLong(&isWhole); // a count, or none
  return isWhole || text.isEmpty() ? text : QString::number(text.toDouble(), 'g', 4);
}

/// In a new window the panel would be too narrow for what it shows.
void widenDock(QWidget* inside)
{
  const auto* const area = ancestorOf<QScrollArea>(inside);
  auto* const dock = ancestorOf<QDockWidget>(inside);
  auto* const window = dock ? ancestorOf<QMainWindow>(dock) : nullptr;
  if (area && window)
  {
    const int missing = area->widget()->minimumSizeHint().width() - area->viewport()->width();
    window->resizeDocks({ dock }, { dock->width() + std::max(missing, 0) }, Qt::Horizontal);
  }
}
}

SurfaceTable::SurfaceTable(vtkSMProxy* filter, vtkSMPropertyGroup* group, QWidget* parent)
  : Superclass(filter, group, parent)
  , What(new QComboBox(this))
  , Search(new QLineEdit(this))
  , Rows(new QTreeWidget(this))
  , Roles(new QMenu(this))
  , Message(new QLabel(this))
  , Highlight(new SurfaceHighlight(filter))
  , Preview(new MotionPreview(filter))
{
  this->setShowLabel(false);

  vtkSMProperty* const what = this->named("Moving");
  this->What->setObjectName("Moving");
  this->What->setToolTip(Superclass::getTooltip(what));
  new pqComboBoxDomain(this->What, what);
  auto* const adaptor = new pqSignalAdaptorComboBox(this->What);
  this->addPropertyLink(adaptor, "currentText", SIGNAL(currentTextChanged(QString)), what);

  this->Search->setObjectName("Search");
  this->Search->setPlaceholderText(tr("Find"));
  this->Search->setClearButtonEnabled(true);
  this->Search->setMinimumWidth(6 * this->fontMetrics().averageCharWidth());
  QObject::connect(this->Search, &QLineEdit::textChanged, this, [this] { this->hideRows(); });

  this->Rows->setObjectName("Rows");
  this->Rows->setHeaderLabels({ tr("Moves"), tr("Faces"), tr("Area"), tr("Shape"), tr("Role") });
  this->Rows->setToolTip(Superclass::getTooltip(this->listOf(Moves)));
  this->Rows->setRootIsDecorated(false);
  this->Rows->setUniformRowHeights(true);
  this->Rows->setSelectionMode(QAbstractItemView::ExtendedSelection);
  this->Rows->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  this->Rows->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
  this->Rows->setItemDelegateForColumn(RoleColumn, new RoleDelegate(this->Rows));
  QHeaderView* const header = this->Rows->header();
  header->setStretchLastSection(false);
  header->setMinimumSectionSize(4 * this->fontMetrics().averageCharWidth());
  header->setSectionResizeMode(QHeaderView::ResizeToContents);
  header->setSectionResizeMode(NameColumn, QHeaderView::Stretch);
  header->setSectionResizeMode(RoleColumn, QHeaderView::Fixed);
  header->resizeSection(
    RoleColumn, this->fontMetrics().horizontalAdvance(RoleNames[1]) + 2 * header->height());
  this->Rows->viewport()->installEventFilter(this);
  QObject::connect(this->Rows, &QTreeWidget::itemChanged, this,
    [this](QTreeWidgetItem* row, int column)
    {
      if (!this->IsFilling && column == NameColumn)
      {
        const QString name = nameOf(row);
        this->setRole(row->isSelected() ? this->selectedNames() : QStringList{ name },
          row->checkState(NameColumn) == Qt::Checked ? Moves : Follows);
      }
    });
  QObject::connect(
    this->Rows, &QTreeWidget::itemSelectionChanged, this, [this] { this->highlight(); });

  this->Roles->setObjectName("Roles");

  auto* const button = new QPushButton(tr("Add selected surfaces"), this);
  button->setObjectName("AddSelected");
  button->setToolTip(Superclass::getTooltip(this->named("Pick")));
  QObject::connect(button, SIGNAL(clicked()), this, SLOT(addSelected()));
  this->Message->setObjectName("Message");
  this->Message->setWordWrap(true);
  this->Message->hide();

  auto* const layout = new QGridLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setColumnStretch(0, 1);
  layout->setColumnStretch(1, 1);
  layout->addWidget(this->What, 0, 0);
  layout->addWidget(this->Search, 0, 1);
  layout->addWidget(this->Rows, 1, 0, 1, 2);
  layout->addWidget(button, 2, 0, 1, 2);
  layout->addWidget(this->Message, 3, 0, 1, 2);

  for (const Role role : { Moves, Stays, Slides, Free })
  {
    vtkSMProperty* const list = this->listOf(role);
    for (const auto event :
      { vtkCommand::ModifiedEvent, vtkCommand::UncheckedPropertyModifiedEvent })
    {
      pqCoreUtilities::connect(list, static_cast<int>(event), this, SLOT(fillLater()));
    }
    if (auto* const names = list->FindDomain<vtkSMArraySelectionDomain>())
    {
      pqCoreUtilities::connect(names, vtkCommand::DomainModifiedEvent, this, SLOT(fillLater()));
    }
  }
  QObject::connect(pqPVApplicationCore::instance()->selectionManager(),
    SIGNAL(selectionChanged(pqOutputPort*)), this, SLOT(pickRows(pqOutputPort*)));
  // The panel is being made; its properties are beside this widget.
  if (auto* const panel = ancestorOf<pqProxyWidget>(this))
  {
    QObject::connect(panel, &pqProxyWidget::changeAvailable, this, &SurfaceTable::previewLater);
  }
  this->fill();
}

SurfaceTable::~SurfaceTable() = default;

void SurfaceTable::showEvent(QShowEvent* event)
{
  this->Superclass::showEvent(event);
  static bool isDone = false; // later widths are the user's
  if (!isDone)
  {
    isDone = true;
    QTimer::singleShot(0, this, [this] { widenDock(this); });
  }
}

vtkSMProperty* SurfaceTable::named(const char* property) const
{
  return this->proxy()->GetProperty(property);
}

vtkSMProperty* SurfaceTable::listOf(Role role) const
{
  constexpr const char* lists[] = { "Surfaces", nullptr, "FixedSurfaces", "SlidingSurfaces",
    "FreeSurfaces" };
  return this->named(lists[role]);
}

QStringList SurfaceTable::namesOf(Role role) const
{
  QStringList names;
  for (const QList<QVariant>& tick :
    pqSMAdaptor::getSelectionProperty(this->listOf(role), pqSMAdaptor::UNCHECKED))
  {
    if (tick.size() == 2 && tick[1].toInt() != 0)
    {
      names << tick[0].toString();
    }
  }
  return names;
}

QHash<QString, SurfaceTable::Role> SurfaceTable::roles() const
{
  QHash<QString, Role> roles;
  for (const Role role : { Free, Slides, Stays, Moves }) // a script may give several
  {
    for (const QString& name : this->namesOf(role))
    {
      roles[name] = role;
    }
  }
  return roles;
}

QVector<SurfaceTable::Surface> SurfaceTable::surfaces() const
{
  const QRegularExpression numbered("^(Surface|Curve) (\\d+)$");
  const QStringList moving = this->namesOf(Moves);
  QVector<Surface> found;
  vtkSMProperty* const property = this->named("SurfaceSizes");
  this->proxy()->UpdatePropertyInformation(property);
  const vtkSMPropertyHelper sizes(property);
  vtkSMProperty* const shapeProperty = this->named("SurfaceShapes");
  this->proxy()->UpdatePropertyInformation(shapeProperty);
  const vtkSMPropertyHelper pairs(shapeProperty);
  QHash<QString, QString> shapes;
  for (unsigned int i = 0; i + 1 < pairs.GetNumberOfElements(); i += 2)
  {
    shapes[pairs.GetAsString(i)] = pairs.GetAsString(i + 1);
  }
  std::size_t place = 0; // among the surfaces of the view
  for (unsigned int i = 0; i + 2 < sizes.GetNumberOfElements(); i += 3)
  {
    Surface one{ sizes.GetAsString(i), sizes.GetAsString(i + 1),
      fourDigits(sizes.GetAsString(i + 2)), shapes.value(sizes.GetAsString(i)), {}, false, 1, 0 };
    const QRegularExpressionMatch match = numbered.match(one.Name);
    if (match.hasMatch())
    {
      one.IsCurve = match.captured(1) == "Curve";
      one.Rank = one.IsCurve ? 3 : 2;
      one.Number = match.captured(2).toInt();
    }
    if (one.Rank == 2)
    {
      const std::array<double, 3> color = SurfaceColors::ColorOf(place++);
      one.Chip = QColor::fromRgbF(color[0], color[1], color[2]);
    }
    if (moving.contains(one.Name))
    {
      one.Rank = 0;
    }
    found.append(one);
  }
  std::stable_sort(found.begin(), found.end(),
    [](const Surface& a, const Surface& b)
    { return std::tie(a.Rank, a.Number) < std::tie(b.Rank, b.Number); });
  return found;
}

void SurfaceTable::fillLater()
{
  if (!this->IsDue)
  {
    this->IsDue = true;
    QTimer::singleShot(0, this, [this] { this->fill(); });
  }
}

void SurfaceTable::makeRows(const QVector<Surface>& surfaces)
{
  this->Rows->clear();
  bool hasCurves = false;
  for (const Surface& one : surfaces)
  {
    if (one.Rank == 3 && !hasCurves)
    {
      hasCurves = true;
      auto* const row = new QTreeWidgetItem(this->Rows); // says how many there are
      row->setFlags(Qt::ItemIsEnabled);
      row->setFirstColumnSpanned(true);
    }
    auto* const row = new QTreeWidgetItem(this->Rows);
    row->setData(NameColumn, Qt::UserRole, one.Name);
    row->setText(NameColumn, one.Name);
    row->setToolTip(NameColumn, one.Name);
    row->setTextAlignment(FacesColumn, Qt::AlignRight | Qt::AlignVCenter);
    row->setTextAlignment(AreaColumn, Qt::AlignRight | Qt::AlignVCenter);
  }
}

void SurfaceTable::fill()
{
  this->IsDue = false;
  this->IsFilling = true;
  const QStringList selected = this->selectedNames();
  const QVector<Surface> surfaces = this->surfaces();
  QHash<QString, Surface> byName;
  for (const Surface& one : surfaces)
  {
    byName[one.Name] = one;
  }
  QSet<QString> shown;
  for (int i = 0; i < this->Rows->topLevelItemCount(); ++i)
  {
    shown.insert(nameOf(this->Rows->topLevelItem(i)));
  }
  shown.remove(QString());
  // Rows stay where they are while a user ticks them.
  const QStringList names = byName.keys();
  if (shown != QSet<QString>(names.begin(), names.end()))
  {
    this->makeRows(surfaces);
  }
  const QHash<QString, Role> roles = this->roles();
  const auto curves = std::count_if(
    surfaces.begin(), surfaces.end(), [](const Surface& one) { return one.Rank == 3; });
  for (int i = 0; i < this->Rows->topLevelItemCount(); ++i)
  {
    QTreeWidgetItem* const row = this->Rows->topLevelItem(i);
    const QString name = nameOf(row);
    if (name.isEmpty())
    {
      row->setText(
        NameColumn, tr(this->AreCurvesShown ? "- %1 curves" : "+ %1 curves").arg(curves));
      continue;
    }
    const Surface& one = byName[name];
    const Role role = roles.value(name, Follows);
    row->setIcon(NameColumn, chipOf(one.Chip));
    row->setText(FacesColumn, one.IsCurve ? tr("%1 edges").arg(one.Faces) : one.Faces);
    row->setText(AreaColumn, one.IsCurve ? tr("%1 long").arg(one.Area) : one.Area);
    row->setText(ShapeColumn, one.Shape);
    row->setToolTip(ShapeColumn, one.Shape);
    row->setCheckState(NameColumn, role == Moves ? Qt::Checked : Qt::Unchecked);
    row->setText(RoleColumn, tr(RoleNames[role]));
  }
  this->IsFilling = false;
  this->selectNames(selected);
  this->hideRows();
  this->hideColumns();
  this->highlight();
}

void SurfaceTable::hideColumns()
{
  const auto widest = [this](int column)
  {
    int width = this->fontMetrics().horizontalAdvance(this->Rows->headerItem()->text(column));
    for (int i = 0; i < this->Rows->topLevelItemCount(); ++i)
    {
      const QTreeWidgetItem* const row = this->Rows->topLevelItem(i);
      const QString text = row->isHidden() ? QString() : row->text(column);
      width = std::max(width, this->fontMetrics().horizontalAdvance(text));
    }
    return width + 2 * this->fontMetrics().averageCharWidth(); // the margins of a cell
  };
  constexpr int Letters = 12; // of a name that are always seen
  const QHeaderView* const header = this->Rows->header();
  const int boxes = 2 * header->height(); // the tick and the color before a name
  int wanted = boxes + header->sectionSize(RoleColumn) +
               std::min(widest(NameColumn), Letters * this->fontMetrics().averageCharWidth());
  for (const int column : { FacesColumn, AreaColumn, ShapeColumn })
  {
    wanted += widest(column);
    this->Rows->setColumnHidden(column, wanted > this->Rows->viewport()->width());
  }
}

void SurfaceTable::hideRows()
{
  const QString wanted = this->Search->text();
  int shown = 0;
  for (int i = 0; i < this->Rows->topLevelItemCount(); ++i)
  {
    QTreeWidgetItem* const row = this->Rows->topLevelItem(i);
    const QString name = nameOf(row);
    const bool isCurve = name.startsWith("Curve ");
    const bool isFound = wanted.isEmpty() ? !isCurve || this->AreCurvesShown ||
                                              row->text(RoleColumn) != tr(RoleNames[Follows])
                                          : name.contains(wanted, Qt::CaseInsensitive);
    row->setHidden(!isFound);
    shown += isFound ? 1 : 0;
  }
  const int height = std::max(this->Rows->sizeHintForRow(0), this->fontMetrics().height() + 2);
  this->Rows->setFixedHeight(this->Rows->header()->sizeHint().height() + 4 +
                             height * std::min(MostRows, std::max(FewestRows, shown)));
}

QStringList SurfaceTable::selectedNames() const
{
  QStringList names;
  for (const QTreeWidgetItem* row : this->Rows->selectedItems())
  {
    names << nameOf(row);
  }
  return names;
}

void SurfaceTable::selectNames(const QStringList& names)
{
  QTreeWidgetItem* first = nullptr;
  for (int i = 0; i < this->Rows->topLevelItemCount(); ++i)
  {
    QTreeWidgetItem* const row = this->Rows->topLevelItem(i);
    const QString name = nameOf(row);
    row->setSelected(!name.isEmpty() && names.contains(name));
    first = row->isSelected() && !first ? row : first;
  }
  if (first)
  {
    this->Rows->scrollToItem(first);
  }
}

bool SurfaceTable::eventFilter(QObject* object, QEvent* event)
{
  if (object == this->Rows->viewport() && event->type() == QEvent::Resize)
  {
    this->hideColumns();
  }
  if (object == this->Rows->viewport() && event->type() == QEvent::MouseButtonPress)
  {
    const auto* const press = static_cast<QMouseEvent*>(event);
    QTreeWidgetItem* const row = this->Rows->itemAt(press->pos());
    if (row && nameOf(row).isEmpty())
    {
      this->AreCurvesShown = !this->AreCurvesShown;
      this->fillLater();
      return true;
    }
    const int column = this->Rows->columnAt(press->pos().x());
    if (row && (column == RoleColumn || press->button() == Qt::RightButton))
    {
      if (!row->isSelected())
      {
        this->Rows->setCurrentItem(
          row, NameColumn, QItemSelectionModel::ClearAndSelect | QItemSelectionModel::Rows);
      }
      this->openRoles(this->Rows->viewport()->mapToGlobal(press->pos()));
      return true;
    }
  }
  return this->Superclass::eventFilter(object, event);
}

void SurfaceTable::addRoles(QMenu* menu, const QStringList& names)
{
  const Role present = this->roles().value(names.value(0), Follows);
  for (const Role role : { Moves, Follows, Stays, Slides, Free })
  {
    QAction* const action = menu->addAction(tr(RoleNames[role]));
    action->setCheckable(true);
    action->setChecked(role == present);
    QObject::connect(
      action, &QAction::triggered, this, [this, names, role] { this->setRole(names, role); });
  }
}

void SurfaceTable::openRoles(const QPoint& place)
{
  this->Roles->clear();
  this->addRoles(this->Roles, this->selectedNames());
  this->Roles->popup(place);
}

void SurfaceTable::OfferRoles(QMenu* menu, pqView* view, const QPoint& place)
{
  auto* const renderer = vtkSMRenderViewProxy::SafeDownCast(view ? view->getProxy() : nullptr);
  for (SurfaceTable* const table : pqCoreUtilities::mainWidget()->findChildren<SurfaceTable*>())
  {
    if (!renderer || !table->isSelected() || table->view() != view)
    {
      continue;
    }
    const double ratio = view->widget()->devicePixelRatioF();
    const int x = static_cast<int>(ratio * place.x());
    const int y = static_cast<int>(ratio * (view->widget()->height() - 1 - place.y()));
    const int pixel[] = { x, y, x, y };
    vtkNew<vtkCollection> shown, selections;
    if (!renderer->SelectSurfaceCells(pixel, shown, selections) || shown->GetNumberOfItems() == 0)
    {
      continue;
    }
    const vtkSMPropertyHelper source(vtkSMProxy::SafeDownCast(shown->GetItemAsObject(0)), "Input");
    const int port = table->portOf(source.GetAsProxy(), static_cast<int>(source.GetOutputPort()));
    auto* const selection = vtkSMProxy::SafeDownCast(selections->GetItemAsObject(0));
    const QStringList names = port < -1 ? QStringList() : table->pickedNames(selection, port);
    if (!names.isEmpty())
    {
      menu->addSection(names.join(", "));
      table->addRoles(menu, names);
      menu->addSeparator();
    }
  }
}

int SurfaceTable::portOf(vtkSMProxy* source, int port) const
{
  const vtkSMPropertyHelper input(this->proxy(), "Input");
  if (source == this->proxy())
  {
    return port;
  }
  return input.GetNumberOfElements() > 0 && source == input.GetAsProxy() ? -1 : -2;
}

void SurfaceTable::setRole(const QStringList& names, Role role)
{
  for (const Role one : { Moves, Stays, Slides, Free })
  {
    Ticks ticks = pqSMAdaptor::getSelectionProperty(this->listOf(one), pqSMAdaptor::UNCHECKED);
    const Ticks before = ticks;
    for (QList<QVariant>& tick : ticks)
    {
      if (tick.size() == 2 && names.contains(tick[0].toString()))
      {
        tick[1] = one == role ? 1 : 0;
      }
    }
    if (ticks != before)
    {
      pqSMAdaptor::setSelectionProperty(this->listOf(one), ticks, pqSMAdaptor::UNCHECKED);
    }
  }
  if (role == Moves)
  {
    this->What->setCurrentIndex(0);
  }
  this->Message->hide();
  Q_EMIT this->changeAvailable();
  Q_EMIT this->changeFinished();
}

void SurfaceTable::apply()
{
  this->Superclass::apply();
  for (const Role role : { Moves, Stays, Slides, Free })
  {
    vtkSMProperty* const list = this->listOf(role);
    const Ticks ticks = pqSMAdaptor::getSelectionProperty(list, pqSMAdaptor::UNCHECKED);
    if (ticks != pqSMAdaptor::getSelectionProperty(list, pqSMAdaptor::CHECKED))
    {
      pqSMAdaptor::setSelectionProperty(list, ticks, pqSMAdaptor::CHECKED);
    }
  }
  this->Rows->clearSelection();
  this->Rows->clear(); // what moves comes first
  this->fillLater();
  this->hidePreview();
  this->Message->hide();
}

void SurfaceTable::reset()
{
  this->Superclass::reset();
  for (const Role role : { Moves, Stays, Slides, Free })
  {
    this->listOf(role)->ClearUncheckedElements();
  }
  this->fillLater();
  this->hidePreview();
  this->Message->hide();
}

void SurfaceTable::hidePreview()
{
  this->Preview->hide();
}

void SurfaceTable::select()
{
  this->Superclass::select();
  this->highlight();
}

void SurfaceTable::deselect()
{
  this->Superclass::deselect();
  this->Highlight->hide();
  this->hidePreview();
}

void SurfaceTable::setView(pqView* view)
{
  this->Superclass::setView(view);
  this->highlight();
}

bool SurfaceTable::areMovesNew() const
{
  vtkSMProperty* const list = this->listOf(Moves);
  return pqSMAdaptor::getSelectionProperty(list, pqSMAdaptor::UNCHECKED) !=
         pqSMAdaptor::getSelectionProperty(list, pqSMAdaptor::CHECKED);
}

void SurfaceTable::highlight()
{
  QStringList names = this->selectedNames();
  // What is applied already, the view shows in another way.
  if (this->areMovesNew())
  {
    names += this->namesOf(Moves);
  }
  names.removeDuplicates();
  if (this->isSelected() && this->view() && !names.isEmpty())
  {
    this->Highlight->show(this->view(), names);
  }
  else
  {
    this->Highlight->hide();
  }
}

void SurfaceTable::previewLater()
{
  if (!this->IsPreviewDue)
  {
    this->IsPreviewDue = true;
    QTimer::singleShot(0, this, [this] { this->preview(); });
  }
}

void SurfaceTable::preview()
{
  this->IsPreviewDue = false;
  const auto* const filter =
    pqApplicationCore::instance()->getServerManagerModel()->findItem<pqPipelineSource*>(
      this->proxy());
  const QStringList names = this->namesOf(Moves);
  const bool isList = vtkSMUncheckedPropertyHelper(this->named("Moving")).GetAsInt() == 0;
  const bool isMotionNew = this->Preview->takeValues();
  // What is applied, the mesh itself shows.
  const bool isPending =
    filter &&
    (filter->modifiedState() == pqProxy::UNINITIALIZED ||
      (filter->modifiedState() == pqProxy::MODIFIED && (isMotionNew || this->areMovesNew())));
  if (this->isSelected() && this->view() && isPending && isList && !names.isEmpty())
  {
    this->Preview->show(this->view(), names);
  }
  else
  {
    this->hidePreview();
  }
}

QStringList SurfaceTable::pickedNames(vtkSMProxy* selection, int port)
{
  vtkSMProxy* const filter = this->proxy();
  vtkSMProperty* const pickProperty = this->named("Pick");
  vtkSMProperty* const portProperty = this->named("PickPort");
  vtkSMProperty* const picked = this->named("PickedSurfaces");
  vtkSMPropertyHelper pick(pickProperty), pickPort(portProperty);
  pick.Set(selection);
  pickPort.Set(port);
  filter->UpdateProperty(filter->GetPropertyName(pickProperty));
  filter->UpdateProperty(filter->GetPropertyName(portProperty));
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
  filter->UpdateProperty(filter->GetPropertyName(pickProperty));
  filter->UpdateProperty(filter->GetPropertyName(portProperty));
  return names;
}

void SurfaceTable::pickRows(pqOutputPort* port)
{
  vtkSMProxy* const selection = port ? port->getSelectionInput() : nullptr;
  if (!selection)
  {
    return;
  }
  const int picked = this->portOf(port->getSource()->getProxy(), port->getPortNumber());
  if (picked < -1)
  {
    return;
  }
  const bool isOwn = picked >= 0;
  this->selectNames(this->pickedNames(selection, picked));
  // ParaView makes the input active, on which was selected; a new filter is still being filled in.
  const auto* const model = pqApplicationCore::instance()->getServerManagerModel();
  auto* const filter = model->findItem<pqPipelineSource*>(this->proxy());
  if (!isOwn && filter && filter->modifiedState() == pqProxy::UNINITIALIZED)
  {
    QTimer::singleShot(
      0, filter, [filter] { pqActiveObjects::instance().setActiveSource(filter); });
  }
}

void SurfaceTable::addSelected()
{
  const QStringList names = this->selectedNames();
  if (names.isEmpty())
  {
    this->say(tr("Nothing is selected. Select cells or points of the mesh in the view, for "
                 "instance with the key S, or rows of the table, and press the button again."));
    return;
  }
  this->setRole(names, Moves);
  pqPVApplicationCore::instance()->selectionManager()->clearSelection();
  this->Rows->clearSelection();
  this->say(tr("Moves: %1").arg(names.join(", ")));
}

void SurfaceTable::say(const QString& message)
{
  this->Message->setText(message);
  this->Message->show();
}
