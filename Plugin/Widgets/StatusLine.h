// SPDX-License-Identifier: BSD-3-Clause
#ifndef StatusLine_h
#define StatusLine_h

#include <pqPropertyWidget.h>

class BadCells;
class QLabel;
class QPushButton;
class MessageList;
class QualityBar;
class QWidget;
class pqPipelineSource;

/// How the last execution ended, on a ground of its color: green where the mesh is valid, orange
/// where it has made a part of the motion, red where it is not valid or there is none. Below it the
/// color map with the minimum, the inverted cells before and after, a link to the bad cells, and
/// the seconds. What the execution had to say follows (MessageList.h). Before anything moves it has
/// the advice what to do instead. A filter with the hint <SavesShapes/> has a button that saves its
/// result as a shape (SavedShape.h).
///
/// It is the widget of the property with the advice (panel_widget="StatusLine"). The filter's
/// results of vtkMorphAlgorithm have their usual names.
class StatusLine : public pqPropertyWidget
{
  Q_OBJECT
  using Superclass = pqPropertyWidget;

public:
  StatusLine(vtkSMProxy* filter, vtkSMProperty* advice, QWidget* parent = nullptr);
  ~StatusLine() override;

public Q_SLOTS:
  void setView(pqView* view) override;

protected:
  /// ParaView disables the widgets of results; this one has buttons.
  void changeEvent(QEvent* event) override;

private Q_SLOTS:
  void showLater();

private:
  double number(const char* result) const;
  QString text(const char* result) const;
  void showStatus();
  pqPipelineSource* source() const;
  /// The button is for a result that has moved the mesh, or that Apply may still make.
  void offerShape();

  QLabel* Status;
  QLabel* Details;
  QLabel* Text;
  QualityBar* Minimum;
  BadCells* Bad;
  MessageList* Messages;
  QPushButton* Save = nullptr; ///< null without the hint
  bool IsDue = false;          ///< showStatus()
};

#endif
