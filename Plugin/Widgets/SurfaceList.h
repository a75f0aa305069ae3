// SPDX-License-Identifier: BSD-3-Clause
#ifndef SurfaceList_h
#define SurfaceList_h

#include <pqPropertyWidget.h>

#include <QString>

class pqArraySelectionWidget;

/// A list of surfaces or zones to tick, with the size of each in two columns beside its name. Of a
/// curve these are edges and length. It is the widget of a list with a KeptArraySelectionDomain
/// (panel_widget="SurfaceList"), whose hint names the property that has the sizes, three texts for
/// each name, and the columns:
///
///     <SurfaceList sizes="SurfaceSizes" columns="Faces Area"/>
class SurfaceList : public pqPropertyWidget
{
  Q_OBJECT
  using Superclass = pqPropertyWidget;

public:
  SurfaceList(vtkSMProxy* filter, vtkSMProperty* list, QWidget* parent = nullptr);
  ~SurfaceList() override;

protected:
  /// Shows a row's name and sizes, which may be cut off, as its tool tip.
  bool eventFilter(QObject* object, QEvent* event) override;

private Q_SLOTS:
  void showSizes();

private:
  pqArraySelectionWidget* List;
  vtkSMProperty* Sizes;
  QString Name; ///< of the list
};

#endif
