// SPDX-License-Identifier: BSD-3-Clause
#ifndef MessageList_h
#define MessageList_h

#include <QPointer>
#include <QStringList>
#include <QVector>
#include <QWidget>

class QLabel;
class QString;
class QVBoxLayout;
class pqPropertyWidget;
class pqView;
class vtkSMProxy;

/// What the last execution of a filter had to say (vtkMorphMesh::GetMessages()), in the words of
/// the panel. A message stands below the field of the property that it names first, or here if none
/// of its fields is shown. Its remedies are buttons: the value of a property that it proposes, or a
/// cell that it names with its place.
class MessageList : public QWidget
{
  Q_OBJECT

public:
  /// `owner`: of the filter's panel.
  explicit MessageList(pqPropertyWidget* owner);
  ~MessageList() override;

  void showMessages();

private:
  pqPropertyWidget* Owner;
  QVBoxLayout* Rows;
  QVector<QPointer<QWidget>> Shown;
  bool IsError = false; ///< one that is shown

  vtkSMProxy* filter() const;
  QWidget* rowOf(const QString& kind, const QString& message);
  /// Adds the buttons of a message to a row.
  void addRemedies(const QString& message, QWidget* row);
  void set(const QString& property, const QString& value);
  void goTo(int cell, const double place[3]);
  /// Puts a row below the field that a message is about, or into this list.
  void place(QWidget* row, const QString& message);
};

#endif
