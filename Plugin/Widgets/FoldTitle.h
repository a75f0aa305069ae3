// SPDX-License-Identifier: BSD-3-Clause
#ifndef FoldTitle_h
#define FoldTitle_h

#include <QToolButton>

/// The title of a group of properties: an arrow, the name in bold, and in gray what it holds, cut
/// off where the panel ends. A press opens or closes the group.
class FoldTitle : public QToolButton
{
  Q_OBJECT
  Q_PROPERTY(QString held READ held)

public:
  FoldTitle(const QString& title, QWidget* panel);
  ~FoldTitle() override;

  QString held() const { return this->Held; }
  void setHeld(const QString& held);

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

protected:
  void paintEvent(QPaintEvent* event) override;

private:
  QString Held;
};

#endif
