// SPDX-License-Identifier: BSD-3-Clause
#ifndef FirstHit_h
#define FirstHit_h

#include <QObject>
#include <QPointer>

class QListWidget;

/// Makes Morph Mesh the first hit of ParaView's quick launch (Ctrl+Space) for what its name starts
/// with. The quick launch orders what it finds by the alphabet, and Morph Adjoint would be the
/// first hit of "morph". Up to ParaView 5.12 Morph Mesh moves before the other filters of the
/// plugin. From 5.13 on the list sorts itself, so Morph Mesh is selected where it is. Entries of
/// others stay where they are, and are taken as before.
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
  QPointer<QObject> Dialog; ///< that is open, up to ParaView 5.12

  /// The lists of `dialog`: filters that are available, and those that are not.
  static void order(QObject* dialog);
  /// Selects as soon as something is typed; `dialog`: from ParaView 5.13 on.
  static void selectIn(QObject* dialog);
};

#endif
