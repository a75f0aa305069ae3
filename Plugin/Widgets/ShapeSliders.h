// SPDX-License-Identifier: BSD-3-Clause
#ifndef ShapeSliders_h
#define ShapeSliders_h

#include <pqPropertyWidget.h>

#include <QList>
#include <QVariant>

#include <vector>

class LiveDrag;
class QCheckBox;
class QGridLayout;
class QLabel;
class QLineEdit;
class QSlider;
class vtkSMProperty;
class vtkSMProxy;

/// The weights of Morph Shapes: a row for each shape with its name, a slider, a number, a tick for
/// a rotation, and below the range of the weight in which no cell is inverted. A slider runs from
/// -1 to 1, and further where the weight is beyond. A weight outside of its range is red. With
/// LiveDrag on the mesh follows a slider while it is dragged. In XML: panel_widget="ShapeSliders".
class ShapeSliders : public pqPropertyWidget
{
  Q_OBJECT
  Q_PROPERTY(QList<QVariant> weights READ weights WRITE setWeights NOTIFY weightsChanged)
  using Superclass = pqPropertyWidget;

public:
  ShapeSliders(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~ShapeSliders() override;

  QList<QVariant> weights() const;
  void setWeights(const QList<QVariant>& weights);

public Q_SLOTS:
  void apply() override;
  void reset() override;

Q_SIGNALS:
  void weightsChanged();

private Q_SLOTS:
  /// One row a shape, with its name and range.
  void refresh();
  /// Ticks as the property Motions has it.
  void showMotions();

private:
  struct Row
  {
    QLabel* Name;
    QSlider* Slider;
    QLineEdit* Number;
    QCheckBox* Turns;
    QLabel* Range;
    double Weight = 0;
    double Lowest = -1, Highest = 1; ///< of the slider
  };
  QGridLayout* Grid;
  LiveDrag* Drag;
  std::vector<Row> Rows;
  bool Showing = false; ///< widgets are being set to what they stand for

  void addRow();
  void removeRow();
  void showName(std::size_t row);
  void showWeight(std::size_t row);
  void showRange(std::size_t row);
  void slide(std::size_t row);
  void type(std::size_t row);
  void change(std::size_t row, double weight);
};

#endif
