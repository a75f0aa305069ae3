// SPDX-License-Identifier: BSD-3-Clause
#ifndef PresentDimension_h
#define PresentDimension_h

#include <pqPropertyWidgetDecorator.h>

#include <vtkSmartPointer.h>

class QLabel;
class vtkSMSourceProxy;

/// Shows below the field of a dimension what it is now, of the surfaces that are ticked in the
/// panel, applied or not, or why they have none (vtkListedSurfaces::GetDimension()).
class PresentDimension : public pqPropertyWidgetDecorator
{
  Q_OBJECT
  using Superclass = pqPropertyWidgetDecorator;

public:
  PresentDimension(vtkPVXMLElement* hint, pqPropertyWidget* widget);
  ~PresentDimension() override;

  bool eventFilter(QObject* object, QEvent* event) override;

private Q_SLOTS:
  void showLater();

private:
  void showDimension();

  QLabel* Text;
  vtkSmartPointer<vtkSMSourceProxy> Source;
  bool IsDue = false; ///< showDimension()
};

#endif
