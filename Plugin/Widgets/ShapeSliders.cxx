// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeSliders.h"

#include "LiveDrag.h"

#include <pqCoreUtilities.h>
#include <vtkCommand.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMUncheckedPropertyHelper.h>

#include <QCheckBox>
#include <QDoubleValidator>
#include <QFontMetrics>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QSlider>

#include <algorithm>
#include <cmath>
#include <string>

namespace
{
constexpr int Steps = 1000;   ///< of a slider
constexpr double Limit = 1e6; ///< an end beyond it is none: rounding makes such ends

QString text(double value, int digits)
{
  return QString::number(value, 'g', digits);
}

/// The range around 0 as text; `ends`: lowest and highest, both 0 for none.
QString rangeText(const double* ends)
{
  const auto isAny = [](double value) { return std::abs(value) > Limit; };
  if (isAny(ends[0]) && isAny(ends[1]))
  {
    return "any";
  }
  if (!(ends[0] < ends[1]))
  {
    return "none";
  }
  const auto end = [&isAny](double value) { return isAny(value) ? "any" : text(value, 4); };
  return QString("%1 to %2").arg(end(ends[0]), end(ends[1]));
}
}

ShapeSliders::ShapeSliders(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
  : Superclass(proxy, parent)
  , Grid(new QGridLayout(this))
  , Drag(new LiveDrag(this))
{
  this->setShowLabel(false);
  // A weight is a change while its slider moves, and done when it is released.
  this->setChangeAvailableAsChangeFinished(false);
  this->Grid->setContentsMargins(0, 0, 0, 0);
  this->Grid->setColumnStretch(1, 2);
  this->Grid->setColumnStretch(2, 1);
  this->refresh();
  this->addPropertyLink(this, "weights", SIGNAL(weightsChanged()), property);
  if (vtkSMProperty* const motions = proxy->GetProperty("Motions"))
  {
    pqCoreUtilities::connect(motions, vtkCommand::ModifiedEvent, this, SLOT(showMotions()));
  }
  for (const char* name : { "Shapes", "ShapeNames", "ValidWeights" })
  {
    if (vtkSMProperty* const other = proxy->GetProperty(name))
    {
      for (const unsigned long event : { static_cast<unsigned long>(vtkCommand::ModifiedEvent),
             static_cast<unsigned long>(vtkCommand::UncheckedPropertyModifiedEvent) })
      {
        pqCoreUtilities::connect(other, static_cast<int>(event), this, SLOT(refresh()));
      }
    }
  }
}

ShapeSliders::~ShapeSliders() = default;

QList<QVariant> ShapeSliders::weights() const
{
  QList<QVariant> list;
  for (const Row& row : this->Rows)
  {
    list.append(row.Weight);
  }
  return list;
}

void ShapeSliders::setWeights(const QList<QVariant>& weights)
{
  for (std::size_t i = 0; i < this->Rows.size(); ++i)
  {
    const int place = static_cast<int>(i);
    this->Rows[i].Weight = place < weights.size() ? weights[place].toDouble() : 0;
    this->showWeight(i);
  }
}

// Not a link: ParaView takes a list with an enumeration for a set of ticks.
void ShapeSliders::apply()
{
  Superclass::apply();
  std::vector<int> motions;
  for (const Row& row : this->Rows)
  {
    motions.push_back(row.Turns->isChecked() ? 1 : 0);
  }
  vtkSMPropertyHelper(this->proxy(), "Motions")
    .Set(motions.data(), static_cast<unsigned int>(motions.size()));
}

void ShapeSliders::reset()
{
  Superclass::reset();
  this->showMotions();
}

void ShapeSliders::showMotions()
{
  const std::vector<int> motions = vtkSMPropertyHelper(this->proxy(), "Motions").GetIntArray();
  for (std::size_t i = 0; i < this->Rows.size(); ++i)
  {
    const QSignalBlocker blocker(this->Rows[i].Turns);
    this->Rows[i].Turns->setChecked(i < motions.size() && motions[i] == 1);
  }
}

void ShapeSliders::refresh()
{
  const std::size_t shapes =
    std::max(1u, vtkSMUncheckedPropertyHelper(this->proxy(), "Shapes").GetNumberOfElements());
  while (this->Rows.size() < shapes)
  {
    this->addRow();
  }
  while (this->Rows.size() > shapes)
  {
    this->removeRow();
  }
  for (std::size_t i = 0; i < this->Rows.size(); ++i)
  {
    this->showName(i);
    this->showRange(i);
  }
}

void ShapeSliders::addRow()
{
  const std::size_t i = this->Rows.size();
  const int place = static_cast<int>(i);
  Row row;
  row.Name = new QLabel(this);
  row.Slider = new QSlider(Qt::Horizontal, this);
  row.Number = new QLineEdit(this);
  row.Turns = new QCheckBox("turns", this);
  row.Range = new QLabel(this);
  row.Slider->setObjectName(QString("Slider%1").arg(place));
  row.Number->setObjectName(QString("Weight%1").arg(place));
  row.Turns->setObjectName(QString("Turns%1").arg(place));
  row.Range->setObjectName(QString("Range%1").arg(place));
  row.Slider->setRange(0, Steps);
  row.Number->setMaximumWidth(QFontMetrics(row.Number->font()).boundingRect("-0.888888").width());
  row.Number->setValidator(new QDoubleValidator(row.Number));
  row.Slider->setToolTip("The weight of the shape: 0 leaves it out, 1 is the whole shape");
  row.Range->setToolTip("No cell is inverted in this range, the other weights at their present "
                        "values");
  row.Turns->setToolTip("Take the shape as a rotation about its axis: the weight is the factor of "
                        "the angle");
  QWidget* const widgets[] = { row.Name, row.Slider, row.Number, row.Turns };
  for (int column = 0; column < 4; ++column)
  {
    this->Grid->addWidget(widgets[column], 2 * place, column);
  }
  // Below, where it changes no width: there is none while a slider is dragged.
  row.Range->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  this->Grid->addWidget(row.Range, 2 * place + 1, 1, 1, 3);
  QObject::connect(row.Turns, &QCheckBox::toggled, this,
    [this]
    {
      Q_EMIT this->changeAvailable();
      Q_EMIT this->changeFinished();
    });
  const auto properties = std::vector<std::string>{ "Weights" };
  QObject::connect(row.Slider, &QSlider::sliderPressed, this,
    [this, properties] { this->Drag->begin(this->proxy(), properties); });
  QObject::connect(row.Slider, &QSlider::valueChanged, this, [this, i] { this->slide(i); });
  QObject::connect(row.Slider, &QSlider::sliderReleased, this,
    [this]
    {
      this->Drag->end();
      Q_EMIT this->changeFinished();
    });
  QObject::connect(row.Number, &QLineEdit::editingFinished, this, [this, i] { this->type(i); });
  this->Rows.push_back(row);
  this->showMotions();
  this->showWeight(i);
}

void ShapeSliders::removeRow()
{
  const Row& row = this->Rows.back();
  for (QWidget* const widget : { static_cast<QWidget*>(row.Name), static_cast<QWidget*>(row.Slider),
         static_cast<QWidget*>(row.Number), static_cast<QWidget*>(row.Turns),
         static_cast<QWidget*>(row.Range) })
  {
    widget->deleteLater();
  }
  this->Rows.pop_back();
}

void ShapeSliders::showName(std::size_t row)
{
  const vtkSMUncheckedPropertyHelper names(this->proxy(), "ShapeNames");
  const auto place = static_cast<unsigned int>(row);
  const QString name = place < names.GetNumberOfElements() ? names.GetAsString(place) : "";
  this->Rows[row].Name->setText(name.isEmpty() ? QString("Shape %1").arg(place + 1) : name);
}

void ShapeSliders::showWeight(std::size_t row)
{
  Row& shown = this->Rows[row];
  this->Showing = true;
  if (!shown.Slider->isSliderDown())
  {
    shown.Lowest = std::min(-1., shown.Weight);
    shown.Highest = std::max(1., shown.Weight);
    shown.Slider->setValue(static_cast<int>(
      std::lround(Steps * (shown.Weight - shown.Lowest) / (shown.Highest - shown.Lowest))));
  }
  shown.Number->setText(text(shown.Weight, 6));
  this->Showing = false;
  this->showRange(row);
}

void ShapeSliders::showRange(std::size_t row)
{
  const Row& shown = this->Rows[row];
  const std::vector<double> ends =
    vtkSMPropertyHelper(this->proxy(), "ValidWeights").GetDoubleArray();
  if (ends.size() < 2 * row + 2)
  {
    shown.Range->clear();
    shown.Number->setStyleSheet(QString());
    return;
  }
  shown.Range->setText(rangeText(&ends[2 * row]));
  const bool isInside = ends[2 * row] < shown.Weight && shown.Weight < ends[2 * row + 1];
  shown.Number->setStyleSheet(isInside ? "" : "color: red");
}

void ShapeSliders::slide(std::size_t row)
{
  const Row& moved = this->Rows[row];
  if (!this->Showing)
  {
    const double part = static_cast<double>(moved.Slider->value()) / Steps;
    this->change(row, moved.Lowest + part * (moved.Highest - moved.Lowest));
  }
}

void ShapeSliders::type(std::size_t row)
{
  bool isNumber = false;
  const double weight = this->Rows[row].Number->text().toDouble(&isNumber);
  // The field shows fewer digits than the weight may have.
  if (isNumber && this->Rows[row].Number->text() != text(this->Rows[row].Weight, 6))
  {
    this->change(row, weight);
  }
}

void ShapeSliders::change(std::size_t row, double weight)
{
  this->Rows[row].Weight = weight;
  this->showWeight(row);
  const bool isDragged = this->Rows[row].Slider->isSliderDown();
  // A key, the wheel or a typed number is a short drag.
  const bool isShort = !isDragged && this->Drag->begin(this->proxy(), { "Weights" });
  Q_EMIT this->weightsChanged();
  Q_EMIT this->changeAvailable();
  if (isDragged)
  {
    this->Drag->follow(true);
    return;
  }
  if (isShort)
  {
    this->Drag->end();
  }
  Q_EMIT this->changeFinished();
}
