// SPDX-License-Identifier: BSD-3-Clause
#ifndef FirstHit_h
#define FirstHit_h

#include <QList>
#include <QObject>

class QListWidget;

/// Puts Morph Mesh before the plugin's other filters in ParaView's quick launch (Ctrl+Space), which
/// orders what it finds by the alphabet: Morph Adjoint would be the first hit of "morph". Entries
/// of others stay where they are.
class FirstHit : public QObject
{
  Q_OBJECT

public:
  FirstHit() = default;
  ~FirstHit() override = default;

  void startup();
  void shutdown() {}
  bool eventFilter(QObject* watched, QEvent* event) override;

private Q_SLOTS:
  void aboutToShow();

private:
  QList<QListWidget*> Lists; ///< of the dialog that is open

  static void order(QListWidget* hits);
};

#endif
