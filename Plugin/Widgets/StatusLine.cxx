// SPDX-License-Identifier: BSD-3-Clause
#include "StatusLine.h"

#include "BadCells.h"
#include "MessageList.h"
#include "QualityBar.h"
#include "SavedShape.h"

#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>
#include <pqPipelineSource.h>
#include <pqServerManagerModel.h>
#include <vtkCommand.h>
#include <vtkPVXMLElement.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>

#include <QApplication>
#include <QEvent>
#include <QHBoxLayout>
#include <QLabel>
#include <QPalette>
#include <QPushButton>
#include <QStringList>
#include <QTimer>
#include <QVBoxLayout>

#include <cmath>

namespace
{
constexpr const char* Results[] = { "MorphStatus", "MinScaledJacobian", "InvertedCells",
  "DegenerateCells", "InvertedBefore", "CrossingFaces", "LargestValidStep", "PrepareSeconds",
  "EvaluateSeconds", "Messages" };

const QString Green = "#2e7d32", Orange = "#b35900", Red = "#b71c1c", Gray = "#616161";
}

StatusLine::StatusLine(vtkSMProxy* filter, vtkSMProperty* advice, QWidget* parent)
  : Superclass(filter, parent)
  , Status(new QLabel(this))
  , Details(new QLabel(this))
  , Text(new QLabel(this))
  , Minimum(new QualityBar(filter, this))
  , Bad(new BadCells(filter, this))
  , Messages(new MessageList(this))
{
  this->setShowLabel(false);
  this->setProperty(advice);
  this->Status->setObjectName("Status");
  this->Details->setObjectName("Details");
  this->Text->setObjectName("Text");
  this->Minimum->setObjectName("Minimum");
  // ParaView gives it the colors of a field that cannot be edited: a frame makes it a note.
  this->Text->setFrameShape(QFrame::StyledPanel);
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  for (QLabel* const label : { this->Status, this->Details, this->Text })
  {
    label->setWordWrap(true);
    label->setMargin(3);
    // Results are fields that cannot be edited, which ParaView shows in gray.
    label->setStyleSheet("color: " + this->palette().color(QPalette::WindowText).name());
    layout->addWidget(label);
  }
  layout->insertWidget(1, this->Minimum);
  auto* const buttons = new QHBoxLayout();
  buttons->addWidget(this->Bad);
  buttons->addStretch();
  vtkPVXMLElement* const hints = filter->GetHints();
  if (hints && hints->FindNestedElementByName("SavesShapes"))
  {
    this->Save = new QPushButton(tr("Save as Shape"), this);
    this->Save->setObjectName("SaveAsShape");
    // ParaView shows what belongs to a result in black.
    this->Save->setStyleSheet(
      "QPushButton:disabled { color: " +
      QApplication::palette().color(QPalette::Disabled, QPalette::ButtonText).name() + " }");
    QObject::connect(this->Save, &QPushButton::clicked, this, [this] { SavedShape::Save(this); });
    buttons->addWidget(this->Save);
    QObject::connect(this->source(), SIGNAL(modifiedStateChanged(pqServerManagerModelItem*)), this,
      SLOT(showLater()));
  }
  layout->addLayout(buttons);
  layout->addWidget(this->Messages);
  pqCoreUtilities::connect(advice, vtkCommand::ModifiedEvent, this, SLOT(showLater()));
  for (const char* const name : Results)
  {
    pqCoreUtilities::connect(
      filter->GetProperty(name), vtkCommand::ModifiedEvent, this, SLOT(showLater()));
  }
  this->showStatus();
}

StatusLine::~StatusLine() = default;

void StatusLine::setView(pqView* view)
{
  this->Superclass::setView(view);
  this->Bad->setView(view);
}

void StatusLine::changeEvent(QEvent* event)
{
  this->Superclass::changeEvent(event);
  if (event->type() == QEvent::EnabledChange && !this->isEnabled())
  {
    this->setEnabled(true);
  }
}

double StatusLine::number(const char* result) const
{
  return vtkSMPropertyHelper(this->proxy(), result).GetAsDouble();
}

QString StatusLine::text(const char* result) const
{
  const vtkSMPropertyHelper helper(this->proxy(), result);
  return helper.GetNumberOfElements() > 0 ? helper.GetAsString() : "None";
}

pqPipelineSource* StatusLine::source() const
{
  return pqApplicationCore::instance()->getServerManagerModel()->findItem<pqPipelineSource*>(
    this->proxy());
}

void StatusLine::offerShape()
{
  if (!this->Save)
  {
    return;
  }
  // What is not applied yet, the button applies first.
  const bool isApplied = this->source()->modifiedState() == pqProxy::UNMODIFIED;
  this->Save->setEnabled(!isApplied || SavedShape::HasMotion(this->proxy()));
  this->Save->setToolTip(
    this->Save->isEnabled()
      ? tr("Makes a Morph Shapes filter with this result as a shape; a press later adds the next "
           "one")
      : tr("Nothing has moved: change what moves, or by how much"));
}

void StatusLine::showLater()
{
  if (!this->IsDue)
  {
    this->IsDue = true;
    QTimer::singleShot(0, this, [this] { this->showStatus(); });
  }
}

void StatusLine::showStatus()
{
  this->IsDue = false;
  const QString status = this->text("MorphStatus");
  const QString advice = this->text("Advice");
  const QString minimum =
    tr(", minimum %1").arg(QString::number(this->number("MinScaledJacobian"), 'g', 3));
  const QString inverted = QString::number(this->number("InvertedCells"), 'f', 0);
  // What is reached is not rounded up to all of it.
  const QString reached =
    QString::number(std::floor(100 * this->number("LargestValidStep")), 'f', 0);
  QString said = status, color = Red;
  if (status == "Valid" || status == "Repaired" || status == "SubStepped")
  {
    color = Green;
    said = (status == "SubStepped" ? tr("Valid, by sub-steps") : status) + minimum;
  }
  else if (status == "Partial")
  {
    color = Orange;
    said = tr("Reached %1 % of the motion").arg(reached) + minimum;
  }
  else if (status == "Inverted")
  {
    said = tr("%1 inverted cells").arg(inverted) + minimum;
  }
  else if (status == "CrossesItself")
  {
    said = tr("Crosses itself: %1 faces").arg(this->number("CrossingFaces"));
  }
  else if (status == "Unmeasured")
  {
    color = Gray;
    said = tr("Not measured");
  }
  else if (status == "Failed")
  {
    said = tr("Failed: the mesh is undeformed");
  }
  else if (status == "Cancelled")
  {
    color = Orange;
    said = tr("Stopped: the mesh is undeformed");
  }
  this->Status->setText(said);
  this->Status->setStyleSheet(
    QString("background: %1; color: white; font-weight: bold").arg(color));
  this->Status->setVisible(status != "None");

  QStringList details;
  if (this->number("InvertedBefore") >= 0 && this->number("InvertedCells") >= 0)
  {
    details << tr("Inverted cells: %1 before, %2 after")
                 .arg(this->number("InvertedBefore"))
                 .arg(inverted);
  }
  details << tr("%1 s").arg(
    QString::number(this->number("PrepareSeconds") + this->number("EvaluateSeconds"), 'g', 2));
  this->Details->setText(details.join(", "));
  this->Details->setVisible(this->Status->isVisibleTo(this) && color != Gray &&
                            status != "Failed" && status != "Cancelled");

  const bool isMeasured = this->number("InvertedCells") >= 0;
  this->Minimum->setMinimum(this->number("MinScaledJacobian"));
  this->Minimum->setVisible(this->Details->isVisibleTo(this) && isMeasured);
  this->Bad->setCount(
    isMeasured ? static_cast<int>(this->number("InvertedCells") + this->number("DegenerateCells"))
               : 0);

  this->Text->setText(advice == "None" ? QString() : advice);
  this->Messages->showMessages();
  this->Text->setVisible(advice != "None" && !advice.isEmpty());
  this->offerShape();
}
