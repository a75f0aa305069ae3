// SPDX-License-Identifier: BSD-3-Clause
#include "QualityBar.h"

#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMSessionProxyManager.h>

#include <QLinearGradient>
#include <QPainter>

#include <algorithm>
#include <cmath>
#include <vector>

QualityBar::QualityBar(vtkSMProxy* filter, QWidget* parent)
  : QWidget(parent)
  , Filter(filter)
{
  this->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

QualityBar::~QualityBar() = default;

void QualityBar::setMinimum(double minimum)
{
  this->Minimum = minimum;
  this->setToolTip(tr("Minimum scaled Jacobian: %1").arg(minimum, 0, 'g', 3));
  this->update();
}

QSize QualityBar::sizeHint() const
{
  return { 10 * this->fontMetrics().averageCharWidth(), this->fontMetrics().height() };
}

void QualityBar::paintEvent(QPaintEvent*)
{
  // A place, and its color; the user may have changed them. No view shows the array: no map.
  vtkSMProxy* const table = this->Filter->GetSessionProxyManager()->GetProxy(
    "lookup_tables", "ScaledJacobian.PVLookupTable");
  const std::vector<double> map =
    table ? vtkSMPropertyHelper(table, "RGBPoints").GetDoubleArray() : std::vector<double>();
  if (map.size() < 8 || !(map[map.size() - 4] > map[0]))
  {
    return;
  }
  const double first = map[0], width = map[map.size() - 4] - first;
  const int mark = this->height() / 2; // as wide as high
  const QRect bar = this->rect().adjusted(mark / 2, mark / 2, -mark / 2 - 1, -1);
  QLinearGradient colors(bar.topLeft(), bar.topRight());
  for (std::size_t i = 0; i + 3 < map.size(); i += 4)
  {
    colors.setColorAt(
      (map[i] - first) / width, QColor::fromRgbF(map[i + 1], map[i + 2], map[i + 3]));
  }
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.fillRect(bar, colors);
  const double part = std::clamp((this->Minimum - first) / width, 0., 1.);
  const double at = bar.left() + part * bar.width();
  painter.setPen(QPen(this->palette().color(QPalette::WindowText), 1.5));
  painter.setBrush(this->palette().color(QPalette::WindowText));
  const QPointF triangle[] = { { at - mark / 2., 0.5 }, { at + mark / 2., 0.5 },
    { at, bar.top() + 2. } };
  painter.drawPolygon(triangle, 3);
  painter.setPen(QPen(Qt::white, 3));
  painter.drawLine(QPointF(at, bar.top() + 3), QPointF(at, bar.bottom()));
  painter.setPen(QPen(Qt::black, 1));
  painter.drawLine(QPointF(at, bar.top() + 3), QPointF(at, bar.bottom()));
}
