// SPDX-License-Identifier: BSD-3-Clause
#include "FoldTitle.h"

#include <QRegularExpression>
#include <QStyleOptionToolButton>
#include <QStylePainter>

FoldTitle::FoldTitle(const QString& title, QWidget* panel)
  : QToolButton(panel)
{
  QString name = title;
  this->setObjectName("Fold" + name.remove(QRegularExpression("[^A-Za-z]")));
  this->setText(title);
  this->setCheckable(true);
  this->setAutoRaise(true);
  this->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

FoldTitle::~FoldTitle() = default;

void FoldTitle::setHeld(const QString& held)
{
  if (this->Held != held)
  {
    this->Held = held;
    this->setToolTip(held);
    this->update();
  }
}

QSize FoldTitle::sizeHint() const
{
  return { 20 * this->fontMetrics().averageCharWidth(), 3 * this->fontMetrics().height() / 2 };
}

QSize FoldTitle::minimumSizeHint() const
{
  return this->sizeHint();
}

void FoldTitle::paintEvent(QPaintEvent*)
{
  QStylePainter painter(this);
  QStyleOptionToolButton option;
  this->initStyleOption(&option);
  option.state &= ~QStyle::State_On; // open: an arrow says so
  option.text.clear();
  painter.drawComplexControl(QStyle::CC_ToolButton, option);

  const int arrow = this->height() / 2;
  QStyleOption place;
  place.initFrom(this);
  place.rect = QRect(arrow / 2, (this->height() - arrow) / 2, arrow, arrow);
  painter.drawPrimitive(
    this->isChecked() ? QStyle::PE_IndicatorArrowDown : QStyle::PE_IndicatorArrowRight, place);

  QFont bold = this->font();
  bold.setBold(true);
  painter.setFont(bold);
  QRect rest = this->rect().adjusted(2 * arrow, 0, -arrow / 2, 0);
  painter.drawText(rest, Qt::AlignLeft | Qt::AlignVCenter, this->text());
  rest.setLeft(rest.left() + painter.fontMetrics().horizontalAdvance(this->text()) + arrow);
  painter.setFont(this->font());
  QColor gray = this->palette().color(QPalette::WindowText);
  gray.setAlphaF(0.6);
  painter.setPen(gray);
  painter.drawText(rest, Qt::AlignLeft | Qt::AlignVCenter,
    this->fontMetrics().elidedText(this->Held, Qt::ElideRight, rest.width()));
}
