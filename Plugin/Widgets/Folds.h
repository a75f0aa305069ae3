// SPDX-License-Identifier: BSD-3-Clause
#ifndef Folds_h
#define Folds_h

#include <QMap>
#include <QObject>
#include <QPointer>
#include <QString>
#include <QVector>

class Fold;
class FoldTitle;
class QWidget;
class pqSearchBox;

/// The groups of one filter's panel that open and close (Fold), and their titles, which take the
/// place of ParaView's. The panel becomes as narrow as ParaView's dock.
class Folds : public QObject
{
  Q_OBJECT
  using Superclass = QObject;

public:
  /// Those of a panel, which owns them.
  static Folds* Of(QWidget* panel);
  ~Folds() override;

  void add(const QString& title, Fold* row);
  bool isOpen(const QString& title) const;

  bool eventFilter(QObject* object, QEvent* event) override;

public Q_SLOTS:
  /// After the values of this round of the event loop.
  void refreshLater();

private:
  struct Group
  {
    QVector<QPointer<Fold>> Rows;
    QPointer<FoldTitle> Title;
    bool Asked = false; ///< a user has opened or closed it: Open
    bool Open = false;
  };

  explicit Folds(QWidget* panel);

  bool isSearched() const;
  bool withAdvanced() const;
  void refresh();
  void narrow() const;
  void place(const QString& title, Group& group);

  QMap<QString, Group> Groups;
  pqSearchBox* Search = nullptr;
  bool Due = false; ///< refresh()
};

#endif
