// SPDX-License-Identifier: BSD-3-Clause
#ifndef QualityBar_h
#define QualityBar_h

#include <QWidget>

class vtkSMProxy;

/// The color map of the scaled Jacobian, as the views of a filter's session have it, with a mark at
/// the minimum of the mesh.
class QualityBar : public QWidget
{
  Q_OBJECT
  Q_PROPERTY(double minimum READ minimum)

public:
  QualityBar(vtkSMProxy* filter, QWidget* parent);
  ~QualityBar() override;

  double minimum() const { return this->Minimum; }
  void setMinimum(double minimum);

  QSize sizeHint() const override;

protected:
  void paintEvent(QPaintEvent* event) override;

private:
  vtkSMProxy* Filter;
  double Minimum = 0;
};

#endif
